// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>

#include "../../core/types.hpp"

namespace taut::io_detail {

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

/// A line of three: column i, and zeros for missing dimensions.
template <class Scalar, int Dim>
void put_column(std::FILE* file, const Points<Scalar, Dim>& values, Index i) {
    for (int d = 0; d < 3; ++d) {
        const double number = d < Dim ? static_cast<double>(values(d < Dim ? d : 0, i)) : 0.0;
        put_number(file, number, d < 2 ? ' ' : '\n');
    }
}

}  // namespace taut::io_detail
