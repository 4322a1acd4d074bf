// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>
#include <utility>

#include "register.hpp"

namespace taut::step_detail {

/// A vector of one place or spring, x y z 0, in registers.
template <class Scalar>
struct Quad {
    using Part = VectorRegister<Scalar, 4>;
    static constexpr int parts = 4 / Part::width;

    Few<Part, parts> part;

    static EIGEN_ALWAYS_INLINE Quad load(const Scalar* from) {
        Quad a;
        for_each_part([&](int i) { a.part[i] = Part::load(from + i * Part::width); });
        return a;
    }
    EIGEN_ALWAYS_INLINE void store(Scalar* to) const {
        for_each_part([&](int i) { part[i].store(to + i * Part::width); });
    }
    friend EIGEN_ALWAYS_INLINE Quad operator+(const Quad& a, const Quad& b) {
        Quad sum;
        for_each_part([&](int i) { sum.part[i] = a.part[i] + b.part[i]; });
        return sum;
    }
    friend EIGEN_ALWAYS_INLINE Quad operator-(const Quad& a, const Quad& b) {
        Quad difference;
        for_each_part([&](int i) { difference.part[i] = a.part[i] - b.part[i]; });
        return difference;
    }
    friend EIGEN_ALWAYS_INLINE Quad operator*(const Quad& a, const Quad& b) {
        Quad product;
        for_each_part([&](int i) { product.part[i] = a.part[i] * b.part[i]; });
        return product;
    }
    friend EIGEN_ALWAYS_INLINE Quad operator*(const Part& factor, const Quad& a) {
        Quad product;
        for_each_part([&](int i) { product.part[i] = factor * a.part[i]; });
        return product;
    }

    /// x + y + z, in the order of Eigen's sums.
    EIGEN_ALWAYS_INLINE Scalar total() const {
#if defined(TAUT_SAME_BITS)
        Scalar axis[4];
        store(axis);
        return axis[0] + axis[1] + axis[2];
#endif
        if constexpr (parts == 1) return Eigen::internal::predux(part[0].packet);
        if constexpr (parts == 2) return Eigen::internal::predux((part[0] + part[1]).packet);
        if constexpr (parts == 4) return ((part[0] + part[1]) + (part[2] + part[3])).packet;
    }
    /// Four factors, each in all lanes.
    static EIGEN_ALWAYS_INLINE Few<Part, 4> factors(const Scalar* from) {
        if constexpr (Part::width == 4) {
            Few<Part, 4> all;
            Eigen::internal::pbroadcast4(from, all[0].packet, all[1].packet, all[2].packet,
                                         all[3].packet);
            return all;
        } else {
            return {Part(from[0]), Part(from[1]), Part(from[2]), Part(from[3])};
        }
    }
    /// Four vectors ↔ all x, all y, all z and all zeros.
    static EIGEN_ALWAYS_INLINE void transpose(Quad& a, Quad& b, Quad& c, Quad& d);
    /// The sums x + y + z of four vectors, a lane each.
    static EIGEN_ALWAYS_INLINE Quad sums(const Quad& a, const Quad& b, const Quad& c,
                                         const Quad& d);

private:
    /// visit(i), unrolled whatever the compiler's flags.
    template <class Visitor>
    static EIGEN_ALWAYS_INLINE void for_each_part(const Visitor& visit) {
        visit(0);
        if constexpr (parts > 1) visit(1);
        if constexpr (parts > 2) visit(2), visit(3);
    }
    static EIGEN_ALWAYS_INLINE Part sum(const Quad& a) { return a.part[0] + a.part[1] + a.part[2]; }
    static EIGEN_ALWAYS_INLINE Part sums_of_two(Quad a, Quad b) {
        step_detail::transpose(a.part[0].packet, b.part[0].packet);
        step_detail::transpose(a.part[1].packet, b.part[1].packet);
        return a.part[0] + b.part[0] + a.part[1];
    }
};

template <class Scalar>
EIGEN_ALWAYS_INLINE void Quad<Scalar>::transpose(Quad& a, Quad& b, Quad& c, Quad& d) {
    if constexpr (Part::width == 1) {
        std::swap(a.part[1], b.part[0]);
        std::swap(a.part[2], c.part[0]);
        std::swap(a.part[3], d.part[0]);
        std::swap(b.part[2], c.part[1]);
        std::swap(b.part[3], d.part[1]);
        std::swap(c.part[3], d.part[2]);
    } else if constexpr (Part::width == 2) {
        step_detail::transpose(a.part[0].packet, b.part[0].packet);
        step_detail::transpose(c.part[0].packet, d.part[0].packet);
        step_detail::transpose(a.part[1].packet, b.part[1].packet);
        step_detail::transpose(c.part[1].packet, d.part[1].packet);
        std::swap(a.part[1], c.part[0]);
        std::swap(b.part[1], d.part[0]);
    } else {
        step_detail::transpose(a.part[0].packet, b.part[0].packet, c.part[0].packet,
                               d.part[0].packet);
    }
}

template <class Scalar>
EIGEN_ALWAYS_INLINE Quad<Scalar> Quad<Scalar>::sums(const Quad& a, const Quad& b, const Quad& c,
                                                    const Quad& d) {
    if constexpr (Part::width == 1) {
        return {{sum(a), sum(b), sum(c), sum(d)}};
    } else if constexpr (Part::width == 2) {
        return {{sums_of_two(a, b), sums_of_two(c, d)}};
    } else {
        Part x = a.part[0];
        Part y = b.part[0];
        Part z = c.part[0];
        Part none = d.part[0];
        step_detail::transpose(x.packet, y.packet, z.packet, none.packet);
        return {{x + y + z}};
    }
}

#ifdef EIGEN_VECTORIZE_AVX
// With half the shuffles.
template <>
EIGEN_ALWAYS_INLINE Quad<double> Quad<double>::sums(const Quad& a, const Quad& b, const Quad& c,
                                                    const Quad& d) {
    const __m256d ab = _mm256_hadd_pd(a.part[0].packet, b.part[0].packet);
    const __m256d cd = _mm256_hadd_pd(c.part[0].packet, d.part[0].packet);
    return {{Part::of(
        _mm256_add_pd(_mm256_blend_pd(ab, cd, 12), _mm256_permute2f128_pd(ab, cd, 0x21)))}};
}
#endif

/// The lanes of two registers side by side in one of twice the width.
template <class Scalar, int lanes>
EIGEN_ALWAYS_INLINE VectorRegister<Scalar, 2 * lanes> join(
    const VectorRegister<Scalar, lanes>& first, const VectorRegister<Scalar, lanes>& second) {
#ifdef EIGEN_VECTORIZE_AVX
    if constexpr (std::is_same_v<Scalar, float> && lanes == 4) {
        return VectorRegister<float, 8>::of(
            _mm256_insertf128_ps(_mm256_castps128_ps256(first.packet), second.packet, 1));
    }
#endif
    Few<Scalar, 2 * lanes> numbers;
    first.store(numbers.data());
    second.store(numbers.data() + lanes);
    return VectorRegister<Scalar, 2 * lanes>::load(numbers.data());
}

}  // namespace taut::step_detail
