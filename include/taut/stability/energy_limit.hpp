// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../core/detail/bisection.hpp"
#include "../model/spring_system.hpp"
#include "detail/symplectic_limit.hpp"
#include "spring_pencil.hpp"

namespace taut {

/// The α, s, from `lower` to `upper`; none if lower > upper.
struct GraphDampingRange {
    double lower = 1;
    double upper = 0;

    /// Whether `alpha` is one of them.
    bool contains(double alpha) const { return alpha >= lower && alpha <= upper; }
    /// Whether there is none.
    bool empty() const { return !(lower <= upper); }
};

/// The steps of symplectic Euler that never raise the energy H = T + V + G, at any pose, under any
/// law, for all time, up to rounding, if every spring damps the whole relative velocity of its ends
/// [T34]: D ⊇ α(L_k ⊗ I), as SpringSystem::set_graph_damping adds. Pins must be at rest, external
/// forces absent.
///
/// A step h ≤ `certified` has an α that proves it; alpha(h) gives all of them. No damping of any
/// kind meets the condition of [T34] above `refuted`; there some motion may still never gain.
template <class Scalar>
struct EnergyLimit : StepLimit<Scalar> {
    /// ℓ, 1/s²: λ_max(M⁻¹L_k), from above; infinity where nothing is known.
    double stiffness = std::numeric_limits<double>::infinity();
    double drag = 0;     ///< d0, 1/s
    double dampers = 0;  ///< c, 1/s: λ_max(M⁻¹D) of all damping else, from above; graph damping's
                         ///< own α is not in it

    /// The α, s, with which a step of h, s, never raises the energy. The system's graph damping, or
    /// the stepper's, or both together must be one of them. Steps that look ahead are others than
    /// [T34]'s: leave ExplicitOptions::damping.look_ahead at 0. It is for a constant h.
    GraphDampingRange alpha(double h) const;
};

namespace stability_detail {

/// [T34] with ℓ, d0 and c at step h: D = B + C, B = d0·M + αL_k, C ⪯ cM. Young's inequality gives C
/// the share that makes 2C − h(1 + 1/τ)CM⁻¹C ⪰ 0 and leaves 2β − ηβ² ≥ hλ of B, β = d0 + αλ.
inline GraphDampingRange graph_damping_range(double h, double stiffness, double drag,
                                             double dampers) {
    const double share = 1 - h * dampers / 2;
    if (!(share > 0)) return {};
    const double eta = h / share;
    // β at λ = 0, where it is d0, and at λ = ℓ: the condition is concave between.
    const double square = 1 - eta * h * stiffness;
    if (!(square >= 0) || !(eta * drag <= 2)) return {};
    if (stiffness == 0) return {0, infinity};
    const double root = std::sqrt(square);
    return {std::max(0.0, (h * stiffness / (1 + root) - drag) / stiffness),
            ((1 + root) / eta - drag) / stiffness};
}

/// What a stepper holds as Scalars, and the arithmetic above, may be off by so much.
template <class Scalar>
inline constexpr double energy_margin = 8 * step_rounding<Scalar>;

template <class Scalar, int Dim, class... Laws>
EnergyLimit<Scalar> energy_bracket(const SpringSystem<Scalar, Dim, Laws...>& system,
                                   Effort& effort) {
    EnergyLimit<Scalar> limit;
    limit.revision = system.revision();
    limit.refuted = std::numeric_limits<Scalar>::infinity();
    const auto overflow = [&] {
        limit.cause = Cause::overflow;
        return limit;
    };
    using Damping = SpringPencil<1>::Damping;
    const auto springs = SpringPencil<1>::any_pose(system, Damping::none);
    if (!springs.lost().empty()) return overflow();
    const auto damped = SpringPencil<1>::any_pose(system, Damping::all_but_graph);
    if (springs.size() > 0) limit.drag = damped.rayleigh().mass_proportional;
    const UnroundedLimit bracket = symplectic_limit(
        springs, effort, 0, [&](double) { return leading_pair(springs, K_plus).vector; });
    if (!(bracket.certified > 0)) return overflow();
    const bool only_drag = damped.is_rayleigh() && damped.rayleigh().stiffness_proportional == 0;
    if (springs.size() > 0 && !only_drag) {
        const double all = damped.upper_bound(D);
        limit.dampers = std::max(0.0, all - limit.drag * (1 - step_rounding<double>));
    }
    if (!std::isfinite(limit.drag + limit.dampers)) return overflow();
    const double k = 2 / bracket.certified;
    limit.stiffness = k * k * (1 + step_rounding<double>);
    const auto holds = [&](double h) { return !limit.alpha(h).empty(); };
    // No damping meets the condition above 1/√ℓ; drag and dampers forbid larger steps than these.
    const double most = std::min(bracket.certified / 2, 2 / (limit.drag + limit.dampers));
    if (!std::isfinite(most)) {
        limit.certified = std::numeric_limits<Scalar>::infinity();
        limit.cause = Cause::nothing_to_limit;
        return limit;
    }
    const double h = holds(most) ? most : detail::last_that_passes(most, 1e-12, holds);
    limit.certified = round_down<Scalar>(h);
    limit.refuted = round_up<Scalar>(bracket.refuted / 2);
    limit.cause = h < bracket.certified / 4 ? Cause::damping : Cause::stiffness;
    return limit;
}

}  // namespace stability_detail

template <class Scalar>
GraphDampingRange EnergyLimit<Scalar>::alpha(double h) const {
    require_positive("EnergyLimit::alpha", "h", h);
    constexpr double margin = stability_detail::energy_margin<Scalar>;
    auto range = stability_detail::graph_damping_range(h * (1 + margin), stiffness,
                                                       drag * (1 + margin), dampers * (1 + margin));
    if (drag > 0 && stiffness > 0) {
        // More drag lowers the upper end, less raises the lower one.
        const auto less = stability_detail::graph_damping_range(
            h * (1 + margin), stiffness, drag * (1 - margin), dampers * (1 + margin));
        range.lower = std::max(range.lower, less.lower);
    }
    range.lower *= 1 + margin;
    range.upper *= 1 - margin;
    return range;
}

/// By the splitting bound alone, O(springs) for each of a few passes [T26]. `cause` is damping
/// where the scene's own drag or dampers hold the step to less than half. Setting the graph damping
/// that it asks for does not move it, though it moves the system's revision. Void like
/// any_pose_limit's answer.
template <class Scalar, int Dim, class... Laws>
EnergyLimit<Scalar> energy_limit(const SpringSystem<Scalar, Dim, Laws...>& system) {
    stability_detail::Effort bounds;
    return stability_detail::energy_bracket(system, bounds);
}

}  // namespace taut
