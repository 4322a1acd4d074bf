// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "../network/spring_system.hpp"

namespace taut {

/// What a run leaves behind: positions and energies at every stride-th of evenly spaced samples,
/// the first of them at the start.
template <class Scalar, int Dim>
struct Trajectory {
    Index stride = 1;                    ///< samples from one entry to the next
    std::vector<Points<Scalar, Dim>> x;  ///< Dim × n each, m
    std::vector<double> energy;          ///< J
    std::vector<double> kinetic;         ///< J

    /// Appends the state and its energies.
    template <class System>
    void see(const System& system, const State<Scalar, Dim>& state) {
        x.push_back(state.x);
        energy.push_back(static_cast<double>(system.energy(state)));
        kinetic.push_back(static_cast<double>(system.kinetic_energy(state)));
    }
};

/// Root mean square of |x − x_ref| over particles and common samples, relative to the largest
/// displacement of the reference from its start. Infinity if the run broke off.
/// @param reference  with stride 1
template <class Scalar, int Dim>
double position_error(const Trajectory<Scalar, Dim>& run,
                      const Trajectory<Scalar, Dim>& reference) {
    const std::size_t stride = static_cast<std::size_t>(run.stride);
    if ((reference.x.size() - 1) / stride + 1 != run.x.size()) {
        return std::numeric_limits<double>::infinity();
    }
    double squares = 0;
    for (std::size_t j = 0; j < run.x.size(); ++j) {
        squares += static_cast<double>((run.x[j] - reference.x[j * stride]).squaredNorm());
    }
    double furthest = 0;
    for (const auto& x : reference.x) {
        furthest = (std::max)(
            furthest,
            static_cast<double>((x - reference.x.front()).colwise().squaredNorm().maxCoeff()));
    }
    const auto particles =
        static_cast<double>(run.x.size() * static_cast<std::size_t>(run.x.front().cols()));
    const double error = std::sqrt(squares / particles / furthest);
    return detail::is_finite(error) ? error : std::numeric_limits<double>::infinity();
}

/// Mean of E − E_ref over the last quarter of the samples, relative to the largest kinetic energy
/// of the reference: what the steps have added to the energy, or taken from it.
template <class Scalar, int Dim>
double energy_drift(const Trajectory<Scalar, Dim>& run, const Trajectory<Scalar, Dim>& reference) {
    const std::size_t stride = static_cast<std::size_t>(run.stride);
    if ((reference.x.size() - 1) / stride + 1 != run.x.size()) {
        return std::numeric_limits<double>::infinity();
    }
    const std::size_t count = std::max<std::size_t>(1, run.x.size() / 4);
    double sum = 0;
    for (std::size_t j = run.x.size() - count; j < run.x.size(); ++j) {
        sum += run.energy[j] - reference.energy[j * stride];
    }
    return sum / static_cast<double>(count) /
           *std::max_element(reference.kinetic.begin(), reference.kinetic.end());
}

}  // namespace taut
