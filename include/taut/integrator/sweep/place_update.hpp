// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>

#include "register.hpp"
#include "state_planes.hpp"

namespace taut::integrator_detail::sweep {

/// Moves places by the forces on them: what a step does beside springs.
template <class Scalar, int Dim>
class PlaceUpdate {
public:
    /// Brings all members up to date.
    /// @param ahead  s, by which springs see x ahead
    template <class System, class Plan>
    void load(const System& system, const Plan& plan, Scalar ahead) {
        gravity_ = system.gravity();
        for (int i = 0; i < max_width; ++i) {
            gravity_of_points_[i] = i % 4 < Dim ? gravity_[i % 4] : Scalar(0);
        }
        drag_ = static_cast<Scalar>(system.rayleigh().mass_proportional);
        ahead_ = ahead;
        const Index size = plan.size() * plan.grain();
        inverse_mass_.resize(plan.stride());
        inverse_mass_.tail(plan.stride() - size).setZero();
        plan.to_plane(system.inverse_mass(), inverse_mass_.data());
        pins_ = (inverse_mass_.head(size).array() == Scalar(0)).any();
    }
    bool has_pins() const { return pins_; }
    bool has_drag() const { return drag_ > 0; }

    /// Forces beside those of springs, N; empty planes for none.
    void set_external(const Planes<Scalar>& force) { external_ = force; }

    /// The scalars first, first + 1, … of planes by the forces on them, which are cleared.
    /// @param update  update(x, v, a, h) of registers, see Sweep::run
    template <bool Pins, bool Drag, bool Stars, class Update>
    void move(const StatePlanes<Scalar>& planes, Index first, Index count, Scalar h,
              const Planes<Scalar>& force_a, const Planes<Scalar>& force_b,
              const Update& update) const;

private:
    using Register = VectorRegister<Scalar>;

    Eigen::Matrix<Scalar, Dim, 1> gravity_;            // m/s²
    std::array<Scalar, max_width> gravity_of_points_;  // x y z 0 x y z 0 …
    Planes<Scalar> external_;                          // N
    VectorX<Scalar> inverse_mass_;                     // a plane, 1/kg, 0 if pinned
    Scalar drag_ = 0;                                  // d0, 1/s
    Scalar ahead_ = 0;
    bool pins_ = false;
};

template <class Scalar, int Dim>
template <bool Pins, bool Drag, bool Stars, class Update>
void PlaceUpdate<Scalar, Dim>::move(const StatePlanes<Scalar>& planes, Index first, Index count,
                                    Scalar h, const Planes<Scalar>& force_a,
                                    [[maybe_unused]] const Planes<Scalar>& force_b,
                                    const Update& update) const {
    // The axis of a lane is the same in each of so many registers in turn.
    constexpr int turns = Stars ? std::max(1, 4 / Register::width) : 1;
    const Register step(h);
    const Register zero(Scalar(0));
    const Register ahead(ahead_);
    const bool looks_ahead = ahead_ > 0;
    [[maybe_unused]] const Register d0(drag_);
    for (int d = 0; d < (Stars ? 1 : Dim); ++d) {
        std::array<Register, turns> gravity;
        for (int turn = 0; turn < turns; ++turn) {
            gravity[turn] = Stars
                                ? Register::load(gravity_of_points_.data() + turn * Register::width)
                                : Register(gravity_[d]);
        }
        const Scalar* inverse_masses = inverse_mass_.data() + first;
        const Scalar* xs = planes.x[d] + first;
        const Scalar* vs = planes.v[d] + first;
        Scalar* new_xs = planes.new_x[d] + first;
        Scalar* new_vs = planes.new_v[d] + first;
        Scalar* new_spring_xs = planes.new_spring_x[d] + first;
        const Scalar* external = external_.first ? external_[d] + first : nullptr;
        Scalar* forces_a = force_a[d];
        [[maybe_unused]] Scalar* forces_b = force_b[d];
        const auto move_register = [&](Index i, const Register& g) {
            const Register inverse_mass = Register::load(inverse_masses + i);
            Register x = Register::load(xs + i);
            Register v = Register::load(vs + i);
            Register free_fall = g;
            if constexpr (Drag) free_fall -= d0 * v;
            if constexpr (Pins) free_fall = where_less(zero, inverse_mass, free_fall, zero);
            Register f = Register::load(forces_a + i);
            zero.store(forces_a + i);
            if constexpr (!Stars) {
                f += Register::load(forces_b + i);
                zero.store(forces_b + i);
            }
            if (external) f += Register::load(external + i);
            update(x, v, free_fall + inverse_mass * f, step);
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

}  // namespace taut::integrator_detail::sweep
