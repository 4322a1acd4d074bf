// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// Outside forces that jump with the velocity: dry friction.
#include <cmath>
#include <taut/integrator/guarded.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/integrator/velocity_verlet.hpp>

#include "../support/catch.hpp"
#include "../support/promise.hpp"
#include "../support/random_system.hpp"

namespace taut_test::guarded_friction_test {

using taut::Guarded;

namespace {

/// What every particle feels that moves against the ground.
enum class Friction { coulomb, each_axis };

/// @param most  N   @param ground  m/s, along every axis
template <class System>
void add_friction(System& system, Friction friction, double most, double ground) {
    system.set_external_force([friction, most, ground](const auto& s, auto& f) {
        using Scalar = std::decay_t<decltype(s.v(0, 0))>;
        const auto u = static_cast<Scalar>(ground);
        for (Index i = 0; i < s.v.cols(); ++i) {
            const auto slip = (s.v.col(i).array() - u).eval();
            const Scalar speed = std::sqrt(slip.square().sum());
            if (speed > 0 && friction == Friction::coulomb) {
                f.col(i).array() -= static_cast<Scalar>(most) / speed * slip;
            }
            if (friction == Friction::each_axis) {
                f.col(i).array() -= static_cast<Scalar>(most) * slip.sign();
            }
        }
    });
}

/// @param ground  m/s
template <class Stepper, class System>
void check_friction(double ground) {
    using Scalar = typename System::Scalar;
    int at_rest = 0;
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        for (const Friction friction : {Friction::coulomb, Friction::each_axis}) {
            Random random(seed);
            auto system = zero_length_system<Scalar, System::Dim>(random);
            system.set_gravity(System::Vector::Zero());
            const double most = log_uniform(random, 0.1, 100);
            INFO("seed " << seed << ", each axis " << (friction == Friction::each_axis) << ", "
                         << most << " N");
            add_friction(system, friction, most, ground);
            auto state = random_state(random, system);
            state.v.leftCols(2).setZero();
            Guarded<Stepper> guard(system);
            Promise<Stepper> promise;
            promise.holds(static_cast<double>(system.energy(state)), 0);
            int given_up = 0;
            int broken = 0;
            double h = 0;
            for (int i = 0; i < 600; ++i) {
                const auto report = guard.advance(state, Scalar(1) / 60);
                given_up += !report;
                if (!report) continue;
                h = static_cast<double>(report.h);
                broken += !promise.holds(static_cast<double>(system.energy(state)),
                                         static_cast<double>(report.advanced), report.work);
            }
            CHECK(given_up == 0);
            CHECK(broken == 0);
            const double turn = h * most * static_cast<double>(system.inverse_mass().maxCoeff());
            at_rest += largest(state.v) <= turn;
        }
    }
    if (ground == 0) CHECK(at_rest > 0);
}

}  // namespace

TEMPLATE_TEST_CASE("guarded: sound scenes with dry friction are not given up, sliding or at rest",
                   "[integrator][slow]", (Case<float, 2>), (Case<double, 1>), (Case<double, 3>)) {
    using System = taut::SpringSystem<typename TestType::Scalar, TestType::Dim>;
    for (const double ground : {0.0, 1.0}) {
        INFO("ground " << ground << " m/s");
        check_friction<taut::SymplecticEuler<System>, System>(ground);
        check_friction<taut::VelocityVerlet<System>, System>(ground);
        check_friction<taut::ImplicitEuler<System>, System>(ground);
    }
}

}  // namespace taut_test::guarded_friction_test
