// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include "implicit_motion.hpp"

namespace drape {

Advance motion_by_gradients(const Options& options, const Scene& scene) {
    using Gradients = taut::ConjugateGradient<double, 3>;
    return implicit_motion<Gradients>(options, scene, [&](Gradients& solver) {
        if (options.tolerance) solver.setTolerance(*options.tolerance);
    });
}

}  // namespace drape
