// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

namespace taut::detail {

/// Whether all of `count` numbers are, by their bits: -ffast-math takes for granted what compares.
template <class Scalar>
bool all_finite(const Scalar* numbers, std::ptrdiff_t count) {
    using Real = std::conditional_t<sizeof(Scalar) == 4, float, double>;
    using Bits = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
    constexpr Bits one = Bits(1) << (std::numeric_limits<Real>::digits - 1),
                   sign = ~(~Bits(0) >> 1);
    constexpr auto unit = static_cast<Scalar>(sizeof(Scalar) > sizeof(Real) ? 0x1p-16000L : 1);
    Bits carried = 0, bits;
    for (std::ptrdiff_t i = 0; i < count; ++i) {
        const auto number = static_cast<Real>(unit * numbers[i]);
        std::memcpy(&bits, &number, sizeof bits);
        carried |= (bits & (sign - one)) + one;  // an exponent of ones carries into the sign
    }
    return carried < sign;
}

/// Whether a number is that was computed just now.
template <class Real>
bool is_finite(Real number) {
    const volatile Real held = number;  // and not what it was computed from
    const Real seen = held;
    return all_finite(&seen, 1);
}

}  // namespace taut::detail
