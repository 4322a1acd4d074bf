// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "../core/detail/fits.hpp"
#include "../model/spring_system.hpp"
#include "detail/explicit_limit.hpp"
#include "detail/growth.hpp"
#include "detail/scales.hpp"
#include "detail/symplectic_limit.hpp"
#include "rayleigh.hpp"

namespace taut {

/// An interval that contains an eigenvalue, 1/s².
struct EigenvalueBracket {
    double lower = 0;
    double upper = 0;
};

/// The extremes of the spectrum of K'⁺ = M⁻¹K⁺.
struct StiffnessSpectrum {
    EigenvalueBracket k_min;  ///< zero modes included
    EigenvalueBracket k_max;  ///< upper: proved; lower: refuted by a vector
};

/// The mode that limits explicit steps: K'⁺u ≈ ku, uᵀMu = 1.
struct LimitingMode {
    double k = 0;           ///< its Rayleigh quotient, 1/s²
    double d = 0;           ///< uᵀDu/uᵀMu, 1/s
    Eigen::VectorXd shape;  ///< u, one entry for each free degree of freedom
};

/// How large may the step be, and how do you know? Analysis of one pose of a SpringSystem, in
/// double whatever Scalar is: what rounding to Scalar may do to a step counts, and masses,
/// stiffnesses, dampings and lengths whose squares double does not hold (below 3e-151 or above
/// 3e150) are refused by name. It keeps a copy of what it needs: later changes of the system do not
/// reach it (see StepLimit::revision).
///
///     taut::Stability<double> stability(cloth, state);
///     auto limit = stability.max_step(taut::Method::symplectic_euler);
///
/// Where springs are compressed, K⁺ stands for K in every answer and the growth of the physics is
/// given apart [T27]. A certified step holds on both sides of a law's kink that lies within
/// rounding of a spring's length; what refutes takes the stiffer side. Zero modes never count as
/// unstable. BDF2, of which nothing is proved beside compressed springs, is refused by name.
///
/// `max_step` and what else names no mode are bounds alone, O(springs) for each of a few passes
/// [T26]. What refutes and what names a mode searches for vectors: bracket, stiffness_spectrum,
/// limiting_mode and those after it. What factorises, or solves a whole eigenvalue problem, is one
/// more header away, tight/tight.hpp: `max_step(stability, method, tightness)`, `certify`, the
/// eigenvalues of the matrix of a step under any damping (`spectral_radius`, the limit of explicit
/// Euler), `count_zero_modes`. Systems of your own matrices are by own_matrices/own_matrices.hpp.
template <class Scalar>
class Stability {
public:
    /// For a system of the same Scalar with a function make_pencil(system), as a LinearSystem.
    template <class System, class = decltype(make_pencil(std::declval<const System&>())),
              class = std::enable_if_t<std::is_same_v<typename System::Scalar, Scalar>>>
    explicit Stability(const System& system)
        : pencil_(make_pencil(system)), revision_(system.revision()) {
        pencil_->require_range("Stability");
    }

    /// @param state  the pose; its velocity is taken as zero. Fails unless it is finite and fits.
    template <int Dim, class... Laws>
    Stability(const SpringSystem<Scalar, Dim, Laws...>& system, const State<Scalar, Dim>& state)
        : revision_(system.revision()) {
        detail::require_fits("Stability", state, system.size());
        if (!state.x.allFinite()) {
            const State<Scalar, Dim> still{state.x, State<Scalar, Dim>::zero(system.size()), 0};
            fail("Stability: the position of particle ", still.first_not_finite(),
                 " is not finite");
        }
        pencil_ = std::make_shared<const Pencil>(
            Pencil::at_pose(system, state.x.template cast<TangentReal<Scalar>>()));
        pencil_->require_range("Stability");
    }

