// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <taut/core/error.hpp>

#include "../support/random.hpp"

namespace taut_test {

/// A spring that stiffens: T = k u (1 + a|u|/(w + |u|)), u = l − L. T′ rises from k to k(1 + a).
struct Stiffening {
    static constexpr bool convex = false;
    static constexpr bool monotone = true;
    static constexpr bool vectorizable = true;

    template <class Scalar>
    struct Parameters {
        Scalar stiffness;  ///< k, N/m, ≥ 0
        Scalar more;       ///< a, ≥ 0
        Scalar width;      ///< w, m, > 0

        void require_valid(const char* where) const {
            taut::require_non_negative(where, "stiffness", stiffness);
            taut::require_non_negative(where, "more", more);
            taut::require_positive(where, "width", width);
        }
        template <class Other>
        Parameters<Other> cast() const {
            return {static_cast<Other>(stiffness), static_cast<Other>(more),
                    static_cast<Other>(width)};
        }
    };

    template <class Scalar>
    static Scalar tension(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        const Scalar u = l - L, r = size(u);
        return p.stiffness * u * (Scalar(1) + p.more * r / (p.width + r));
    }
    template <class Scalar>
    static Scalar tension_slope(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        const Scalar left = p.width / (p.width + size(l - L));
        return p.stiffness * (Scalar(1) + p.more * (Scalar(1) - left * left));
    }
    template <class Scalar>
    static Scalar energy(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        const Scalar u = std::abs(l - L), w = p.width;
        return p.stiffness * (u * u / 2 + p.more * (u * u / 2 - w * u + w * w * std::log1p(u / w)));
    }
    template <class Scalar>
    static Scalar stiffness_bound(const Parameters<Scalar>& p, Scalar) {
        return p.stiffness * (Scalar(1) + p.more);
    }

private:
    template <class Scalar>
    static Scalar size(Scalar u) {
        using std::max;
        return max(u, Scalar(0) - u);
    }
};

/// For the tests.
template <class Scalar>
Stiffening::Parameters<Scalar> draw_parameters(Random& random, Stiffening) {
    const auto stiffness = static_cast<Scalar>(random.uniform(20, 200));
    const auto more = static_cast<Scalar>(random.uniform(0, 3));
    return {stiffness, more, static_cast<Scalar>(random.uniform(0.01, 1))};
}

}  // namespace taut_test
