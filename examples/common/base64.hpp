// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

// Numbers as text in a page.

namespace example {

inline std::string base64(const std::vector<std::uint8_t>& bytes) {
    static constexpr char digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve(4 * ((bytes.size() + 2) / 3));
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto at = [&](std::size_t j) { return j < bytes.size() ? bytes[j] : 0U; };
        const unsigned three = at(i) << 16U | at(i + 1) << 8U | at(i + 2);
        for (unsigned d = 0; d < 4; ++d)
            text += i + d <= bytes.size() ? digits[three >> (18 - 6 * d) & 63U] : '=';
    }
    return text;
}

/// Little-endian, `width` bytes each.
inline void append(std::vector<std::uint8_t>& bytes, std::uint64_t value, int width) {
    for (int i = 0; i < width; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}

}  // namespace example
