// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <taut/network/spring_system.hpp>
#include <utility>
#include <vector>

namespace bench {

using Net = taut::SpringSystem<double, 3>;

/// Largest l/L.
template <class Scalar>
double largest_stretch(const taut::SpringSystem<Scalar, 3>& net,
                       const taut::State<Scalar, 3>& state) {
    const auto& springs = net.springs();
    Scalar stretch = 0;
    for (std::size_t s = 0; s < springs.a.size(); ++s) {
        const Scalar l = (state.x.col(springs.b[s]) - state.x.col(springs.a[s])).norm();
        stretch = std::max(stretch, l / springs.rest_length[s]);
    }
    return static_cast<double>(stretch);
}

/// What becomes of a scene, judged by Taut's own energies whoever moves it.
class Outcome {
public:
    /// A spring of so many times its length counts as an explosion.
    static constexpr double explosion = 10;
    static constexpr const char* columns = "energy drift | largest l/L | exploded";

    explicit Outcome(const Net& net) : net_(net), start_(net.energy(net.initial_state())) {}

    /// Sees the scene after a frame that ends at time t, s.
    void see(double t, const Net::State& state) {
        const double energy = state.finite() ? net_.energy(state) : NAN;
        if (!std::isfinite(energy)) return explode();
        energies_.push_back({t, energy});
        kinetic_ = std::max(kinetic_, net_.kinetic_energy(state));
        stretch_ = std::max(stretch_, largest_stretch(net_, state));
    }
    /// The stepper gave up, or a number is not finite.
    void explode() { lost_ = true; }
    bool lost() const { return lost_; }

    /// (mean energy of the last 0.1 s seen − E₀) over the largest kinetic energy.
    double drift() const {
        double sum = 0;
        int late = 0;
        for (const auto& [t, energy] : energies_) {
            if (t < energies_.back().first - 0.0999) continue;
            sum += energy;
            ++late;
        }
        return (sum / late - start_) / kinetic_;
    }
    /// The cells below `columns`.
    std::string cells() const {
        if (lost_ || energies_.empty()) return lost_ ? "– | – | yes" : "– | – | –";
        char text[80];
        std::snprintf(text, sizeof text, "%+.3g %% | %.4g | %s", 100 * drift(), stretch_,
                      stretch_ > explosion ? "yes" : "no");
        return text;
    }

private:
    const Net& net_;
    double start_;                                     // energy, J
    std::vector<std::pair<double, double>> energies_;  // s, J
    double kinetic_ = 0;                               // largest, J
    double stretch_ = 0;
    bool lost_ = false;
};

}  // namespace bench
