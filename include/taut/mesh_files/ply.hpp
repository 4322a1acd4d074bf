// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "detail/little_endian.hpp"
#include "detail/output_file.hpp"
#include "mesh_sequence.hpp"

namespace taut {

/// Writes points, faces and edges as a binary little-endian PLY file (G. Turk, "The PLY polygon
/// file format", 1994), metres: per vertex float x y z, a vertex a particle; per face a list
/// vertex_indices; per edge int vertex1 vertex2, the element edge only where there are any. A scene
/// in one or two dimensions gets zeros for the rest. Some readers leave edges out: ParaView,
/// Assimp.
/// @param x      finite as floats; at most 2³¹ − 1 columns
/// @param faces  of at most 255 corners each
template <class Scalar, int Dim>
FileReport write_ply(const std::string& path, const Points<Scalar, Dim>& x, const MeshFaces& faces,
                     const MeshEdges& edges = {}) {
    if (x.cols() > (std::numeric_limits<std::int32_t>::max)()) {
        fail("write_ply: ", x.cols(), " positions; a PLY file holds at most 2147483647");
    }
    if (const Index i = io_detail::first_unwritable<float>(x); i >= 0) {
        return {FileStatus::not_finite, path, i};
    }
    io_detail::require_mesh("write_ply", x.cols(), faces, edges);
    std::size_t size = 12 * static_cast<std::size_t>(x.cols()) + 8 * edges.size();
    for (std::size_t f = 0; f < faces.size(); ++f) {
        if (faces[f].size() > 255) {
            fail("write_ply: face ", f, " has ", faces[f].size(),
                 " corners; at most 255 are allowed");
        }
        size += 1 + 4 * faces[f].size();
    }
    std::string header =
        "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(x.cols()) +
        "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
        std::to_string(faces.size()) + "\nproperty list uchar int vertex_indices\n";
    if (!edges.empty()) {
        header += "element edge " + std::to_string(edges.size()) +
                  "\nproperty int vertex1\nproperty int vertex2\n";
    }
    header += "end_header\n";

    std::vector<unsigned char> file(header.size() + size);
    unsigned char* bytes = std::copy(header.begin(), header.end(), file.data());
    bytes = io_detail::put_bytes(x, bytes);
    const auto put_corners = [&](const auto& corners) {
        for (const Index i : corners) {
            bytes = io_detail::put_bytes(static_cast<std::uint32_t>(i), bytes);
        }
    };
    for (const auto& face : faces) {
        *bytes++ = static_cast<unsigned char>(face.size());
        put_corners(face);
    }
    for (const auto& edge : edges) put_corners(edge);

    io_detail::OutputFile out(path);
    if (!out.is_open()) return out.report();
    std::fwrite(file.data(), 1, file.size(), out.get());
    return out.close();
}

namespace io_detail {

struct PlyFormat {
    static constexpr const char* extension = ".ply";
    template <class Scalar, int Dim>
    static FileReport write(const std::string& path, const Points<Scalar, Dim>& x,
                            const MeshFaces& faces, const MeshEdges& edges) {
        return write_ply(path, x, faces, edges);
    }
};

}  // namespace io_detail

/// One PLY file a frame.
using PlySequence = MeshSequence<io_detail::PlyFormat>;

}  // namespace taut
