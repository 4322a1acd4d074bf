// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "../../tight/certificate.hpp"
#include "../step_limit.hpp"
#include "quotients.hpp"

// What every search for a limit has in common: what it may spend, what it found, and how a bracket
// is narrowed: sharpen the vector that refutes, then prove below it.

namespace taut::stability_detail {

/// A step limit in double, before it is rounded to a system's Scalar: see rounded().
struct UnroundedLimit {
    double certified = 0;       ///< s
    double refuted = infinity;  ///< s
    Cause cause = Cause::stiffness;
    double estimate = 0;         ///< s; 0: none
    double certified_up_to = 0;  ///< s, but for admitted_growth
    double admitted_growth = 0;  ///< 1/s
};

/// The limit as Scalars that claim no more. @param revision  of the system that was analysed
template <class Scalar>
StepLimit<Scalar> rounded(const UnroundedLimit& limit, std::uint64_t revision) {
    StepLimit<Scalar> answer;
    answer.certified = round_down<Scalar>(limit.certified);
    answer.refuted = round_up<Scalar>(limit.refuted);
    answer.cause = limit.cause;
    // Nothing found is no estimate, and none lies where a vector refutes.
    if (limit.estimate > 0 && std::isfinite(limit.estimate)) {
        answer.estimate = std::min(static_cast<Scalar>(limit.estimate), answer.refuted);
    }
    answer.certified_up_to = round_down<Scalar>(limit.certified_up_to);
    answer.admitted_growth = limit.admitted_growth;
    answer.revision = revision;
    return answer;
}

// An effort says what a search for a limit may compute: Bounds or Factorisations.

/// Eigenvalue bounds and vectors, by products with the matrices: no factorisation.
struct Bounds {
    static constexpr bool factorises = false;
};

/// Sparse factorisations as well, until the bracket is as narrow as `tightness` asks.
template <class Cholesky>
struct Factorisations {
    static constexpr bool factorises = true;
    double tightness = 0;
    Prover<Cholesky> prover;
};

/// [certified, refuted), s, and the vector that refutes.
struct Bracket {
    double certified = 0;
    double refuted = infinity;
    Eigen::VectorXd vector;
};

/// Whether refuted/certified ≤ 1 + tightness, of a Bracket or an UnroundedLimit.
template <class Limit>
bool within(const Limit& limit, double tightness) {
    return limit.refuted <= limit.certified * (1 + tightness);
}

/// Options for a Ritz value whose relative error is well below `share`.
inline LanczosOptions sharp(double share) {
    LanczosOptions options;
    options.basis = 32;
    options.restarts = 200;
    options.tolerance = share / 10;
    options.settled = share / 100;
    return options;
}

/// Tries proves(h) just below bracket.refuted, sharpening the refutation first, then further down.
/// @param sharpen  double sharpen(Bracket&, share): lowers bracket.refuted
template <class Sharpen, class Proves>
void narrow(Bracket& bracket, double tightness, Sharpen&& sharpen, Proves&& proves) {
    // A failed proof means that the vector was not sharp enough, or that rounding hides the rest.
    double share = tightness;
    for (double distance = tightness; distance < 0.5 && !within(bracket, distance);
         distance *= 16) {
        sharpen(bracket, share);
        const double h = bracket.refuted / (1 + 0.9 * distance);
        if (h > bracket.certified && proves(h)) bracket.certified = h;
        share = std::max(share / 16, 1e-14);
    }
}

}  // namespace taut::stability_detail
