// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/stability/any_pose.hpp>
#include <taut/stability/stability.hpp>
#include <taut/tight/tight.hpp>

#include "../support/catch.hpp"
#include "../support/tolerance.hpp"
#include "../support/zero_rest_length.hpp"
#include "../stability/wild_system.hpp"

// Brackets narrowed by factorisations: as tight as asked for, and the truth inside.

namespace taut_test::narrow_test {

using taut::ChainEnds;
using taut::Method;

namespace {

constexpr double tightness = 1e-6;

template <class Scalar>
constexpr double ulp = static_cast<double>(std::numeric_limits<Scalar>::epsilon());

/// What rounding to Scalar adds to a bracket: both ends count 2 ulp of a stepper's, and are
/// rounded.
template <class Scalar>
constexpr double rounded_apart = 1 + 6 * ulp<Scalar>;

/// certified ≤ truth ≤ refuted ≤ (1 + tightness)·certified; the truth known to a few ulp.
template <class Scalar>
void check_around(const taut::StepLimit<Scalar>& limit, double truth) {
    INFO(limit.certified << " <= " << truth << " <= " << limit.refuted);
    CHECK(static_cast<double>(limit.certified) <= truth * (1 + 1e-15));
    CHECK(static_cast<double>(limit.refuted) >= truth * (1 - 1e-15));
    CHECK(static_cast<double>(limit.refuted) <=
          static_cast<double>(limit.certified) * (1 + tightness) * rounded_apart<Scalar>);
    CHECK(limit.certified > 0);
}

/// λ_min of 4M − 2hD − h²K, as M⁻¹ of it, over the size of its terms.
Real margin(const Exact& e, double h) {
    const Real t = static_cast<Real>(h);
    const RealMatrix S = e.scaled(4, -t * t, -2 * t, false);
    return eigenvalues(S)[0] / S.cwiseAbs().maxCoeff();
}
constexpr Real noise = 256 * real_epsilon;

template <class Scalar>
void check_symplectic(const taut::StepLimit<Scalar>& limit, const Exact& e) {
    INFO(limit.certified << ", " << limit.refuted << ", " << describe(limit.cause));
    const auto certified = static_cast<double>(limit.certified);
    const auto refuted = static_cast<double>(limit.refuted);
    REQUIRE(certified > 0);
    if (std::isfinite(certified)) {
        for (const double part : {1.0, 0.99, 0.7, 0.3, 0.01})
            CHECK(margin(e, part * certified) >= -noise);
    }
    if (std::isfinite(refuted)) CHECK(margin(e, refuted) <= noise);
    CHECK(((std::isinf(certified) && std::isinf(refuted)) ||
           refuted <= certified * (1 + tightness) * rounded_apart<Scalar>));
}

double chain_k_max(const taut::ChainOptions& c) {
    const auto n = static_cast<Real>(c.masses);
    const Real pi = std::acos(Real(-1));
    const Real angle = c.ends == ChainEnds::fixed_fixed  ? n * pi / (2 * (n + 1))
                       : c.ends == ChainEnds::fixed_free ? (2 * n - 1) * pi / (2 * (2 * n + 1))
                       : c.ends == ChainEnds::free_free  ? (n - 1) * pi / (2 * n)
                                                         : std::floor(n / 2) * pi / n;
    const Real sine = std::sin(angle);
    return static_cast<double>(4 * static_cast<Real>(c.stiffness) / static_cast<Real>(c.mass) *
                               sine * sine);
}

/// A row of squeezed springs from a pin, each free end with bare dampers across the row: K is
/// indefinite, no damping commutes with it, and 4M − 2hD − h²K ≻ 0 may hold again at large h.
template <class Scalar, int Dim>
taut::SpringSystem<Scalar, Dim> squeezed_row(Random& random) {
    using Vector = Eigen::Matrix<double, Dim, 1>;
    taut::SpringSystem<Scalar, Dim> system;
    const auto add = [&](const Vector& x, double mass) {
        return system.add_particle(x.template cast<Scalar>(), static_cast<Scalar>(mass));
    };
    const auto join = [&](Index a, Index b, double k, double rest, double c) {
        system.add_spring(taut::Spring<Scalar, taut::Hookean>{
            a, b, {static_cast<Scalar>(k)}, static_cast<Scalar>(rest), static_cast<Scalar>(c)});
    };
    Vector x = Vector::Zero();
    Index last = add(x, 1);
    system.pin(last);
    const Index count = 1 + random.below(3);
    for (Index i = 0; i < count; ++i) {
        const double k = log_uniform(random, 0.5, 2);
        const double m = log_uniform(random, 0.5, 2);
        const double l = log_uniform(random, 0.005, 0.05);
        x[0] += l;
        const Index next = add(x, m);
        join(last, next, k, 1, 0);
        for (int axis = 1; axis < Dim; ++axis) {
            const Index anchor = add(x + Vector::Unit(axis), 1);
            system.pin(anchor);
            join(next, anchor, 0, 1, random.uniform(2.2, 4) * std::sqrt(k / l * m));
        }
        last = next;
    }
    return system;
}

constexpr ChainEnds all_ends[] = {ChainEnds::fixed_fixed, ChainEnds::fixed_free,
                                  ChainEnds::free_free, ChainEnds::ring};

}  // namespace

TEMPLATE_TEST_CASE("narrow: chains and rings by their closed forms", "[stability]", double, float) {
    for (const ChainEnds ends : all_ends) {
        for (const Index masses : {3, 4, 17, 100, 401}) {
            taut::ChainOptions options;
            options.masses = masses;
            options.ends = ends;
            options.mass = 0.25;
            options.stiffness = 300;
            auto chain = taut::chain<TestType, 1>(options);
            const double k = chain_k_max(options);
            INFO(masses << " masses, ends " << static_cast<int>(ends));
            const auto limit_of = [&](Method method) {
                return taut::max_step(taut::Stability<TestType>(chain, chain.initial_state()),
                                      method, tightness);
            };
            check_around(limit_of(Method::symplectic_euler), 2 / std::sqrt(k));
            check_around(limit_of(Method::velocity_verlet), 2 / std::sqrt(k));
            // Rayleigh damping of either kind; k_max decides.
            const double omega = std::sqrt(k);
            for (const auto& [d0, alpha] : {std::pair<double, double>{0.5 * omega, 0},
                                            {0, 0.25 / omega},
                                            {0, 3 / omega},
                                            {0.3 * omega, 1 / omega}}) {
                INFO("d0 = " << d0 << ", alpha = " << alpha);
                chain.set_rayleigh({d0, alpha});
                const double d = d0 + alpha * k;
                check_around(limit_of(Method::symplectic_euler),
                             4 / (d + std::sqrt(d * d + 4 * k)));
                const double truth = d * d < 4 * k ? d / k : 4 / (d + std::sqrt(d * d - 4 * k));
                if (d0 == 0 || truth < 2 / d0)
                    check_around(limit_of(Method::explicit_euler), truth);
            }
            chain.set_rayleigh({0, 0});
        }
    }
}

TEST_CASE("narrow: grids of zero rest length by their closed form", "[stability]") {
    for (const auto& [rows, columns] : {std::pair<Index, Index>{2, 5}, {9, 9}, {16, 25}}) {
        taut::ClothOptions options;
        options.rows = rows;
        options.columns = columns;
        options.bend = 0;
        options.diagonals = false;
        options.pin_corners = false;
        const auto grid = at_zero_rest_length(taut::hanging_cloth<double>(options));
        taut::ChainOptions row;
        row.ends = ChainEnds::free_free;
        row.mass = options.mass / static_cast<double>(rows * columns);
        row.stiffness = options.stretch;
        row.masses = rows;
        double k = chain_k_max(row);
        row.masses = columns;
        k += chain_k_max(row);
        // Linear: the same at every pose, and for all of them at once.
        for (const std::uint32_t seed : {1, 2}) {
            const taut::Stability<double> stability(grid, deformed(grid, 1.3, 0.2, seed));
            check_around(taut::max_step(stability, Method::symplectic_euler, tightness),
                         2 / std::sqrt(k));
        }
        check_around(taut::any_pose_limit(grid, tightness), 2 / std::sqrt(k));
    }
}

TEMPLATE_TEST_CASE("narrow: symplectic Euler, every scene and damping", "[stability][slow]", double,
                   float) {
    for (const auto& c : stability_cases<TestType>(true)) {
        if (c.exact.size() == 0) continue;
        INFO(c.text);
        const auto limit = taut::max_step(c.stability, Method::symplectic_euler, tightness);
        check_symplectic(limit, c.exact);
        // Never worse than the bound alone.
        const auto bound = c.stability.max_step(Method::symplectic_euler);
        CHECK(limit.certified >= bound.certified);
        CHECK(limit.refuted <= bound.refuted);
        CHECK(limit.revision == bound.revision);
    }
}

TEMPLATE_TEST_CASE("narrow: random systems over many decades", "[stability][slow]",
                   (std::integral_constant<int, 1>), (std::integral_constant<int, 2>),
                   (std::integral_constant<int, 3>)) {
    Random random(300);
    for (int repeat = 0; repeat < 100; ++repeat) {
        const auto system = wild_system<double, TestType::value>(random);
        const auto state = system.initial_state();
        const Exact e = exact_matrices(system, state.x);
        INFO("system " << repeat);
        const auto limit = taut::max_step(taut::Stability<double>(system, state),
                                          Method::symplectic_euler, tightness);
        check_symplectic(limit, e);
        const auto any = taut::any_pose_limit(system, tightness);
        CHECK(any.refuted <= any.certified * (1 + tightness) * (1 + 2 * ulp<double>));
        if (std::isfinite(any.certified)) CHECK(margin(e, any.certified) >= -noise);
    }
}

TEST_CASE("narrow: bare matrices, definite and indefinite", "[stability]") {
    Random random(301);
    for (int repeat = 0; repeat < 150; ++repeat) {
        const Index n = 1 + random.below(12);
        Eigen::VectorXd k(n), d(n), mass(n);
        for (Index i = 0; i < n; ++i) {
            k[i] = log_uniform(random, 1e-3, 1e3);
            d[i] = log_uniform(random, 1e-3, 1e3);
            mass[i] = log_uniform(random, 0.1, 10);
        }
        const bool indefinite = repeat % 3 == 0 && n > 1;
        if (indefinite) k[0] = -log_uniform(random, 1e-2, 1e2);
        Eigen::MatrixXd D = with_spectrum(random, d);
        if (repeat % 2 == 0) D.setZero();
        const taut::LinearSystem<double> system(mass, sparse(D), sparse(with_spectrum(random, k)));
        const taut::Stability<double> stability(system);
        INFO("system " << repeat << ", " << n << " unknowns");
        const auto limit = taut::max_step(stability, Method::symplectic_euler, tightness);
        check_symplectic(limit, exact_matrices(system));
        CHECK((limit.growth_rate > 0) == indefinite);
        if (indefinite) {
            const Exact e = exact_matrices(system);
            CHECK_THAT(limit.growth_rate, WithinRel(Multipliers(e).growth_rate(), 1e-3));
        }
    }
}

TEMPLATE_TEST_CASE(
    "narrow: with an indefinite K and dampers across it nothing above the first limit",
    "[stability]", (Case<double, 2>), (Case<double, 3>), (Case<float, 2>), (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    Random random(302);
    int again = 0;
    for (int repeat = 0; repeat < 40; ++repeat) {
        const auto system = squeezed_row<Scalar, TestType::Dim>(random);
        const auto state = system.initial_state();
        const taut::Stability<Scalar> stability(system, state);
        const Exact e = exact_matrices(system, state.x);
        const double truth = definite_limit(e, 1, false) * (1 + 1e-9);
        INFO("system " << repeat << ", limit " << truth);
        for (const Method method : {Method::symplectic_euler, Method::velocity_verlet}) {
            const auto limit = taut::max_step(stability, method, tightness);
            CHECK(limit.certified > 0);
            CHECK(static_cast<double>(limit.certified) <= truth);
            CHECK(static_cast<double>(limit.refuted) >= truth * (1 - 2e-9));
            for (double h = truth / 2; h < 3 * static_cast<double>(limit.refuted); h *= 1.25) {
                if (taut::certify(stability, method, h).proved) CHECK(h <= truth);
                // The first condition alone would prove this step.
                again += h > truth && margin(e, h) > 1e-6L ? 1 : 0;
            }
        }
    }
    CHECK(again > 50);
    // By hand: a spring of 1 N/m at a hundredth of its length, 30 N·s/m across it, 1 kg.
    taut::SpringSystem<Scalar, 2> system;
    for (const auto& [x, y] : {std::pair<double, double>{0, 0}, {0.01, 0}, {0.01, 1}}) {
        system.add_particle({static_cast<Scalar>(x), static_cast<Scalar>(y)}, 1);
    }
    system.add_spring(taut::Spring<Scalar, taut::Hookean>{0, 1, {1}, 1, 0});
    system.add_spring(taut::Spring<Scalar, taut::Hookean>{1, 2, {0}, 1, 30});
    system.pin(0);
    system.pin(2);
    const taut::Stability<Scalar> stability(system, system.initial_state());
    const double truth = 4 / (30 + std::sqrt(900.0 - 4 * 99));
    CHECK_THAT(truth, WithinAbs(0.0763, 1e-4));
    const auto limit = taut::max_step(stability, Method::symplectic_euler, tightness);
    CHECK(static_cast<double>(limit.certified) <= truth * (1 + 1e-6));
    for (const double h : {0.54, 1.0, 1.9})
        CHECK_FALSE(taut::certify(stability, Method::symplectic_euler, h).proved);
}

TEST_CASE("narrow: explicit Euler stays on the safe side of the truth", "[stability][slow]") {
    int narrowed = 0;
    int tight = 0;
    for (const auto& c : stability_cases<double>(true)) {
        if (c.exact.size() == 0) continue;
        const Multipliers multipliers = c.multipliers();
        const double truth = multipliers.explicit_limit();
        const auto bound = c.stability.max_step(Method::explicit_euler);
        const auto limit = taut::max_step(c.stability, Method::explicit_euler, 1e-4);
        INFO(c.text << ": " << limit.certified << " <= " << truth << " <= " << limit.refuted);
        CHECK(limit.certified <= truth * (1 + 1e-9));
        CHECK(limit.refuted >= truth * (1 - 1e-6));
        CHECK(limit.certified >= bound.certified);
        CHECK(limit.refuted >= limit.certified);
        narrowed += limit.certified > bound.certified * 1.0001 ? 1 : 0;
        tight += limit.refuted <= limit.certified * (1 + 1e-4) ? 1 : 0;
        if (limit.certified_up_to > 0) {
            const double h = limit.certified_up_to;
            CHECK(limit.admitted_growth > 0);
            CHECK(multipliers.induced_radius(Method::explicit_euler, h) <=
                  1 + static_cast<Real>(h * limit.admitted_growth) + Multipliers::tolerance);
        }
    }
    CHECK(narrowed > 10);
    CHECK(tight > 40);
}

TEST_CASE("narrow: cloths too large for dense eigenvalues", "[stability][slow]") {
    taut::ClothOptions options;
    options.rows = options.columns = 16;
    const auto undamped = taut::hanging_cloth<double>(options);
    auto rayleigh = undamped;
    rayleigh.set_rayleigh({2, 1e-4});
    for (const auto& cloth : {undamped, rayleigh, with_dampers(undamped, 1e-3)}) {
        int pose = 0;
        for (const auto& state : {cloth.initial_state(), deformed(cloth, 1.1, 0.005, 1),
                                  deformed(cloth, 0.9, 0.01, 2)}) {
            INFO("pose " << pose++);
            const taut::Stability<double> stability(cloth, state);
            const auto limit = taut::max_step(stability, Method::symplectic_euler, tightness);
            CHECK(limit.certified > 0);
            CHECK(limit.refuted <= limit.certified * (1 + tightness) * (1 + 2 * ulp<double>));
            const auto bound = stability.max_step(Method::symplectic_euler);
            CHECK(limit.certified >= bound.certified);
            CHECK(limit.refuted <= bound.refuted);
            // certify finds the proof by itself, just below, and none above.
            CHECK(taut::certify(stability, Method::symplectic_euler, limit.certified * (1 - 1e-5))
                      .proved);
            CHECK_FALSE(taut::certify(stability, Method::symplectic_euler, limit.refuted).proved);
        }
    }
}

TEST_CASE("narrow: the tightness is what was asked for", "[stability]") {
    taut::ClothOptions options;
    options.rows = options.columns = 6;
    const auto cloth = with_dampers(taut::hanging_cloth<double>(options), 1e-3);
    const taut::Stability<double> stability(cloth, deformed(cloth, 1.05, 0.02, 4));
    const Exact e = exact_matrices(cloth, deformed(cloth, 1.05, 0.02, 4).x);
    for (const double asked : {0.1, 1e-2, 1e-4, 1e-6, 1e-7}) {
        const auto limit = taut::max_step(stability, Method::symplectic_euler, asked);
        CHECK(limit.refuted <= limit.certified * (1 + asked) * (1 + 2 * ulp<double>));
        CHECK(margin(e, limit.certified) >= 0);
        CHECK(margin(e, limit.refuted) <= 0);
        const auto any = taut::any_pose_limit(cloth, asked);
        CHECK(any.refuted <= any.certified * (1 + asked) * (1 + 2 * ulp<double>));
    }
    // More than can be had: an honest bracket.
    const auto limit = taut::max_step(stability, Method::symplectic_euler, 1e-15);
    CHECK(margin(e, limit.certified) >= 0);
    CHECK(margin(e, limit.refuted) <= 0);
    CHECK(limit.refuted <= limit.certified * (1 + 1e-6));
    for (const double wrong : {-1e-6, std::nan(""), std::numeric_limits<double>::infinity()}) {
        CHECK_THROWS_AS(taut::max_step(stability, Method::symplectic_euler, wrong),
                        std::invalid_argument);
        CHECK_THROWS_AS(taut::any_pose_limit(cloth, wrong), std::invalid_argument);
    }
}

TEST_CASE("narrow: a stiffness that overflows is named", "[stability]") {
    Eigen::Matrix2d K;
    K << 1.5e308, -1.5e308, -1.5e308, 1.5e308;
    K(0, 0) = -1.5e308;
    const taut::LinearSystem<double> system(Eigen::Vector2d(1, 1), {}, K.sparseView());
    CHECK_THROWS_WITH(taut::Stability<double>(system), ContainsSubstring("stiffness in row 0"));
}

}  // namespace taut_test::narrow_test
