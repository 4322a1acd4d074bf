// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/integrator/explicit_euler.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/integrator/velocity_verlet.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/stability/stability.hpp>
#include <taut/tight/tight.hpp>

#include "../support/catch.hpp"
#include "../support/direct_euler.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"
#include "../support/referee.hpp"
#include "../support/tolerance.hpp"

// D = α(L_k ⊗ I): every spring damps the whole relative velocity of its ends.

namespace taut_test::graph_damping_test {

using taut::Hookean;
using taut::Method;
using taut::StepDamping;

namespace {

/// A stepper with the damping, and another whose system has it, take the same steps.
template <class Stepper, class System>
void check_own_damping(Random& random, double share, bool external) {
    using Scalar = typename System::Scalar;
    RandomOptions options;
    options.particles = 40;
    options.springs = 90;
    options.dampers = random.below(2) == 0;
    auto system = random_like<System>(random, options);
    if (random.below(2) == 0) system.set_rayleigh({0.1, 1e-4});
    if (external) system.set_external_force([](const auto& s, auto& f) { f -= s.v; });
    const Scalar h = Scalar(1e-3);
    auto damped = system;
    damped.set_graph_damping(static_cast<double>(h) * share);
    auto a = random_state(random, system);
    auto b = a;
    Stepper by_stepper(system, taut::ExplicitOptions{1, StepDamping{0, share}});
    Stepper by_system(damped);
    REQUIRE(by_stepper.step(a, h, 20));
    REQUIRE(by_system.step(b, h, 20));
    CHECK(static_cast<double>((a.x - b.x).norm()) <= 40 * Tolerance<Scalar>::rounding);
    CHECK(static_cast<double>((a.v - b.v).norm()) <= 4e3 * Tolerance<Scalar>::rounding);
}

template <class System>
void check_own_damping(std::uint32_t seed) {
    Random random(seed);
    for (const bool external : {false, true}) {
        for (const double share : {0.1, 0.5}) {
            check_own_damping<taut::SymplecticEuler<System>, System>(random, share, external);
            check_own_damping<taut::ExplicitEuler<System>, System>(random, share, external);
            check_own_damping<taut::VelocityVerlet<System>, System>(random, share, external);
        }
    }
}

}  // namespace

TEMPLATE_TEST_CASE(
    "graph_damping: the force is that of each spring's bound on the relative velocity", "[model]",
    (Case<double, 1>), (Case<double, 2>), (Case<double, 3>), (Case<float, 2>), (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(340 + Dim);
    for (int repeat = 0; repeat < 30; ++repeat) {
        RandomOptions options;
        options.dampers = repeat % 2 == 0;
        options.rayleigh = repeat % 3 == 0;
        auto system = random_system<Scalar, Dim, Hookean, TensionOnly, Buckling>(random, options);
        auto state = random_state(random, system);
        state.x.col(3) = state.x.col(4);  // no length, no direction
        typename decltype(system)::Force without, with;
        system.force(state, without);
        const double alpha = random.uniform(0.001, 0.1);
        system.set_graph_damping(alpha);
        system.force(state, with);
        RealMatrix expected = without.template cast<Real>();
        system.for_each_set([&](const auto& set) {
            using Law = typename std::decay_t<decltype(set)>::Law;
            for (std::size_t s = 0; s < set.a.size(); ++s) {
                const Real c = static_cast<Real>(alpha) *
                               Law::stiffness_bound(set.parameters[s].template cast<Real>(),
                                                    static_cast<Real>(set.rest_length[s]));
                const RealMatrix dv =
                    (state.v.col(set.b[s]) - state.v.col(set.a[s])).template cast<Real>();
                expected.col(set.a[s]) += c * dv;
                expected.col(set.b[s]) -= c * dv;
            }
        });
        const RealMatrix error = with.template cast<Real>() - expected;
        CHECK(static_cast<double>(error.norm()) <=
              Tolerance<Scalar>::rounding * static_cast<double>(1 + expected.norm()));
    }
}

TEMPLATE_TEST_CASE("graph_damping: linearize and the analysis see the matrix that the force has",
                   "[model][slow]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>)) {
    constexpr int Dim = TestType::Dim;
    Random random(350 + Dim);
    for (int repeat = 0; repeat < 30; ++repeat) {
        RandomOptions options;
        options.dampers = repeat % 2 == 0;
        options.rayleigh = repeat % 3 == 0;
        auto system = random_system<double, Dim, Hookean, TensionOnly>(random, options);
        system.set_graph_damping(random.uniform(0.001, 0.1));
        const auto state = random_state(random, system);
        const auto linear = taut::linearize(system, state);
        const Exact e = exact_matrices(system, state.x);
        const RealMatrix D = linear.damping().toDense().template cast<Real>();
        CHECK(static_cast<double>((D - e.D).norm()) <= 1e-13 * static_cast<double>(e.D.norm()));
        const taut::Stability<double> stability(system, state);
        for (const Method method : {Method::symplectic_euler, Method::explicit_euler}) {
            const auto limit = taut::max_step(stability, method, 1e-4);
            const Multipliers multipliers(e);
            if (limit.certified > 0) {
                CHECK(multipliers.induced_radius(method, limit.certified) <=
                      1 + Multipliers::tolerance);
            }
        }
    }
}

TEMPLATE_TEST_CASE("graph_damping: a stepper's own damping is the system's, by its step", "[model]",
                   (Case<double, 1>), (Case<double, 2>), (Case<double, 3>), (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    check_own_damping<Mixed<Scalar, Dim>>(360 + Dim);
    check_own_damping<Strings<Scalar, Dim>>(364 + Dim);
}

TEMPLATE_TEST_CASE("graph_damping: the sweep of explicit steps and the plain force agree",
                   "[model]", float, double) {
    using Scalar = TestType;
    Random random(370);
    for (const bool shuffled : {false, true}) {
        for (const double alpha : {0.0, 2e-4}) {
            taut::ClothOptions options;
            options.rows = options.columns = 24;
            auto cloth = taut::hanging_cloth<Scalar>(options);
            if (shuffled) {
                for (Index i = 0; i < 300; ++i)
                    cloth.add_spring(i, 575 - random.below(200), Scalar(5));
            }
            cloth.set_graph_damping(3e-4);
            cloth.set_rayleigh({0.1, alpha});
            const auto start = random_state(random, cloth);
            const Scalar h = Scalar(1e-4);
            auto swept = start;
            taut::SymplecticEuler<decltype(cloth)> stepper(cloth);
            REQUIRE(stepper.step(swept, h));
            auto plain = start;
            typename decltype(cloth)::Force f;
            cloth.force(plain, f);
            plain.v.array() += h * (f.array().rowwise() * cloth.inverse_mass().transpose().array());
            plain.x += h * plain.v;
            CHECK(static_cast<double>((swept.v - plain.v).norm()) <=
                  Tolerance<Scalar>::rounding * 1e3 * static_cast<double>(plain.v.norm()));
        }
    }
}

TEST_CASE("graph_damping: implicit Euler damps as its matrix says", "[model]") {
    Random random(380);
    for (int repeat = 0; repeat < 20; ++repeat) {
        // In one dimension K is constant, and the step is (M + hD + h²K)Δv = h(f − hKv) [T6].
        auto system = random_system<double, 1>(random);
        system.set_graph_damping(0.02);
        auto start = random_state(random, system);
        for (Index i = 0; i < system.size(); ++i) start.v.col(i) *= system.is_pinned(i) ? 0 : 1;
        auto state = start;
        DirectEuler stepper(system);
        const double h = 1e-2;
        REQUIRE(stepper.step(state, h));
        const Exact e = exact_matrices(system, start.x);
        decltype(system)::Force f;
        system.force(start, f);
        RealVector v(e.size()), load(e.size()), moved(e.size());
        Index j = 0;
        for (Index i = 0; i < system.size(); ++i) {
            if (system.is_pinned(i)) continue;
            v[j] = static_cast<Real>(start.v(0, i));
            load[j] = static_cast<Real>(f(0, i));
            moved[j++] = static_cast<Real>(state.v(0, i) - start.v(0, i));
        }
        const Real t = static_cast<Real>(h);
        RealMatrix A = t * e.D + t * t * e.K;
        A.diagonal() += e.mass;
        const RealVector expected = solve(A, t * (load - t * e.K * v));
        CHECK(static_cast<double>((moved - expected).norm()) <=
              1e-11 * static_cast<double>(expected.norm()));
    }
}

TEST_CASE("graph_damping: it stops rotation at the rate of [T34]", "[model]") {
    // A free cross of four masses turns without changing a length: dω/dt = −α Σ k l²/I ω.
    taut::SpringSystem<double, 2> cross;
    for (int i = 0; i < 4; ++i) {
        cross.add_particle(Eigen::Vector2d(std::cos(i * EIGEN_PI / 2), std::sin(i * EIGEN_PI / 2)),
                           0.5);
    }
    for (Index i = 0; i < 4; ++i) cross.add_spring(i, (i + 1) % 4, 300);
    const double alpha = 1e-5;
    cross.set_graph_damping(alpha);
    auto state = cross.initial_state();
    for (Index i = 0; i < 4; ++i)
        state.v.col(i) = 0.01 * Eigen::Vector2d(-state.x(1, i), state.x(0, i));
    taut::SymplecticEuler<decltype(cross)> stepper(cross);
    const double before = cross.kinetic_energy(state);
    const double seconds = 0.2;
    REQUIRE(stepper.step(state, 1e-4, 2000));
    const double rate = alpha * 4 * 300 * 2 / (4 * 0.5);
    CHECK_THAT(std::log(before / cross.kinetic_energy(state)) / 2, WithinRel(rate * seconds, 0.01));
}

TEST_CASE("graph_damping: bad input and revisions", "[model][bad_input]") {
    taut::SpringSystem<double, 2> system;
    system.add_particle({0, 0}, 1);
    const auto revision = system.revision();
    system.set_graph_damping(0.5);
    CHECK(system.graph_damping() == 0.5);
    CHECK(system.revision() != revision);
    for (const double wrong : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        CHECK_THROWS_AS(system.set_graph_damping(wrong), std::invalid_argument);
        using Stepper = taut::SymplecticEuler<taut::SpringSystem<double, 2>>;
        CHECK_THROWS_AS(Stepper(system, taut::ExplicitOptions{1, {wrong, 0}}),
                        std::invalid_argument);
        CHECK_THROWS_AS(Stepper(system, taut::ExplicitOptions{1, {0, wrong}}),
                        std::invalid_argument);
    }
    const auto linear =
        taut::LinearSystem<double>(Eigen::VectorXd::Ones(1), {}, taut::SparseMatrix<double>(1, 1));
    using Linear = taut::SymplecticEuler<taut::LinearSystem<double>>;
    CHECK_THROWS_AS(Linear(linear, taut::ExplicitOptions{1, {0.1, 0}}), std::invalid_argument);
}

namespace {

/// A law that hardens and whose author forgot it: T = k(l − L)³/L², bound k.
struct Hardening : taut::Hookean {
    template <class Scalar>
    static Scalar tension(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        return p.stiffness * (l - L) * (l - L) * (l - L) / (L * L);
    }
    template <class Scalar>
    static Scalar tension_slope(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        return 3 * p.stiffness * (l - L) * (l - L) / (L * L);
    }
};

}  // namespace

TEMPLATE_TEST_CASE("graph_damping: a debug build finds a law above its bound", "[model][bad_input]",
                   float, double) {
#ifndef NDEBUG
    Random random(390);
    for (int repeat = 0; repeat < 20; ++repeat) {
        taut::SpringSystem<TestType, 2, Hardening> system;
        system.add_particle({0, 0}, 1);
        system.add_particle({1, 0}, 1);
        const auto k = static_cast<TestType>(log_uniform(random, 1e-6, 1e6));
        const auto L = static_cast<TestType>(log_uniform(random, 1e-6, 1e6));
        const auto message = message_of([&] {
            system.add_spring(taut::Spring<TestType, Hardening>{0, 1, {k}, L});
        });
        CHECK(missing(message, {"Hardening", "stiffness_bound", "at length", "T' is"}) == "");
    }
#endif
}

}  // namespace taut_test::graph_damping_test
