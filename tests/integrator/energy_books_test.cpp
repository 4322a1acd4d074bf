// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// The energy that an explicit method keeps on a linear scene [T36], and what it may change by.
#include <taut/integrator/detail/energy_books.hpp>
#include <taut/integrator/detail/work_meter.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/integrator/velocity_verlet.hpp>
#include <taut/stability/any_pose.hpp>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::energy_books_test {

using taut::Method;
using taut::integrator_detail::energy_books;
using taut::integrator_detail::EnergyBooks;

namespace {

template <class System>
EnergyBooks books_of(const System& system, const typename System::State& state, Method method) {
    typename System::Force f;
    taut::integrator_detail::PinWork<System> pins;
    return energy_books(system, state, method, pins, f);
}

/// The largest change of kept energy less work over a run, and the most kinetic energy in it, J.
struct Balance {
    double highest = 0;  // of kept energy less work, above the start
    double lowest = 0;   // below it
    double scale = 0;
};

template <class Stepper, class System>
Balance balance(const System& system, typename System::State state, double share, int steps) {
    constexpr Method method = Stepper::method;
    const auto h = static_cast<typename System::Scalar>(
        share * static_cast<double>(taut::any_pose_limit(system).certified));
    const auto step = static_cast<double>(h);
    const double start = books_of(system, state, method).kept(method, step);
    taut::integrator_detail::WorkMeter<System, taut::method::Of<method>> meter;
    meter.start(step, 1);
    Stepper stepper(system);
    Balance result;
    for (int i = 0; i < steps; ++i) {
        meter.depart(system, state, false, false);
        REQUIRE(stepper.step(state, h));
        meter.arrive(system, state, nullptr);
        const EnergyBooks books = books_of(system, state, method);
        const double change = books.kept(method, step) - meter.work() - start;
        result.highest = std::max(result.highest, change);
        result.lowest = std::min(result.lowest, change);
        result.scale = std::max({result.scale, books.owned(), std::abs(meter.work())});
    }
    return result;
}

/// @param h_share  of the any-pose limit, up to which the law must hold
template <class Stepper, class System>
void check_kept(const System& system, const typename System::State& state, double h_share) {
    using Scalar = typename System::Scalar;
    const Balance bare = balance<Stepper>(system, state, h_share, 300);
    CHECK(bare.highest <= Tolerance<Scalar>::accumulated * bare.scale);
    CHECK(-bare.lowest <= Tolerance<Scalar>::accumulated * bare.scale);
}

/// check(system, state) on five scenes whose pins move.
template <class Case, class Check>
void on_moving_scenes(Check&& check) {
    using Scalar = typename Case::Scalar;
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
        INFO("seed " << seed);
        Random random(seed);
        auto system = zero_length_system<Scalar, Case::Dim>(random);
        check(system, random_state(random, system));
    }
}

template <class Case>
using Symplectic = taut::SymplecticEuler<taut::SpringSystem<typename Case::Scalar, Case::Dim>>;
template <class Case>
using Verlet = taut::VelocityVerlet<taut::SpringSystem<typename Case::Scalar, Case::Dim>>;

}  // namespace

#define TAUT_TEST_CASES                                                                         \
    (Case<float, 1>), (Case<float, 2>), (Case<float, 3>), (Case<double, 1>), (Case<double, 2>), \
        (Case<double, 3>)

TEMPLATE_TEST_CASE("energy books: near the limit a linear scene keeps what its method keeps",
                   "[integrator]", TAUT_TEST_CASES) {
    on_moving_scenes<TestType>([](auto& system, auto state) {
        state.v.leftCols(2).setZero();
        check_kept<Symplectic<TestType>>(system, state, 0.97);
        check_kept<Verlet<TestType>>(system, state, 0.97);
    });
}

