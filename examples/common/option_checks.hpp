// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <taut/core/version.hpp>
#include <utility>
#include <vector>

#include "number.hpp"

// What the programs' options take: numbers as people write them, within their ranges.

namespace example {

/// CLI11's own range checks print 309 digits.
inline CLI::Validator positive() {
    return {[](std::string& text) {
                const double value = std::strtod(text.c_str(), nullptr);
                return value > 0 && std::isfinite(value) ? "" : text + " is not finite and > 0";
            },
            "> 0"};
}
inline CLI::Validator non_negative() {
    return {[](std::string& text) {
                const double value = std::strtod(text.c_str(), nullptr);
                return value >= 0 && std::isfinite(value) ? "" : text + " is not finite and >= 0";
            },
            ">= 0"};
}
/// Of names: an empty one would be taken for an option that is not given.
inline CLI::Validator not_empty() {
    return {[](std::string& text) { return text.empty() ? "it is empty" : ""; }, ""};
}

/// Of outputs: the device is "-", so that one place is one name.
inline CLI::Validator standard_output() {
    return {[](std::string& path) {
                if (path == "/dev/stdout") path = "-";
                return std::string();
            },
            ""};
}

/// To be given to CLI::Option::transform, ahead of the checks: they and the option see the number
/// in the unit that is worth 1.
inline CLI::Validator quantity(std::vector<Unit> units, const char* example) {
    return {[units = std::move(units), example](std::string& text) -> std::string {
                double value = 0;
                if (!read_quantity(text, units, value)) {
                    return in_quotes(text) + " is no number such as " + example;
                }
                char digits[32];
                std::snprintf(digits, sizeof digits, "%.17g", value);
                text = digits;
                return {};
            },
            ""};
}
/// s
inline CLI::Validator time_quantity() {
    return quantity({{"s", 1}, {"ms", 1e-3}, {"us", 1e-6}, {"\u00b5s", 1e-6}, {"\u03bcs", 1e-6}},
                    "0.001, 1/240 or 0.5ms");
}
/// m
inline CLI::Validator length_quantity() {
    return quantity({{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}}, "0.01, 1cm or 10mm");
}
/// Of a whole.
inline CLI::Validator share_quantity() { return quantity({{"%", 1e-2}}, "0.02, 1/50 or 2%"); }

/// In the option's own unit.
inline CLI::Validator plain_quantity() { return quantity({}, "0.01 or 1/100"); }

/// --version, of every program.
inline void add_version(CLI::App& app, const char* program) {
    app.set_version_flag("--version", std::string(program) + ", Taut " +
                                          std::to_string(TAUT_VERSION_MAJOR) + "." +
                                          std::to_string(TAUT_VERSION_MINOR) + "." +
                                          std::to_string(TAUT_VERSION_PATCH));
}

}  // namespace example
