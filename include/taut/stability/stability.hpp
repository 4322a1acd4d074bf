// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "../model/spring_system.hpp"
#include "detail/limits.hpp"
#include "detail/narrow.hpp"
#include "detail/quick_mode.hpp"
#include "detail/zero_modes.hpp"
#include "explicit_estimate.hpp"
#include "matrix_pencil.hpp"
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
    static constexpr Index dense_size = 120;

    /// For matrices, where K⁺ = K.
    explicit Stability(const LinearSystem<Scalar>& system)
        : pencil_(std::make_shared<MatrixPencil<Scalar>>(system)), revision_(system.revision()) {
        pencil_->require_range("Stability");
        stiffest_ = largest_ritz_pair(*pencil_, {0, 1, 0});
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
    StepLimit<Scalar> max_step(Method method) const { return bracket(method, detail::Bounds{}); }
    /// The same, narrowed by sparse factorisations until refuted/certified ≤ 1 + tightness (and 6
    /// ulp of Scalar) where the method's conditions allow it (1e-6 is reachable; a factorisation or
    /// two) [T22], up to dense_size also by dense eigensolvers. An overload, since only its callers
    /// compile these.
    /// @param tightness  0: as above
    StepLimit<Scalar> max_step(Method method, double tightness) const {
        require_non_negative("Stability::max_step", "tightness", tightness);
        if (tightness == 0) return max_step(method);
        return bracket(method, detail::Factorisations<Cholesky>{tightness, {}});
    }
    /// Whether step h, s, is proved stable: by the bound, or else by factorisation.
    Certificate certify(Method method, double h) const;
    /// The α, s, that make step h stable with D = d0·M + αK⁺ in place of the system's own damping:
    /// proved, since it takes k_max from above and k_min as 0 [T14]–[T16].
    AlphaWindow rayleigh_window(Method method, double h, double d0 = 0) const {
        if (size() == 0) return taut::rayleigh_window(method, h, d0, 0, 0, 0);
        const double stiffest = pencil_->upper_bound({0, 1, 0});
        // Springs count as semi-definite though rounding leaves them slightly compressed.
        const bool compressed = method::is_limited_by<method::LimitedByDamping>(method) &&
                                (pencil_->projects() || !pencil_->stiffness_semidefinite());
        const double compression = compressed ? pencil_->upper_bound({0, -1, 0, false}) : 0;
        if (!std::isfinite(stiffest) || !std::isfinite(compression)) {
            return {0, 0, EmptyWindow::overflow, false};
        }
        return taut::rayleigh_window(method, h, d0, 0, std::max(0.0, stiffest),
                                     std::max(0.0, compression));
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
    std::vector<SpringShare> limiting_springs(Index count) const;
    /// The particles that hold most of its kinetic energy, the first one most.
    std::vector<ParticleShare> limiting_particles(Index count) const;

    /// The largest factor on all stiffness (αK⁺ included) for which step h, s, is still certified
    /// by the bound, to nine digits; 0 if none is, infinity if every one is, of those that double
    /// holds.
    double max_stiffness_scale(Method method, double h) const;
    /// The least factor on all masses (d0·M included) for which step h, s, is certified by the
    /// bound, to nine digits; infinity if none is, 0 if every one is.
    double min_mass_scale(Method method, double h) const;
    /// The number of equal steps of a frame, s, that the bound certifies; nothing if no step is.
    std::optional<Index> substeps(Method method, double frame) const;

    /// Free degrees of freedom.
    Index size() const { return pencil_->size(); }
    /// What all answers are computed from.
    const Pencil& pencil() const { return *pencil_; }

private:
    // Effort: detail::Bounds or detail::Factorisations.
    template <class Effort>
    StepLimit<Scalar> bracket(Method method, Effort effort) const;
    // Of a whole method, by what limits it.
    template <class Effort>
    StepLimit<Scalar> limit_by(method::LimitedByDamping, Effort& effort) const;
    template <class Effort>
    StepLimit<Scalar> limit_by(method::LimitedByStiffness, Effort& effort) const;
    template <class Effort>
    StepLimit<Scalar> limit_by(method::LimitedByIndefiniteness, Effort&) const;
    template <class Effort>
    void add_growth(Method method, StepLimit<Scalar>& limit, Effort& effort) const;
    static bool claims(const StepLimit<Scalar>& limit) {
        return limit.certified > 0 || limit.certified_up_to > 0;
    }
    static void admit(Method method, double rate, StepLimit<Scalar>& limit);
    void admit_negative_damping(Method method, StepLimit<Scalar>& limit) const;
    double certified_when_scaled(Method method, double stiffness, double mass) const;
    StepLimit<Scalar> limit(double certified, double refuted, Cause cause) const {
        StepLimit<Scalar> answer;
        answer.certified = detail::round_down<Scalar>(certified);
        answer.refuted = detail::round_up<Scalar>(refuted);
        answer.cause = cause;
        answer.revision = revision_;
        return answer;
    }

    std::shared_ptr<const Pencil> pencil_;  // immutable, so copies may share it
    std::uint64_t revision_ = 0;
    RitzPair stiffest_;  // of K⁺: where every search begins
};

template <class Scalar, class Cholesky>
template <int Dim, class... Laws>
void Stability<Scalar, Cholesky>::update(const SpringSystem<Scalar, Dim, Laws...>& system,
                                         const State<Scalar, Dim>& state) {
    if (state.x.cols() != system.size() || state.v.cols() != system.size()) {
        fail("Stability: the state has ", state.x.cols(), " positions and ", state.v.cols(),
             " velocities; the system has ", system.size(), " particles");
    }
    if (!state.x.allFinite()) {
        const State<Scalar, Dim> still{state.x, State<Scalar, Dim>::zero(system.size()), 0};
        fail("Stability: the position of particle ", still.first_not_finite(), " is not finite");
    }
    auto pencil = std::make_shared<SpringPencil<Dim>>(
        SpringPencil<Dim>::at_pose(system, state.x.template cast<TangentReal<Scalar>>()));
    pencil->require_range("Stability");
    if (pencil->size() > 0) {
        stiffest_ = detail::leading_pair(*pencil, {0, 1, 0}, stiffest_.vector);
    }
    pencil_ = std::move(pencil);
    revision_ = system.revision();
}

template <class Scalar, class Cholesky>
Certificate Stability<Scalar, Cholesky>::certify(Method method, double h) const {
    Certificate certificate{method, h, false};
    require_positive("Stability::certify", "h", h);
    const StepLimit<Scalar> bound = max_step(method);
    certificate.proved = h <= static_cast<double>(bound.certified);
    if (certificate.proved || !(h < static_cast<double>(bound.refuted))) return certificate;
    const Pencil& pencil = *pencil_;
    const double wide = h * (1 + detail::step_rounding<Scalar>);
    // An h² that underflows would leave the stiffness out.
    if (method::is_limited_by<method::LimitedByStiffness>(method) &&
        h * h >= std::numeric_limits<double>::min() && pencil.damping_semidefinite() &&
        (pencil.projects() || pencil.stiffness_semidefinite())) {
        // [T19] at h itself; where K is indefinite hD ≺ 4M carries it to smaller steps.
        Prover<Cholesky> prover;
        certificate.proved =
            prove(prover, pencil, {4, -wide * wide, -2 * wide, false}).proved &&
            (pencil.stiffness_semidefinite() || prove(prover, pencil, {4, 0, -wide}).proved);
        return certificate;
    }
    // A bracket narrowed to its distance from h may still contain h: the refuting end moves too.
    double room = std::min(1.0, static_cast<double>(bound.refuted) / h - 1);
    for (int repeat = 0; repeat < 8 && !certificate.proved; ++repeat) {
        const StepLimit<Scalar> narrowed = max_step(method, std::max(room, 1e-9));
        certificate.proved = h <= static_cast<double>(narrowed.certified);
        if (!(h < static_cast<double>(narrowed.refuted)) || room < 1e-9) break;
        room = std::min(room / 8, static_cast<double>(narrowed.refuted) / h - 1);
    }
    return certificate;
}

template <class Scalar, class Cholesky>
StiffnessSpectrum Stability<Scalar, Cholesky>::stiffness_spectrum(bool count_zero_modes) const {
    StiffnessSpectrum spectrum;
    if (size() == 0) return spectrum;
    const Pencil& pencil = *pencil_;
    spectrum.k_max.upper = std::max(0.0, pencil.upper_bound({0, 1, 0}));
    spectrum.k_max.lower =
        std::max(0.0, detail::quotients(pencil, stiffest_.vector, true).k.lower());
    const RitzPair softest = detail::softest(pencil);
    spectrum.k_min.upper = detail::quotients(pencil, softest.vector, true).k.upper();
    if (std::isnan(spectrum.k_min.upper)) spectrum.k_min.upper = detail::infinity;  // overflow
    // Springs: K⁺ ⪰ 0 by construction. Bare matrices: proved so, or bounded.
    spectrum.k_min.lower = -std::max(0.0, pencil.upper_bound({0, -1, 0}));
    if (pencil.projects() || pencil.stiffness_semidefinite()) spectrum.k_min.lower = 0;
    spectrum.k_min.upper = std::max(spectrum.k_min.upper, spectrum.k_min.lower);
    if (count_zero_modes)
        spectrum.zero_modes = detail::count_zero_modes(pencil, spectrum.k_max.upper);
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
        const RitzPair end = largest_ritz_pair(*pencil_, {0, sign, 0});
        const auto [k, d] = detail::quotients(*pencil_, end.vector, true);
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
    RitzPair pair = largest_ritz_pair(*pencil_, {0, 1, 0}, options, stiffest_.vector);
    const auto [k, d] = detail::quotients(*pencil_, pair.vector, true);
    return {k.value, d.value, std::move(pair.vector)};
}

}  // namespace taut

#include "detail/stability_blame.ipp"
#include "detail/stability_limits.ipp"
