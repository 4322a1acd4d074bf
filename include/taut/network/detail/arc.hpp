// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace taut::network_detail {

/// ½w is what bends a beam to an arc over a chord λ = l/L, w = (κL/2)² and λ = sinc √w. Its slope
///
///     G(λ) = −½w′ = w/(sinc √w − cos √w),  from π² (ends touch) to 3 (flat),
///
/// is r₀ + Σ r/(λ + q) with r, q > 0, whose sums and integrals lose nothing to cancellation. These
/// are the best of their number by Remez's exchange of the relative error: 5.5e-9 for float,
/// 9.5e-19 for double, 1.1e-20 beyond, where G′ is good to 96 roundings.
/// @returns r₀, then q and r of each pole
template <int digits>
constexpr auto arc_poles() {
    if constexpr (digits <= 24) {
        return std::array<long double, 9>{0.09396015115L, 0.2301324698L, 0.9892786193L,
                                          0.3578242690L,  1.107405585L,  0.8190188768L,
                                          1.377987400L,   3.094169159L,  2.164656989L};
    } else if constexpr (digits <= 53) {
        return std::array<long double, 19>{
            0.0214704891241619332L, 0.220262372460959264L, 0.478086959184210217L,
            0.245721586919635671L,  0.491680343791122620L, 0.303822106521403325L,
            0.518592473172323136L,  0.412517472388043364L, 0.559342590322011039L,
            0.611307695791100397L,  0.617577699133832899L, 0.992921067456352245L,
            0.704566921182676028L,  1.81399927041986559L,  0.850095067327309293L,
            4.02417805472907719L,   1.14180679600845973L,  13.9612872947749396L,
            1.97693619930627920L};
    } else {
        return std::array<long double, 21>{
            0.01759093077977348385724L, 0.2197248026967799206183L, 0.4335233439656035502091L,
            0.2404817486143080510387L,  0.4436779969987520327093L, 0.2867501306139036041262L,
            0.4637776823051799476900L,  0.3699286379381264746146L, 0.4939393187011470874213L,
            0.5133100034410593190815L,  0.5357485401469679510914L, 0.7656284718522014291673L,
            0.5942732103801448453120L,  1.239853644027975880029L,  0.6820438390351660574451L,
            2.248093221229345081047L,   0.8295380053517743276565L, 4.945940257685172384908L,
            1.124362049322786055603L,   17.05047640997151974301L,  1.962724403701721344768L};
    }
}

/// The scalar of a number or of a register of them.
template <class Real>
struct ScalarOf {
    using type = Real;
};
template <template <class, int> class Register, class Scalar, int most>
struct ScalarOf<Register<Scalar, most>> {
    using type = Scalar;
};

/// G at λ in [0, 1], its derivative and its integral. Numbers, or registers.
template <class Real>
struct Arc {
    using Scalar = typename ScalarOf<Real>::type;
    static constexpr Scalar touching = static_cast<Scalar>(9.86960440108935861883L);  // π²

    /// G(λ), in [3, π²] but for rounding.
    static Real slope(const Real& lambda) {
        Real above(polynomials.above[poles]), below(Scalar(1));
        for (std::size_t m = poles; m-- > 0;) {
            above = above * lambda + Real(polynomials.above[m]);
            below = below * lambda + Real(polynomials.below[m]);
        }
        return above / below;
    }
    /// −G′(λ), > 0.
    static Real curvature(const Real& lambda) {
        Real sum(Scalar(0));
        for (std::size_t m = 1; m < table.size(); m += 2) {
            const Real inverse = Real(Scalar(1)) / (lambda + Real(Scalar(table[m])));
            sum += Real(Scalar(table[m + 1])) * inverse * inverse;
        }
        return sum;
    }
    /// The integral of G over shortenings 1 − λ between two, that of ½w.
    static Real work(Real from, Real to) {
        Real sum = Scalar(table[0]) * (to - from);
        for (std::size_t m = 1; m < table.size(); m += 2) {
            sum += Scalar(table[m + 1]) *
                   std::log1p((to - from) / (1 - to + static_cast<Scalar>(table[m])));
        }
        return sum;
    }

private:
    static constexpr auto table = arc_poles<std::numeric_limits<Scalar>::digits>();
    static constexpr std::size_t poles = table.size() / 2;
    /// G = above/below: one division. No coefficient is negative.
    struct Polynomials {
        std::array<Scalar, poles + 1> above{}, below{};
        constexpr Polynomials() {
            std::array<long double, poles + 1> r{table[0]}, q{1};
            for (std::size_t m = 0; m < poles; ++m) {
                for (std::size_t i = m + 2; i-- > 0;) {
                    const long double r_before = i > 0 ? r[i - 1] : 0;
                    const long double q_before = i > 0 ? q[i - 1] : 0;
                    r[i] = r[i] * table[2 * m + 1] + r_before + q[i] * table[2 * m + 2];
                    q[i] = q[i] * table[2 * m + 1] + q_before;
                }
            }
            for (std::size_t i = 0; i <= poles; ++i) {
                above[i] = static_cast<Scalar>(r[i]);
                below[i] = static_cast<Scalar>(q[i]);
            }
        }
    };
    static constexpr Polynomials polynomials{};
};

}  // namespace taut::network_detail
