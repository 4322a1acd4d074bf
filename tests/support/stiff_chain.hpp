// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <taut/model/spring_system.hpp>

namespace taut_test {

/// A chain of springs over twelve decades of stiffness: in a step of 1 s, conjugate gradients do
/// not reach a residual of 1e-13 within their cap.
inline taut::SpringSystem<double, 3> stiff_chain() {
    taut::SpringSystem<double, 3> chain;
    for (int i = 0; i < 20; ++i) {
        chain.add_particle({double(i), 0, 0}, 1e-4);
        if (i > 0) chain.add_spring(i - 1, i, std::pow(1e12, (i * 7 % 20) / 20.0));
    }
    chain.pin(0);
    chain.set_gravity({1, 2, 3});
    return chain;
}

}  // namespace taut_test
