// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <taut/contact/contact.hpp>

#include "../support/catch.hpp"
#include "../support/tolerance.hpp"
#include "bodies.hpp"
#include "curved_bodies.hpp"

namespace taut_test::pressed_contacts_test {

namespace {

using taut::Contacts;

/// The most that a step gains beyond the bodies' work, in roundings of what is added up.
/// @param move  (frame) moves the bodies
template <class System, class Move>
double most_gained(const System& system, Contacts<System>& contacts, typename System::State state,
                   typename System::Scalar h, int frames, const Move& move) {
    taut::EnergyStableEuler<System> stepper(system);
    double before = static_cast<double>(system.energy(state)), worst = -1;
    for (const double held : contacts.open(state)) before += held;
    for (int frame = 0; frame < frames; ++frame) {
        move();
        REQUIRE(taut::step_through(stepper, state, h, 1, contacts));
        const double energy = static_cast<double>(system.energy(state)) + contacts.energy();
        const double size = std::abs(energy) + std::abs(before) + std::abs(contacts.work());
        const double gain = (energy - before - contacts.work()) / size;
        worst = std::max(worst, gain / std::numeric_limits<typename System::Scalar>::epsilon());
        before = energy;
    }
    return worst;
}

}  // namespace

TEMPLATE_TEST_CASE("pressed contacts: in the corners of two rooms no step gains energy",
                   "[contact]", (Case<float, 2>), (Case<double, 1>), (Case<double, 2>),
                   (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    Random random(71);
    double worst = -1;
    for (int scene = 0; scene < 400; ++scene) {
        taut::SpringSystem<Scalar, Dim> system;
        system.add_particle(random.vector<Scalar, Dim>(0.2, 0.5), 1);
        system.add_particle(Vector::Zero(), 1);
        system.add_spring(0, 1, {100});
        Contacts contacts(system);
        taut::BodyOptions options;
        options.thickness = 0.3;  // no wider than some rooms
        std::vector<taut::Pose<Scalar, Dim>> poses(2);
        for (auto& pose : poses) {
            pose = turn<Scalar, Dim>(random, 0.3);
            pose.position = random.vector<Scalar, Dim>(-0.1, 0.1);
            const Vector half = Vector::Constant(static_cast<Scalar>(random.uniform(0.25, 0.6)));
            contacts.add(Room<Scalar, Dim>{taut::Box<Scalar, Dim>(half)}, options, pose);
        }
        auto state = system.initial_state();
        state.v.col(0) = random.vector<Scalar, Dim>(-5, 5);
        const Scalar h = taut::energy_limit(system).certified;
        worst = std::max(worst, most_gained(system, contacts, state, h, 10, [&] {
                             for (std::size_t b = 0; b < poses.size(); ++b) {
                                 const auto by = turn<Scalar, Dim>(random, 0.2);
                                 poses[b].rotation = by.rotation * poses[b].rotation;
                                 poses[b].position += 3 * h * random.vector<Scalar, Dim>(-1, 1);
                                 contacts.move_to(static_cast<Index>(b), poses[b]);
                             }
                         }));
    }
    CHECK(worst < 100);
}

TEMPLATE_TEST_CASE("pressed contacts: three walls gain no energy however long the step is",
                   "[contact]", float, double) {
    using Vector = Eigen::Matrix<TestType, 3, 1>;
    Random random(72);
    double worst = -1;
    for (int scene = 0; scene < 200; ++scene) {
        taut::SpringSystem<TestType, 3> system;
        system.add_particle(Vector::Zero(), 1);
        system.add_particle(5 * Vector::Unit(0), 1);
        system.add_spring(0, 1, {TestType(std::pow(10, random.uniform(-4, 3)))});
        Contacts contacts(system);
        const TestType h = taut::energy_limit(system).certified;
        if (scene % 2)
            contacts.set_stiffness(TestType(std::pow(10, random.uniform(0, 13))) / h / h);
        for (int wall = 0; wall < 3; ++wall) {
            const Vector normal = random.vector<TestType, 3>(-1, 1);
            contacts.add(taut::HalfSpace<TestType, 3>(TestType(-1e-4) * Vector::Unit(2),
                                                      {normal[0], normal[1], 1}));
        }
        auto state = system.initial_state();
        state.v.col(0) = random.vector<TestType, 3>(-1, 1) - 3 * Vector::Unit(2);
        worst = std::max(worst, most_gained(system, contacts, state, h, 20, [&] {
                             for (Index wall = 0; wall < 3; ++wall) {
                                 taut::Pose<TestType, 3> pose;
                                 pose.position = h * random.vector<TestType, 3>(-1, 1);
                                 contacts.move_to(wall, pose);
                             }
                         }));
    }
    CHECK(worst < 1000);
}

TEMPLATE_TEST_CASE("pressed contacts: what begins inside two balls leaves as it leaves one",
                   "[contact]", float, double) {
    using Vector = Eigen::Matrix<TestType, 3, 1>;
    Random random(73);
    TestType fastest = 0;
    int out = 0;
    for (int scene = 0; scene < 300; ++scene) {
        taut::SpringSystem<TestType, 3> system;
        system.add_particle(Vector::Zero(), 1);
        Contacts contacts(system);
        taut::BodyOptions options;
        options.friction = scene % 2 ? 0.5 : 0;
        for (int ball = 0; ball < 2; ++ball) {
            const Vector way = random.vector<TestType, 3>(-1, 1).normalized();
            const auto off = static_cast<TestType>(random.uniform(0.05, 0.25));
            contacts.add(taut::Sphere<TestType, 3>(off * way, TestType(0.3)), options);
        }
        taut::EnergyStableEuler stepper(system);
        auto state = system.initial_state();
        for (int frame = 0; frame < 200; ++frame) {
            REQUIRE(taut::step_through(stepper, state, TestType(1.0 / 600), 10, contacts));
            fastest = std::max(fastest, state.v.norm());
        }
        out += contacts.touching() == 0;
    }
    CHECK(fastest < TestType(1.5));  // push_out is 1 m/s
    CHECK(out > 280);
}

}  // namespace taut_test::pressed_contacts_test
