// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <limits>
#include <taut/own_matrices/linear_system.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/tolerance.hpp"
#include "matrices.hpp"

namespace taut_test::own_matrices {

namespace {

constexpr auto all_digits = {Digits::of_float, Digits::of_double};
Real epsilon_of(Digits digits) { return digits == Digits::of_float ? 0x1p-23L : 0x1p-52L; }

const RealVector mass{{1, 2, 4}};
const RealMatrix K{{3, -1, 0}, {-1, 3, -2}, {0, -2, 3}};

RealMatrix draw_matrix(Random& random, Index rows = 8, Index columns = 8) {
    return random_points(random, static_cast<int>(rows), columns, -1, 1).cast<Real>();
}
AnyState draw_state(Random& random, AnyState u) {
    u.x = random_points(random, 1, u.x.cols(), -1, 1);
    u.v = random_points(random, 1, u.v.cols(), -1, 1);
    return u;
}

std::string refusal(const Matrices& m, bool general = false) {
    return message_of([&] { general ? general_system(m) : linear_system(m); });
}
void refuse(const Matrices& m, std::initializer_list<const char*> words, bool general = false) {
    CHECK(missing(refusal(m, general), words) == "");
}
RealMatrix with_entry(Index row, Index column, Real value) {
    RealMatrix changed = K;
    changed(row, column) = value;
    return changed;
}

}  // namespace

TEST_CASE(
    "linear_system: force and energy are load - K u - D v and its potential, and a "
    "GeneralLinearSystem's D and K may be unsymmetric",
    "[own_matrices]") {
    for (const Digits digits : all_digits) {
        Random random(1);
        const auto rounding = static_cast<double>(64 * epsilon_of(digits));
        const RealMatrix A = draw_matrix(random), B = draw_matrix(random);
        const RealVector m = draw_matrix(random, 8, 1).array() / 2 + 1;
        const RealVector load = draw_matrix(random, 8, 1);
        const auto check = [&](const Matrices& of, const AnyLinear& system) {
            const AnyState start = system.start;
            CHECK((start.x.isZero(0) && start.v.isZero(0)));
            const AnyState u = draw_state(random, start);
            const RealVector x = u.x.transpose().cast<Real>(), v = u.v.transpose().cast<Real>();
            CHECK(distance(system.force(u), of.load - of.K * x - of.D * v) <= rounding * 10);
            const Real energy =
                v.dot(of.mass.cwiseProduct(v)) / 2 + x.dot(of.K * x) / 2 - of.load.dot(x);
            CHECK_THAT(system.energy(u), WithinAbs(static_cast<double>(energy), rounding * 10));
            CHECK(distance(system.inverse_mass, of.mass.cwiseInverse()) <= rounding);
            CHECK((system.load.cast<Real>() == of.load));
            CHECK(system.revision == 0);
            // To the bit.
            CHECK((system.stiffness.cast<Real>() == of.K));
            CHECK((system.damping.cast<Real>() == of.D));
        };
        const Matrices symmetric(m, B + B.transpose(), A + A.transpose(), digits, load);
        check(symmetric, linear_system(symmetric));
        const Matrices general(m, B, A, digits, load);
        check(general, general_system(general));
    }
}

TEST_CASE("linear_system: no damping and no load mean zeros of the right size", "[own_matrices]") {
    const auto system = linear_system({mass, {}, K});
    CHECK(system.damping == Eigen::MatrixXd::Zero(3, 3));
    CHECK(system.load == Eigen::VectorXd::Zero(3));
}

TEST_CASE("linear_system: asymmetry of a few ulp is averaged, of many is refused",
          "[own_matrices]") {
    for (const Digits digits : all_digits) {
        const Real ulp = epsilon_of(digits);
        RealMatrix almost = with_entry(0, 1, -1 - 4 * ulp);
        const auto system = linear_system({mass, almost, almost, digits});
        almost(0, 1) = almost(1, 0) = -1 - 2 * ulp;
        CHECK((system.stiffness.cast<Real>() == almost));
        CHECK((system.damping.cast<Real>() == almost));
        refuse({mass, {}, with_entry(0, 1, -1 - 1000 * ulp), digits},
               {"stiffness", "symmetric", "GeneralLinearSystem"});
    }
}

TEST_CASE("linear_system: each pair of entries is judged by its own rows", "[own_matrices]") {
    for (const Digits digits : all_digits) {
        const Real ulp = epsilon_of(digits);
        Random random(4);
        for (int repeat = 0; repeat < 200; ++repeat) {
            // Stiff and soft rows beside each other, some of them coupled.
            const RealMatrix A = draw_matrix(random);
            RealVector scale(8);
            for (Index i = 0; i < 8; ++i) scale[i] = log_uniform(random, 1e-6, 1e6);
            const RealMatrix S = scale.asDiagonal() * (A + A.transpose()) * scale.asDiagonal();
            const Index i = random.below(8);
            const Index j = (i + 1 + random.below(7)) % 8;
            const Real own =
                std::min(S.row(i).cwiseAbs().maxCoeff(), S.row(j).cwiseAbs().maxCoeff());
            INFO("matrix " << repeat << ", (" << i << ", " << j << ")");
            for (const Real asymmetry : {0 * ulp, 8 * ulp, 64 * ulp, Real(0.1)}) {
                RealMatrix changed = S;
                changed(i, j) += asymmetry * own;
                const bool accepted = asymmetry < 10 * ulp;
                CHECK(refusal({RealVector::Ones(8), {}, changed, digits}).empty() == accepted);
                CHECK(refusal({RealVector::Ones(8), changed, S, digits}).empty() == accepted);
            }
        }
        // A circulatory block that a stiff neighbour hid.
        const RealMatrix hiding{{1e12, 0, 0}, {0, 1e-6, 1e-4}, {0, -1e-4, 1e-6}};
        refuse({mass, {}, hiding, digits}, {"stiffness", "symmetric", "(2, 1)", "(1, 2)"});
    }
}

TEST_CASE("linear_system: bad input: an asymmetric K or D is refused with the entry named",
          "[own_matrices][bad_input]") {
    const RealMatrix lopsided = with_entry(2, 1, -2.5);
    refuse({mass, {}, lopsided}, {"stiffness", "(2, 1)", "(1, 2)", "-2.5", "-2", "symmetric"});
    refuse({mass, lopsided, K}, {"damping", "(2, 1)", "(1, 2)", "-2.5", "symmetric"});
    // One triangle alone, as symmetric Matrix Market files store it.
    refuse({mass, {}, with_entry(0, 2, 0.5)}, {"stiffness", "0.5", "symmetric"});
}

TEST_CASE("linear_system: bad input: numbers", "[own_matrices][bad_input]") {
    const double infinity = std::numeric_limits<double>::infinity();
    const double not_a_number = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {not_a_number, infinity}) {
        refuse({mass, {}, with_entry(1, 1, bad)}, {"stiffness(1, 1)", "finite"});
        refuse({mass, with_entry(1, 1, bad), K}, {"damping(1, 1)", "finite"});
        refuse({mass, {}, with_entry(0, 1, bad)}, {"stiffness(0, 1)", "finite"}, true);
        refuse({mass, {}, K, Digits::of_double, RealVector{{1, 2, bad}}}, {"load[2]", "finite"});
    }
    // The inverse of a mass must be finite, too.
    for (const double bad :
         {0.0, -1.0, not_a_number, infinity, std::numeric_limits<double>::denorm_min()}) {
        const RealVector m{{1, bad, 4}};
        refuse({m, {}, K}, {"mass[1] is ", "finite and > 0"});
        refuse({m, {}, K}, {"mass[1] is ", "finite and > 0"}, true);
    }
}

