// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "../core/buffer.hpp"

namespace taut::step_detail {

using detail::Few;

/// No register of Eigen's is wider, in scalars; arrays are padded by as many.
inline constexpr int max_width = 64 / sizeof(float);

template <class Packet>
EIGEN_ALWAYS_INLINE Packet rsqrt_packet(const Packet& a) {
    return Eigen::internal::prsqrt(a);
}
template <class Packet>
EIGEN_ALWAYS_INLINE Packet select_less_packet(const Packet& a, const Packet& b, const Packet& yes,
                                              const Packet& no) {
    return Eigen::internal::pselect(Eigen::internal::pcmp_lt(a, b), yes, no);
}
template <class Packet>
EIGEN_ALWAYS_INLINE Packet unless_negative_packet(const Packet& sign, const Packet& value) {
    const Packet zero = Eigen::internal::pset1<Packet>(0);
    return Eigen::internal::pandnot(value, Eigen::internal::pcmp_lt(sign, zero));
}

#ifdef EIGEN_VECTORIZE_AVX512
// Eigen's own go through vectors of masks, and give infinity its due; here they are most of a step.
// With y = (1 + ε)/√a good to 14 bits and e = 1 − ay²: 1/√a = y(1 + e/2 + 3e²/8 + 5e³/16 + …).
EIGEN_ALWAYS_INLINE __m512d rsqrt_packet(const __m512d& a) {
    const __m512d y = _mm512_maskz_rsqrt14_pd(0xff, a);
    const __m512d e = _mm512_fnmadd_pd(_mm512_mul_pd(a, y), y, _mm512_set1_pd(1));
    const __m512d p = _mm512_fmadd_pd(e, _mm512_set1_pd(0.3125), _mm512_set1_pd(0.375));
    const __m512d q = _mm512_fmadd_pd(e, p, _mm512_set1_pd(0.5));
    return _mm512_fmadd_pd(_mm512_mul_pd(y, e), q, y);
}
EIGEN_ALWAYS_INLINE __m512 rsqrt_packet(const __m512& a) {
    const __m512 y = _mm512_maskz_rsqrt14_ps(0xffff, a);
    const __m512 e = _mm512_fnmadd_ps(_mm512_mul_ps(a, y), y, _mm512_set1_ps(1));
    return _mm512_fmadd_ps(_mm512_mul_ps(y, e), _mm512_set1_ps(0.5f), y);
}
EIGEN_ALWAYS_INLINE __m512d unless_negative_packet(const __m512d& sign, const __m512d& value) {
    return _mm512_maskz_mov_pd(_mm512_cmp_pd_mask(sign, _mm512_setzero_pd(), _CMP_GE_OQ), value);
}
EIGEN_ALWAYS_INLINE __m512 unless_negative_packet(const __m512& sign, const __m512& value) {
    return _mm512_maskz_mov_ps(_mm512_cmp_ps_mask(sign, _mm512_setzero_ps(), _CMP_GE_OQ), value);
}
EIGEN_ALWAYS_INLINE __m512d select_less_packet(const __m512d& a, const __m512d& b,
                                               const __m512d& yes, const __m512d& no) {
    return _mm512_mask_blend_pd(_mm512_cmp_pd_mask(a, b, _CMP_LT_OQ), no, yes);
}
EIGEN_ALWAYS_INLINE __m512 select_less_packet(const __m512& a, const __m512& b, const __m512& yes,
                                              const __m512& no) {
    return _mm512_mask_blend_ps(_mm512_cmp_ps_mask(a, b, _CMP_LT_OQ), no, yes);
}
#endif
#if defined(EIGEN_VECTORIZE_AVX512) && defined(__AVX512VL__)
EIGEN_ALWAYS_INLINE __m256d rsqrt_packet(const __m256d& a) {
    const __m256d y = _mm256_rsqrt14_pd(a);
    const __m256d e = _mm256_fnmadd_pd(_mm256_mul_pd(a, y), y, _mm256_set1_pd(1));
    const __m256d p = _mm256_fmadd_pd(e, _mm256_set1_pd(0.3125), _mm256_set1_pd(0.375));
    const __m256d q = _mm256_fmadd_pd(e, p, _mm256_set1_pd(0.5));
    return _mm256_fmadd_pd(_mm256_mul_pd(y, e), q, y);
}
EIGEN_ALWAYS_INLINE __m256 rsqrt_packet(const __m256& a) {
    const __m256 y = _mm256_rsqrt14_ps(a);
    const __m256 e = _mm256_fnmadd_ps(_mm256_mul_ps(a, y), y, _mm256_set1_ps(1));
    return _mm256_fmadd_ps(_mm256_mul_ps(y, e), _mm256_set1_ps(0.5f), y);
}
#endif

// Deduced: a template argument would lose the attributes of a packet, which GCC warns of.
template <class Packet>
typename Eigen::internal::unpacket_traits<Packet>::half half_of(const Packet& packet);
/// Columns ↔ rows.
template <class Packet>
EIGEN_ALWAYS_INLINE void transpose(Packet& a, Packet& b, Packet& c, Packet& d) {
    Eigen::internal::PacketBlock<Packet, 4> block;
    block.packet[0] = a;
    block.packet[1] = b;
    block.packet[2] = c;
    block.packet[3] = d;
    Eigen::internal::ptranspose(block);
    a = block.packet[0];
    b = block.packet[1];
    c = block.packet[2];
    d = block.packet[3];
}
template <class Packet>
EIGEN_ALWAYS_INLINE void transpose(Packet& a, Packet& b) {
    Eigen::internal::PacketBlock<Packet, 2> block;
    block.packet[0] = a;
    block.packet[1] = b;
    Eigen::internal::ptranspose(block);
    a = block.packet[0];
    b = block.packet[1];
}

/// Eigen's widest packet, halved so many times.
template <class Scalar, int halvings>
struct HalvedPacket {
    using type = typename Eigen::internal::packet_traits<Scalar>::type;
};
template <class Scalar>
struct HalvedPacket<Scalar, 1> {
    using type = typename Eigen::internal::packet_traits<Scalar>::half;
};
template <class Scalar>
struct HalvedPacket<Scalar, 2> {
    using type = decltype(half_of(typename HalvedPacket<Scalar, 1>::type()));
};
constexpr int halvings(int lanes, int most) {
    return lanes > most ? 1 + halvings(lanes / 2, most) : 0;
}

/// One vector register with a scalar's arithmetic, on Eigen's packets: as wide as the compiler's
/// flags and `most` allow (SSE2 on plain x86-64), of one lane where there is nothing.
template <class Scalar, int most = max_width>
struct VectorRegister {
    using Packet =
        typename HalvedPacket<Scalar,
                              halvings(Eigen::internal::packet_traits<Scalar>::size, most)>::type;
    static constexpr int width = Eigen::internal::unpacket_traits<Packet>::size;

