// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// same_output RANGES PAGE QUOTED PRINTED [together]: whether every line of the file QUOTED, which a
// page shows, is a line of PRINTED, which its programs have printed: word for word, and number for
// number within a range. QUOTED may be the page itself (.md); its lines are then those that begin
// with "    > ". `together`: the lines of QUOTED follow each other in PRINTED, too.
//
// Words and whole numbers must be the same. Other numbers may differ by one unit of the last place
// that the page shows, or by a thousandth; beside 0e+00 up to 1e-12 is 0. RANGES widens this for
// lines that depend on the machine; it says of which page, which lines, by how much, and why.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace {

struct Number {
    double value;
    double last_place;  // one unit of the last digit shown; 0 for a whole number
};

struct Line {
    std::string text;
    std::string words;  // the text with # for each number and one blank for several
    std::vector<Number> numbers;
};

Number parse_number(const std::string& digits) {
    const double value = std::strtod(digits.c_str(), nullptr);
    const auto exponent = digits.find('e');
    const auto mantissa = digits.substr(0, exponent);
    const auto point = mantissa.find('.');
    if (exponent == std::string::npos && point == std::string::npos) return {value, 0};
    if (exponent != std::string::npos && value == 0) return {0, 1e-12};  // rounding of some motion
    const int decimals = point == std::string::npos ? 0 : int(mantissa.size() - point) - 1;
    const int power = exponent == std::string::npos ? 0 : std::atoi(digits.c_str() + exponent + 1);
    return {value, std::pow(10.0, power - decimals)};
}

Line parse_line(const std::string& text) {
    static const std::regex number("[-+]?[0-9]+(\\.[0-9]+)?(e[-+]?[0-9]+)?");
    static const std::regex blanks("[ \t]+");
    Line line{text, "", {}};
    for (std::sregex_iterator found(text.begin(), text.end(), number), end; found != end; ++found) {
        line.numbers.push_back(parse_number(found->str()));
    }
    line.words = std::regex_replace(std::regex_replace(text, number, "#"), blanks, " ");
    if (!line.words.empty() && line.words.back() == ' ') line.words.pop_back();
    if (!line.words.empty() && line.words.front() == ' ') line.words.erase(0, 1);
    return line;
}

std::ifstream open(const std::string& path) {
    std::ifstream file(path);
    if (!file) {
        std::cerr << path << ": cannot be opened\n";
        std::exit(2);
    }
    return file;
}

std::vector<Line> read_lines(const std::string& path) {
    static const std::string mark = "    > ";
    const bool is_page = path.size() > 3 && path.compare(path.size() - 3, 3, ".md") == 0;
    std::ifstream file = open(path);
    std::vector<Line> lines;
    for (std::string text; std::getline(file, text);) {
        if (!is_page) {
            lines.push_back(parse_line(text));
        } else if (text.compare(0, mark.size(), mark) == 0) {
            lines.push_back(parse_line(text.substr(mark.size())));
        }
    }
    return lines;
}

struct Range {
    std::regex lines;
    double relative;  // infinite: numbers are not compared
};

/// A line of the file: page, range, regular expression. The range is a share, or "any".
std::vector<Range> read_ranges(const std::string& path, const std::string& page) {
    std::ifstream file = open(path);
    std::vector<Range> ranges;
    for (std::string text; std::getline(file, text);) {
        std::istringstream words(text);
        std::string of, share, expression;
        if (text.empty() || text[0] == '#' || !(words >> of >> share) || of != page) continue;
        std::getline(words >> std::ws, expression);
        ranges.push_back({std::regex(expression),
                          share == "any" ? HUGE_VAL : std::strtod(share.c_str(), nullptr)});
    }
    return ranges;
}

bool agree(const Number& quoted, const Number& printed, std::optional<double> range) {
    const double apart = std::abs(quoted.value - printed.value);
    const double size = std::max(std::abs(quoted.value), std::abs(printed.value));
    if (range) return *range == HUGE_VAL || apart <= std::max(*range * size, quoted.last_place);
    if (quoted.last_place == 0) return apart == 0;
    return apart <= std::max(1e-3 * size, 1.001 * quoted.last_place);
}

bool agree(const Line& quoted, const Line& printed, std::optional<double> range) {
    if (quoted.words != printed.words || quoted.numbers.size() != printed.numbers.size())
        return false;
    for (std::size_t i = 0; i < quoted.numbers.size(); ++i) {
        if (!agree(quoted.numbers[i], printed.numbers[i], range)) return false;
    }
    return true;
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 5 || count > 6) {
        std::cerr << "usage: same_output RANGES PAGE QUOTED PRINTED [together]\n";
        return 2;
    }
    const std::string page = arguments[2];
    const auto ranges = read_ranges(arguments[1], page);
    const auto quoted = read_lines(arguments[3]);
    const auto printed = read_lines(arguments[4]);
    const bool together = count == 6;
    const auto agrees = [&](const Line& line, const Line& other) {
        std::optional<double> range;
        for (const Range& r : ranges) {
            if (std::regex_search(line.text, r.lines))
                range = std::max(range.value_or(0), r.relative);
        }
        return agree(line, other, range);
    };

    if (quoted.empty()) {
        std::cerr << page << " quotes no output\n";
        return 1;
    }
    bool same = true;
    auto expected = printed.begin();
    for (const Line& line : quoted) {
        const auto here = [&](const Line& other) { return agrees(line, other); };
        const bool first = &line == quoted.data();
        auto found = printed.end();
        if (!together || first) {
            found = std::find_if(printed.begin(), printed.end(), here);
        } else if (expected != printed.end() && here(*expected)) {
            found = expected;
        }
        if (found != printed.end()) {
            expected = found + 1;
            continue;
        }
        same = false;
        std::cerr << page << " quotes:   " << line.text << "\n";
        for (const Line& other : printed) {
            if (other.words == line.words) std::cerr << "  printed is: " << other.text << "\n";
        }
        if (together) break;
    }
    if (!same) {
        std::cerr << "All that is printed:\n";
        for (const Line& line : printed) std::cerr << line.text << "\n";
    }
    return same ? 0 : 1;
}
