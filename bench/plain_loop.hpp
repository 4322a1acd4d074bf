// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <taut/model/spring_system.hpp>
#include <vector>

namespace bench {

using taut::Index;
using Cloth = taut::SpringSystem<double, 3>;

/// The step that everybody writes: one loop over springs in the order of the scene.
class PlainLoop {
public:
    explicit PlainLoop(const Cloth& cloth) : cloth_(cloth), springs_(cloth.springs()) {
        const auto state = cloth.initial_state();
        x_.assign(state.x.data(), state.x.data() + state.x.size());
        v_.assign(x_.size(), 0);
        f_.assign(x_.size(), 0);
    }
    void step(double h) {
        std::fill(f_.begin(), f_.end(), 0);
        for (std::size_t s = 0; s < springs_.a.size(); ++s) {
            const double* a = &x_[3 * static_cast<std::size_t>(springs_.a[s])];
            const double* b = &x_[3 * static_cast<std::size_t>(springs_.b[s])];
            const double dx = b[0] - a[0];
            const double dy = b[1] - a[1];
            const double dz = b[2] - a[2];
            const double l = std::sqrt(dx * dx + dy * dy + dz * dz);
            const double pull =
                springs_.parameters[s].stiffness * (l - springs_.rest_length[s]) / l;
            double* fa = &f_[3 * static_cast<std::size_t>(springs_.a[s])];
            double* fb = &f_[3 * static_cast<std::size_t>(springs_.b[s])];
            fa[0] += pull * dx;
            fa[1] += pull * dy;
            fa[2] += pull * dz;
            fb[0] -= pull * dx;
            fb[1] -= pull * dy;
            fb[2] -= pull * dz;
        }
        const auto inverse_mass = cloth_.inverse_mass();
        for (Index i = 0; i < cloth_.size(); ++i) {
            const double w = inverse_mass[i];
            for (std::size_t d = 0; d < 3; ++d) {
                const auto j = 3 * static_cast<std::size_t>(i) + d;
                const double gravity = w > 0 ? cloth_.gravity()[static_cast<Index>(d)] : 0;
                v_[j] += h * (w * f_[j] + gravity);
                x_[j] += h * v_[j];
            }
        }
    }

private:
    const Cloth& cloth_;
    const taut::SpringSet<double, taut::Hookean>& springs_;
    std::vector<double> x_, v_, f_;
};

}  // namespace bench
