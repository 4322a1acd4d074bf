// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <taut/contact/contacts.hpp>

#include "../support/catch.hpp"
#include "../support/tolerance.hpp"
#include "bodies.hpp"

namespace taut_test::contacts_test {

namespace {

using taut::Contacts;
using taut::Pose;

}  // namespace

TEMPLATE_TEST_CASE("contacts: no step raises the energy beyond the bodies' work", "[contact]",
                   (Case<float, 3>), (Case<double, 1>), (Case<double, 2>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    Random random(39);
    Index touched = 0;
    double worst = -1;  // in roundings of what is added up
    for (int scene = 0; scene < 150; ++scene) {
        RandomOptions options;
        options.particles = 2 + random.below(8);
        options.springs = 2 * options.particles;
        options.pinned = scene % 3 == 0 ? 1 : 0;
        options.dampers = scene % 4 == 0;
        const auto system = random_system<Scalar, Dim>(random, options);
        const Scalar limit = taut::energy_limit(system).certified;
        const auto h = limit * static_cast<Scalar>(random.below(2) ? 1 : random.uniform(0.05, 1));
        Contacts contacts(system);
        std::vector<Pose<Scalar, Dim>> poses(static_cast<std::size_t>(1 + random.below(4)));
        for (auto& pose : poses) {
            pose = turn<Scalar, Dim>(random, 3);
            pose.position = random.vector<Scalar, Dim>(-0.7, 0.7);
            add_some_body(random, contacts, pose);
        }
        auto state = random_state(random, system);
        state.v *= static_cast<Scalar>(std::pow(10, random.uniform(-1, 1.5)));
        for (Index i = 0; i < options.pinned; ++i) state.v.col(i).setZero();
        taut::EnergyStableEuler stepper(system);
        double before = 0;
        for (int frame = 0; frame < 20; ++frame) {
            const double speed = std::pow(10, random.uniform(-2, 1.3));
            const auto way = speed * static_cast<double>(h);
            for (std::size_t b = 0; b < poses.size(); ++b) {
                const Pose<Scalar, Dim> by = turn<Scalar, Dim>(random, std::min(2.0, 5 * way));
                poses[b].rotation = by.rotation * poses[b].rotation;
                const Vector shift = random.vector<Scalar, Dim>(-1, 1);
                poses[b].position += static_cast<Scalar>(way) * shift;
                contacts.move_to(static_cast<Index>(b), poses[b]);
            }
            REQUIRE(taut::step_through(stepper, state, h, 1, contacts));
            touched += contacts.touching();
            const auto kinetic = static_cast<double>(system.kinetic_energy(state));
            const auto potential = static_cast<double>(system.potential_energy(state));
            const double energy = kinetic + potential + contacts.energy();
            if (frame > 0) {
                const double size = std::abs(energy) + std::abs(before) + kinetic +
                                    std::abs(potential) + std::abs(contacts.work());
                worst = std::max(worst, (energy - before - contacts.work()) / size /
                                            std::numeric_limits<Scalar>::epsilon());
            }
            before = energy;
        }
    }
    CHECK(worst < 100);
    CHECK(touched > 500);
}

}  // namespace taut_test::contacts_test
