// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "detail/number_text.hpp"
#include "detail/output_file.hpp"
#include "mesh_sequence.hpp"

namespace taut {

/// Writes points, faces and edges as a Wavefront OBJ file, metres, one vertex a particle; corner
/// indices are 0-based here and 1-based in the file. A scene in one or two dimensions gets zeros
/// for the rest.
template <class Scalar, int Dim>
FileReport write_obj(const std::string& path, const Points<Scalar, Dim>& x, const MeshFaces& faces,
                     const MeshEdges& edges = {}) {
    if (const Index i = io_detail::first_unwritable<double>(x); i >= 0) {
        return {FileStatus::not_finite, path, i};
    }
    io_detail::require_mesh("write_obj", x.cols(), faces, edges);
    io_detail::OutputFile out(path);
    if (!out.is_open()) return out.report();
    for (Index i = 0; i < x.cols(); ++i) {
        std::fputs("v ", out.get());
        io_detail::put_column(out.get(), x, i);
    }
    const auto put_line = [&](char kind, const auto& corners) {
        std::fputc(kind, out.get());
        for (const Index i : corners)
            std::fprintf(out.get(), " %lld", static_cast<long long>(i) + 1);
        std::fputc('\n', out.get());
    };
    for (const auto& face : faces) put_line('f', face);
    for (const auto& edge : edges) put_line('l', edge);
    return out.close();
}

namespace io_detail {

struct ObjFormat {
    static constexpr const char* extension = ".obj";
    template <class Scalar, int Dim>
    static FileReport write(const std::string& path, const Points<Scalar, Dim>& x,
                            const MeshFaces& faces, const MeshEdges& edges) {
        return write_obj(path, x, faces, edges);
    }
};

}  // namespace io_detail

/// One OBJ file a frame.
using ObjSequence = MeshSequence<io_detail::ObjFormat>;

}  // namespace taut
