// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

// Stability::max_step, by what limits the method, and what an unproved K or D adds.

namespace taut {

template <class Scalar, class Cholesky>
template <class Effort>
StepLimit<Scalar> Stability<Scalar, Cholesky>::bracket(Method method, Effort effort) const {
    if (size() == 0) return limit(detail::infinity, detail::infinity, Cause::nothing_to_limit);
    auto answer = method::visit_limited("Stability", method, [&](auto descriptor) {
        return limit_by(typename decltype(descriptor)::Limit{}, effort);
    });
    // An explicit step is claimed by D − hK ⪰ −δM, which needs no D ⪰ 0 beside it unless K is
    // indefinite: there it says nothing of smaller steps.
    if (!method::is_limited_by<method::LimitedByDamping>(method) || !claims(answer) ||
        !pencil_->stiffness_semidefinite())
        admit_negative_damping(method, answer);
    add_growth(method, answer, effort);
    return answer;
}

template <class Scalar, class Cholesky>
template <class Effort>
StepLimit<Scalar> Stability<Scalar, Cholesky>::limit_by(method::LimitedByDamping,
                                                        Effort& effort) const {
    const Pencil& pencil = *pencil_;
    const double k = pencil.upper_bound({0, 1, 0});
    const double d = pencil.upper_bound({0, 0, 1});
    // A negative K or D of bare matrices is not nothing.
    if (!(k > 0) && !(d > 0) && pencil.upper_bound({0, -1, 0, false}) <= 0 &&
        pencil.upper_bound({0, 0, -1}) <= 0) {
        return limit(detail::infinity, detail::infinity, Cause::nothing_to_limit);
    }
    if (!std::isfinite(k) || !std::isfinite(d)) {
        return limit(0, detail::infinity, Cause::overflow);
    }
    if (!(d > 0)) {
        // One mode with k > 0 refutes every step; buckled modes alone do not.
        const bool vibrates = detail::quotients(pencil, stiffest_.vector, false).k.lower() > 0;
        return limit(0, vibrates ? 0 : detail::infinity, Cause::undamped);
    }
    // α K⁺ is not a function of an indefinite K, so only d0·M commutes with it.
    const bool commutes = pencil.is_rayleigh() && (pencil.stiffness_semidefinite() ||
                                                   pencil.rayleigh().stiffness_proportional == 0);
    detail::Bracket bracket{detail::certified_explicit(pencil, k, d), detail::infinity, {}};
    bracket.refuted = detail::refuted_explicit(pencil, stiffest_, commutes);
    double estimate = 0;
    double up_to = 0;
    double delta = 0;
    if constexpr (Effort::factorises) {
        if (pencil.is_rayleigh() && pencil.stiffness_semidefinite()) {
            detail::narrow_commuting(pencil, effort, d, stiffest_, bracket);
        }
        if (!commutes && size() <= dense_size) {
            const DenseAnalysis<> dense(pencil, false);
            bracket.refuted = std::min(bracket.refuted, dense.explicit_limit_above());
            estimate = dense.explicit_limit();
        } else if (!commutes && k > 0) {
            estimate = explicit_estimate(pencil, k);
        }
        if (!bracket.within(effort.tightness) && !pencil.is_rayleigh()) {
            // No limit is above that of the best commuting damping by much [T12].
            const double high = k > 0 ? 4 / std::sqrt(k) : 4 / d;
            detail::narrow_explicit(pencil, effort, k, high, bracket, up_to, delta);
        }
    }
    const double certified = bracket.certified;
    const bool by_damping = k <= 0 || certified * certified * k < 4 * (1 - 1e-3);
    StepLimit<Scalar> answer = limit(certified, std::max(bracket.refuted, certified),
                                     certified == 0 ? Cause::undamped_modes
                                     : by_damping   ? Cause::damping
                                                    : Cause::stiffness);
    // Nothing found is no estimate, and none lies where a vector refutes.
    if (estimate > 0 && std::isfinite(estimate)) {
        answer.estimate = std::min(static_cast<Scalar>(estimate), answer.refuted);
    }
    if (up_to > certified) {
        answer.certified_up_to = detail::round_down<Scalar>(up_to);
        answer.admitted_growth = delta;
        if (certified == 0) answer.cause = Cause::rounding;
    }
    return answer;
}

template <class Scalar, class Cholesky>
template <class Effort>
StepLimit<Scalar> Stability<Scalar, Cholesky>::limit_by(method::LimitedByStiffness,
                                                        Effort& effort) const {
    const Pencil& pencil = *pencil_;
    // A bound within 3 % of the Ritz value's step needs no improvement.
    detail::Bracket bracket;
    bracket.certified = detail::certified_symplectic(pencil, 1.06 * stiffest_.value);
    if (!std::isfinite(bracket.certified)) {
        return limit(detail::infinity, detail::infinity, Cause::nothing_to_limit);
    }
    if (!(bracket.certified > 0)) return limit(0, detail::infinity, Cause::overflow);
    bracket.vector = stiffest_.vector;
    bracket.refuted = detail::refuted_symplectic(pencil, bracket.vector);
    if constexpr (Effort::factorises) detail::narrow_symplectic(pencil, effort, bracket);
    return limit(bracket.certified, bracket.refuted,
                 detail::symplectic_cause(pencil, bracket.certified, bracket.vector));
}

template <class Scalar, class Cholesky>
template <class Effort>
StepLimit<Scalar> Stability<Scalar, Cholesky>::limit_by(method::LimitedByIndefiniteness,
                                                        Effort&) const {
    const Pencil& pencil = *pencil_;
    // K⁺ ⪰ 0 for springs: solvable and stable at every step [T20], [T27].
    const double kappa = std::max(0.0, pencil.upper_bound({0, -1, 0}));
    if (pencil.projects() || pencil.stiffness_semidefinite() || kappa == 0) {
        return limit(detail::infinity, detail::infinity, Cause::unconditional);
    }
    if (!std::isfinite(kappa)) return limit(0, detail::infinity, Cause::overflow);
    // Bare matrices, D ⪰ −δM: the step matrix stays definite while 1 − hδ − h²κ > 0, and turns
    // singular where a vector says so [T21].
    const double delta = pencil.damping_semidefinite() ? 0 : pencil.deficit({0, 0, 1});
    const auto definite_up_to = [delta](double most) {
        return critical_step(Method::symplectic_euler, most, delta) / 2;
    };
    const RitzPair softest = largest_ritz_pair(pencil, {0, -1, 0});
    const auto [k, d] = detail::quotients(pencil, softest.vector, true);
    if (k.upper() < 0) {
        return limit(definite_up_to(kappa),
                     critical_step(Method::implicit_euler, k.upper(), std::max(0.0, d.upper())),
                     Cause::stiffness);
    }
    return limit(definite_up_to(pencil.deficit({0, 1, 0})), detail::infinity, Cause::stiffness);
}

/// What is semi-definite but for `rate`, 1/s, is enough for an answer of another name: multipliers
/// stay below 1 + h·rate [T17], those of implicit Euler below 1/(1 − h·rate), which is less than
/// e^(2h·rate) while h·rate ≤ ½. Rates add up where they meet in one vector.
template <class Scalar, class Cholesky>
void Stability<Scalar, Cholesky>::admit(Method method, double rate, StepLimit<Scalar>& limit) {
    limit.admitted_growth += is_implicit(method) ? 2 * rate : rate;
    const double most = 1 / std::max(limit.admitted_growth, 1e-300);
    limit.certified_up_to = std::min(std::max(limit.certified, limit.certified_up_to),
                                     detail::round_down<Scalar>(most));
    limit.certified = 0;
    limit.cause = Cause::rounding;
}

/// D ⪰ −δM by rounding is admitted; a δ that is no rounding feeds energy in at every step.
template <class Scalar, class Cholesky>
void Stability<Scalar, Cholesky>::admit_negative_damping(Method method,
                                                         StepLimit<Scalar>& limit) const {
    const Pencil& pencil = *pencil_;
    if (pencil.damping_semidefinite()) return;
    const double delta = pencil.deficit({0, 0, 1});
    if (delta == 0) return;
    if (delta <= 1e-6 * std::max(0.0, pencil.upper_bound({0, 0, 1}))) {
        if (claims(limit)) admit(method, delta, limit);
        return;
    }
    limit.certified = limit.certified_up_to = 0;
    limit.admitted_growth = 0;
    limit.refuted = std::numeric_limits<Scalar>::infinity();
    limit.cause = Cause::damping_unproved;
}

/// What the physics adds where K is not known to be positive semi-definite [T27]: √κ of the
/// undamped motion (damping slows the growth but does not remove it), or what could not be
/// excluded.
template <class Scalar, class Cholesky>
template <class Effort>
void Stability<Scalar, Cholesky>::add_growth(Method method, StepLimit<Scalar>& limit,
                                             [[maybe_unused]] Effort& effort) const {
    const Pencil& pencil = *pencil_;
    if (pencil.stiffness_semidefinite()) return;
    LanczosOptions options;
    options.basis = 48;
    options.tolerance = 1e-4;
    const RitzPair softest = largest_ritz_pair(pencil, {0, -1, 0, false}, options);
    const Enclosed k = detail::quotients(pencil, softest.vector, false).k;
    // Rest lengths and poses are rounded to Scalar: so much compression is no statement about
    // physics.
    const double resolution =
        pencil.projects() ? 16 * static_cast<double>(std::numeric_limits<Scalar>::epsilon()) *
                                std::max(0.0, pencil.upper_bound({0, 1, 0}))
                          : 0;
    if (k.upper() < -resolution) {
        limit.growth_rate = std::sqrt(-k.value);
        if (limit.certified > 0) limit.cause = Cause::buckling;
        return;
    }
    if (!claims(limit)) return;
    // Not refuted, not proved: K ⪰ −εM is what can be said.
    const Combination stiffness{0, 1, 0, false};
    double epsilon = pencil.deficit(stiffness);
    if constexpr (Effort::factorises) {
        if (pencil.projects()) {
            epsilon = std::min(epsilon, proved_deficit(effort.prover, pencil, stiffness, epsilon));
        }
    }
    if (pencil.projects()) {
        limit.admitted_growth += std::sqrt(epsilon);
    } else {
        admit(method, std::sqrt(epsilon), limit);
    }
}

}  // namespace taut