TEMPLATE_TEST_CASE("energy books: work of moving pins and of outside forces is all that changes it",
                   "[integrator]", TAUT_TEST_CASES) {
    using Scalar = typename TestType::Scalar;
    on_moving_scenes<TestType>([](auto& system, const auto& state) {
        check_kept<Symplectic<TestType>>(system, state, 0.9);
        check_kept<Verlet<TestType>>(system, state, 0.9);
        // Depends on time, place and velocity.
        system.set_external_force([](const auto& s, auto& f) {
            f.array() += 20 * (s.x.array() + Scalar(30) * s.time).sin();
            f.array() += 20 * (3 * s.v.array()).cos();
        });
        check_kept<Symplectic<TestType>>(system, state, 0.9);
        check_kept<Verlet<TestType>>(system, state, 0.9);
    });
}

TEMPLATE_TEST_CASE("energy books: damping lowers it, with pins that drag through dampers",
                   "[integrator]", TAUT_TEST_CASES) {
    using Scalar = typename TestType::Scalar;
    on_moving_scenes<TestType>([](auto& system, const auto& state) {
        for (const taut::RayleighDamping damping :
             {taut::RayleighDamping{0.5, 0}, {0, 1e-3}, {0.5, 1e-3}}) {
            INFO("d0 " << damping.mass_proportional << ", alpha "
                       << damping.stiffness_proportional);
            system.set_rayleigh(damping);
            const Balance symplectic = balance<Symplectic<TestType>>(system, state, 0.9, 300);
            CHECK(symplectic.highest <= Tolerance<Scalar>::accumulated * symplectic.scale);
            CHECK(-symplectic.lowest > 1e-3 * symplectic.scale);
            // To first order in the damping only: it lags half a step.
            const Balance verlet = balance<Verlet<TestType>>(system, state, 0.5, 300);
            CHECK(verlet.highest <= 0.01 * verlet.scale);
            CHECK(-verlet.lowest > 1e-3 * verlet.scale);
        }
    });
}

TEMPLATE_TEST_CASE("energy books: a share s of the limit keeps E = T + V within 1 ± s of it",
                   "[integrator]", TAUT_TEST_CASES) {
    // |½h v·f| ≤ s·E and ⅛h² fᵀM⁻¹f ≤ s²·V, at any pose of springs that push and pull.
    using Scalar = typename TestType::Scalar;
    using System = taut::SpringSystem<Scalar, TestType::Dim, taut::Hookean, TensionOnly, Buckling>;
    Random random(11);
    RandomOptions options;
    options.gravity = false;
    double symplectic = 0;
    double verlet = 0;
    for (int scene = 0; scene < 40; ++scene) {
        const auto system = random_like<System>(random, options);
        auto state = random_state(random, system);
        state.v.leftCols(2).setZero();
        const double limit = static_cast<double>(taut::any_pose_limit(system).certified);
        // A state in which velocities and forces are aligned comes nearest to the bound.
        typename System::Force f;
        system.force(state, f);
        const auto scale = static_cast<Scalar>(log_uniform(random, 0.01, 1) * limit);
        state.v = f * system.inverse_mass().asDiagonal() * scale;
        for (const double share : {0.3, 0.6, 0.95}) {
            const double h = share * limit;
            const EnergyBooks books = books_of(system, state, Method::velocity_verlet);
            const double slack = Tolerance<Scalar>::rounding * books.owned();
            const double swing = books.kept(Method::symplectic_euler, h) - books.total();
            CHECK(std::abs(swing) <= share * books.owned() + slack);
            const double fall = books.total() - books.kept(Method::velocity_verlet, h);
            CHECK(fall <= share * share * books.elastic + slack);
            symplectic = std::max(symplectic, std::abs(swing) / (share * books.owned()));
            verlet = std::max(verlet, fall / (share * share * books.elastic));
        }
    }
    CHECK(symplectic > 0.2);  // the bounds are of use
    CHECK(verlet > 0.1);
}

}  // namespace taut_test::energy_books_test
