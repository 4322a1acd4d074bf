// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <taut/core/types.hpp>
#include <vector>

#include "number.hpp"

namespace example {

/// The lines of a Matrix Market file, without comments and empty ones.
struct MatrixMarketLines {
    std::string path;
    std::ifstream file;
    std::string line;
    long long number = 0;

    explicit MatrixMarketLines(const std::string& name) : path(name), file(name) {
        if (!file) throw std::runtime_error(path + ": cannot be opened");
    }
    bool next() {
        while (std::getline(file, line)) {
            ++number;
            const bool comment = number > 1 && !line.empty() && line[0] == '%';
            if (!comment && line.find_first_not_of(" \t\r") != std::string::npos) return true;
        }
        return false;
    }
    [[noreturn]] void fail(const std::string& why) const {
        throw std::runtime_error(path + ", line " + std::to_string(number) + ": " + why);
    }
};

struct MatrixMarketHeader {
    bool coordinate = false;
    bool symmetric = false;
    long long rows = 0;
    long long columns = 0;
    long long entries = 0;  // of the coordinate form
};

inline MatrixMarketHeader read_header(MatrixMarketLines& lines) {
    if (!lines.next()) lines.fail("the file is empty");
    std::string banner, object, format, field, symmetry;
    std::istringstream words(lines.line);
    words >> banner >> object >> format >> field >> symmetry;
    for (auto* word : {&object, &format, &field, &symmetry}) {
        std::transform(word->begin(), word->end(), word->begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    }
    if (banner != "%%MatrixMarket" || object != "matrix") {
        lines.fail("a Matrix Market file begins with \"%%MatrixMarket matrix\"");
    }
    MatrixMarketHeader header;
    header.coordinate = format == "coordinate";
    if (!header.coordinate && format != "array")
        lines.fail("format \"" + format + "\"; coordinate or array");
    if (field != "real" && field != "integer")
        lines.fail("field \"" + field + "\"; real or integer");
    header.symmetric = symmetry == "symmetric";
    if (!header.symmetric && symmetry != "general")
        lines.fail("\"" + symmetry + "\"; general or symmetric");

    if (!lines.next()) lines.fail("the size line is missing");
    const char* text = lines.line.c_str();
    const bool complete = read_number(text, header.rows) && read_number(text, header.columns) &&
                          (!header.coordinate || read_number(text, header.entries));
    if (!complete || !at_end(text) || header.rows <= 0 || header.columns <= 0 ||
        header.entries < 0 || header.rows > 100'000'000 || header.columns > 100'000'000) {
        lines.fail("\"" + lines.line + "\" is no valid size line");
    }
    if (header.symmetric && header.rows != header.columns)
        lines.fail("a symmetric matrix must be square");
    return header;
}

/// Reads a real or integer matrix in Matrix Market coordinate or array form, general or symmetric
/// (both triangles are returned). Throws std::runtime_error naming file, line and reason.
inline taut::SparseMatrix<double> read_matrix_market(const std::string& path) {
    MatrixMarketLines lines(path);
    const auto [coordinate, symmetric, rows, columns, entries] = read_header(lines);
    std::vector<Eigen::Triplet<double>> triplets;
    const auto add = [&triplets, both = symmetric](long long i, long long j, double value) {
        triplets.emplace_back(static_cast<int>(i), static_cast<int>(j), value);
        if (both && i != j) triplets.emplace_back(static_cast<int>(j), static_cast<int>(i), value);
    };
    double value = 0;
    for (long long e = 0; coordinate && e < entries; ++e) {
        if (!lines.next()) {
            lines.fail("ends after " + std::to_string(e) + " of " + std::to_string(entries) +
                       " entries");
        }
        const char* text = lines.line.c_str();
        long long i = 0, j = 0;
        if (!read_number(text, i) || !read_number(text, j) || !read_number(text, value) ||
            !at_end(text) || i < 1 || j < 1 || i > rows || j > columns) {
            lines.fail("\"" + lines.line + "\" is no entry of a " + std::to_string(rows) + " by " +
                       std::to_string(columns) + " matrix of finite numbers");
        }
        if (symmetric && i < j) lines.fail("a symmetric matrix is given by its lower triangle");
        add(i - 1, j - 1, value);
    }
    for (long long j = 0; !coordinate && j < columns; ++j) {
        for (long long i = symmetric ? j : 0; i < rows; ++i) {
            if (!lines.next()) lines.fail("ends before the matrix is complete");
            const char* text = lines.line.c_str();
            if (!read_number(text, value) || !at_end(text))
                lines.fail("\"" + lines.line + "\" is not one finite number");
            add(i, j, value);
        }
    }
    if (lines.next()) lines.fail("more entries than announced");
    taut::SparseMatrix<double> matrix(rows, columns);
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    return matrix;
}

}  // namespace example
