// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// What all steppers promise, for implicit Euler solved by Newton's method.
#include <taut/model/spring_system.hpp>
#include <taut/newton/newton.hpp>

#include "../support/catch.hpp"
#include "../support/check_stepper.hpp"

namespace taut_test::implicit_newton_common_test {

namespace {

template <class System>
struct Newton : taut::NewtonEuler<System> {
    using Base = taut::NewtonEuler<System>;
    explicit Newton(const System& system) : Base(system, options()) {}

    static typename Base::Options options() {
        typename Base::Options options;
        options.iterations = 40;
        options.tolerance = 1e-10;
        return options;
    }
};

}  // namespace

TEST_CASE("implicit_newton: count steps are count single steps, to the bit", "[integrator]") {
    check_counted_steps_are_single_steps<Newton, double, 3>();
}

TEST_CASE("implicit_newton: a bad step or state is reported and nothing is touched",
          "[integrator][bad_input]") {
    Random random(21);
    const auto springs = random_system<double, 2>(random);
    check_bad_steps<Newton>(springs, random_state(random, springs));
}

TEST_CASE("implicit_newton: pinned particles obey their velocity", "[integrator]") {
    check_pinned_particles_obey_their_velocity<Newton, double>();
}

TEST_CASE("implicit_newton: linear momentum of an unpinned scene is kept to rounding",
          "[integrator]") {
    check_linear_momentum_is_kept<Newton, double, 3>();
}

TEST_CASE("implicit_newton: the measured order of convergence is the declared one",
          "[integrator]") {
    CHECK_THAT((measured_order<Newton, 3>()), Catch::Matchers::WithinAbs(1, 0.05));
}

TEST_CASE("implicit_newton: changes of the system and the state between steps are taken up",
          "[integrator]") {
    check_takes_up_all_changes<Newton>();
}

TEST_CASE("implicit_newton: a scene without free particles is stepped without failure",
          "[integrator]") {
    check_nothing_free<Newton>();
}

}  // namespace taut_test::implicit_newton_common_test
