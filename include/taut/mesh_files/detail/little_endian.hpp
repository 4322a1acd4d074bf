// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>

#include "../../core/types.hpp"

namespace taut::io_detail {

/// Writes four bytes, least significant first. @returns where the next ones go
inline unsigned char* put_bytes(std::uint32_t bits, unsigned char* bytes) {
    for (int i = 0; i < 4; ++i) *bytes++ = static_cast<unsigned char>(bits >> (8 * i));
    return bytes;
}
inline unsigned char* put_bytes(float number, unsigned char* bytes) {
    static_assert(std::numeric_limits<float>::is_iec559, "taut: binary files need IEEE floats");
    std::uint32_t bits = 0;
    std::memcpy(&bits, &number, sizeof bits);
    return put_bytes(bits, bytes);
}

/// Three floats a column, zeros for missing dimensions: 12 bytes each.
template <class Scalar, int Dim>
unsigned char* put_bytes(const Points<Scalar, Dim>& x, unsigned char* bytes) {
    for (Index i = 0; i < x.cols(); ++i) {
        for (int d = 0; d < 3; ++d) {
            bytes = put_bytes(d < Dim ? static_cast<float>(x(d < Dim ? d : 0, i)) : 0.0F, bytes);
        }
    }
    return bytes;
}

}  // namespace taut::io_detail
