// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "../../core/detail/bisection.hpp"
#include "../../proof/detail/explicit_bracket.hpp"
#include "../../proof/detail/symplectic_bracket.hpp"
#include "../certificate.hpp"
#include "../dense.hpp"
#include "../explicit_estimate.hpp"

// How a bracket is narrowed: sharpen the vector that refutes, then prove below it.

namespace taut::proof_detail {

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
        share = (std::max)(share / 16, 1e-14);
    }
}

/// Proves step h, s, stable by factorisations, with the true K [T19]. Needs D ⪰ 0.
template <class Real = double>  // a template, as all below: only its callers compile it
bool proves_symplectic(const Pencil& pencil, Prover& prover, double h) {
    // With an indefinite K the condition at h says nothing of smaller steps; hD ≺ 4M does.
    return prove(prover, pencil, 4 * M - 2 * h * D - h * h * K).proved &&
           (pencil.stiffness_semidefinite() || prove(prover, pencil, 4 * M - h * D).proved);
}

/// k_max of K'⁺ as a bracket {refuted lower value, proved upper one}, by σM − K⁺ ≻ 0.
struct ProvedMaximum {
    double lower = 0;
    double upper = 0;
    Eigen::VectorXd vector;
};

template <class Real = double>
ProvedMaximum narrow_maximum(const Pencil& pencil, Prover& prover, double tightness) {
    ProvedMaximum k;
    k.upper = (std::max)(0.0, pencil.upper_bound(K_plus));
    // narrow() works on steps: 1/k is a step's square, up to a factor.
    Bracket inverse{k.upper > 0 ? 1 / k.upper : infinity, infinity, {}};
    const auto sharpen = [&](Bracket& b, double share) {
        RitzPair pair = largest_ritz_pair(pencil, K_plus, sharp(share), b.vector);
        const double value = quotients(pencil, pair.vector, K_plus).k.lower();
        if (value > 0) b.refuted = (std::min)(b.refuted, 1 / value);
        b.vector = std::move(pair.vector);
    };
    narrow(inverse, tightness, sharpen,
           [&](double share) { return prove(prover, pencil, 1 / share * M - K_plus).proved; });
    k.upper = (std::min)(k.upper, 1 / inverse.certified * (1 + 4e-16));
    k.lower = detail::is_finite(inverse.refuted) ? 1 / inverse.refuted : 0;
    k.vector = std::move(inverse.vector);
    return k;
}

/// Explicit Euler where M, D and K commute [T9]: near critical damping the step moves faster than
/// k_max does, so k_max is narrowed until the step's bracket fits.
/// @param d     a bound on the largest eigenvalue of D', 1/s
/// @param mode  the stiffest one known
template <class Real = double>
void narrow_commuting(const Pencil& pencil, Prover& prover, double tightness, double d,
                      RitzPair mode, UnroundedLimit& limit) {
    for (double share = tightness; share > 1e-14 && !within(limit, tightness); share /= 16) {
        auto proved = narrow_maximum(pencil, prover, share);
        limit.certified = (std::max)(limit.certified, certified_explicit(pencil, proved.upper, d));
        if (proved.vector.size() > 0) mode.vector = std::move(proved.vector);
        limit.refuted = refuted_explicit(pencil, mode, true);
        if (proved.upper > proved.lower * (1 + share)) break;
    }
}

/// Explicit Euler with a D that does not commute: [T17] by two factorisations, as far as D − hK⁺ is
/// definite up to −δM. Raises `certified` where δ = 0 suffices, else `certified_up_to`
/// with δ for `admitted_growth`.
/// @param k     a bound on k_max, 1/s²
/// @param high  no limit is above this step, s
template <class Real = double>
void narrow_dampers(const Pencil& pencil, Prover& prover, double tightness, double k, double high,
                    UnroundedLimit& limit) {
    const auto second = [&](double h) {
        return prove(prover, pencil, 4 * M - 2 * h * D + h * h * K).proved;
    };
    // The largest h with D − hK⁺ ⪰ −δM, δ tiny beside hK⁺.
    double shown = 0;
    const auto proves = [&](double h) {
        const double tiny = 1e-9 * h * k;
        const bool strict = prove(prover, pencil, D - h * K_plus).proved;
        const bool weak = strict || prove(prover, pencil, tiny * M + D - h * K_plus).proved;
        if (!weak || !second(h)) return false;
        shown = strict ? 0 : tiny;
        if (strict) limit.certified = h;
        return true;
    };
    // Far below the limit the rounding of D hides so small a δ: a first proof is sought from above.
    double top = (std::min)(high, limit.refuted);
    double low = limit.certified;
    for (int repeat = 0; low == 0 && repeat < 10; ++repeat) {
        const double h = top / 16;
        (proves(h) ? low : top) = h;
    }
    if (low == 0) return;
    detail::Bisection<double> search(low, top, tightness);
    while (search.open()) search.narrow(proves(search.middle()));
    if (search.passes() > limit.certified) {
        limit.certified_up_to = search.passes();
        limit.admitted_growth = shown;
    }
}

/// Sparse factorisations, until the bracket is as narrow as `tightness` asks; of small systems
/// dense eigensolvers as well.
template <class Real = double>  // a template: only its callers compile the factorisations
class Factorisations {
public:
    explicit Factorisations(Real tightness) : tightness_(tightness) {}

    void narrow_symplectic(const Pencil& pencil, Bracket& bracket) {
        const auto sharpen = [&](Bracket& b, double share) {
            sharpen_symplectic(pencil, sharp(share), 0.1 * share, b.refuted, b.vector);
        };
        narrow(bracket, tightness_, sharpen,
               [&](double h) { return proves_symplectic(pencil, prover_, h); });
    }
    void narrow_explicit(const Pencil& pencil, const RitzPair& stiffest, UnroundedLimit& limit) {
        const double k = pencil.upper_bound(K_plus);
        const double d = pencil.upper_bound(D);
        const bool commuting = commutes(pencil);
        if (pencil.is_rayleigh() && pencil.stiffness_semidefinite()) {
            narrow_commuting(pencil, prover_, tightness_, d, stiffest, limit);
        }
        if (!commuting && pencil.size() <= DenseAnalysis<>::good_size) {
            const DenseAnalysis<> dense(pencil, K);
            limit.refuted = (std::min)(limit.refuted, dense.explicit_limit_above());
            limit.estimate = dense.explicit_limit();
        } else if (!commuting && k > 0) {
            limit.estimate = explicit_estimate(pencil, k);
        }
        if (!within(limit, tightness_) && !pencil.is_rayleigh()) {
            // No limit is above that of the best commuting damping by much [T12].
            const double high = k > 0 ? 4 / std::sqrt(k) : 4 / d;
            narrow_dampers(pencil, prover_, tightness_, k, high, limit);
        }
    }
    double narrow_deficit(const Pencil& pencil, const Combination& c, double epsilon) {
        return (std::min)(epsilon, proved_deficit(prover_, pencil, c, epsilon));
    }

private:
    double tightness_;
    Prover prover_;
};

}  // namespace taut::proof_detail
