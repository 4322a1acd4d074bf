// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "any_pose.hpp"
#include "detail/explicit_bracket.hpp"
#include "detail/growth.hpp"
#include "detail/limit_of.hpp"
#include "detail/pencil_shares.ipp"
#include "detail/symplectic_bracket.hpp"
#include "energy_limit.hpp"
#include "mode.hpp"
#include "stability.hpp"

// What bounds a limit from above, and what sets it: by vectors that a Lanczos iteration finds.

namespace taut {

namespace proof_detail {

/// The limit with what refutes, as ByBounds.
template <class Effort>
struct ByVectors {
    const Pencil& pencil;
    Effort& effort;

    UnroundedLimit operator()(method::LimitedByDamping) const {
        return explicit_bracket(pencil, effort, leading_pair(pencil, K_plus));
    }
    UnroundedLimit operator()(method::LimitedByStiffness) const {
        return symplectic_bracket(pencil, effort,
                                  [&](double) { return leading_pair(pencil, K_plus).vector; });
    }
    UnroundedLimit operator()(method::LimitedByIndefiniteness limit) const {
        return ByBounds{pencil}(limit);
    }
    void add_growth(UnroundedLimit& limit) const {
        proof_detail::add_growth(pencil, effort, limit);
    }
};

/// A step beyond which a method is known to fail, and what compression makes grow.
template <class Scalar, class Effort>
StepLimit<Scalar> bracket(const Stability<Scalar>& stability, Method method, Effort& effort) {
    return limit_of<Scalar>(method, stability.pencil(), stability.revision(),
                            ByVectors<Effort>{stability.pencil(), effort});
}

/// The `count` largest shares, in descending order.
template <class Share>
std::vector<Share> largest_shares(std::vector<Share> shares, Index count) {
    const auto kept = std::clamp<Index>(count, 0, static_cast<Index>(shares.size()));
    std::partial_sort(shares.begin(), shares.begin() + kept, shares.end(),
                      [](const Share& a, const Share& b) { return a.share > b.share; });
    shares.resize(static_cast<std::size_t>(kept));
    return shares;
}

}  // namespace proof_detail

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

/// Stability::max_step with `refuted`, s, and growth_rate: by Ritz vectors.
template <class Scalar>
StepLimit<Scalar> bracket(const Stability<Scalar>& stability, Method method) {
    proof_detail::NoEffort bounds;
    return proof_detail::bracket(stability, method, bounds);
}

/// any_pose_limit with `refuted`, s, where the condition itself fails: no larger step can be
/// certified for every pose in this way, though a given pose may allow one.
template <class Scalar, int Dim, class... Laws>
StepLimit<Scalar> any_pose_bracket(const SpringSystem<Scalar, Dim, Laws...>& system) {
    proof_detail::NoEffort bounds;
    return proof_detail::bracket_of_laplacians<Scalar>(Pencil::any_pose(system), bounds,
                                                       system.revision());
}

/// energy_limit with `refuted`, s, above which the condition fails. That ends the proof, not the
/// scene: some motion may gain energy there, most will not.
template <class Scalar, int Dim, class... Laws>
StepLimit<Scalar> energy_bracket(const SpringSystem<Scalar, Dim, Laws...>& system) {
    proof_detail::NoEffort bounds;
    return proof_detail::bracket_of_laplacians<Scalar>(
        Pencil::any_pose(system, Pencil::Damping::half), bounds, system.revision(), 0.5);
}

/// Brackets of the extreme eigenvalues.
template <class Scalar>
StiffnessSpectrum stiffness_spectrum(const Stability<Scalar>& stability) {
    StiffnessSpectrum spectrum;
    if (stability.size() == 0) return spectrum;
    const Pencil& pencil = stability.pencil();
    const RitzPair stiffest = leading_pair(pencil, matrices::K_plus);
    spectrum.k_max.upper = (std::max)(0.0, pencil.upper_bound(matrices::K_plus));
    spectrum.k_max.lower = (std::max)(
        0.0, proof_detail::quotients(pencil, stiffest.vector, matrices::K_plus).k.lower());
    const RitzPair softest = proof_detail::softest(pencil);
    spectrum.k_min.upper =
        proof_detail::quotients(pencil, softest.vector, matrices::K_plus).k.upper();
    // Springs: K⁺ ⪰ 0 by construction. Bare matrices: proved so, or bounded.
    spectrum.k_min.lower = -(std::max)(0.0, pencil.upper_bound(-matrices::K_plus));
    if (pencil.projected_semidefinite()) spectrum.k_min.lower = 0;
    spectrum.k_min.upper = (std::max)(spectrum.k_min.upper, spectrum.k_min.lower);
    return spectrum;
}

namespace proof_detail {

/// The vector of the largest eigenvalue of M⁻¹S, to 1e-6, of a pencil that is not empty.
template <class Real = double>  // a template: only its callers compile it
RitzPair largest_mode(const Pencil& pencil, const Combination& c) {
    LanczosOptions options;
    options.basis = 60;
    options.tolerance = 1e-6;
    return largest_ritz_pair<Real>(pencil, c, options, leading_pair<Real>(pencil, c).vector);
}

}  // namespace proof_detail

/// The vibration that holds explicit steps down, as the Lanczos iteration found it.
template <class Scalar>
Mode limiting_mode(const Stability<Scalar>& stability) {
    if (stability.size() == 0) return {};
    const Pencil& pencil = stability.pencil();
    RitzPair pair = proof_detail::largest_mode(pencil, matrices::K_plus);
    const auto [k, d] = proof_detail::quotients(pencil, pair.vector, matrices::K_plus);
    return {k.value, d.value, std::move(pair.vector)};
}

/// The `count` springs that hold most of a mode's elastic energy, the first one most.
template <class Scalar>
std::vector<SpringShare> limiting_springs(const Stability<Scalar>& stability, Index count,
                                          const Mode& mode) {
    return proof_detail::largest_shares(stability.pencil().spring_shares(mode.shape), count);
}
/// Of the limiting mode. Finding it is most of the work.
template <class Scalar>
std::vector<SpringShare> limiting_springs(const Stability<Scalar>& stability, Index count) {
    return limiting_springs(stability, count, limiting_mode(stability));
}

/// The `count` particles that hold most of a mode's kinetic energy, the first one most.
template <class Scalar>
std::vector<ParticleShare> limiting_particles(const Stability<Scalar>& stability, Index count,
                                              const Mode& mode) {
    return proof_detail::largest_shares(stability.pencil().particle_shares(mode.shape), count);
}
/// Of the limiting mode.
template <class Scalar>
std::vector<ParticleShare> limiting_particles(const Stability<Scalar>& stability, Index count) {
    return limiting_particles(stability, count, limiting_mode(stability));
}

}  // namespace taut

#if defined(TAUT_COMPILED)
#include "../compiled_bracket.hpp"
#endif
