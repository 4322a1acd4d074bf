// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <limits>

namespace taut::network_detail {

/// A circular arc of length L over a chord l: half its angle is y = κL/2, and l/L = sinc y. In
/// w = y² everything is an entire function, summed here as a power series for 0 ≤ w ≤ π², which
/// needs no branch for flat arcs and loses nothing to cancellation in 1 − sinc y or sinc y − cos y.
template <class Scalar>
struct Arc {
    Scalar w;        ///< (κL/2)²
    Scalar sag;      ///< A(w) = (1 − sinc y)/w
    Scalar lever;    ///< B(w) = (sinc y − cos y)/w, from 1/3 (flat) to 1/π² (ends touch)
    Scalar lever_w;  ///< B′(w)

    static constexpr Scalar touching = static_cast<Scalar>(9.86960440108935861883L);  // π²

    /// The arc of a given w in [0, π²].
    static Arc at(Scalar w) {
        Arc arc{w, 0, 0, 0};
        for (std::size_t m = terms; m-- > 0;) {
            arc.lever_w = arc.lever_w * w + arc.lever;
            arc.lever = arc.lever * w + coefficients.lever[m];
            arc.sag = arc.sag * w + coefficients.sag[m];
        }
        return arc;
    }
    /// The arc of a given shortening δ = 1 − l/L in [0, 1]: Newton on w·A(w) = δ, whose derivative
    /// is B/2, from a polynomial within 2e-4 of the root. One iteration leaves 2e-8, two 1e-16.
    static Arc shortened(Scalar delta) {
        Scalar ratio = 0;  // w/δ
        for (const double c : {4.5395, -9.6342, 8.7017, -2.9314, 1.4315, 1.7604, 6.0004}) {
            ratio = ratio * delta + static_cast<Scalar>(c);
        }
        Arc arc = at(delta * ratio);
        for (int i = 0; i < iterations; ++i) {
            const Scalar w = arc.w - 2 * (arc.w * arc.sag - delta) / arc.lever;
            arc = at(w < 0 ? Scalar(0) : w);
        }
        return arc;
    }

private:
    static constexpr std::size_t terms = 17;  // the first one left out is below 1e-21
    static constexpr int digits = std::numeric_limits<Scalar>::digits;
    static constexpr int iterations = digits <= 24 ? 1 : digits <= 53 ? 2 : 3;
    struct Coefficients {
        std::array<Scalar, terms> sag{};    // (−1)^m/(2m + 3)!
        std::array<Scalar, terms> lever{};  // (−1)^m (2m + 2)/(2m + 3)!
        constexpr Coefficients() {
            long double term = 1.0L / 6;
            for (std::size_t m = 0; m < terms; ++m) {
                const auto n = static_cast<long double>(2 * m);
                sag[m] = static_cast<Scalar>(term);
                lever[m] = static_cast<Scalar>((n + 2) * term);
                term = -term / ((n + 4) * (n + 5));
            }
        }
    };
    static constexpr Coefficients coefficients{};
};

}  // namespace taut::network_detail
