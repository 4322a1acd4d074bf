// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../types.hpp"

namespace taut::detail {

/// Whether all of `count` numbers are, a register at a time.
template <class Scalar>
bool all_finite(const Scalar* numbers, Index count) {
    using namespace Eigen::internal;
    using Packet = typename packet_traits<Scalar>::type;
    constexpr Index width = packet_traits<Scalar>::size;
    // x − x is 0, or NaN where x is not finite; and so is the sum.
    Packet sums = pset1<Packet>(Scalar(0)), others = sums;
    Index i = 0;
    for (; i + 2 * width <= count; i += 2 * width) {
        const Packet x = ploadu<Packet>(numbers + i), y = ploadu<Packet>(numbers + i + width);
        sums = padd(sums, psub(x, x));
        others = padd(others, psub(y, y));
    }
    Scalar sum = predux(padd(sums, others));
    for (; i < count; ++i) sum += numbers[i] - numbers[i];
    return sum == Scalar(0);
}

}  // namespace taut::detail
