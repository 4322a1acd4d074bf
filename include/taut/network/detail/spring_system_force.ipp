// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

namespace taut {

template <class Scalar, int Dim, class... Laws>
template <class PullOf>
void SpringSystem<Scalar, Dim, Laws...>::sum_forces(const State& state, Force& f,
                                                    PullOf&& pull) const {
    f.resize(Dim, size());
    const Scalar d0 = static_cast<Scalar>(rayleigh_.mass_proportional);
    for (Index i = 0; i < size(); ++i) {
        f.col(i) = mass_[i] * gravity_;
        if (d0 > 0) f.col(i) -= d0 * mass_[i] * state.v.col(i);
    }
    for_each_set([&](const auto& set) {
        for (const auto spring : set) {
            const Vector force = pull(spring);
            f.col(spring.a) += force;
            f.col(spring.b) -= force;
        }
    });
    external_.add(state, f);
}

template <class Scalar, int Dim, class... Laws>
void SpringSystem<Scalar, Dim, Laws...>::force(const State& state, Force& f) const {
    detail::require_fits("SpringSystem::force", state, size());
    const auto alpha = static_cast<Scalar>(rayleigh_.stiffness_proportional);
    sum_forces(state, f, [&](const auto& spring) -> Vector {
        const Vector dx = state.x.col(spring.b) - state.x.col(spring.a);
        if (alpha == 0 && spring.damping == 0) return pull(spring, dx);
        const Vector dv = state.v.col(spring.b) - state.v.col(spring.a);
        return pull(spring, dx, dv, alpha);
    });
}

template <class Scalar, int Dim, class... Laws>
void SpringSystem<Scalar, Dim, Laws...>::force_ahead(const State& state, Scalar h, Force& f) const {
    detail::require_fits("SpringSystem::force_ahead", state, size());
    const auto alpha = static_cast<Scalar>(rayleigh_.stiffness_proportional);
    sum_forces(state, f, [&](const auto& spring) {
        const Vector dx = state.x.col(spring.b) - state.x.col(spring.a);
        const Vector dv = state.v.col(spring.b) - state.v.col(spring.a);
        return pull_ahead(spring, dx, dv, h, alpha);
    });
}

template <class Scalar, int Dim, class... Laws>
Scalar SpringSystem<Scalar, Dim, Laws...>::kinetic_energy(const State& state) const {
    detail::require_fits("SpringSystem::kinetic_energy", state, size());
    Scalar energy = 0;
    for (Index i = 0; i < size(); ++i) {
        if (!is_pinned(i)) energy += Scalar(0.5) * mass_[i] * state.v.col(i).squaredNorm();
    }
    return energy;
}

template <class Scalar, int Dim, class... Laws>
Scalar SpringSystem<Scalar, Dim, Laws...>::potential_energy(const State& state) const {
    detail::require_fits("SpringSystem::potential_energy", state, size());
    Scalar energy = 0;
    for (Index i = 0; i < size(); ++i) energy -= mass_[i] * gravity_.dot(state.x.col(i));
    visit_springs([&](const auto& spring) {
        const Vector dx = state.x.col(spring.b) - state.x.col(spring.a);
        energy += spring.energy(dx.norm());
    });
    return energy;
}

}  // namespace taut
