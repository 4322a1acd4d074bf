// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>

namespace taut::detail {

/// Nine digits, with a point whatever the program's locale is, and `end`.
inline void put_number(std::FILE* file, double number, char end) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", number);
    for (char& c : text) {
        if (c == ',') c = '.';
        if (c == '\0') break;
    }
    std::fputs(text, file);
    std::fputc(end, file);
}

/// A line of three.
inline void put_numbers(std::FILE* file, const double (&p)[3]) {
    put_number(file, p[0], ' ');
    put_number(file, p[1], ' ');
    put_number(file, p[2], '\n');
}

}  // namespace taut::detail
