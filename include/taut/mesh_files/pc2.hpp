// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "../core/error.hpp"
#include "detail/little_endian.hpp"
#include "detail/output_file.hpp"

namespace taut {

/// The times of a point cache.
struct Pc2Options {
    float start = 0;     ///< frame number of the first sample
    float sampling = 1;  ///< frames from one sample to the next, > 0
};

/// A PC2 point cache, frame after frame: the positions of a mesh's vertices as 3DS Max's Point
/// Cache 2 writes them and Blender's Mesh Cache modifier reads them.
///
/// Little-endian: "POINTCACHE2\0", then int32 version (1) and number of points, float start and
/// sampling, int32 number of samples; after these 32 bytes the samples, float x y z a point. The
/// number of samples is brought up to date with every frame, so that a run cut short leaves a cache
/// of the frames it had.
///
/// In Blender: import the first frame as OBJ, add a Mesh Cache modifier of format PC2 to it, and
/// leave its axes as they are: the cache has the coordinates of the OBJ.
class Pc2Writer {
public:
    /// Replaces the file. @param points  in every frame, 1 … 2³¹ − 1
    Pc2Writer(std::string path, Index points, const Pc2Options& options = {});

    /// Appends a frame, m. Nothing is appended when a position is not finite as a float.
    /// @param x  Dim × points; one or two dimensions get zeros for the rest
    template <class Scalar, int Dim>
    FileReport write(const Points<Scalar, Dim>& x);
    /// What became of the file as a whole; a destructor could not say. Frames after it are
    /// not_opened.
    FileReport close() { return file_.close(); }
    /// Frames written so far.
    Index frames() const { return frames_; }

private:
    /// The path, once all else is right: opening the file empties it.
    static std::string checked(std::string path, Index points, const Pc2Options& options);

    static constexpr long count_at = 28;  // of the number of samples, bytes

    io_detail::OutputFile file_;
    Index points_;
    Index frames_ = 0;
    std::vector<unsigned char> frame_;
};

inline std::string Pc2Writer::checked(std::string path, Index points, const Pc2Options& options) {
    if (points < 1 || points > (std::numeric_limits<std::int32_t>::max)()) {
        fail("Pc2Writer: points is ", points, "; it must be 1 to 2147483647");
    }
    if (!((std::abs)(options.start) <= (std::numeric_limits<float>::max)())) {
        fail("Pc2Writer: start is ", options.start, "; it must be finite");
    }
    require_positive("Pc2Writer", "sampling", options.sampling);
    return path;
}

inline Pc2Writer::Pc2Writer(std::string path, Index points, const Pc2Options& options)
    : file_(checked(std::move(path), points, options)), points_(points) {
    if (!file_.is_open()) return;
    unsigned char header[32] = "POINTCACHE2";
    io_detail::put_bytes(std::uint32_t(1), header + 12);
    io_detail::put_bytes(static_cast<std::uint32_t>(points), header + 16);
    io_detail::put_bytes(options.start, header + 20);
    io_detail::put_bytes(options.sampling, header + 24);
    io_detail::put_bytes(std::uint32_t(0), header + count_at);
    std::fwrite(header, 1, sizeof header, file_.get());
    frame_.resize(12 * static_cast<std::size_t>(points));
}

template <class Scalar, int Dim>
FileReport Pc2Writer::write(const Points<Scalar, Dim>& x) {
    if (x.cols() != points_) {
        fail("Pc2Writer::write: ", x.cols(), " positions; the cache has ", points_, " points");
    }
    if (const FileReport report = file_.report(); !report) return report;
    if (const Index i = io_detail::first_unwritable<float>(x); i >= 0) {
        return file_.report(FileStatus::not_finite, i);
    }
    io_detail::put_bytes(x, frame_.data());
    std::FILE* file = file_.get();
    unsigned char count[4];
    io_detail::put_bytes(static_cast<std::uint32_t>(frames_ + 1), count);
    const bool written = std::fwrite(frame_.data(), 1, frame_.size(), file) == frame_.size() &&
                         std::fseek(file, count_at, SEEK_SET) == 0 &&
                         std::fwrite(count, 1, sizeof count, file) == sizeof count &&
                         std::fseek(file, 0, SEEK_END) == 0 && std::fflush(file) == 0;
    if (!written) return file_.report(FileStatus::not_written);
    ++frames_;
    return file_.report();
}

}  // namespace taut
