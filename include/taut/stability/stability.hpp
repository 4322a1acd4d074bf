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
#include "detail/implicit_limit.hpp"
#include "detail/quick_mode.hpp"
#include "detail/scales.hpp"
#include "detail/symplectic_limit.hpp"
#include "../own_matrices/detail/unproved.hpp"
#include "../tight/detail/zero_modes.hpp"
#include "../own_matrices/matrix_pencil.hpp"
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
    std::optional<Index>
        zero_modes;  ///< rigid motions and mechanisms; only if asked for; numerical
};

/// Answer of Stability::certify.
struct Certificate {
    Method method = Method::symplectic_euler;
    double step = 0;      ///< h, s
    bool proved = false;  ///< false means not proved, which is not a disproof
};

/// The mode that limits explicit steps: K'⁺u ≈ ku, uᵀMu = 1.
struct LimitingMode {
    double k = 0;           ///< its Rayleigh quotient, 1/s²
    double d = 0;           ///< uᵀDu/uᵀMu, 1/s
    Eigen::VectorXd shape;  ///< u, one entry for each free degree of freedom
};

/// How large may the step be, and how do you know? Analysis of one pose of a SpringSystem, or of a
/// LinearSystem, in double whatever Scalar is: what rounding to Scalar may do to a step counts, and
/// masses, stiffnesses, dampings and lengths whose squares double does not hold (below 3e-151 or
/// above 3e150) are refused by name. It keeps a copy of what it needs: later changes of the system
/// do not reach it (see StepLimit::revision).
///
///     taut::Stability<double> stability(cloth, state);
///     auto limit = stability.max_step(taut::Method::symplectic_euler);
///
/// Where springs are compressed, K⁺ stands for K in every answer and the growth of the physics is
/// given apart [T27]. A certified step holds on both sides of a law's kink that lies within
/// rounding of a spring's length; what refutes takes the stiffer side. Zero modes never count as
/// unstable. BDF2, of which nothing is proved beside compressed springs, is refused by name in all
/// but spectral_radius().
/// @tparam Cholesky  the factorisation behind proofs (see Prover)
template <class Scalar, class Cholesky = EigenCholesky>
class Stability {
public:
    /// Up to so many degrees of freedom dense eigensolvers help where bounds are not enough.
    static constexpr Index dense_size = DenseAnalysis<>::good_size;

    /// For matrices, where K⁺ = K.
    explicit Stability(const LinearSystem<Scalar>& system)
        : pencil_(std::make_shared<MatrixPencil<Scalar>>(system)), revision_(system.revision()) {
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
    /// passes [T26], and a Ritz vector. Bare matrices that are not diagonally dominant take some
    /// factorisations by Eigen, too.
    StepLimit<Scalar> max_step(Method method) const {
        return bracket(method, stability_detail::Bounds{});
    }
    /// The same, narrowed by sparse factorisations until refuted/certified ≤ 1 + tightness (and 6
    /// ulp of Scalar) where the method's conditions allow it (1e-6 is reachable; a factorisation or
    /// two) [T22], up to dense_size also by dense eigensolvers. An overload, since only its callers
    /// compile these.
    /// @param tightness  0: as above
    StepLimit<Scalar> max_step(Method method, double tightness) const {
        require_non_negative("Stability::max_step", "tightness", tightness);
        if (tightness == 0) return max_step(method);
        return bracket(method, stability_detail::Factorisations<Cholesky>{tightness, {}});
    }
    /// Whether step h, s, is proved stable: by the bound, or else by factorisation.
    Certificate certify(Method method, double h) const;
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
    /// Brackets of the extreme eigenvalues. @param count_zero_modes by the inertia of K⁺ − εM: one
    /// sparse factorisation
    StiffnessSpectrum stiffness_spectrum(bool count_zero_modes = false) const;
    /// Largest |μ| of one step of size h, s, apart from zero modes. Exact to rounding up to
    /// dense_size; above, an estimate from below by the extreme Ritz values (D taken as Rayleigh,
    /// or by its quotients on those two vectors).
    double spectral_radius(Method method, double h) const;
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
    // Effort: stability_detail::Bounds or stability_detail::Factorisations.
    template <class Effort>
    StepLimit<Scalar> bracket(Method method, Effort effort) const;
    // A method's bracket, by what limits it.
    template <class Effort>
    stability_detail::UnroundedLimit limit_by(method::LimitedByDamping, Effort& effort) const {
        return stability_detail::explicit_limit(*pencil_, effort, stiffest_);
    }
    template <class Effort>
    stability_detail::UnroundedLimit limit_by(method::LimitedByStiffness, Effort& effort) const {
        // A bound within 3 % of the Ritz value's step needs no improvement.
        return stability_detail::symplectic_limit(*pencil_, effort, 1.06 * stiffest_.value,
                                                  [this](double) { return stiffest_.vector; });
    }
    template <class Effort>
    stability_detail::UnroundedLimit limit_by(method::LimitedByIndefiniteness, Effort&) const {
        return stability_detail::implicit_limit(*pencil_);
    }
    template <class Effort>
    stability_detail::UnroundedLimit limit_by(method::LimitedByDrag, Effort&) const {
        return stability_detail::drag_limit(*pencil_, method::GraphInertia::margin);
    }

    std::shared_ptr<const ScenePencil> pencil_;  // immutable, so copies may share it
    std::uint64_t revision_ = 0;
    RitzPair stiffest_;  // of K⁺: where every search begins
};

template <class Scalar, class Cholesky>
template <int Dim, class... Laws>
void Stability<Scalar, Cholesky>::update(const SpringSystem<Scalar, Dim, Laws...>& system,
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
        stiffest_ = stability_detail::leading_pair(*pencil, matrices::K_plus, stiffest_.vector);
    }
    pencil_ = std::move(pencil);
    revision_ = system.revision();
}

