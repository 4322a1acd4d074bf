// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "../core/error.hpp"
#include "detail/number_text.hpp"
#include "detail/output_file.hpp"

namespace taut {

/// Writes points and faces as a Wavefront OBJ file, metres, one vertex a particle; corner indices
/// are 0-based here and 1-based in the file. A scene in one or two dimensions gets zeros for the
/// rest.
template <class Scalar, int Dim>
FileReport write_obj(const std::string& path, const Points<Scalar, Dim>& x,
                     const std::vector<std::vector<Index>>& faces) {
    if (const Index i = detail::first_unwritable<double>(x); i >= 0) {
        return {FileStatus::not_finite, path, i};
    }
    for (std::size_t f = 0; f < faces.size(); ++f) {
        for (const Index corner : faces[f]) {
            if (corner >= 0 && corner < x.cols()) continue;
            fail("write_obj: face ", f, " has the corner ", corner, "; there are ", x.cols(),
                 " positions");
        }
    }
    detail::OutputFile out(path);
    if (!out.is_open()) return out.check();
    for (Index i = 0; i < x.cols(); ++i) {
        double p[3] = {0, 0, 0};
        for (int d = 0; d < Dim; ++d) p[d] = static_cast<double>(x(d, i));
        std::fputs("v ", out.get());
        detail::put_numbers(out.get(), p);
    }
    for (const auto& face : faces) {
        std::fputc('f', out.get());
        for (const Index corner : face)
            std::fprintf(out.get(), " %lld", static_cast<long long>(corner) + 1);
        std::fputc('\n', out.get());
    }
    return out.close();
}

/// A sequence of OBJ files, prefix00000.obj, prefix00001.obj and so on, one a frame.
class ObjSequence {
public:
    /// @param prefix  of every path, folders in it must exist
    /// @param faces   as write_obj takes them
    ObjSequence(std::string prefix, std::vector<std::vector<Index>> faces)
        : prefix_(std::move(prefix)), faces_(std::move(faces)) {}

    /// Writes the next frame, m; after a failure the same one again.
    template <class Scalar, int Dim>
    FileReport write(const Points<Scalar, Dim>& x) {
        FileReport report = write_obj(path(frames_), x, faces_);
        if (report) ++frames_;
        return report;
    }
    /// Frames written so far.
    Index frames() const { return frames_; }
    /// Of a frame, written or not.
    std::string path(Index frame) const {
        const std::string number = std::to_string(frame);
        const std::size_t zeros = number.size() < 5 ? 5 - number.size() : 0;
        return prefix_ + std::string(zeros, '0') + number + ".obj";
    }

private:
    std::string prefix_;
    std::vector<std::vector<Index>> faces_;
    Index frames_ = 0;
};

}  // namespace taut