    /// The largest step that is proved stable, s. `refuted` and growth_rate are not looked for.
    StepLimit<Scalar> max_step(Method method) const;
    /// The same with `refuted`, and what compression makes grow: by Ritz vectors.
    StepLimit<Scalar> bracket(Method method) const {
        stability_detail::NoEffort bounds;
        return bracket(method, bounds);
    }
    /// The same with more than bounds, for modules.
    template <class Effort>
    StepLimit<Scalar> bracket(Method method, Effort& effort) const;
    /// The α, s, that make step h stable with D = d0·M + αK⁺ in place of the system's own damping:
    /// proved, since it takes k_max from above and k_min as 0 [T14]–[T16].
    AlphaWindow rayleigh_window(Method method, double h, double d0 = 0) const {
        if (size() == 0) return taut::rayleigh_window(method, h, d0, 0, 0, 0);
        const double stiffest = pencil_->upper_bound(matrices::K_plus);
        const bool by_damping = method::is_limited_by<method::LimitedByDamping>(method);
        const double compression = by_damping ? pencil_->compression() : 0;
        if (!std::isfinite(stiffest) || !std::isfinite(compression)) {
            return {0, 0, EmptyWindow::overflow, false};
        }
        return taut::rayleigh_window(method, h, d0, 0, std::max(0.0, stiffest), compression);
    }
    /// Brackets of the extreme eigenvalues.
    StiffnessSpectrum stiffness_spectrum() const;
    /// The vibration that holds explicit steps down, as the Lanczos iteration found it.
    LimitingMode limiting_mode() const;
    /// The springs that hold most of the limiting mode's elastic energy, the first one most.
    std::vector<SpringShare> limiting_springs(Index count) const {
        if (size() == 0 || count <= 0) return {};
        return limiting_springs(count, limiting_mode());
    }
    /// The same of a mode that is known: finding it is most of the work.
    std::vector<SpringShare> limiting_springs(Index count, const LimitingMode& mode) const {
        if (size() == 0 || count <= 0) return {};
        return stability_detail::largest_shares(pencil_->spring_shares(mode.shape), count);
    }
    /// The particles that hold most of its kinetic energy, the first one most.
    std::vector<ParticleShare> limiting_particles(Index count) const {
        if (size() == 0 || count <= 0) return {};
        return limiting_particles(count, limiting_mode());
    }
    /// The same of a mode that is known.
    std::vector<ParticleShare> limiting_particles(Index count, const LimitingMode& mode) const {
        if (size() == 0 || count <= 0) return {};
        return stability_detail::largest_shares(pencil_->particle_shares(mode.shape), count);
    }

    /// The largest factor on all stiffness (αK⁺ included) for which step h, s, is still certified
    /// by the bound, to nine digits; 0 if none is, infinity if every one is, of those that double
    /// holds.
    double max_stiffness_scale(Method method, double h) const {
        require_positive("Stability::max_stiffness_scale", "h", h);
        return stability_detail::max_stiffness_scale(method, *pencil_, h);
    }
    /// The least factor on all masses (d0·M included) for which step h, s, is certified by the
    /// bound, to nine digits; infinity if none is, 0 if every one is.
    double min_mass_scale(Method method, double h) const {
        require_positive("Stability::min_mass_scale", "h", h);
        return stability_detail::min_mass_scale(method, *pencil_, h);
    }
    /// The number of equal steps of a frame, s, that the bound certifies; nothing if no step is.
    std::optional<Index> substeps(Method method, double frame) const;

    /// Free degrees of freedom.
    Index size() const { return pencil_->size(); }
    /// What all answers are computed from.
    const Pencil& pencil() const { return *pencil_; }

private:
    using Limit = stability_detail::UnroundedLimit;

    // A method's limit, by what limits it: with a stiffest mode as a bracket. Of springs K⁺ ⪰ 0,
    // which is enough for every step of implicit Euler to be solvable and stable [T20], [T27].
    Limit limit_by(method::LimitedByDamping) const {
        return stability_detail::explicit_by_bounds(
            *pencil_, pencil_->upper_bound(matrices::K_plus), pencil_->upper_bound(matrices::D));
    }
    Limit limit_by(method::LimitedByStiffness) const {
        return stability_detail::symplectic_by_bounds(*pencil_);
    }
    template <class Effort>
    Limit limit_by(method::LimitedByDamping, Effort& effort) const {
        return stability_detail::explicit_bracket(*pencil_, effort, stiffest());
    }
    template <class Effort>
    Limit limit_by(method::LimitedByStiffness, Effort& effort) const {
        return stability_detail::symplectic_bracket(*pencil_, effort,
                                                    [&](double) { return stiffest().vector; });
    }
    template <class... Search>
    Limit limit_by(method::LimitedByIndefiniteness, Search&&...) const {
        constexpr double infinity = stability_detail::infinity;
        return {infinity, infinity, Cause::unconditional};
    }
    /// @param add_growth  of a pencil of springs: add_growth(limit)
    template <class AddGrowth, class... Search>
    StepLimit<Scalar> limit_of(Method method, const AddGrowth& add_growth,
                               Search&&... search) const;
    RitzPair stiffest() const { return leading_pair(*pencil_, matrices::K_plus); }

