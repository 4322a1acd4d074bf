// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "../certificate.hpp"
#include "limits.hpp"

// Brackets narrowed by factorisations: sharpen the vector that refutes, then prove below it.

namespace taut::detail {

/// How much Stability::max_step may spend: bounds alone …
struct Bounds {
    static constexpr bool factorises = false;
};

/// … or factorisations as well.
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

    bool within(double tightness) const { return refuted <= certified * (1 + tightness); }
};

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
    for (double distance = tightness; distance < 0.5 && !bracket.within(distance); distance *= 16) {
        sharpen(bracket, share);
        const double h = bracket.refuted / (1 + 0.9 * distance);
        if (h > bracket.certified && proves(h)) bracket.certified = h;
        share = std::max(share / 16, 1e-14);
    }
}

/// Symplectic Euler: 4M − 2hD − h²K ≻ 0 with the true K [T19]. Needs D ⪰ 0.
template <class Cholesky>
void narrow_symplectic(const Pencil& pencil, Factorisations<Cholesky>& effort, Bracket& bracket) {
    Prover<Cholesky>& prover = effort.prover;
    const auto sharpen = [&](Bracket& b, double share) {
        sharpen_symplectic(pencil, sharp(share), 0.1 * share, b.refuted, b.vector);
    };
    narrow(bracket, effort.tightness, sharpen, [&](double h) {
        // With an indefinite K the condition at h says nothing of smaller steps; hD ≺ 4M does.
        return prove(prover, pencil, {4, -h * h, -2 * h, false}).proved &&
               (pencil.stiffness_semidefinite() || prove(prover, pencil, {4, 0, -h}).proved);
    });
}

/// k_max of K'⁺ as a bracket {refuted lower value, proved upper one}, by σM − K⁺ ≻ 0.
struct ProvedMaximum {
    double lower = 0;
    double upper = 0;
    Eigen::VectorXd vector;
};

template <class Cholesky>
ProvedMaximum narrow_maximum(const Pencil& pencil, Prover<Cholesky>& prover, double tightness) {
    ProvedMaximum k;
    k.upper = std::max(0.0, pencil.upper_bound({0, 1, 0}));
    // narrow() works on steps: 1/k is a step's square, up to a factor.
    Bracket inverse{k.upper > 0 ? 1 / k.upper : infinity, infinity, {}};
    const auto sharpen = [&](Bracket& b, double share) {
        RitzPair pair = largest_ritz_pair(pencil, {0, 1, 0}, sharp(share), b.vector);
        const double value = quotients(pencil, pair.vector, true).k.lower();
        if (value > 0) b.refuted = std::min(b.refuted, 1 / value);
        b.vector = std::move(pair.vector);
    };
    narrow(inverse, tightness, sharpen, [&](double share) {
        return prove(prover, pencil, {1 / share, -1, 0}).proved;
    });
    k.upper = std::min(k.upper, 1 / inverse.certified * (1 + 4e-16));
    k.lower = std::isfinite(inverse.refuted) ? 1 / inverse.refuted : 0;
    k.vector = std::move(inverse.vector);
    return k;
}

/// Explicit Euler where M, D and K commute [T9]: near critical damping the step moves faster than
/// k_max does, so k_max is narrowed until the step's bracket fits.
/// @param d     a bound on the largest eigenvalue of D', 1/s
/// @param mode  the stiffest one known
template <class Cholesky>
void narrow_commuting(const Pencil& pencil, Factorisations<Cholesky>& effort, double d,
                      RitzPair mode, Bracket& bracket) {
    for (double share = effort.tightness; share > 1e-14 && !bracket.within(effort.tightness);
         share /= 16) {
        auto proved = narrow_maximum(pencil, effort.prover, share);
        bracket.certified =
            std::max(bracket.certified, certified_explicit(pencil, proved.upper, d));
        if (proved.vector.size() > 0) mode.vector = std::move(proved.vector);
        bracket.refuted = refuted_explicit(pencil, mode, true);
        if (proved.upper > proved.lower * (1 + share)) break;
    }
}

/// Explicit Euler with a D that does not commute: [T17] by two factorisations, as far as D − hK⁺ is
/// definite up to −δM. Raises `up_to` and `delta`, 1/s; certified itself where δ = 0 sufficed.
/// @param k     a bound on k_max, 1/s²
/// @param high  no limit is above this step, s
template <class Cholesky>
void narrow_explicit(const Pencil& pencil, Factorisations<Cholesky>& effort, double k, double high,
                     Bracket& bracket, double& up_to, double& delta) {
    Prover<Cholesky>& prover = effort.prover;
    const auto second = [&](double h) {
        return prove(prover, pencil, {4, h * h, -2 * h, false}).proved;
    };
    // The largest h with D − hK⁺ ⪰ −δM, δ tiny beside hK⁺.
    double shown = 0;
    const auto proves = [&](double h) {
        const double tiny = 1e-9 * h * k;
        const bool strict = prove(prover, pencil, {0, -h, 1}).proved;
        const bool weak = strict || prove(prover, pencil, {tiny, -h, 1}).proved;
        if (!weak || !second(h)) return false;
        shown = strict ? 0 : tiny;
        if (strict) bracket.certified = h;
        return true;
    };
    // Far below the limit the rounding of D hides so small a δ: a first proof is sought from above.
    double top = std::min(high, bracket.refuted);
    double low = bracket.certified;
    for (int repeat = 0; low == 0 && repeat < 10; ++repeat) {
        const double h = top / 16;
        (proves(h) ? low : top) = h;
    }
    if (low == 0) return;
    Bisection<double> search(low, top, effort.tightness);
    while (search.open()) search.narrow(proves(search.middle()));
    if (search.passes() > bracket.certified) {
        up_to = search.passes();
        delta = shown;
    }
}

}  // namespace taut::detail
