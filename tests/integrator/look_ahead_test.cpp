// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/integrator/explicit_euler.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/integrator/velocity_verlet.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/stability/any_pose.hpp>

#include "../support/catch.hpp"
#include "../support/plain_steps.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"
#include "../support/referee.hpp"
#include "../support/tolerance.hpp"

// Steps whose springs look ahead: StepDamping::look_ahead [T37].

namespace taut_test::look_ahead_test {

using taut::ExplicitOptions;
using taut::Hookean;
using taut::StepDamping;
using taut::TensionOnly;

namespace {

/// f at (x + ahead·v, v): no part of it but the springs' depends on x.
template <class System>
typename System::Force force_ahead(const System& system, typename System::State state,
                                   typename System::Scalar ahead) {
    typename System::Force f;
    state.x += ahead * state.v;
    system.force(state, f);
    return f;
}

template <class System>
void kick(const System& system, typename System::State& state, typename System::Scalar h,
          typename System::Scalar ahead) {
    const auto f = force_ahead(system, state, ahead);
    state.v.array() += h * (f.array().rowwise() * system.inverse_mass().transpose().array());
}

/// The step of each method as its page writes it.
template <class Stepper, class System>
void written_out(const System& system, typename System::State& state, typename System::Scalar h,
                 typename System::Scalar ahead) {
    using State = typename System::State;
    switch (Stepper::method) {
        case taut::Method::explicit_euler: {
            const State before = state;
            kick(system, state, h, ahead);
            state.x += h * before.v;
            return;
        }
        case taut::Method::symplectic_euler:
            kick(system, state, h, ahead);
            state.x += h * state.v;
            return;
        default:
            kick(system, state, h / 2, ahead);
            state.x += h * state.v;
            kick(system, state, h / 2, ahead);
    }
}

/// By the sweep, by the plain path, and written out: the same step.
template <class Stepper, class System>
void check_sees_ahead(Random& random, double share) {
    using Scalar = typename System::Scalar;
    RandomOptions options;
    options.particles = 40;
    options.springs = 90;
    options.dampers = random.below(2) == 0;
    options.rayleigh = random.below(2) == 0;
    const auto system = random_like<System>(random, options);
    const Scalar h = Scalar(1e-3);
    auto swept = random_state(random, system);  // of pins that move, too
    auto plain = swept, expected = swept;
    Stepper fast(system, ExplicitOptions{1, StepDamping{share, 0}});
    REQUIRE(fast.step(swept, h));
    plain_steps<Stepper::method>(system, plain, h, 1, {share, 0});
    written_out<Stepper>(system, expected, h, static_cast<Scalar>(share) * h);
    for (const auto* state : {&swept, &plain}) {
        CHECK(static_cast<double>((state->x - expected.x).norm()) <=
              Tolerance<Scalar>::rounding * static_cast<double>(expected.x.norm()));
        CHECK(static_cast<double>((state->v - expected.v).norm()) <=
              10 * Tolerance<Scalar>::rounding * static_cast<double>(expected.v.norm()));
    }
}

template <class System>
void check_sees_ahead(std::uint32_t seed) {
    Random random(seed);
    for (int repeat = 0; repeat < 10; ++repeat) {
        for (const double share : {0.1, 0.4, 1.5}) {
            check_sees_ahead<taut::SymplecticEuler<System>, System>(random, share);
            check_sees_ahead<taut::ExplicitEuler<System>, System>(random, share);
            check_sees_ahead<taut::VelocityVerlet<System>, System>(random, share);
        }
    }
}

}  // namespace

TEMPLATE_TEST_CASE("look ahead: springs see the particles at x + a·h·v, nothing else does",
                   "[integrator]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>),
                   (Case<float, 2>), (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    check_sees_ahead<Mixed<Scalar, Dim>>(1100 + Dim);
    check_sees_ahead<Strings<Scalar, Dim>>(1120 + Dim);
}

TEMPLATE_TEST_CASE("look ahead: external forces are those of the state", "[integrator]", float,
                   double) {
    using System = taut::SpringSystem<TestType, 3>;
    Random random(1110);
    auto system = random_system<TestType, 3>(random);
    typename System::State seen;
    system.set_external_force([&](const auto& state, auto&) { seen = state; });
    const auto start = random_state(random, system);
    auto state = start;
    taut::SymplecticEuler<System> stepper(system, {1, taut::recipe.damping});
    REQUIRE(stepper.step(state, TestType(1e-3)));
    CHECK(seen.x == start.x);
    CHECK(seen.v == start.v);
}

TEMPLATE_TEST_CASE("look ahead: a count of steps has the bits of as many single ones",
                   "[integrator]", float, double) {
    using System = Mixed<TestType, 3>;
    Random random(1120);
    for (const bool dampers : {false, true}) {
        RandomOptions options;
        options.dampers = dampers;
        const auto system = random_like<System>(random, options);
        auto together = random_state(random, system);
        auto apart = together;
        taut::SymplecticEuler<System> stepper(system, {1, StepDamping{0.4, 0.1}});
        REQUIRE(stepper.step(together, TestType(1e-3), 25));
        for (int i = 0; i < 25; ++i) REQUIRE(stepper.step(apart, TestType(1e-3)));
        CHECK(together.x == apart.x);
        CHECK(together.v == apart.v);
    }
}

TEMPLATE_TEST_CASE("look ahead: the sweep over several blocks is the plain path",
                   "[integrator][slow]", float, double) {
    using System = taut::SpringSystem<TestType, 3>;
    Random random(1125);
    for (const bool dampers : {false, true}) {
        auto cloth = taut::hanging_cloth<TestType>({80, 64});
        if (dampers) {
            for (Index i = 0; i < 900; ++i)
                cloth.add_spring(5 * i, 5119 - i, TestType(5), TestType(0.01));
        }
        auto swept = cloth.initial_state();
        swept.v = random.template points<TestType, 3>(cloth.size(), -0.1, 0.1);
        auto plain = swept;
        const auto h = TestType(0.5) * taut::any_pose_limit(cloth).certified;
        taut::SymplecticEuler<System> fast(cloth, {1, taut::recipe.damping});
        REQUIRE(fast.step(swept, h, 25));
        plain_steps<taut::Method::symplectic_euler>(cloth, plain, h, 25, taut::recipe.damping);
        CHECK(static_cast<double>((swept.x - plain.x).cwiseAbs().maxCoeff()) <=
              100 * Tolerance<TestType>::rounding);
    }
}

TEMPLATE_TEST_CASE("look ahead: velocity Verlet's force is that of its step", "[integrator]", float,
                   double) {
    using System = taut::SpringSystem<TestType, 3>;
    Random random(1127);
    const auto system = random_system<TestType, 3>(random);
    const auto start = random_state(random, system);
    const TestType h = TestType(1e-3);
    taut::VelocityVerlet<System> used(system, {1, taut::recipe.damping});
    auto state = start;
    REQUIRE(used.step(state, 2 * h));
    auto fresh_state = state;
    for (const Index none : {0, 0}) REQUIRE(used.step(state, h, none));
    REQUIRE(used.step(state, h, 3));
    taut::VelocityVerlet<System> fresh(system, {1, taut::recipe.damping});
    REQUIRE(fresh.step(fresh_state, h, 0));
    REQUIRE(fresh.step(fresh_state, h, 3));
    CHECK(state.x == fresh_state.x);
    CHECK(state.v == fresh_state.v);
}

TEMPLATE_TEST_CASE("look ahead: on a linear scene it is Rayleigh damping of α = a·h",
                   "[integrator]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>),
                   (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using System = taut::SpringSystem<Scalar, Dim>;
    Random random(1130 + Dim);
    for (int repeat = 0; repeat < 20; ++repeat) {
        const auto system = zero_length_system<Scalar, Dim>(random);
        const double share = random.uniform(0.05, 0.6);
        const auto h = static_cast<Scalar>(random.uniform(0.1, 0.5)) *
                       static_cast<Scalar>(taut::any_pose_limit(system).certified);
        auto damped = system;
        damped.set_rayleigh({0, share * static_cast<double>(h)});
        auto ahead = random_state(random, system);
        auto rayleigh = ahead;
        taut::SymplecticEuler<System> looking(system, {1, StepDamping{share, 0}});
        taut::SymplecticEuler<System> plain(damped);
        REQUIRE(looking.step(ahead, h, 20));
        REQUIRE(plain.step(rayleigh, h, 20));
        const auto tolerance = 100 * Tolerance<Scalar>::rounding;
        CHECK(static_cast<double>((ahead.x - rayleigh.x).norm()) <=
              tolerance * static_cast<double>(1 + rayleigh.x.norm()));
        CHECK(static_cast<double>((ahead.v - rayleigh.v).norm()) <=
              tolerance * static_cast<double>(1 + rayleigh.v.norm()));
    }
}

// [T37] over a swing short enough that no spring passes through length 0. H + ½h v·f is what
// symplectic Euler keeps, to O(h²), without looking ahead.
TEMPLATE_TEST_CASE("look ahead: takes τ fᵀM⁻¹f a second out of H − τ v·f, whatever the sign of K",
                   "[integrator]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>)) {
    constexpr int Dim = TestType::Dim;
    Random random(1140 + Dim);
    int indefinite = 0;
    for (int repeat = 0; repeat < 40; ++repeat) {
        RandomOptions options;
        options.pinned = 0;
        const auto system = random_system<double, Dim>(random, options);
        const auto start = random_state(random, system);
        const Exact e = exact_matrices(system, start.x);
        if (eigenvalues(e.K)[0] < -1e-3) ++indefinite;
        const double share = random.uniform(0.2, 0.6);
        const double span = 0.02 * taut::any_pose_limit(system).certified;
        // What the law leaves open over `steps` steps, and what it says is lost.
        const auto miss = [&](int steps) {
            const double h = span / steps;
            const double tau = share * h;
            taut::SymplecticEuler stepper(system, {1, StepDamping{share, 0}});
            auto state = start;
            double lost = 0;
            const auto kept = [&] {
                const auto f = force_ahead(system, state, 0);
                return system.energy(state) + (h / 2 - tau) * f.cwiseProduct(state.v).sum();
            };
            const double before = kept();
            for (int i = 0; i < steps; ++i) {
                const auto f = force_ahead(system, state, 0);
                const auto a = (f.array().rowwise() * system.inverse_mass().transpose().array());
                lost += h * tau * (f.array() * a).sum();
                REQUIRE(stepper.step(state, h));
            }
            return std::make_pair(std::abs(kept() - before + lost), lost);
        };
        const auto [coarse, lost] = miss(8);
        const auto fine = miss(16).first;
        const double rounding = 1e-12 * std::abs(system.energy(start));
        INFO("lost " << lost << ", missed " << coarse << ", at half the step " << fine);
        CHECK(coarse <= 0.3 * lost + rounding);
        CHECK(fine <= 0.35 * coarse + rounding);
    }
    CHECK((Dim == 1 || indefinite > 10));
}

TEMPLATE_TEST_CASE("look ahead: the share of the limit that is left keeps every pose stable",
                   "[integrator]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>)) {
    constexpr int Dim = TestType::Dim;
    Random random(1150 + Dim);
    for (int repeat = 0; repeat < 30; ++repeat) {
        const auto system = random_system<double, Dim>(random);
        const auto state = random_state(random, system);
        const StepDamping damping{log_uniform(random, 0.05, 5), 0};
        const double h = taut::share_of_limit(1, damping) * taut::any_pose_limit(system).certified;
        // No multiplier ≤ −1: 4M − 2hD − h²K ≻ 0 with D = a·h·K [T23].
        const Exact e = exact_matrices(system, state.x);
        RealMatrix A = -(1 + 2 * damping.look_ahead) * h * h * e.K;
        A.diagonal() += 4 * e.mass;
        CHECK(eigenvalues(A)[0] > 0);
    }
}

}  // namespace taut_test::look_ahead_test
