// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <taut/integrator/guarded.hpp>

#include "tolerance.hpp"

namespace taut_test {

/// What `ok` promises by the docstring of Guarded, with its default options and without gravity and
/// moving pins: E ≤ C·E_then + w·(W + slack·S + drift·∫S dt).
template <class Stepper>
struct Promise {
    using Scalar = typename Stepper::Scalar;
    static constexpr bool implicit = taut::is_implicit(Stepper::method);
    static constexpr double swing = implicit                                            ? 1
                                    : Stepper::method == taut::Method::symplectic_euler ? 3.9
                                                                                        : 2.4;
    static constexpr double yield = implicit                                            ? 1
                                    : Stepper::method == taut::Method::symplectic_euler ? 2.6
                                                                                        : 2;

    double granted = std::numeric_limits<double>::infinity();
    double scale = 0;

    /// @param work  done in the frame that ends with this energy, J
    bool holds(double energy, double span, double work = 0) {
        const typename taut::Guarded<Stepper>::Options options;
        const double most = std::max(scale * std::exp(-span / 10), last + std::abs(work));
        const double slack = options.energy_slack + Tolerance<Scalar>::accumulated;
        granted += yield * (work + options.energy_drift * span * most);
        const bool kept = energy <= granted + yield * slack * most;
        granted = std::min(granted, swing * energy);
        scale = most;
        last = energy;
        return kept;
    }

private:
    double last = 0;
};

}  // namespace taut_test
