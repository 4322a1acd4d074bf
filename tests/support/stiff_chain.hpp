// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <taut/network/spring_system.hpp>

namespace taut_test {

/// A chain of springs over twelve decades of stiffness: in a step of 1 s, conjugate gradients do
/// not reach a residual of 1e-13 within their cap.
inline taut::SpringSystem<double, 1> stiff_chain() {
    using Vector = Eigen::Matrix<double, 1, 1>;
    taut::SpringSystem<double, 1> chain;
    for (int i = 0; i < 20; ++i) {
        chain.add_particle(Vector(double(i)), 1e-4);
        if (i > 0) chain.add_spring(i - 1, i, std::pow(1e12, (i * 7 % 20) / 20.0));
    }
    chain.set_gravity(Vector(1.0));
    return chain;
}

}  // namespace taut_test
