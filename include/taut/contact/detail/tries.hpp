// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <vector>

#include "contact_step.hpp"

namespace taut::contact_detail {

/// What contact came to in a frame, by particle.
struct Outcome {
    Buffer<double> work;           // of the bodies, J
    Buffer<double> energy;         // at its end, of what touches, J
    std::vector<KnownPair> known;  // at its end, by particle

    /// @param particle  at each place
    template <class Scalar, int Dim>
    void take(const ContactStep<Scalar, Dim>& step, const Buffer<int>& particle) {
        const auto size = static_cast<Index>(particle.size());
        work.assign(size, 0);
        energy.assign(size, 0);
        for (Index place = 0; place < size; ++place)
            work[particle[place]] = static_cast<double>(step.work[place]);
        step.near.remember(step.bodies, known);
        for (auto& pair : known) pair.at = particle[pair.at];
        step.each_energy([&](int place, double held) { energy[particle[place]] += held; });
    }
};

}  // namespace taut::contact_detail
