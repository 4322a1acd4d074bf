// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cctype>
#include <cmath>
#include <cstdlib>

namespace example {

/// Reads a finite number and moves `text` behind it. False if there is none, or anything but space
/// follows it.
inline bool read_number(const char*& text, double& value) {
    char* end = nullptr;
    value = std::strtod(text, &end);
    if (end == text || !std::isfinite(value)) return false;
    if (*end != '\0' && std::isspace(static_cast<unsigned char>(*end)) == 0) return false;
    text = end;
    return true;
}

inline bool read_number(const char*& text, long long& value) {
    char* end = nullptr;
    value = std::strtoll(text, &end, 10);  // too large a number becomes the largest
    if (end == text) return false;
    if (*end != '\0' && std::isspace(static_cast<unsigned char>(*end)) == 0) return false;
    text = end;
    return true;
}

/// Whether nothing but space is left.
inline bool at_end(const char* text) {
    while (std::isspace(static_cast<unsigned char>(*text)) != 0) ++text;
    return *text == '\0';
}

}  // namespace example
