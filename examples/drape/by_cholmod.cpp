// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <taut/solver/cholmod.hpp>

#include "implicit_motion.hpp"

namespace drape {

Advance motion_by_cholmod(const Options& options, const Scene& scene) {
    return implicit_motion<taut::Cholmod<double>>(options, scene);
}

}  // namespace drape
