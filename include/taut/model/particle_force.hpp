// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <type_traits>
#include <utility>

#include "../core/types.hpp"

namespace taut::model_detail {

/// Some particles in memory, whatever its order: coordinate d of particle i, counted from the first
/// here, is at d·axis + i·grain.
template <class Scalar>
struct ParticleSpan {
    const Scalar* x;  // m
    const Scalar* v;  // m/s
    Scalar* f;        // N
    Index axis_of_state;
    Index axis_of_force;
    Index grain;
    Index count;
    Index first;       // the first particle's index where `order` is null
    const int* order;  // the particles' indices

    Index particle(Index i) const { return order ? order[i] : first + i; }
};

/// A force on each particle alone, by its position, velocity and index. Type-erased by the span,
/// not by the particle, so that the user's function is inlined in the loop.
template <class Scalar, int Dim>
using ParticleForce = std::function<void(const ParticleSpan<Scalar>&)>;

/// Empty where the function is, or nullptr.
template <class Scalar, int Dim, class Function>
ParticleForce<Scalar, Dim> make_particle_force(Function function) {
    // Like std::function; a lambda, which converts by itself, is never empty.
    if constexpr (std::is_constructible_v<bool, Function> &&
                  !std::is_convertible_v<Function, bool>) {
        if (!static_cast<bool>(function)) return {};
    }
    if constexpr (std::is_null_pointer_v<Function>) {
        return {};
    } else {
        return [function = std::move(function)](const ParticleSpan<Scalar>& span) {
            using Vector = Eigen::Matrix<Scalar, Dim, 1>;
            for (Index i = 0; i < span.count; ++i) {
                Vector x, v;
                for (int d = 0; d < Dim; ++d) {
                    x[d] = span.x[d * span.axis_of_state + i * span.grain];
                    v[d] = span.v[d * span.axis_of_state + i * span.grain];
                }
                const Vector force = function(std::as_const(x), std::as_const(v), span.particle(i));
                for (int d = 0; d < Dim; ++d) {
                    span.f[d * span.axis_of_force + i * span.grain] += force[d];
                }
            }
        };
    }
}

}  // namespace taut::model_detail
