// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "stepping.hpp"

namespace drape {

/// implicit, newton and bdf2 with one solver.
/// @param prepare  prepare(solver), before it is used
template <class Solver, class Prepare = AsItIs>
Advance implicit_motion(const Options& options, const Scene& scene, const Prepare& prepare = {}) {
    const auto configure = [&](auto& stepper) { stepper.configure(prepare); };
    if (options.integrator == "bdf2") {
        return plain_or_guarded<taut::Bdf2<Cloth, Solver>>(options, scene, configure);
    }
    using Implicit = taut::ImplicitEuler<Cloth, Solver>;
    typename Implicit::Options newton;
    if (options.integrator == "newton") newton.newton_iterations = 100;
    return plain_or_guarded<Implicit>(options, scene, configure, newton);
}

}  // namespace drape
