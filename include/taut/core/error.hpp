// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <limits>
#include <string>
#include <type_traits>

#include "assert.hpp"
#include "detail/finite.hpp"

namespace taut {
namespace detail {

/// A part of a message: words, which must outlive it, or a number.
class Part {
public:
    Part(const char* words) : words_(words) {}
    Part(const std::string& words) : words_(words.c_str()) {}
    template <class Number, std::enable_if_t<std::is_arithmetic_v<Number>, int> = 0>
    Part(Number number) {
        if constexpr (std::is_floating_point_v<Number>) {
            write("%.9g", static_cast<double>(number));
        } else if constexpr (std::is_signed_v<Number>) {
            write("%lld", static_cast<long long>(number));
        } else {
            write("%llu", static_cast<unsigned long long>(number));
        }
    }
    const char* text() const { return words_ ? words_ : number_; }

private:
    template <class Number>
    TAUT_COLD TAUT_NOINLINE void write(const char* format, Number number) {
        std::snprintf(number_, sizeof number_, format, number);
    }

    const char* words_ = nullptr;
    char number_[32];
};

inline std::string text(const Part& part) { return part.text(); }

[[noreturn]] TAUT_COLD TAUT_NOINLINE inline void fail_with(std::initializer_list<Part> parts) {
    std::string message = "taut::";
    for (const Part& part : parts) message += part.text();
    TAUT_FAIL(message.c_str());
    std::abort();  // reached only when a user's TAUT_FAIL returns
}

}  // namespace detail

/// Reports wrong input: joins the parts to one sentence and hands it to TAUT_FAIL. Never returns.
template <class... Parts>
[[noreturn]] void fail(Parts... parts) {  // by value, so that words of any length are one type
    detail::fail_with({detail::Part(parts)...});
}

/// Fails unless `value` is finite and ≥ 0; the message names function, argument and value.
template <class Scalar>
void require_non_negative(const char* function, const char* argument, Scalar value) {
    if (!(value >= Scalar(0)) || !detail::is_finite(value)) {
        fail(function, ": ", argument, " is ", value, "; it must be finite and >= 0");
    }
}

/// Fails unless `value` is finite, ≥ 0 and, rounded to Scalar, still finite.
template <class Scalar>
void require_held(const char* function, const char* argument, double value) {
    require_non_negative(function, argument, value);
    constexpr Scalar most = (std::numeric_limits<Scalar>::max)();
    if (value > static_cast<double>(most)) {
        fail(function, ": ", argument, " is ", value, "; the system's numbers end at ", most);
    }
}

/// Fails unless `value` is finite and > 0.
template <class Scalar>
void require_positive(const char* function, const char* argument, Scalar value) {
    if (!(value > Scalar(0)) || !detail::is_finite(value)) {
        fail(function, ": ", argument, " is ", value, "; it must be finite and > 0");
    }
}

}  // namespace taut
