// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <taut/contact/contact.hpp>

#include "../support/catch.hpp"
#include "../support/tolerance.hpp"
#include "bodies.hpp"
#include "random_scenes.hpp"

namespace taut_test::contacts_test {

namespace {

using taut::Contacts;
using taut::Pose;

}  // namespace

TEMPLATE_TEST_CASE("contacts: no step raises the energy beyond the bodies' work", "[contact]",
                   (Case<float, 3>), (Case<double, 1>), (Case<double, 2>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(39);
    const Gained gained = gained_in_scenes<Scalar, Dim>(
        random, 150, [&](auto& contacts, auto& pose) { add_some_body(random, contacts, pose); });
    CHECK(gained.worst < 100);
    CHECK(gained.touched > 500);
}

TEMPLATE_TEST_CASE("contacts: what several bodies carry by friction gains what they do",
                   "[contact]", (Case<float, 2>), (Case<float, 3>), (Case<double, 2>),
                   (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    Random random(41);
    double worst = -1;  // in roundings of what is added up
    for (int scene = 0; scene < 40; ++scene) {
        // Two particles in a trough, whose walls move as one.
        taut::SpringSystem<Scalar, Dim> system;
        const Vector up = Vector::Unit(Dim - 1), across = Vector::Unit(0);
        system.add_particle(Scalar(0.01) * up, 1);
        system.add_particle(Scalar(0.01) * up + Scalar(0.5) * Vector::Unit(Dim - 2), 1);
        system.add_spring(0, 1, {1000});
        system.set_gravity(Scalar(-9.81) * up);
        Contacts contacts(system);
        taut::BodyOptions options;
        options.friction = random.uniform(0.2, 2);
        for (const int side : {-1, 1}) {
            const auto slope = static_cast<Scalar>(side * random.uniform(0.2, 2));
            contacts.add(taut::HalfSpace<Scalar, Dim>(Vector::Zero(), up + slope * across),
                         options);
        }
        const double speed = std::pow(10, random.uniform(-1, 1));
        const Vector velocity = static_cast<Scalar>(speed) * random.vector<Scalar, Dim>(-1, 1);
        taut::EnergyStableEuler stepper(system);
        auto state = system.initial_state();
        const Scalar h = taut::energy_limit(system).certified;
        double before = 0;
        for (int frame = 1; frame <= 200; ++frame) {
            Pose<Scalar, Dim> pose;
            pose.position = static_cast<Scalar>(frame) * h * velocity;
            for (const Index wall : {0, 1}) contacts.move_to(wall, pose);
            REQUIRE(taut::step_through(stepper, state, h, 1, contacts));
            const auto kinetic = static_cast<double>(system.kinetic_energy(state));
            const auto potential = static_cast<double>(system.potential_energy(state));
            const double energy = kinetic + potential + contacts.energy();
            const double size = std::abs(before) + kinetic + std::abs(potential) +
                                contacts.energy() + std::abs(contacts.work());
            if (frame > 1) {  // what begins inside holds energy
                worst = std::max(worst, (energy - before - contacts.work()) / size /
                                            std::numeric_limits<Scalar>::epsilon());
            }
            before = energy;
        }
    }
    CHECK(worst < 100);
}

}  // namespace taut_test::contacts_test
