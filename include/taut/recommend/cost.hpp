// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>

#include "../core/clock.hpp"
#include "candidate.hpp"

namespace taut {

/// How costs are measured.
struct Calibration {
    double seconds = 0.05;             ///< of steps, for each candidate
    Index least_steps = 3;             ///< even where they take longer
    double (*clock)() = &cpu_seconds;  ///< s
};

/// CPU seconds of a step of `candidate` from `state` on, which is left as it is: batches of 1, 2, 4
/// … steps after a first one that sets up patterns and plans; the cheaper of the last two batches
/// counts. Infinity when a step fails.
/// @param hopeless  s: one implicit step that costs more ends the measurement (an explicit one
///                  says little: each call converts the scene, for all of its steps)
template <class System>
double step_cost(const System& system, const typename System::State& state,
                 const Candidate& candidate, const Calibration& calibration = {},
                 double hopeless = std::numeric_limits<double>::infinity()) {
    const auto h = static_cast<typename System::Scalar>(candidate.h);
    double last = std::numeric_limits<double>::infinity();
    double before = last;
    with_stepper(system, candidate, [&](auto& stepper) {
        auto moving = state;
        bool alive = static_cast<bool>(stepper.step(moving, h));
        double spent = 0;
        Index taken = 0;
        for (Index batch = 1;
             alive && (spent < calibration.seconds || taken < calibration.least_steps);
             batch *= 2) {
            const double start = calibration.clock();
            alive = static_cast<bool>(stepper.step(moving, h, batch));
            const double elapsed = calibration.clock() - start;
            spent += elapsed;
            taken += batch;
            before = last;
            last = elapsed / static_cast<double>(batch);
            if (batch == 1 && last > hopeless && is_implicit(candidate.method)) break;
        }
        if (!alive) before = last = std::numeric_limits<double>::infinity();
    });
    return (std::min)(before, last);
}

}  // namespace taut
