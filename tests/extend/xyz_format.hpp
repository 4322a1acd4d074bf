// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <fstream>
#include <taut/mesh_files/mesh_sequence.hpp>

namespace taut_test {

/// XYZ, as OVITO and VMD read it: the number of points, a line of words, a line for each point, m.
struct XyzFormat {
    static constexpr const char* extension = ".xyz";

    template <class Scalar, int Dim>
    static taut::FileReport write(const std::string& path, const taut::Points<Scalar, Dim>& x,
                                  const taut::MeshFaces&, const taut::MeshEdges&) {
        for (Index i = 0; i < x.cols(); ++i) {
            if (!x.col(i).allFinite()) return {taut::FileStatus::not_finite, path, i};
        }
        std::ofstream out(path);
        if (!out) return {taut::FileStatus::not_opened, path};
        out.precision(17);
        out << x.cols() << "\nmetres\n";
        for (Index i = 0; i < x.cols(); ++i) {
            out << 'P';
            for (int d = 0; d < 3; ++d) out << ' ' << (d < Dim ? x(d, i) : Scalar(0));
            out << '\n';
        }
        out.close();
        return {out ? taut::FileStatus::ok : taut::FileStatus::not_written, path};
    }
};

}  // namespace taut_test
