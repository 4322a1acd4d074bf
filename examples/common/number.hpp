// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

// The words and numbers of text files. What is no number as a whole is none: a reader that takes
// the start of a word for its meaning reads another file than the one that was written. And proved
// bounds as text: nearest is not good enough for them, as half of the steps printed so would be
// larger than the step that is proved.

namespace example {

/// Takes the next word off the front of `line`: what stands between spaces, tabs and carriage
/// returns. Empty at the end.
inline std::string_view next_word(std::string_view& line) {
    constexpr std::string_view blank = " \t\r";
    line.remove_prefix(std::min(line.find_first_not_of(blank), line.size()));
    const std::string_view word = line.substr(0, line.find_first_of(blank));
    line.remove_prefix(word.size());
    return word;
}

/// Reads a word that is a finite decimal number. False for 0x10, inf, nan and 1x.
inline bool read_number(std::string_view word, double& value) {
    if (word.empty() || word.find_first_not_of("0123456789+-.eE") != word.npos) return false;
    const std::string text(word);
    char* end = nullptr;
    value = std::strtod(text.c_str(), &end);
    return end == text.c_str() + text.size() && std::isfinite(value);
}

/// Reads a word that is a whole number. False where it is too large for one.
inline bool read_number(std::string_view word, long long& value) {
    if (word.substr(0, 1) == "+" && word.substr(1, 1) != "-") word.remove_prefix(1);
    const char* end = word.data() + word.size();
    const auto read = std::from_chars(word.data(), end, value);
    return read.ec == std::errc() && read.ptr == end;
}

/// What a word behind a number is worth.
struct Unit {
    std::string_view name;
    double worth;
};

/// Reads a number as people write it: 0.5, 1/240, and either with a unit behind it, as 0.5ms.
/// False where the whole is no finite number.
inline bool read_quantity(std::string_view text, const std::vector<Unit>& units, double& value) {
    const auto trim = [](std::string_view part) {
        part.remove_prefix(std::min(part.find_first_not_of(' '), part.size()));
        return part.substr(0, part.find_last_not_of(' ') + 1);
    };
    text = trim(text);
    const std::size_t end = text.find_last_of("0123456789.") + 1;  // 0 without any
    const std::string_view name = trim(text.substr(end));
    double worth = 1;
    if (!name.empty()) {
        const auto unit = std::find_if(units.begin(), units.end(),
                                       [&](const Unit& one) { return one.name == name; });
        if (unit == units.end()) return false;
        worth = unit->worth;
    }
    const std::string_view number = text.substr(0, end);
    const std::size_t slash = number.find('/');
    double below = 1;
    if (!read_number(trim(number.substr(0, slash)), value)) return false;
    if (slash != number.npos && !read_number(trim(number.substr(slash + 1)), below)) return false;
    value = value / below * worth;
    return std::isfinite(value);
}

namespace detail {

/// The number of so many digits that is nearest to `value` on one side of it.
inline std::string rounded(double value, int digits, char style, bool up) {
    const char format[] = {'%', '.', '*', style, '\0'};
    const int places = style == 'e' ? digits - 1 : digits;
    // Less than one unit of the last digit, so that no number of so many digits is passed over.
    const double size = std::abs(value);
    const double stride =
        std::max(size * std::pow(10.0, -digits) / 2, std::nextafter(size, HUGE_VAL) - size);
    for (double near = value;; near += up ? stride : -stride) {
        char text[64];
        std::snprintf(text, sizeof text, format, places, near);
        const double read = std::strtod(text, nullptr);
        if (up ? !(read < value) : !(read > value)) return text;
    }
}

}  // namespace detail

/// A proved upper bound of what is safe, as a certified step: the text, read back, is at most
/// `value`.
/// @param digits  significant ones, at most 15
/// @param style   of printf: e, or g, which leaves out zeros at the end
inline std::string rounded_down(double value, int digits, char style = 'e') {
    return detail::rounded(value, digits, style, false);
}

/// A bound from the other side, as a refuted step: the text, read back, is at least `value`.
inline std::string rounded_up(double value, int digits, char style = 'e') {
    return detail::rounded(value, digits, style, true);
}

/// A piece of a file for a message: its start, without bytes that a terminal would obey.
inline std::string in_quotes(std::string_view text) {
    constexpr std::size_t most = 60;
    std::string shown(text.substr(0, most));
    std::replace_if(
        shown.begin(), shown.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, '?');
    return '"' + shown + (text.size() > most ? "...\"" : "\"");
}

}  // namespace example