    std::shared_ptr<const Pencil> pencil_;  // immutable, so copies may share it
    std::uint64_t revision_ = 0;
};

template <class Scalar>
template <class AddGrowth, class... Search>
StepLimit<Scalar> Stability<Scalar>::limit_of(Method method, const AddGrowth& add_growth,
                                              Search&&... search) const {
    using namespace stability_detail;
    if (size() == 0) {
        return rounded<Scalar>({infinity, infinity, Cause::nothing_to_limit}, revision_);
    }
    Limit limit = method::visit_limited("Stability", method, [&](auto descriptor) {
        return limit_by(typename decltype(descriptor)::Limit{}, search...);
    });
    // What no Scalar holds claims nothing.
    for (double* step : {&limit.certified, &limit.certified_up_to}) {
        if (round_down<Scalar>(*step) == 0) *step = 0;
    }
    if (const BareMatrices* matrices = pencil_->matrices()) {
        matrices->amend(method, *pencil_, limit);
    } else {
        add_growth(limit);
    }
    return rounded<Scalar>(limit, revision_);
}

template <class Scalar>
StepLimit<Scalar> Stability<Scalar>::max_step(Method method) const {
    return limit_of(method, [&](Limit& limit) {
        if (pencil_->stiffness_semidefinite() || !stability_detail::claims(limit)) return;
        limit.admitted_growth = std::sqrt(pencil_->deficit(matrices::K));
    });
}

template <class Scalar>
template <class Effort>
StepLimit<Scalar> Stability<Scalar>::bracket(Method method, Effort& effort) const {
    return limit_of(
        method, [&](Limit& limit) { stability_detail::add_growth(*pencil_, effort, limit); },
        effort);
}

template <class Scalar>
StiffnessSpectrum Stability<Scalar>::stiffness_spectrum() const {
    StiffnessSpectrum spectrum;
    if (size() == 0) return spectrum;
    const Pencil& pencil = *pencil_;
    spectrum.k_max.upper = std::max(0.0, pencil.upper_bound(matrices::K_plus));
    spectrum.k_max.lower = std::max(
        0.0, stability_detail::quotients(pencil, stiffest().vector, matrices::K_plus).k.lower());
    const RitzPair softest = stability_detail::softest(pencil);
    spectrum.k_min.upper =
        stability_detail::quotients(pencil, softest.vector, matrices::K_plus).k.upper();
    if (std::isnan(spectrum.k_min.upper))
        spectrum.k_min.upper = stability_detail::infinity;  // overflow
    // Springs: K⁺ ⪰ 0 by construction. Bare matrices: proved so, or bounded.
    spectrum.k_min.lower = -std::max(0.0, pencil.upper_bound(-matrices::K_plus));
    if (pencil.projected_semidefinite()) spectrum.k_min.lower = 0;
    spectrum.k_min.upper = std::max(spectrum.k_min.upper, spectrum.k_min.lower);
    return spectrum;
}

template <class Scalar>
LimitingMode Stability<Scalar>::limiting_mode() const {
    if (size() == 0) return {};
    LanczosOptions options;
    options.basis = 60;
    options.tolerance = 1e-6;
    RitzPair pair = largest_ritz_pair(*pencil_, matrices::K_plus, options, stiffest().vector);
    const auto [k, d] = stability_detail::quotients(*pencil_, pair.vector, matrices::K_plus);
    return {k.value, d.value, std::move(pair.vector)};
}

template <class Scalar>
std::optional<Index> Stability<Scalar>::substeps(Method method, double frame) const {
    require_positive("Stability::substeps", "frame", frame);
    const double certified = static_cast<double>(max_step(method).certified);
    // Beyond 1e15 the count is no longer exact, and no frame was meant.
    if (!(certified > 0) || !(frame / certified < 1e15)) return std::nullopt;
    return std::max<Index>(1, static_cast<Index>(std::ceil(frame / certified)));
}

}  // namespace taut
