// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/network/spring_system.hpp>

namespace bench {

/// The step that everybody writes: one loop over springs in the order of the scene.
template <class Scalar>
class PlainLoop {
public:
    using System = taut::SpringSystem<Scalar, 3>;

    explicit PlainLoop(const System& system) : system_(system), springs_(system.springs()) {
        const auto state = system.initial_state();
        x_.assign(state.x.data(), state.x.data() + state.x.size());
        v_.assign(x_.size(), 0);
        f_.assign(x_.size(), 0);
    }
    void step(Scalar h) {
        std::fill(f_.begin(), f_.end(), Scalar(0));
        for (std::size_t s = 0; s < springs_.a.size(); ++s) {
            const Scalar* a = &x_[3 * static_cast<std::size_t>(springs_.a[s])];
            const Scalar* b = &x_[3 * static_cast<std::size_t>(springs_.b[s])];
            const Scalar dx = b[0] - a[0];
            const Scalar dy = b[1] - a[1];
            const Scalar dz = b[2] - a[2];
            const Scalar l = std::sqrt(dx * dx + dy * dy + dz * dz);
            const Scalar pull =
                springs_.parameters[s].stiffness * (l - springs_.rest_length[s]) / l;
            Scalar* fa = &f_[3 * static_cast<std::size_t>(springs_.a[s])];
            Scalar* fb = &f_[3 * static_cast<std::size_t>(springs_.b[s])];
            fa[0] += pull * dx;
            fa[1] += pull * dy;
            fa[2] += pull * dz;
            fb[0] -= pull * dx;
            fb[1] -= pull * dy;
            fb[2] -= pull * dz;
        }
        const auto inverse_mass = system_.inverse_mass();
        for (taut::Index i = 0; i < system_.size(); ++i) {
            const Scalar w = inverse_mass[i];
            for (std::size_t d = 0; d < 3; ++d) {
                const auto j = 3 * static_cast<std::size_t>(i) + d;
                const Scalar gravity =
                    w > 0 ? system_.gravity()[static_cast<taut::Index>(d)] : Scalar(0);
                v_[j] += h * (w * f_[j] + gravity);
                x_[j] += h * v_[j];
            }
        }
    }

private:
    const System& system_;
    const taut::SpringSet<Scalar, taut::Hookean>& springs_;
    std::vector<Scalar> x_, v_, f_;
};

}  // namespace bench
