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

namespace example {

/// Reads a real or integer matrix in Matrix Market coordinate or array form, general or symmetric
/// (both triangles are returned). Throws std::runtime_error naming file, line and reason.
inline taut::SparseMatrix<double> read_matrix_market(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error(path + ": cannot be opened");
    int line_number = 0;
    std::string line;
    const auto fail = [&](const std::string& why) {
        throw std::runtime_error(path + ", line " + std::to_string(line_number) + ": " + why);
    };
    const auto next = [&]() -> bool {
        while (std::getline(file, line)) {
            ++line_number;
            const bool comment = line_number > 1 && !line.empty() && line[0] == '%';
            if (!comment && line.find_first_not_of(" \t\r") != std::string::npos) return true;
        }
        return false;
    };
    if (!next()) fail("the file is empty");
    std::string banner, object, format, field, symmetry;
    std::istringstream header(line);
    header >> banner >> object >> format >> field >> symmetry;
    for (auto* word : {&object, &format, &field, &symmetry}) {
        std::transform(word->begin(), word->end(), word->begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    }
    if (banner != "%%MatrixMarket" || object != "matrix") {
        fail("a Matrix Market file begins with \"%%MatrixMarket matrix\"");
    }
    const bool coordinate = format == "coordinate";
    if (!coordinate && format != "array") fail("format \"" + format + "\"; coordinate or array");
    if (field != "real" && field != "integer") fail("field \"" + field + "\"; real or integer");
    const bool symmetric = symmetry == "symmetric";
    if (!symmetric && symmetry != "general") fail("\"" + symmetry + "\"; general or symmetric");

    long long rows = 0, columns = 0, entries = 0;
    if (!next()) fail("the size line is missing");
    std::istringstream size(line);
    size >> rows >> columns;
    if (coordinate) size >> entries;
    if (!size || rows <= 0 || columns <= 0 || entries < 0 || rows > 100'000'000 ||
        columns > 100'000'000) {
        fail("\"" + line + "\" is no valid size line");
    }
    if (symmetric && rows != columns) fail("a symmetric matrix must be square");

    std::vector<Eigen::Triplet<double>> triplets;
    const auto add = [&](long long i, long long j, double value) {
        triplets.emplace_back(static_cast<int>(i), static_cast<int>(j), value);
        if (symmetric && i != j)
            triplets.emplace_back(static_cast<int>(j), static_cast<int>(i), value);
    };
    if (coordinate) {
        for (long long e = 0; e < entries; ++e) {
            if (!next())
                fail("ends after " + std::to_string(e) + " of " + std::to_string(entries) +
                     " entries");
            std::istringstream entry(line);
            long long i = 0, j = 0;
            std::string number;
            entry >> i >> j >> number;
            if (!entry || i < 1 || j < 1 || i > rows || j > columns) {
                fail("\"" + line + "\" is no entry of a " + std::to_string(rows) + " by " +
                     std::to_string(columns) + " matrix");
            }
            add(i - 1, j - 1, std::strtod(number.c_str(), nullptr));
        }
    } else {
        for (long long j = 0; j < columns; ++j) {
            for (long long i = symmetric ? j : 0; i < rows; ++i) {
                if (!next()) fail("ends before the matrix is complete");
                add(i, j, std::strtod(line.c_str(), nullptr));
            }
        }
    }
    if (next()) fail("more entries than announced");
    taut::SparseMatrix<double> matrix(rows, columns);
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    return matrix;
}

}  // namespace example
