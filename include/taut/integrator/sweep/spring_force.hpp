// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "../../model/damping.hpp"
#include "spring_table.hpp"

namespace taut::detail::sweep {

/// Which damping in proportion to stiffness a sweep computes; `projected` includes `graph`.
enum class Proportional { none, graph, projected };

/// The force on end a of each spring is of_dx·dx + of_dv·dv, with dx = x_b − x_a and dv = v_b −
/// v_a; that on end b is its opposite.
template <class Scalar>
struct Coefficients {
    VectorRegister<Scalar> of_dx;  // N/m
    VectorRegister<Scalar> of_dv;  // N·s/m
};

/// @param springs  a SpringTable's Reader, at as many springs as a register has lanes
/// @param damping  damping in proportion to stiffness, s
/// @param l2       dx·dx, m²
/// @param dx_dv    dx·dv, m²/s; read where a spring has a damper or Kind is `projected`
template <class Law, bool Dampers, Proportional Kind, class Reader, class Scalar>
EIGEN_ALWAYS_INLINE Coefficients<Scalar> coefficients(const Reader& springs,
                                                      const StiffnessDamping<Scalar>& damping,
                                                      const VectorRegister<Scalar>& l2,
                                                      const VectorRegister<Scalar>& dx_dv) {
    using Register = VectorRegister<Scalar>;
    // Kept from zero, a spring of no length has no direction, and so no force.
    const Register safe_l2 = max(l2, Register(std::numeric_limits<Scalar>::min()));
    const Register over_l = reciprocal_sqrt(safe_l2);
    const Register l = safe_l2 * over_l;
    const Register tension = springs.evaluate(
        [](const auto& p, auto L, auto length) { return Law::tension(p, L, length); }, l);
    const Register tension_over_l = tension * over_l;
    const Register zero(Scalar(0));
    if constexpr (!Dampers && Kind == Proportional::none)
        return {springs.unless_gap(tension_over_l), zero};
    Register of_dx = tension_over_l;
    Register of_dv = zero;
    Register bound = zero;
    if constexpr (Kind != Proportional::none) {
        bound = springs.evaluate([](const auto& p, auto L) { return Law::stiffness_bound(p, L); });
        of_dv = Register(damping.graph) * bound;
    }
    [[maybe_unused]] const Register stretching = dx_dv * over_l * over_l;
    if constexpr (Dampers) of_dx += springs.damping() * stretching;
    if constexpr (Kind == Proportional::projected) {
        const Register slope = springs.evaluate(
            [](const auto& p, auto L, auto length) { return Law::tension_slope(p, L, length); }, l);
        const Register transverse = where_less(zero, l2, max(tension_over_l, zero), bound);
        of_dv += Register(damping.projected) * transverse;
        of_dx += Register(damping.projected) * (max(slope, zero) - transverse) * stretching;
    }
    return {springs.unless_gap(of_dx), springs.unless_gap(of_dv)};
}

}  // namespace taut::detail::sweep
