// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cctype>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
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
    std::string_view words = lines.line;
    std::string banner, object, format, field, symmetry;
    for (auto* word : {&banner, &object, &format, &field, &symmetry}) *word = next_word(words);
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
        lines.fail("format " + in_quotes(format) + "; coordinate or array");
    if (field != "real" && field != "integer")
        lines.fail("field " + in_quotes(field) + "; real or integer");
    header.symmetric = symmetry == "symmetric";
    if (!header.symmetric && symmetry != "general")
        lines.fail(in_quotes(symmetry) + "; general or symmetric");

    if (!lines.next()) lines.fail("the size line is missing");
    words = lines.line;
    const bool complete = read_number(next_word(words), header.rows) &&
                          read_number(next_word(words), header.columns) &&
                          (!header.coordinate || read_number(next_word(words), header.entries));
    if (!complete || !next_word(words).empty() || header.rows <= 0 || header.columns <= 0 ||
        header.entries < 0 || header.rows > 100'000'000 || header.columns > 100'000'000) {
        lines.fail(in_quotes(lines.line) + " is no valid size line");
    }
    if (header.symmetric && header.rows != header.columns)
        lines.fail("a symmetric matrix must be square");
    return header;
}

/// What a Matrix Market file holds. It takes the memory of its entries, whatever size it announces.
struct MatrixMarketFile {
    std::string path;
    long long rows = 0;
    long long columns = 0;
    std::vector<Eigen::Triplet<double>> entries;

    /// The matrix. A size that the file announces is believed once as many masses were read.
    /// @throws std::runtime_error naming the file unless it is `size` by `size`
    taut::SparseMatrix<double> matrix(long long size) const {
        if (rows != size || columns != size) {
            throw std::runtime_error(path + ": is " + std::to_string(rows) + " by " +
                                     std::to_string(columns) + "; there are " +
                                     std::to_string(size) + " masses");
        }
        taut::SparseMatrix<double> result(rows, columns);
        result.setFromTriplets(entries.begin(), entries.end());
        return result;
    }
    /// The same of a mass matrix, every row of which has an entry.
    taut::SparseMatrix<double> mass_matrix() const {
        const auto count = static_cast<long long>(entries.size());
        if (count < rows) {
            throw std::runtime_error(path + ": has " + std::to_string(count) + " entries for " +
                                     std::to_string(rows) + " masses");
        }
        return matrix(rows);
    }
};

/// Reads a real or integer matrix in Matrix Market coordinate or array form, general or symmetric
/// (both triangles are returned). Throws std::runtime_error naming file, line and reason.
inline MatrixMarketFile read_matrix_market(const std::string& path) {
    MatrixMarketLines lines(path);
    const auto [coordinate, symmetric, rows, columns, entries] = read_header(lines);
    MatrixMarketFile file{path, rows, columns, {}};
    const auto add = [&file, both = symmetric](long long i, long long j, double value) {
        const auto row = static_cast<int>(i);
        const auto column = static_cast<int>(j);
        file.entries.emplace_back(row, column, value);
        if (both && i != j) file.entries.emplace_back(column, row, value);
    };
    double value = 0;
    for (long long e = 0; coordinate && e < entries; ++e) {
        if (!lines.next()) {
            lines.fail("ends after " + std::to_string(e) + " of " + std::to_string(entries) +
                       " entries");
        }
        std::string_view words = lines.line;
        long long i = 0, j = 0;
        if (!read_number(next_word(words), i) || !read_number(next_word(words), j) ||
            !read_number(next_word(words), value) || !next_word(words).empty() || i < 1 || j < 1 ||
            i > rows || j > columns) {
            lines.fail(in_quotes(lines.line) + " is no entry of a " + std::to_string(rows) +
                       " by " + std::to_string(columns) + " matrix of finite numbers");
        }
        if (symmetric && i < j) lines.fail("a symmetric matrix is given by its lower triangle");
        add(i - 1, j - 1, value);
    }
    for (long long j = 0; !coordinate && j < columns; ++j) {
        for (long long i = symmetric ? j : 0; i < rows; ++i) {
            if (!lines.next()) lines.fail("ends before the matrix is complete");
            std::string_view words = lines.line;
            if (!read_number(next_word(words), value) || !next_word(words).empty())
                lines.fail(in_quotes(lines.line) + " is not one finite number");
            add(i, j, value);
        }
    }
    if (lines.next()) lines.fail("more entries than announced");
    return file;
}

}  // namespace example