TEST_CASE("linear_system: bad input: shapes", "[own_matrices][bad_input]") {
    const auto zero = [](Index rows, Index columns) -> RealMatrix {
        return RealMatrix::Zero(rows, columns);
    };
    refuse({{}, {}, {}}, {"mass is empty"});
    refuse({mass, {}, zero(2, 2)}, {"stiffness is 2 by 2", "3 by 3"});
    refuse({mass, {}, zero(3, 2)}, {"stiffness is 3 by 2", "3 by 3"});
    refuse({mass, {}, {}}, {"stiffness is 0 by 0"});
    refuse({mass, zero(4, 4), K}, {"damping is 4 by 4", "3 by 3"});
    refuse({mass, {}, K, Digits::of_double, RealVector::Ones(2)}, {"load has 2", "3"});
    const auto system = linear_system({mass, {}, K});
    const AnyState u{Eigen::MatrixXd::Zero(1, 2), Eigen::MatrixXd::Zero(1, 3)};
    CHECK(missing(message_of([&] { system.force(u); }), {"2 positions", "3 velocities"}) == "");
    CHECK(missing(message_of([&] { system.energy(u); }), {"2 positions"}) == "");
}

TEST_CASE("diagonal_mass: takes the diagonal and names what is off it",
          "[own_matrices][bad_input]") {
    const auto refused = [](const taut::SparseMatrix<double>& M) {
        return message_of([&] { taut::diagonal_mass(M); });
    };
    const Eigen::Vector3d diagonal(1, 2, 4);
    taut::SparseMatrix<double> M = Eigen::Matrix3d(diagonal.asDiagonal()).sparseView();
    CHECK((taut::diagonal_mass(M) == diagonal));
    M.insert(0, 1) = 0;
    CHECK((taut::diagonal_mass(M) == diagonal));
    M.insert(0, 2) = 0.5;
    CHECK(missing(refused(M), {"diagonal_mass", "M(0, 2) is 0.5", "diagonal"}) == "");
    M.resize(3, 2);
    CHECK(missing(refused(M), {"diagonal_mass", "3 by 2", "square"}) == "");
    // A missing diagonal entry is a mass of zero, which the system refuses.
    M.resize(3, 3);
    CHECK((taut::diagonal_mass(M) == Eigen::Vector3d::Zero()));
}

