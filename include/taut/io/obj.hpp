// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "../core/types.hpp"

namespace taut {

/// Writes points and faces as a Wavefront OBJ file, metres, one vertex a particle; corner indices
/// are 0-based here and 1-based in the file. A scene in one or two dimensions gets zeros for the
/// rest.
/// @returns false when the file cannot be written completely
template <class Scalar, int Dim>
bool write_obj(const std::string& path, const Points<Scalar, Dim>& x,
               const std::vector<std::vector<Index>>& faces) {
    std::FILE* file = std::fopen(path.c_str(), "w");
    if (file == nullptr) return false;
    for (Index i = 0; i < x.cols(); ++i) {
        double p[3] = {0, 0, 0};
        for (int d = 0; d < Dim; ++d) p[d] = static_cast<double>(x(d, i));
        std::fprintf(file, "v %.9g %.9g %.9g\n", p[0], p[1], p[2]);
    }
    for (const auto& face : faces) {
        std::fputc('f', file);
        for (const Index corner : face)
            std::fprintf(file, " %lld", static_cast<long long>(corner) + 1);
        std::fputc('\n', file);
    }
    const bool written = std::ferror(file) == 0;
    return std::fclose(file) == 0 && written;
}

}  // namespace taut
