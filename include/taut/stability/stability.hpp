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
#include "spring_pencil.hpp"

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
/// What factorises, or solves a whole eigenvalue problem, is one more header away, tight/tight.hpp:
/// `max_step(stability, method, tightness)`, `certify`, the eigenvalues of the matrix of a step
/// under any damping (`spectral_radius`, the limit of explicit Euler), `count_zero_modes`. Systems
/// of your own matrices are by own_matrices/own_matrices.hpp.
template <class Scalar>
class Stability {
public:
    /// For a system of the same Scalar with a function make_pencil(system), as a LinearSystem.
    template <class System, class = decltype(make_pencil(std::declval<const System&>())),
              class = std::enable_if_t<std::is_same_v<typename System::Scalar, Scalar>>>
    explicit Stability(const System& system)
        : pencil_(make_pencil(system)), revision_(system.revision()) {
        pencil_->require_range("Stability");
        stiffest_ = largest_ritz_pair(*pencil_, matrices::K_plus);
    }

    /// @param state  the pose; its velocity is taken as zero. Fails unless it is finite and fits.
    template <int Dim, class... Laws>
    Stability(const SpringSystem<Scalar, Dim, Laws...>& system, const State<Scalar, Dim>& state) {
        update(system, state);
    }

    /// Takes the system as it is now, or another pose, at the cost of a new analysis but for the
    /// first search, which begins at the last stiffest mode.
    template <int Dim, class... Laws>
    void update(const SpringSystem<Scalar, Dim, Laws...>& system, const State<Scalar, Dim>& state);

    /// The bracket of the largest stable step, s: by bounds alone, O(springs) for each of a few
    /// passes [T26], and a Ritz vector.
    StepLimit<Scalar> max_step(Method method) const {
        stability_detail::Effort bounds;
        return max_step(method, bounds);
    }
    /// The same with more than bounds, for modules.
    StepLimit<Scalar> max_step(Method method, stability_detail::Effort& effort) const;
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
    const ScenePencil& pencil() const { return *pencil_; }

private:
    using Effort = stability_detail::Effort;
    using Limit = stability_detail::UnroundedLimit;

    // A method's bracket, by what limits it. Of springs K⁺ ⪰ 0, which is enough for every step of
    // implicit Euler to be solvable and stable [T20], [T27].
    Limit limit_by(method::LimitedByDamping, Effort& effort) const {
        return stability_detail::explicit_limit(*pencil_, effort, stiffest_);
    }
    Limit limit_by(method::LimitedByStiffness, Effort& effort) const {
        // A bound within 3 % of the Ritz value's step needs no improvement.
        return stability_detail::symplectic_limit(*pencil_, effort, 1.06 * stiffest_.value,
                                                  [this](double) { return stiffest_.vector; });
    }
    Limit limit_by(method::LimitedByIndefiniteness, Effort&) const {
        constexpr double infinity = stability_detail::infinity;
        return {infinity, infinity, Cause::unconditional};
    }

    std::shared_ptr<const ScenePencil> pencil_;  // immutable, so copies may share it
    std::uint64_t revision_ = 0;
    RitzPair stiffest_;  // of K⁺: where every search begins
};

template <class Scalar>
template <int Dim, class... Laws>
void Stability<Scalar>::update(const SpringSystem<Scalar, Dim, Laws...>& system,
                               const State<Scalar, Dim>& state) {
    detail::require_fits("Stability", state, system.size());
    if (!state.x.allFinite()) {
        const State<Scalar, Dim> still{state.x, State<Scalar, Dim>::zero(system.size()), 0};
        fail("Stability: the position of particle ", still.first_not_finite(), " is not finite");
    }
    auto pencil = std::make_shared<SpringPencil<Dim>>(
        SpringPencil<Dim>::at_pose(system, state.x.template cast<TangentReal<Scalar>>()));
    pencil->require_range("Stability");
    if (pencil->size() > 0) {
        // The old mode alone, where it no longer leads, would be found again and nothing else.
        Eigen::VectorXd start = stiffest_.vector;
        if (start.size() > 0) {
            start *= 4 / start.norm();
            start += stability_detail::scattered_vector(start.size()).normalized();
        }
        stiffest_ = leading_pair(*pencil, matrices::K_plus, start);
    }
    pencil_ = std::move(pencil);
    revision_ = system.revision();
}

template <class Scalar>
StepLimit<Scalar> Stability<Scalar>::max_step(Method method, Effort& effort) const {
    using namespace stability_detail;
    if (size() == 0) {
        return rounded<Scalar>({infinity, infinity, Cause::nothing_to_limit}, revision_);
    }
    auto limit = method::visit_limited("Stability", method, [&](auto descriptor) {
        return limit_by(typename decltype(descriptor)::Limit{}, effort);
    });
    // What no Scalar holds claims nothing.
    for (double* step : {&limit.certified, &limit.certified_up_to}) {
        if (round_down<Scalar>(*step) == 0) *step = 0;
    }
    if (!pencil_->amend(method, limit)) add_growth(*pencil_, effort, limit);
    return rounded<Scalar>(limit, revision_);
}

template <class Scalar>
StiffnessSpectrum Stability<Scalar>::stiffness_spectrum() const {
    StiffnessSpectrum spectrum;
    if (size() == 0) return spectrum;
    const Pencil& pencil = *pencil_;
    spectrum.k_max.upper = std::max(0.0, pencil.upper_bound(matrices::K_plus));
    spectrum.k_max.lower = std::max(
        0.0, stability_detail::quotients(pencil, stiffest_.vector, matrices::K_plus).k.lower());
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
    RitzPair pair = largest_ritz_pair(*pencil_, matrices::K_plus, options, stiffest_.vector);
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
