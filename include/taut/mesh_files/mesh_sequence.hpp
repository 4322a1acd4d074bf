// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "../core/error.hpp"
#include "file_report.hpp"

namespace taut {

/// The corners of each face, particles from 0, in order round it.
using MeshFaces = std::vector<std::vector<Index>>;
/// The ends of each edge, particles from 0. A system's springs:
///     system.for_each_spring([&](Index a, Index b) { edges.push_back({a, b}); });
using MeshEdges = std::vector<std::array<Index, 2>>;

/// A sequence of files of one mesh, one a frame: prefix00000.obj, prefix00001.obj and so on.
/// @tparam Format  `extension` with its point, and `write(path, x, faces, edges)`
template <class Format>
class MeshSequence {
public:
    /// @param prefix        of every path, folders in it must exist
    /// @param faces, edges  as the format's writer takes them
    /// @param first         the frame to begin with, where a run goes on that was ended
    explicit MeshSequence(std::string prefix, MeshFaces faces, MeshEdges edges = {},
                          Index first = 0)
        : prefix_(std::move(prefix)),
          faces_(std::move(faces)),
          edges_(std::move(edges)),
          frames_(first) {}

    /// Writes the next frame, m; after a failure the same one again.
    template <class Scalar, int Dim>
    FileReport write(const Points<Scalar, Dim>& x) {
        FileReport report = Format::write(path(frames_), x, faces_, edges_);
        if (report) ++frames_;
        return report;
    }
    /// The next frame: those written so far, where the first was 0.
    Index frames() const { return frames_; }
    /// Of a frame, written or not.
    std::string path(Index frame) const {
        const std::string number = std::to_string(frame);
        const std::size_t zeros = number.size() < 5 ? 5 - number.size() : 0;
        return prefix_ + std::string(zeros, '0') + number + Format::extension;
    }

private:
    std::string prefix_;
    MeshFaces faces_;
    MeshEdges edges_;
    Index frames_;
};

namespace io_detail {

/// Fails naming the first corner or end that is no particle.
inline void require_mesh(const char* function, Index particles, const MeshFaces& faces,
                         const MeshEdges& edges) {
    const auto require_corners = [&](const char* part, std::size_t index, const char* role,
                                     const auto& of) {
        for (const Index i : of) {
            if (i >= 0 && i < particles) continue;
            fail(function, ": ", part, " ", index, " has the ", role, " ", i, "; there are ",
                 particles, " positions");
        }
    };
    for (std::size_t f = 0; f < faces.size(); ++f) require_corners("face", f, "corner", faces[f]);
    for (std::size_t e = 0; e < edges.size(); ++e) require_corners("edge", e, "end", edges[e]);
}

}  // namespace io_detail
}  // namespace taut
