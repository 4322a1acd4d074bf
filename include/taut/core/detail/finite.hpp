// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include "../assert.hpp"
#include "../types.hpp"

namespace taut::detail {

/// Whether all of `count` numbers are, by their bits: -ffast-math takes for granted what compares.
template <class Scalar>
bool finite_one_by_one(const Scalar* numbers, Index count) {
    using Real = std::conditional_t<sizeof(Scalar) == 4, float, double>;
    using Bits = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
    constexpr Bits one = Bits(1) << (std::numeric_limits<Real>::digits - 1),
                   sign = ~(~Bits(0) >> 1);
    constexpr auto unit = static_cast<Scalar>(sizeof(Scalar) > sizeof(Real) ? 0x1p-16000L : 1);
    Bits carried = 0, bits;
    for (Index i = 0; i < count; ++i) {
        const auto number = static_cast<Real>(unit * numbers[i]);
        std::memcpy(&bits, &number, sizeof bits);
        carried |= (bits & (sign - one)) + one;  // an exponent of ones carries into the sign
    }
    return carried < sign;
}

/// The same, a register at a time.
template <class Scalar>
bool all_finite(const Scalar* numbers, Index count) {
    TAUT_BY_KERNEL(finite(), numbers, count);
    if constexpr (sizeof(Scalar) <= sizeof(double)) {
        using namespace Eigen::internal;
        using Packet = typename packet_traits<Scalar>::type;
        constexpr Index width = packet_traits<Scalar>::size;
        // Infinity's bits are those of an exponent. The largest of all exponents is it, or all of
        // the numbers are finite.
        constexpr Scalar infinity = std::numeric_limits<Scalar>::infinity();
        const Packet exponent = pset1<Packet>(infinity);
        Packet most = pset1<Packet>(Scalar(0)), other = most;
        for (; count >= 2 * width; count -= 2 * width, numbers += 2 * width) {
            most = pmax(most, pand(exponent, ploadu<Packet>(numbers)));
            other = pmax(other, pand(exponent, ploadu<Packet>(numbers + width)));
        }
        Scalar lanes[sizeof(Packet) / sizeof(Scalar)];
        pstoreu(lanes, pmax(most, other));
        if (!finite_one_by_one(lanes, width)) return false;
    }
    return finite_one_by_one(numbers, count);
}

/// The same of a matrix.
template <class Derived>
bool all_finite(const Eigen::PlainObjectBase<Derived>& numbers) {
    return all_finite(numbers.data(), numbers.size());
}

/// Whether a number is that was computed just now.
template <class Scalar>
TAUT_NOINLINE bool is_finite(Scalar number) {
    const volatile Scalar held = number;  // and not what it was computed from
    const Scalar seen = held;
    return finite_one_by_one(&seen, 1);
}
inline bool is_finite(float number) { return is_finite<double>(number); }

}  // namespace taut::detail
