// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "convex_on.hpp"

namespace taut_test {

taut::Report step_in_2d(const ConvexScene& scene, double h, AnyState& any, double tolerance,
                        const Held* held) {
    return step_in<2>(scene, h, any, tolerance, held);
}

}  // namespace taut_test
