// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "../../examples/common/matrix_market.hpp"
#include "../support/catch.hpp"
#include "../support/random.hpp"
#include "../support/temporary_file.hpp"

namespace taut_test::matrix_market_test {

namespace {

struct MatrixText : TemporaryFile {
    explicit MatrixText(const std::string& text) : TemporaryFile("matrix.mtx") {
        std::ofstream(path, std::ios::binary) << text;
    }
};

template <class Use>
std::string complaint(const std::string& text, Use&& use) {
    const MatrixText file(text);
    try {
        use(example::read_matrix_market(file.path));
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return {};
}
std::string complaint(const std::string& text) {
    return complaint(text, [](const auto&) {});
}

std::string text_of(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
}

/// A random matrix, and the lines of a file that holds it: the banner, the size, the entries.
struct Written {
    Eigen::MatrixXd matrix;
    std::vector<std::string> lines;

    explicit Written(Random& random) {
        const Index n = 1 + random.below(9);
        const bool symmetric = random.below(2) == 0;
        const bool coordinate = random.below(2) == 0;
        matrix = Eigen::MatrixXd::Zero(n, n);
        lines = {std::string("%%MatrixMarket matrix ") + (coordinate ? "coordinate" : "array") +
                     " real " + (symmetric ? "symmetric" : "General"),
                 ""};
        for (Index j = 0; j < n; ++j) {
            for (Index i = symmetric ? j : 0; i < n; ++i) {
                if (coordinate && random.below(3) == 0) continue;
                const double value = random.uniform(-3, 3);
                matrix(i, j) = value;
                if (symmetric) matrix(j, i) = value;
                const std::string place =
                    coordinate ? std::to_string(i + 1) + " \t" + std::to_string(j + 1) + " " : "";
                lines.push_back(place + text_of(value));
            }
        }
        lines[1] = std::to_string(n) + " " + std::to_string(n);
        if (coordinate) lines[1] += " " + std::to_string(lines.size() - 2);
    }
    std::string text(const std::string& end) const {
        std::string all;
        for (const auto& line : lines) all += line + end;
        return all;
    }
};

}  // namespace

TEST_CASE("matrix_market: what was written is read", "[programs]") {
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        INFO("seed " << seed);
        Random random(seed);
        Written written(random);
        written.lines.insert(written.lines.begin() + 1, {"% a comment", "", "%"});
        const MatrixText file(written.text(seed % 3 == 0 ? "\r\n" : "\n"));
        const auto read = example::read_matrix_market(file.path);
        const auto matrix = read.matrix(written.matrix.rows());
        CHECK(Eigen::MatrixXd(matrix) == written.matrix);
    }
}

TEST_CASE("matrix_market: bad input: a word that is no number is refused by its line",
          "[programs][bad_input]") {
    const std::string nul(1, '\0');
    const std::vector<std::string> tails = {nul,  nul + "7", "x",    "\v1", " 1",  " " + nul,
                                            "\f", "e",       "\x1b", " %",  "..1", "_0"};
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        Random random(seed);
        Written written(random);
        const Index line = 1 + random.below(static_cast<Index>(written.lines.size()) - 1);
        auto& changed = written.lines[static_cast<std::size_t>(line)];
        changed += tails[random.below(static_cast<Index>(tails.size()))];
        INFO("seed " << seed << ": " << changed);
        const std::string told = complaint(written.text("\n"));
        CHECK_THAT(told, ContainsSubstring("line " + std::to_string(line + 1) + ": "));
        CHECK_THAT(told, !ContainsSubstring("\x1b") && !ContainsSubstring(nul));
    }
    const std::string banner = "%%MatrixMarket matrix coordinate real general\n";
    for (const std::string entry : {"1 1 0x10", "0x1 1 1", "1 1 nan", "1 1 inf", "1 1 1e999",
                                    "1.0 1 1", "1 1", "1", "0 1 1", "3 1 1", "1 -1 1"}) {
        INFO(entry);
        CHECK_THAT(complaint(banner + "2 2 1\n" + entry + "\n"), ContainsSubstring("line 3: "));
    }
}

TEST_CASE("matrix_market: bad input: a size is believed once there are entries for it",
          "[programs][bad_input]") {
    const auto as_masses = [](const example::MatrixMarketFile& file) { (void)file.mass_matrix(); };
    const auto beside_two = [](const example::MatrixMarketFile& file) { (void)file.matrix(2); };
    const std::string banner = "%%MatrixMarket matrix coordinate real ";
    for (const std::string kind : {"general", "symmetric"}) {
        const std::string text = banner + kind + "\n100000000 100000000 1\n1 1 1\n";
        CHECK_THAT(complaint(text, as_masses), ContainsSubstring("1 entries for 100000000 masses"));
        CHECK_THAT(complaint(text, beside_two),
                   ContainsSubstring("100000000 by 100000000") && ContainsSubstring("2 masses"));
    }
    const std::string wide = banner + "general\n1 100000000 1\n1 1 1\n";
    CHECK_THAT(complaint(wide, as_masses), ContainsSubstring("1 by 100000000"));
    CHECK_THAT(complaint(banner + "general\n100000001 1 1\n1 1 1\n"),
               ContainsSubstring("line 2: "));
    CHECK(complaint(banner + "general\n2 2 2\n1 1 1\n2 2 1\n", as_masses) == "");
}

}  // namespace taut_test::matrix_market_test
