// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

namespace taut::detail {

/// No register of Eigen's holds more scalars than this; arrays are padded by it.
inline constexpr int most_lanes = 64 / sizeof(float);

/// One vector register of scalars with a scalar's arithmetic, on Eigen's packets: vectorised for
/// whatever the compiler's flags allow (SSE2 on plain x86-64), one number where there is nothing.
template <class Scalar>
struct Lanes {
    using Packet = typename Eigen::internal::packet_traits<Scalar>::type;
    static constexpr int size = Eigen::internal::unpacket_traits<Packet>::size;

    Packet packet;

    Lanes() = default;
    EIGEN_ALWAYS_INLINE Lanes(Scalar value) : packet(Eigen::internal::pset1<Packet>(value)) {}
    static EIGEN_ALWAYS_INLINE Lanes of(const Packet& packet) {
        Lanes lanes;
        lanes.packet = packet;
        return lanes;
    }
    static EIGEN_ALWAYS_INLINE Lanes load(const Scalar* from) { return of(Eigen::internal::ploadu<Packet>(from)); }
    EIGEN_ALWAYS_INLINE void store(Scalar* to) const { Eigen::internal::pstoreu(to, packet); }

    friend EIGEN_ALWAYS_INLINE Lanes operator+(const Lanes& a, const Lanes& b) {
        return of(Eigen::internal::padd(a.packet, b.packet));
    }
    friend EIGEN_ALWAYS_INLINE Lanes operator-(const Lanes& a, const Lanes& b) {
        return of(Eigen::internal::psub(a.packet, b.packet));
    }
    friend EIGEN_ALWAYS_INLINE Lanes operator*(const Lanes& a, const Lanes& b) {
        return of(Eigen::internal::pmul(a.packet, b.packet));
    }
    friend EIGEN_ALWAYS_INLINE Lanes operator/(const Lanes& a, const Lanes& b) {
        return of(Eigen::internal::pdiv(a.packet, b.packet));
    }
    friend EIGEN_ALWAYS_INLINE Lanes operator-(const Lanes& a) { return of(Eigen::internal::pnegate(a.packet)); }
    EIGEN_ALWAYS_INLINE Lanes& operator+=(const Lanes& other) { return *this = *this + other; }
    EIGEN_ALWAYS_INLINE Lanes& operator-=(const Lanes& other) { return *this = *this - other; }
    EIGEN_ALWAYS_INLINE Lanes& operator*=(const Lanes& other) { return *this = *this * other; }

    friend EIGEN_ALWAYS_INLINE Lanes max(const Lanes& a, const Lanes& b) {
        return of(Eigen::internal::pmax(a.packet, b.packet));
    }
    friend EIGEN_ALWAYS_INLINE Lanes min(const Lanes& a, const Lanes& b) {
        return of(Eigen::internal::pmin(a.packet, b.packet));
    }
    friend EIGEN_ALWAYS_INLINE Lanes sqrt(const Lanes& a) { return of(Eigen::internal::psqrt(a.packet)); }
    /// 1/√a of normal numbers, to a few ulp.
    friend EIGEN_ALWAYS_INLINE Lanes reciprocal_sqrt(const Lanes& a) { return of(Eigen::internal::prsqrt(a.packet)); }
    /// Lane by lane, `yes` where a < b and `no` elsewhere, whatever the other one holds.
    friend EIGEN_ALWAYS_INLINE Lanes where_less(const Lanes& a, const Lanes& b, const Lanes& yes, const Lanes& no) {
        return of(Eigen::internal::pselect(Eigen::internal::pcmp_lt(a.packet, b.packet), yes.packet,
                                           no.packet));
    }
};

}  // namespace taut::detail
