// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include "register.hpp"

namespace taut::step_detail {

/// Three registers of points, x y z x y z …, ↔ one of all x, one of all y, one of all z. Their
/// width is no multiple of three: one of the three has an x in the same lane.
template <class Scalar,
          class Lanes = std::make_integer_sequence<int, VectorRegister<Scalar>::width>>
struct Triples {
    static constexpr bool exist = false;
};

#if defined(EIGEN_VECTORIZE_AVX) && defined(__has_builtin)
#if __has_builtin(__builtin_shufflevector)
template <class Scalar, int... i>
struct Triples<Scalar, std::integer_sequence<int, i...>> {
    using Register = VectorRegister<Scalar>;
    static constexpr int n = Register::width;
    static constexpr bool exist = n > 1;

    static EIGEN_ALWAYS_INLINE void split(const Scalar* points, Scalar* x, Scalar* y, Scalar* z) {
        const Register a = Register::load(points), b = Register::load(points + n),
                       c = Register::load(points + 2 * n);
        lanes<0, 3>(choose<0, 2 * n>(a, b, c)).store(x);
        lanes<1, 3>(choose<n, 2 * n>(a, b, c)).store(y);
        lanes<2, 3>(choose<2 * n, 2 * n>(a, b, c)).store(z);
    }
    static EIGEN_ALWAYS_INLINE void join(const Scalar* x, const Scalar* y, const Scalar* z,
                                         Scalar* points) {
        constexpr int third = 11;  // times three is one, modulo any width up to 32
        const Register a = lanes<0, third>(Register::load(x)),
                       b = lanes<third*(n - 1), third>(Register::load(y)),
                       c = lanes<third*(2 * n - 2), third>(Register::load(z));
        choose<0, 1>(a, b, c).store(points);
        choose<n, 1>(a, b, c).store(points + n);
        choose<2 * n, 1>(a, b, c).store(points + 2 * n);
    }

private:
    /// In lane k that of register p + q k of the three, modulo 3.
    template <int p, int q>
    static EIGEN_ALWAYS_INLINE Register choose(const Register& a, const Register& b,
                                               const Register& c) {
        const auto ab =
            __builtin_shufflevector(a.packet, b.packet, ((p + q * i) % 3 == 1 ? n + i : i)...);
        return Register::of(
            __builtin_shufflevector(ab, c.packet, ((p + q * i) % 3 == 2 ? n + i : i)...));
    }
    /// In lane k that of lane p + q k, modulo the width.
    template <int p, int q>
    static EIGEN_ALWAYS_INLINE Register lanes(const Register& a) {
        return Register::of(__builtin_shufflevector(a.packet, a.packet, ((p + q * i) % n)...));
    }
};
#endif
#endif

}  // namespace taut::step_detail
