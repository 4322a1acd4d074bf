// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/SparseCholesky>
#include <Eigen/SparseLU>
#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <taut/contact/obstacle.hpp>
#include <taut/core/concepts.hpp>
#include <taut/core/detail/fits.hpp>
#include <taut/core/error.hpp>
#include <taut/core/revision.hpp>
#include <taut/core/status.hpp>
#include <taut/core/types.hpp>
#include <taut/network/spring_system.hpp>
#include <taut/solver/solver_concept.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/network/buckling.hpp>
#include <taut/network/tension_only.hpp>

#include "../support/catch.hpp"
#include "../support/laws.hpp"
#include "../support/message.hpp"
#include "../support/random.hpp"

namespace taut_test::core_test {

namespace {

/// The least that the System concept asks for: one free particle on a line, falling.
struct Falling {
    using Scalar = double;
    using State = taut::State<double, 1>;
    taut::Index size() const { return 1; }
    void force(const State&, taut::Points<double, 1>& f) const { f.setConstant(1, 1, -10); }
    Eigen::VectorXd inverse_mass() const { return Eigen::VectorXd::Ones(1); }
    std::uint64_t revision() const { return 0; }
    std::uint64_t force_revision() const { return 0; }
};

}  // namespace

TEST_CASE("concepts: the library's systems and a minimal one of the user's are Systems", "[core]") {
    taut::require_system<Falling>();
    taut::require_system<taut::SpringSystem<float, 2>>();
    taut::require_system<taut::LinearSystem<double>>();
    taut::require_system<taut::GeneralLinearSystem<double>>();
    SUCCEED();
}

TEST_CASE("concepts: Eigen's sparse solvers are Solvers, and symmetric ones are known as such",
          "[core]") {
    using Matrix = taut::SparseMatrix<double>;
    taut::require_solver<Eigen::SimplicialLLT<Matrix>, double>();
    taut::require_solver<Eigen::SparseLU<Matrix>, double>();
    taut::require_solver<Eigen::SparseLU<taut::SparseMatrix<float>>, float>();
    CHECK(taut::is_symmetric_solver_v<Eigen::SimplicialLLT<Matrix>>);
    CHECK(taut::is_symmetric_solver_v<Eigen::SimplicialLDLT<Matrix, Eigen::Upper>>);
    CHECK_FALSE(taut::is_symmetric_solver_v<Eigen::SparseLU<Matrix>>);
}

namespace {

/// A law in double alone, as a user may write one, with slopes between two lengths.
struct InDouble {
    static constexpr bool convex = false;
    template <class Scalar>
    using Parameters = taut::Hookean::Parameters<Scalar>;
    using P = Parameters<double>;
    static double tension(const P& p, double L, double l) { return p.stiffness * (l - L); }
    static double tension_slope(const P& p, double, double) { return p.stiffness; }
    static double energy(const P& p, double L, double l) {
        return p.stiffness * (l - L) * (l - L) / 2;
    }
    static double stiffness_bound(const P& p, double) { return p.stiffness; }
};

/// An engine's own ground, with its own name for what it answers.
struct Ground {
    struct Hit {
        float distance;
        Eigen::Vector3f normal;
    };
    Hit surface(const Eigen::Vector3f& x) const { return {x.z(), Eigen::Vector3f::UnitZ()}; }
};

}  // namespace

TEST_CASE("concepts: the library's laws and a user's own are Laws", "[core]") {
    taut::require_law<taut::Hookean, float>();
    taut::require_law<taut::TensionOnly, double>();
    taut::require_law<taut::Buckling, float>();
    taut::require_law<taut_test::Glue, double>();
    taut::require_law<InDouble, double>();
    SUCCEED();
}

TEST_CASE("concepts: the library's obstacles and a user's own are Obstacles", "[core]") {
    taut::require_obstacle<taut::HalfSpace<float, 2>, Eigen::Vector2f>();
    taut::require_obstacle<taut::Sphere<double, 3>, Eigen::Vector3d>();
    taut::require_obstacle<Ground, Eigen::Vector3f>();
    SUCCEED();
}

TEST_CASE("error: fail joins words and numbers to one sentence", "[core]") {
    const auto message =
        message_of([] { taut::fail("f", ": x[", 3, "] is ", -0.5, "; ", std::string("no")); });
    CHECK(message == "taut::f: x[3] is -0.5; no");
}

TEST_CASE("error: numbers in messages keep nine digits, and NaN and infinity have names",
          "[core]") {
    CHECK(missing(message_of([] { taut::fail(0.123456789); }), {"0.123456789"}) == "");
    CHECK(missing(message_of([] { taut::fail(1e300); }), {"1e+300"}) == "");
    CHECK(missing(message_of([] { taut::fail(std::numeric_limits<float>::infinity()); }),
                  {"inf"}) == "");
    CHECK(missing(message_of([] { taut::fail(std::numeric_limits<double>::quiet_NaN()); }),
                  {"nan"}) == "");
    CHECK(missing(message_of([] { taut::fail(std::numeric_limits<long long>::min()); }),
                  {"-9223372036854775808"}) == "");
    CHECK(missing(message_of([] { taut::fail(std::numeric_limits<unsigned long long>::max()); }),
                  {"18446744073709551615"}) == "");
}

TEMPLATE_TEST_CASE(
    "error: require_non_negative takes zero and every positive number, and nothing else", "[core]",
    float, double) {
    using Limits = std::numeric_limits<TestType>;
    const auto check = [](TestType value) {
        return message_of([&] { taut::require_non_negative("Law", "stiffness", value); });
    };
    for (const TestType good : {TestType(0), Limits::denorm_min(), TestType(1), Limits::max()}) {
        CHECK(check(good) == "");
    }
    for (const TestType bad : {-Limits::denorm_min(), TestType(-1), Limits::infinity(),
                               -Limits::infinity(), Limits::quiet_NaN()}) {
        CHECK(missing(check(bad), {"taut::Law", "stiffness is ", "finite and >= 0"}) == "");
    }
    CHECK(missing(check(TestType(-2.5)), {"-2.5"}) == "");
}

namespace {

struct Pair {
    double first, second;
};

#if defined(__GNUC__) && !defined(__clang__)
__attribute__((noinline, optimize("O3")))
#endif
void hold(const Pair& values, Pair& held) {
    held = {taut::held_as<float>(values.first), taut::held_as<float>(values.second)};
}

}  // namespace

TEST_CASE("held_as: neighbours are rounded too when the optimizer takes them together", "[core]") {
    Random random(20);
    for (int repeat = 0; repeat < 100; ++repeat) {
        const float first = static_cast<float>(random.uniform(1, 2));
        const float second = static_cast<float>(random.uniform(1, 2));
        const double between = 1e-8 * random.uniform(0, 1);  // less than half of a float's last bit
        Pair held{};
        hold({static_cast<double>(first) + between, static_cast<double>(second) + between}, held);
        CHECK(held.first == static_cast<double>(first));
        CHECK(held.second == static_cast<double>(second));
        CHECK(taut::held_as<double>(between) == between);
    }
}

TEST_CASE("revision: edits and assignments only ever raise it", "[core]") {
    taut::Revision a;
    taut::Revision b;
    for (int i = 0; i < 5; ++i) ++b;
    for (int i = 0; i < 3; ++i) ++a;
    const std::uint64_t before = a;
    a = b;
    CHECK(a > before);
    CHECK(a > b);
    const std::uint64_t again = b;
    b = a;
    CHECK(b > again);
    const taut::Revision copy = a;
    CHECK(copy == a);
}

TEST_CASE("status: every status has a sentence of its own", "[core]") {
    const auto all = {taut::Status::ok,
                      taut::Status::invalid_step,
                      taut::Status::invalid_state,
                      taut::Status::diverged,
                      taut::Status::not_positive_definite,
                      taut::Status::solver_failed,
                      taut::Status::not_converged};
    std::set<std::string> sentences;
    for (const taut::Status status : all) sentences.insert(taut::describe(status));
    CHECK(sentences.size() == all.size());
    CHECK(sentences.count("") == 0);
    CHECK(sentences.count(taut::describe(static_cast<taut::Status>(99))) == 0);
}

TEST_CASE("status: a report is true exactly when its status is ok", "[core]") {
    CHECK(static_cast<bool>(taut::Report{}));
    CHECK(taut::Report{}.where == -1);
    CHECK_FALSE(static_cast<bool>(taut::Report{taut::Status::invalid_step}));
    CHECK_FALSE(static_cast<bool>(taut::Report{taut::Status::not_converged, 500}));
}

TEST_CASE("fits: a state fits by its positions and by its velocities", "[core]") {
    using State = taut::State<double, 2>;
    CHECK(taut::detail::fits(State{State::zero(3), State::zero(3), 0}, 3));
    CHECK_FALSE(taut::detail::fits(State{State::zero(2), State::zero(3), 0}, 3));
    CHECK_FALSE(taut::detail::fits(State{State::zero(3), State::zero(2), 0}, 3));
}

}  // namespace taut_test::core_test
