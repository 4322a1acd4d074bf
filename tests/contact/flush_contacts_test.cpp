// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <taut/contact/contact.hpp>

#include "../support/catch.hpp"
#include "../support/tolerance.hpp"
#include "bodies.hpp"

namespace taut_test::flush_contacts_test {

namespace {

/// Two particles of 1 kg at x and beside it, on a spring at rest.
template <class Scalar, int Dim>
auto pair_at(const Eigen::Matrix<Scalar, Dim, 1>& x, const Eigen::Matrix<Scalar, Dim, 1>& beside) {
    taut::SpringSystem<Scalar, Dim> system;
    system.add_particle(x, 1);
    system.add_particle(x + beside, 1);
    system.add_spring(0, 1, {1000});
    return system;
}

}  // namespace

TEMPLATE_TEST_CASE("flush contacts: what slides over two floors that are one gains nothing",
                   "[contact]", (Case<float, 3>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    Random random(7);
    for (int scene = 0; scene < 20; ++scene) {
        const Vector up = random.vector<Scalar, Dim>(-1, 1).normalized();
        Vector along = random.vector<Scalar, Dim>(-1, 1);
        along = (along - along.dot(up) * up).normalized();
        auto system = pair_at<Scalar, Dim>(-along / 4, along / 2);
        system.set_gravity(Scalar(-9.81) * up);
        const Scalar h = taut::energy_limit(system).certified;
        taut::Contacts contacts(system);
        // κ/m, 1/s², up to what Contacts takes; the first as it is.
        const double most_stiff = std::is_same_v<Scalar, float> ? 8e7 : 1e16;
        if (scene > 0)
            contacts.set_stiffness(static_cast<Scalar>(log_uniform(random, 1e6, most_stiff)));
        for (int floors = 0; floors < 2; ++floors)
            contacts.add(taut::HalfSpace<Scalar, Dim>(Vector::Zero(), up));
        taut::EnergyStableEuler stepper(system);
        auto state = system.initial_state();
        state.v = along.replicate(1, 2);
        double before = 0, most = 0;
        for (int step = 0; step < 20; ++step) {
            REQUIRE(taut::step_through(stepper, state, h, 1, contacts));
            const double energy = static_cast<double>(system.kinetic_energy(state)) +
                                  static_cast<double>(system.potential_energy(state)) +
                                  contacts.energy();
            if (step > 0) most = std::max(most, energy - before - contacts.work());
            before = energy;
        }
        CAPTURE(scene, contacts.stiffness());
        CHECK(most < Tolerance<Scalar>::rounding);
        CHECK_THAT(static_cast<double>(along.dot(state.v.col(0))),
                   WithinAbs(1, 20 * Tolerance<Scalar>::rounding));
    }
}

TEMPLATE_TEST_CASE("flush contacts: what lies on a surface leaves it as fast as it goes",
                   "[contact]", (Case<float, 3>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    const Scalar radius = Scalar(0.5);
    const Vector up = Vector::Unit(Dim - 1);
    for (const int bodies : {1, 2}) {
        for (const double speed : {0.1, 1.0, 100.0}) {
            const auto system = pair_at<Scalar, Dim>(radius * up, up);
            taut::Contacts contacts(system);
            for (int k = 0; k < bodies; ++k) contacts.add(OwnSphere<Scalar, Dim>{radius});
            taut::EnergyStableEuler stepper(system);
            auto state = system.initial_state();
            state.v = static_cast<Scalar>(speed) * up.replicate(1, 2);
            const Scalar h = taut::energy_limit(system).certified;
            REQUIRE(taut::step_through(stepper, state, h, 1, contacts));
            CHECK_THAT(static_cast<double>(up.dot(state.v.col(0))) / speed,
                       WithinAbs(1, Tolerance<Scalar>::accumulated));
        }
    }
}

}  // namespace taut_test::flush_contacts_test
