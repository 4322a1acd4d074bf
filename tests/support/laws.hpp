// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <taut/network/buckling.hpp>
#include <taut/network/hookean.hpp>
#include <taut/network/spring_system.hpp>
#include <taut/network/tension_only.hpp>
#include <type_traits>

#include "random.hpp"

namespace taut_test {

using taut::Buckling;
using taut::TensionOnly;

/// Glue: T = k·u·exp(−u²/w²), u = l − L. Pulled far, it lets go: T′ < 0 beyond u = w/√2.
struct Glue {
    static constexpr bool convex = false;

    template <class Scalar>
    struct Parameters {
        Scalar stiffness;  // N/m
        Scalar width;      // m

        void require_valid(const char* where) const {
            taut::require_non_negative(where, "stiffness", stiffness);
            taut::require_non_negative(where, "width", width);
        }
        template <class Other>
        Parameters<Other> cast() const {
            return {static_cast<Other>(stiffness), static_cast<Other>(width)};
        }
    };
    template <class Scalar>
    static Scalar tension(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        return p.stiffness * (l - L) * decay(p, L, l);
    }
    template <class Scalar>
    static Scalar tension_slope(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        const Scalar r = (l - L) / p.width;
        return p.stiffness * (1 - 2 * r * r) * decay(p, L, l);
    }
    template <class Scalar>
    static Scalar energy(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        return Scalar(0.5) * p.stiffness * p.width * p.width * (1 - decay(p, L, l));
    }
    template <class Scalar>
    static Scalar stiffness_bound(const Parameters<Scalar>& p, Scalar) {
        return p.stiffness;
    }

private:
    template <class Scalar>
    static Scalar decay(const Parameters<Scalar>& p, Scalar L, Scalar l) {
        const Scalar r = (l - L) / p.width;
        return std::exp(-r * r);
    }
};

template <class Scalar>
taut::Hookean::Parameters<Scalar> draw_parameters(Random& random, taut::Hookean) {
    return {static_cast<Scalar>(random.uniform(20, 200))};
}
template <class Scalar>
TensionOnly::Parameters<Scalar> draw_parameters(Random& random, TensionOnly) {
    return {static_cast<Scalar>(random.uniform(20, 200))};
}
template <class Scalar>
Buckling::Parameters<Scalar> draw_parameters(Random& random, Buckling) {
    const auto stiffness = static_cast<Scalar>(random.uniform(20, 200));
    const auto bending = static_cast<Scalar>(random.uniform(0.01, 2));
    return {stiffness, bending, static_cast<Scalar>(random.uniform(20, 400))};
}
template <class Scalar>
Glue::Parameters<Scalar> draw_parameters(Random& random, Glue) {
    const auto stiffness = static_cast<Scalar>(random.uniform(20, 200));
    return {stiffness, static_cast<Scalar>(random.uniform(0.3, 1))};
}

/// Springs of all laws that the tests know; those without springs cost nothing.
template <class Scalar, int Dim>
using AnyLaw = taut::SpringSystem<Scalar, Dim, taut::Hookean, TensionOnly, Buckling, Glue>;

// Systems of which Taut::Compiled holds the steppers: to name others costs a test minutes.

/// Springs of two laws; in one dimension of one.
template <class Scalar, int Dim>
using Mixed = std::conditional_t<Dim == 1, taut::SpringSystem<Scalar, Dim>,
                                 taut::SpringSystem<Scalar, Dim, taut::Hookean, Buckling>>;
/// Springs that do not push; the library has those of two and three dimensions.
template <class Scalar, int Dim>
using Strings = taut::SpringSystem<Scalar, Dim, TensionOnly>;

}  // namespace taut_test
