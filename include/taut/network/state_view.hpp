// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

#include "../core/detail/fits.hpp"
#include "../core/error.hpp"
#include "state.hpp"

namespace taut {

/// An engine's own arrays as a state: steppers take it where they take a State, and Guarded too.
///
/// Explicit steps of springs read and write the arrays themselves, once a call, as they do a
/// State's. Implicit steps work on a State of their own and copy it back, one pass a call. Each
/// number is converted where Stored is not the system's Scalar; what is too large for Stored
/// becomes infinite, and the next step refuses it.
///
///     struct Particle { float x[3], v[3], wear; };
///     taut::StateView<float, 3> view(particles[0].x, particles[0].v, count,
///                                    sizeof(Particle) / sizeof(float));
///     stepper.step(view, h, substeps);
///
/// The view keeps the pointers only: make a new one when the arrays have moved.
template <class Stored_, int Dim_>
struct StateView {
    static_assert(std::is_floating_point_v<Stored_>,
                  "taut::StateView<Stored, Dim>: Stored must be float, double or long double");
    static_assert(Dim_ >= 1 && Dim_ <= 3, "taut::StateView<Stored, Dim>: Dim must be 1, 2 or 3");

    using Stored = Stored_;
    static constexpr int Dim = Dim_;
    /// Particle i is column i; a matrix of one row strides along that row.
    using Stride =
        std::conditional_t<Dim == 1, Eigen::InnerStride<>, Eigen::OuterStride<Eigen::Dynamic>>;
    using Array = Eigen::Map<Points<Stored, Dim>, Eigen::Unaligned, Stride>;

    Array x;          ///< Dim × n, m
    Array v;          ///< Dim × n, m/s
    double time = 0;  ///< s

    /// @param stride  numbers from one particle to the next, ≥ Dim: 4 for a padded float4
    StateView(Stored* positions, Stored* velocities, Index particles, Index stride = Dim)
        : StateView(positions, stride, velocities, stride, particles) {}
    /// The same with a stride for each array.
    StateView(Stored* positions, Index position_stride, Stored* velocities, Index velocity_stride,
              Index particles)
        : x(map("positions", positions, position_stride, particles)),
          v(map("velocities", velocities, velocity_stride, particles)) {}

    /// Another view of the same arrays.
    StateView(const StateView&) = default;
    /// Whether to copy numbers or pointers, nobody could tell.
    StateView& operator=(const StateView&) = delete;

    /// Whether every coordinate is, of x and v.
    bool finite() const {
        // a − a is 0, or NaN where a is not finite; and so is the sum.
        Eigen::Array<Stored, Dim, 1> sum = Eigen::Array<Stored, Dim, 1>::Zero();
        for (Index i = 0; i < x.cols(); ++i) {
            sum += (x.col(i) - x.col(i)).array() + (v.col(i) - v.col(i)).array();
        }
        return (sum == Stored(0)).all();
    }
    /// Index of the first particle with a coordinate that is not finite, or -1.
    Index first_not_finite() const { return network_detail::first_not_finite(x, v); }
    /// What is not a step (Stability, an energy) takes a State.
    template <class Scalar>
    void copy_to(State<Scalar, Dim>& state) const {
        state.x = x.template cast<Scalar>();
        state.v = v.template cast<Scalar>();
        state.time = static_cast<Scalar>(time);
    }
    /// @param state  of as many particles
    template <class Scalar>
    void copy_from(const State<Scalar, Dim>& state) {
        detail::require_fits("StateView::copy_from", state, x.cols(), "the view has");
        x = state.x.template cast<Stored>();
        v = state.v.template cast<Stored>();
        time = static_cast<double>(state.time);
    }

private:
    static Array map(const char* name, Stored* first, Index stride, Index particles) {
        if (particles < 0) {
            fail("StateView: particles is ", particles, "; it must be >= 0");
        }
        if (stride < Dim) {
            fail("StateView: the stride of ", name, " is ", stride, "; it must be >= ", Dim);
        }
        if (first == nullptr && particles > 0) fail("StateView: ", name, " is a null pointer");
        return Array(first, Dim, particles, Stride(stride));
    }
};

namespace network_detail {

template <class T>
inline constexpr bool is_state_view_v = false;
template <class Stored, int Dim>
inline constexpr bool is_state_view_v<StateView<Stored, Dim>> = true;

/// What a step of a system with this State accepts.
template <class State, class AnyState>
constexpr void require_state() {
    if constexpr (is_state_view_v<AnyState>) {
        static_assert(State::Dim == AnyState::Dim,
                      "taut: a step takes a StateView of the system's own dimension");
    } else {
        static_assert(std::is_same_v<State, AnyState>,
                      "taut: a step takes the system's State, or a StateView");
    }
}

}  // namespace network_detail
}  // namespace taut
