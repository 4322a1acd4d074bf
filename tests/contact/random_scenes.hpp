// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "../support/catch.hpp"
#include "bodies.hpp"

namespace taut_test {

struct Gained {
    double worst = -1;  ///< energy beyond the bodies' work, in roundings of what is added up
    taut::Index touched = 0;
};

/// Small networks among one to four bodies that move and turn, in steps of their limit or less.
/// @param add_body  (contacts, pose)
template <class Scalar, int Dim, class AddBody>
Gained gained_in_scenes(Random& random, int scenes, const AddBody& add_body) {
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    Gained gained;
    for (int scene = 0; scene < scenes; ++scene) {
        RandomOptions options;
        options.particles = 2 + random.below(8);
        options.springs = 2 * options.particles;
        options.pinned = scene % 3 == 0 ? 1 : 0;
        options.dampers = scene % 4 == 0;
        const auto system = random_system<Scalar, Dim>(random, options);
        const Scalar limit = taut::energy_limit(system).certified;
        const auto h = limit * static_cast<Scalar>(random.below(2) ? 1 : random.uniform(0.05, 1));
        taut::Contacts contacts(system);
        std::vector<taut::Pose<Scalar, Dim>> poses(static_cast<std::size_t>(1 + random.below(4)));
        for (auto& pose : poses) {
            pose = turn<Scalar, Dim>(random, 3);
            pose.position = random.vector<Scalar, Dim>(-0.7, 0.7);
            add_body(contacts, pose);
        }
        auto state = random_state(random, system);
        state.v *= static_cast<Scalar>(std::pow(10, random.uniform(-1, 1.5)));
        for (taut::Index i = 0; i < options.pinned; ++i) state.v.col(i).setZero();
        taut::EnergyStableEuler stepper(system);
        double before = 0;
        for (int frame = 0; frame < 20; ++frame) {
            const double speed = std::pow(10, random.uniform(-2, 1.3));
            const auto way = speed * static_cast<double>(h);
            for (std::size_t b = 0; b < poses.size(); ++b) {
                const auto by = turn<Scalar, Dim>(random, std::min(2.0, 5 * way));
                poses[b].rotation = by.rotation * poses[b].rotation;
                const Vector shift = random.vector<Scalar, Dim>(-1, 1);
                poses[b].position += static_cast<Scalar>(way) * shift;
                contacts.move_to(static_cast<taut::Index>(b), poses[b]);
            }
            REQUIRE(taut::step_through(stepper, state, h, 1, contacts));
            gained.touched += contacts.touching();
            const auto kinetic = static_cast<double>(system.kinetic_energy(state));
            const auto potential = static_cast<double>(system.potential_energy(state));
            const double energy = kinetic + potential + contacts.energy();
            if (frame > 0) {
                const double size = std::abs(energy) + std::abs(before) + kinetic +
                                    std::abs(potential) + std::abs(contacts.work());
                gained.worst = std::max(gained.worst, (energy - before - contacts.work()) / size /
                                                          std::numeric_limits<Scalar>::epsilon());
            }
            before = energy;
        }
    }
    return gained;
}

}  // namespace taut_test