template <class Scalar, class Cholesky>
template <class Effort>
StepLimit<Scalar> Stability<Scalar, Cholesky>::bracket(Method method, Effort effort) const {
    if (size() == 0) {
        return stability_detail::rounded<Scalar>(
            {stability_detail::infinity, stability_detail::infinity, Cause::nothing_to_limit},
            revision_);
    }
    const auto limit = method::visit_limited("Stability", method, [&](auto descriptor) {
        return limit_by(typename decltype(descriptor)::Limit{}, effort);
    });
    auto answer = stability_detail::rounded<Scalar>(limit, revision_);
    // An explicit step is claimed by D − hK ⪰ −δM, which needs no D ⪰ 0 beside it unless K is
    // indefinite: there it says nothing of smaller steps.
    if (!method::is_limited_by<method::LimitedByDamping>(method) ||
        !stability_detail::claims(answer) || !pencil_->stiffness_semidefinite())
        stability_detail::admit_negative_damping(method, *pencil_, answer);
    stability_detail::add_growth(method, *pencil_, answer, effort);
    return answer;
}

template <class Scalar, class Cholesky>
Certificate Stability<Scalar, Cholesky>::certify(Method method, double h) const {
    Certificate certificate{method, h, false};
    require_positive("Stability::certify", "h", h);
    const StepLimit<Scalar> bound = max_step(method);
    certificate.proved = h <= static_cast<double>(bound.certified);
    if (certificate.proved || !(h < static_cast<double>(bound.refuted))) return certificate;
    const Pencil& pencil = *pencil_;
    const double wide = h * (1 + stability_detail::step_rounding<Scalar>);
    // An h² that underflows would leave the stiffness out.
    if (method::is_limited_by<method::LimitedByStiffness>(method) &&
        h * h >= std::numeric_limits<double>::min() && pencil.damping_semidefinite() &&
        pencil.projected_semidefinite()) {
        Prover<Cholesky> prover;
        certificate.proved = stability_detail::proves_symplectic(pencil, prover, wide);
        return certificate;
    }
    // A bracket narrowed to its distance from h may still contain h: the refuting end moves too.
    double distance = std::min(1.0, static_cast<double>(bound.refuted) / h - 1);
    for (int repeat = 0; repeat < 8 && !certificate.proved; ++repeat) {
        const StepLimit<Scalar> narrowed = max_step(method, std::max(distance, 1e-9));
        certificate.proved = h <= static_cast<double>(narrowed.certified);
        if (!(h < static_cast<double>(narrowed.refuted)) || distance < 1e-9) break;
        distance = std::min(distance / 8, static_cast<double>(narrowed.refuted) / h - 1);
    }
    return certificate;
}

template <class Scalar, class Cholesky>
StiffnessSpectrum Stability<Scalar, Cholesky>::stiffness_spectrum(bool count_zero_modes) const {
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
    if (count_zero_modes)
        spectrum.zero_modes = stability_detail::count_zero_modes(pencil, spectrum.k_max.upper);
    return spectrum;
}

template <class Scalar, class Cholesky>
double Stability<Scalar, Cholesky>::spectral_radius(Method method, double h) const {
    require_positive("Stability::spectral_radius", "h", h);
    if (size() == 0) return 0;
    if (size() <= dense_size) return DenseAnalysis<>(*pencil_).spectral_radius(method, h);
    // For fixed h the radius is quasi-convex in k (for BDF2 known only without damping), so the
    // ends of the spectrum decide.
    double radius = 0;
    for (const double sign : {1.0, -1.0}) {
        const RitzPair end = largest_ritz_pair(*pencil_, sign * matrices::K_plus);
        const auto [k, d] = stability_detail::quotients(*pencil_, end.vector, matrices::K_plus);
        if (std::abs(k.value) <= k.error && std::abs(d.value) <= d.error) continue;  // a zero mode
        radius = std::max(radius, taut::spectral_radius(method, k.value, d.value, h));
    }
    return radius;
}

template <class Scalar, class Cholesky>
LimitingMode Stability<Scalar, Cholesky>::limiting_mode() const {
    if (size() == 0) return {};
    LanczosOptions options;
    options.basis = 60;
    options.tolerance = 1e-6;
    RitzPair pair = largest_ritz_pair(*pencil_, matrices::K_plus, options, stiffest_.vector);
    const auto [k, d] = stability_detail::quotients(*pencil_, pair.vector, matrices::K_plus);
    return {k.value, d.value, std::move(pair.vector)};
}

template <class Scalar, class Cholesky>
std::optional<Index> Stability<Scalar, Cholesky>::substeps(Method method, double frame) const {
    require_positive("Stability::substeps", "frame", frame);
    const double certified = static_cast<double>(max_step(method).certified);
    // Beyond 1e15 the count is no longer exact, and no frame was meant.
    if (!(certified > 0) || !(frame / certified < 1e15)) return std::nullopt;
    return std::max<Index>(1, static_cast<Index>(std::ceil(frame / certified)));
}

}  // namespace taut
