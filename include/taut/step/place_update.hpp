// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "layout.hpp"

namespace taut::step_detail {

/// The scalars first … first + count − 1 of planes, the places of a tile, and the forces on them.
template <class Scalar>
struct TilePlaces {
    const StatePlanes<Scalar>& planes;
    Index first;
    Index count;
    Planes<Scalar> force_a;   // N
    Planes<Scalar> force_b;   // N
    Planes<Scalar> external;  // beside those of springs, N; empty planes for none
};

/// Moves places by the forces on them: what a step does beside springs.
template <class Scalar>
class PlaceUpdate {
public:
    /// Brings all members up to date.
    /// @param gravity  the system's   @param drag  d0 of Rayleigh damping, 1/s
    /// @param ahead    s, by which springs see x ahead
    void load(const Scalar* gravity, int dim, Scalar drag, Scalar ahead);
    /// @param inverse_mass  the system's, 1/kg
    void load_masses(const Layout<Scalar>& layout, const Scalar* inverse_mass);

    /// A step of h, s, of the places of a tile by the forces on them, which are cleared.
    /// @tparam Update  update(x, v, a, h) of registers: x, v, of one coordinate, by the
    /// acceleration
    template <class Update>
    void move(const Layout<Scalar>& layout, const TilePlaces<Scalar>& tile, Scalar h) const;

private:
    using Register = VectorRegister<Scalar>;

    template <bool Stars, class Update>
    void move(const TilePlaces<Scalar>& tile, int planes, Scalar h) const;

    Few<Scalar, 4> gravity_{};                  // m/s²
    Few<Scalar, max_width> gravity_of_points_;  // x y z 0 x y z 0 …
    Buffer<Scalar> inverse_mass_;               // a plane, 1/kg, 0 if pinned
    Scalar drag_ = 0;                           // d0, 1/s
    Scalar ahead_ = 0;
};

template <class Scalar>
void PlaceUpdate<Scalar>::load(const Scalar* gravity, int dim, Scalar drag, Scalar ahead) {
    gravity_.fill(0);
    std::copy_n(gravity, dim, gravity_.begin());
    for (int i = 0; i < max_width; ++i) gravity_of_points_[i] = gravity_[i % 4];
    drag_ = drag;
    ahead_ = ahead;
}

template <class Scalar>
void PlaceUpdate<Scalar>::load_masses(const Layout<Scalar>& layout, const Scalar* inverse_mass) {
    const Index size = layout.size() * layout.grain();
    inverse_mass_.resize(static_cast<std::size_t>(layout.stride()));
    detail::set_zero(inverse_mass_.data() + size, layout.stride() - size);
    layout.to_plane(inverse_mass, inverse_mass_.data());
}

template <class Scalar>
template <class Update>
void PlaceUpdate<Scalar>::move(const Layout<Scalar>& layout, const TilePlaces<Scalar>& tile,
                               Scalar h) const {
    TAUT_BY_KERNEL(move(Update()), this, &layout, &tile, h);
    const int planes = layout.planes();
    layout.has_stars() ? move<true, Update>(tile, 1, h) : move<false, Update>(tile, planes, h);
}

template <class Scalar>
template <bool Stars, class Update>
void PlaceUpdate<Scalar>::move(const TilePlaces<Scalar>& tile, int planes, Scalar h) const {
    // The axis of a lane is the same in each of so many registers in turn.
    constexpr int turns = Stars ? (std::max)(1, 4 / Register::width) : 1;
    const Index count = tile.count;  // a store through a register may be one to the tile
    const Register step(h);
    const Register zero(Scalar(0));
    const Register ahead(ahead_);
    const bool looks_ahead = ahead_ > 0;
    const Register d0(drag_);
    const bool drags = drag_ > 0;
    for (int d = 0; d < planes; ++d) {
        Few<Register, turns> gravity;
        for (int turn = 0; turn < turns; ++turn) {
            gravity[turn] = Stars
                                ? Register::load(gravity_of_points_.data() + turn * Register::width)
                                : Register(gravity_[d]);
        }
        const Scalar* inverse_masses = inverse_mass_.data() + tile.first;
        const Scalar* xs = tile.planes.x[d] + tile.first;
        const Scalar* vs = tile.planes.v[d] + tile.first;
        Scalar* new_xs = tile.planes.new_x[d] + tile.first;
        Scalar* new_vs = tile.planes.new_v[d] + tile.first;
        Scalar* new_spring_xs = tile.planes.new_spring_x[d] + tile.first;
        const Scalar* external = tile.external.first ? tile.external[d] : nullptr;
        Scalar* forces_a = tile.force_a[d];
        [[maybe_unused]] Scalar* forces_b = tile.force_b[d];
        const auto move_register = [&](Index i, const Register& g) {
            const Register inverse_mass = Register::load(inverse_masses + i);
            Register x = Register::load(xs + i);
            Register v = Register::load(vs + i);
            Register free_fall = g;
            if (drags) free_fall -= d0 * v;
            free_fall = where_less(zero, inverse_mass, free_fall, zero);  // pins do not fall
            Register f = Register::load(forces_a + i);
            zero.store(forces_a + i);
            if constexpr (!Stars) {
                f += Register::load(forces_b + i);
                zero.store(forces_b + i);
            }
            if (external) f += Register::load(external + i);
            Update()(x, v, free_fall + inverse_mass * f, step);
            x.store(new_xs + i);
            v.store(new_vs + i);
            if (looks_ahead) (x + ahead * v).store(new_spring_xs + i);
        };
        for (Index i = 0; i < count; i += turns * Register::width) {
            for (int turn = 0; turn < turns; ++turn) {
                move_register(i + turn * Register::width, gravity[turn]);
            }
        }
    }
}

}  // namespace taut::step_detail
