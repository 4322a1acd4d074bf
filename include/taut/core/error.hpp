// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <type_traits>

#include "assert.hpp"

namespace taut {
namespace detail {

inline std::string text(const char* words) { return words; }
inline std::string text(const std::string& words) { return words; }

template <class Number, std::enable_if_t<std::is_arithmetic_v<Number>, int> = 0>
std::string text(Number number) {
    if constexpr (std::is_integral_v<Number>) {
        return std::to_string(number);
    } else {
        char buffer[32];
        std::snprintf(buffer, sizeof buffer, "%.9g", static_cast<double>(number));
        return buffer;
    }
}

}  // namespace detail

/// Reports wrong input: joins the parts to one sentence and hands it to TAUT_FAIL. Never returns.
template <class... Parts>
[[noreturn]] void fail(const Parts&... parts) {
    std::string message = "taut::";
    ((message += detail::text(parts)), ...);
    TAUT_FAIL(message.c_str());
    std::abort();  // reached only when a user's TAUT_FAIL returns
}

/// Fails unless `value` is finite and ≥ 0; the message names function, argument and value.
template <class Scalar>
void require_non_negative(const char* function, const char* argument, Scalar value) {
    if (!(value >= Scalar(0)) || !std::isfinite(value)) {
        fail(function, ": ", argument, " is ", value, "; it must be finite and >= 0");
    }
}

/// Fails unless `value` is finite, ≥ 0 and, rounded to Scalar, still finite.
template <class Scalar>
void require_held(const char* function, const char* argument, double value) {
    require_non_negative(function, argument, value);
    constexpr Scalar most = std::numeric_limits<Scalar>::max();
    if (value > most) {
        fail(function, ": ", argument, " is ", value, "; the system's numbers end at ", most);
    }
}

/// Fails unless `value` is finite and > 0.
template <class Scalar>
void require_positive(const char* function, const char* argument, Scalar value) {
    if (!(value > Scalar(0)) || !std::isfinite(value)) {
        fail(function, ": ", argument, " is ", value, "; it must be finite and > 0");
    }
}

}  // namespace taut