    Packet packet;

    VectorRegister() = default;
    EIGEN_ALWAYS_INLINE VectorRegister(Scalar value)
        : packet(Eigen::internal::pset1<Packet>(value)) {}
    static EIGEN_ALWAYS_INLINE VectorRegister of(const Packet& packet) {
        VectorRegister result;
        result.packet = packet;
        return result;
    }
    static EIGEN_ALWAYS_INLINE VectorRegister load(const Scalar* from) {
        return of(Eigen::internal::ploadu<Packet>(from));
    }
    EIGEN_ALWAYS_INLINE void store(Scalar* to) const { Eigen::internal::pstoreu(to, packet); }

    friend EIGEN_ALWAYS_INLINE VectorRegister operator+(const VectorRegister& a,
                                                        const VectorRegister& b) {
        return of(Eigen::internal::padd(a.packet, b.packet));
    }
    friend EIGEN_ALWAYS_INLINE VectorRegister operator-(const VectorRegister& a,
                                                        const VectorRegister& b) {
        return of(Eigen::internal::psub(a.packet, b.packet));
    }
    friend EIGEN_ALWAYS_INLINE VectorRegister operator*(const VectorRegister& a,
                                                        const VectorRegister& b) {
        return of(Eigen::internal::pmul(a.packet, b.packet));
    }
    friend EIGEN_ALWAYS_INLINE VectorRegister operator/(const VectorRegister& a,
                                                        const VectorRegister& b) {
        return of(Eigen::internal::pdiv(a.packet, b.packet));
    }
    friend EIGEN_ALWAYS_INLINE VectorRegister operator-(const VectorRegister& a) {
        return of(Eigen::internal::pnegate(a.packet));
    }
    EIGEN_ALWAYS_INLINE VectorRegister& operator+=(const VectorRegister& other) {
        return *this = *this + other;
    }
    EIGEN_ALWAYS_INLINE VectorRegister& operator-=(const VectorRegister& other) {
        return *this = *this - other;
    }
    EIGEN_ALWAYS_INLINE VectorRegister& operator*=(const VectorRegister& other) {
        return *this = *this * other;
    }

    friend EIGEN_ALWAYS_INLINE VectorRegister larger(const VectorRegister& a,
                                                     const VectorRegister& b) {
        return of(Eigen::internal::pmax(a.packet, b.packet));
    }
    /// As laws call them.
    friend EIGEN_ALWAYS_INLINE VectorRegister(max)(const VectorRegister& a,
                                                   const VectorRegister& b) {
        return larger(a, b);
    }
    friend EIGEN_ALWAYS_INLINE VectorRegister(min)(const VectorRegister& a,
                                                   const VectorRegister& b) {
        return of(Eigen::internal::pmin(a.packet, b.packet));
    }
    friend EIGEN_ALWAYS_INLINE VectorRegister sqrt(const VectorRegister& a) {
        return of(Eigen::internal::psqrt(a.packet));
    }
    /// Lane by lane, the stiffness of K⁺: 0 where it is negative.
    friend EIGEN_ALWAYS_INLINE VectorRegister k_plus(const VectorRegister& stiffness) {
        return larger(stiffness, VectorRegister(Scalar(0)));
    }
    /// 1/√a of normal numbers, to a few ulp.
    friend EIGEN_ALWAYS_INLINE VectorRegister reciprocal_sqrt(const VectorRegister& a) {
#if defined(TAUT_SAME_BITS)
        return VectorRegister(Scalar(1)) / sqrt(a);  // IEEE 754 says what these two give
#else
        return of(rsqrt_packet(a.packet));
#endif
    }
    /// `value` in the lanes where `sign` is ≥ 0, and 0 in the others, whatever they hold.
    friend EIGEN_ALWAYS_INLINE VectorRegister unless_negative(const VectorRegister& sign,
                                                              const VectorRegister& value) {
        return of(unless_negative_packet(sign.packet, value.packet));
    }
    /// Lane by lane, `yes` where a < b and `no` elsewhere, whatever the other one holds.
    friend EIGEN_ALWAYS_INLINE VectorRegister where_less(const VectorRegister& a,
                                                         const VectorRegister& b,
                                                         const VectorRegister& yes,
                                                         const VectorRegister& no) {
        return of(select_less_packet(a.packet, b.packet, yes.packet, no.packet));
    }
};

}  // namespace taut::step_detail