TEST_CASE(
    "linearize: to_free and from_free are each other's inverse, and forces agree to first "
    "order",
    "[own_matrices]") {
    for (const Kind kind : {Kind{true, 3}, Kind{false, 1}, Kind{false, 2}, Kind{false, 3}}) {
        INFO(kind);
        Random random(4);
        RandomOptions options;
        options.pinned = 0;
        options.dampers = options.rayleigh = true;
        Scene scene = random_scene(random, kind, options);
        scene.pin(2);
        scene.pin(5);
        auto pose = random_state(random, scene), state = random_state(random, scene);
        pose.v.col(2).setZero();  // a pin's motion is not in the reduced system
        pose.v.col(5).setZero();
        state.time = 3;
        const auto linear = linearized(scene, pose);
        const AnyState u = linear.to_free(state);
        CHECK(u.x.cols() == kind.dim * 6);
        CHECK(u.time == 3);
        CHECK(linear.to_free(pose).x.isZero(0));
        const auto before = random_state(random, scene);
        auto back = before;
        linear.from_free(u, back);
        CHECK(back.time == 3);
        for (Index i = 0; i < 8; ++i) {
            const auto& from = scene.is_pinned(i) ? before : state;
            CHECK(distance(back.x.col(i), from.x.col(i)) <= kind.rounding());
            CHECK((back.v.col(i) == from.v.col(i)));
        }

        // Forces on the free particles; of a pose at rest, so that no change of D is seen.
        auto still = pose;
        still.v.setZero();
        const auto error = [&](const AnyState& at, double size) {
            auto moved = at;
            for (Index i = 0; i < 8; ++i) {
                if (scene.is_pinned(i)) continue;
                moved.x.col(i) += size * (state.x.col(i) - at.x.col(i));
                moved.v.col(i) += size * state.v.col(i);
            }
            auto force = moved;
            force.x = scene.force(moved) + pose.x;  // which to_free() takes away again
            const auto about = linearized(scene, at);
            return distance(about.force(about.to_free(moved)), linear.to_free(force).x.transpose());
        };
        const double rounding = kind.accumulated();
        CHECK(error(pose, 0) <= rounding);
        if (kind.single) continue;
        CHECK(error(still, 1e-4) < 1e-2);
        // Second order: a tenth of the displacement leaves a hundredth of the error.
        CHECK(error(still, 1e-5) < 0.02 * error(still, 1e-4) + 1e-10);
    }
}

TEST_CASE("linearize: bad input: to_free and from_free of the wrong system or size",
          "[own_matrices][bad_input]") {
    Random random(7);
    const Scene plane = random_scene(random, {false, 2}), space = random_scene(random, {false, 3});
    auto state = plane.initial_state();
    const auto linear = linearized(plane, state);
    const auto refused = [](const AnyLinear& of, const AnyState& any) {
        return message_of([&] { of.to_free(any); });
    };
    CHECK(missing(refused(linear_system({mass, {}, K}), state),
                  {"not linearised from a SpringSystem of dimension 2"}) == "");
    CHECK(missing(refused(linear, space.initial_state()), {"dimension 3"}) == "");
    const AnyState u = linear.to_free(state);
    state.x.conservativeResize(2, 7);
    CHECK(missing(refused(linear, state), {"7 positions", "8 velocities", "8 particles"}) == "");
    const AnyState before = state;
    CHECK(missing(message_of([&] { linear.from_free(u, state); }),
                  {"7 positions", "8 particles"}) == "");
    CHECK(state == before);
}

}  // namespace taut_test::own_matrices
