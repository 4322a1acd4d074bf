// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "../core/buffer.hpp"
#include "../core/error.hpp"
#include "../network/state.hpp"
#include "detail/text_lines.hpp"

namespace taut {

/// What can become of a dump that is read.
enum class DumpStatus {
    ok,          ///< a frame was read
    end,         ///< the file ends, after a whole frame
    not_opened,  ///< no such file, or no right to read it
    foreign,     ///< this line is not what write_lammps asks LAMMPS for
    cut,         ///< the file ends within a frame, or before the first
    not_finite   ///< the line has a number that is not finite: the run diverged
};

/// One sentence for people.
constexpr const char* describe(DumpStatus status) {
    switch (status) {
        case DumpStatus::ok: return "a frame was read";
        case DumpStatus::end: return "there are no more frames";
        case DumpStatus::not_opened: return "cannot be opened";
        case DumpStatus::foreign: return "is no dump of this scene";
        case DumpStatus::cut: return "ends within a frame";
        case DumpStatus::not_finite: return "a position or velocity is not finite";
    }
    return "unknown status";
}

/// Outcome of reading a frame; false when there is none.
struct [[nodiscard]] DumpReport {
    DumpStatus status = DumpStatus::ok;
    std::string path;    ///< the file in question
    long long line = 0;  ///< where it was read, from 1; 0 before the first
    std::string what;    ///< of a foreign line: what is wrong with it

    /// Whether a frame was read.
    explicit operator bool() const { return status == DumpStatus::ok; }
    /// "taut.dump:9: is no dump of this scene: 8 particles; the scene has 9"
    std::string message() const {
        std::string text = path + (line > 0 ? ":" + std::to_string(line) : "");
        text += std::string(": ") + describe(status);
        return what.empty() ? text : text + ": " + what;
    }
};

/// Reads the frames of a dump that LAMMPS wrote for write_lammps(), one after the other, in the
/// memory of two of them:
///
///     taut::LammpsDump<double, 3> dump("taut.dump", system.size());
///     while (auto report = dump.read(state)) use(state);
///
/// It takes any text dump of style custom with TIME and the columns id and x y z, or xu yu zu, in
/// any order, sorted or not, with any other columns. Without vx vy vz, velocities are 0. With
/// UNITS, they must be si or lj.
template <class Scalar, int Dim>
class LammpsDump {
    static_assert(Dim >= 1 && Dim <= 3, "taut::LammpsDump<Scalar, Dim>: Dim must be 1, 2 or 3");

public:
    /// @param particles  of the scene, ≥ 1; each frame must have as many
    LammpsDump(std::string path, Index particles) : lines_(path), particles_(particles) {
        if (particles < 1) fail("LammpsDump: particles is ", particles, "; it must be >= 1");
        report_.path = std::move(path);
        if (!lines_.is_open()) report_.status = DumpStatus::not_opened;
    }

    /// Reads the next frame: x, m, v, m/s, and the time since LAMMPS began, s. After anything but
    /// ok, `state` is as it was, and every further call says the same.
    DumpReport read(State<Scalar, Dim>& state);
    /// Frames read so far.
    Index frames() const { return frames_; }
    /// Whether the last frame had velocities.
    bool has_velocities() const { return has_velocities_; }

private:
    enum Column { id, x, v = x + Dim, columns = v + Dim, other = columns };

    bool read_frame();
    bool read_columns(const char* names);
    bool read_particle();
    /// The next line, or false: the file is cut there.
    bool next() {
        if (lines_.next()) return true;
        return missing();
    }
    bool missing() {
        return lines_.binary() ? stop(DumpStatus::foreign, "it is no text") : stop(DumpStatus::cut);
    }
    bool stop(DumpStatus status, std::string what = {}) {
        report_.status = status;
        report_.what = std::move(what);
        return false;
    }

    io_detail::TextLines lines_;
    Index particles_;
    Index frames_ = 0;
    bool has_velocities_ = false;
    DumpReport report_;
    State<Scalar, Dim> frame_;
    std::vector<Column> order_;        // of the columns
    std::vector<unsigned char> seen_;  // of each particle: whether the frame has had it
};

template <class Scalar, int Dim>
DumpReport LammpsDump<Scalar, Dim>::read(State<Scalar, Dim>& state) {
    if (report_.status != DumpStatus::ok) return report_;
    const bool read = read_frame();
    report_.line = lines_.number();
    if (read) {
        ++frames_;
        std::swap(state, frame_);
    }
    return report_;
}

template <class Scalar, int Dim>
bool LammpsDump<Scalar, Dim>::read_frame() {
    if (!lines_.next()) {
        const bool ended = frames_ > 0 && !lines_.broken();
        return ended ? stop(DumpStatus::end) : missing();
    }
    bool timed = false;
    bool counted = false;
    for (;;) {
        const char* rest = nullptr;
        if (lines_.is("ITEM: TIMESTEP")) {
            if (!next()) return false;
        } else if (lines_.is("ITEM: TIME")) {
            double time = 0;
            if (!next()) return false;
            if (!lines_.only(time)) return stop(DumpStatus::foreign, "the time is no number");
            frame_.time = static_cast<Scalar>(time);
            timed = true;
        } else if (lines_.is("ITEM: UNITS")) {
            if (!next()) return false;
            if (!lines_.is("si") && !lines_.is("lj")) {
                return stop(DumpStatus::foreign, "its units are neither si nor lj");
            }
        } else if (lines_.is("ITEM: NUMBER OF ATOMS")) {
            long long count = 0;
            if (!next()) return false;
            if (!lines_.only(count) || count != particles_) {
                return stop(DumpStatus::foreign, "it has \"" + lines_.excerpt() +
                                                     "\" particles; the scene has " +
                                                     std::to_string(particles_));
            }
            counted = true;
        } else if (lines_.starts("ITEM: BOX BOUNDS")) {
            for (int d = 0; d < 3; ++d) {
                if (!next()) return false;
            }
        } else if ((rest = lines_.starts("ITEM: ATOMS")) != nullptr) {
            if (!timed) return stop(DumpStatus::foreign, "its frame has no ITEM: TIME");
            if (!counted) return stop(DumpStatus::foreign, "its frame has no NUMBER OF ATOMS");
            if (!read_columns(rest)) return false;
            break;
        } else {
            return stop(DumpStatus::foreign, "\"" + lines_.excerpt() + "\" begins no item of it");
        }
        if (!next()) return false;
    }
    frame_.x.resize(Dim, particles_);
    frame_.v.setZero(Dim, particles_);
    seen_.assign(static_cast<std::size_t>(particles_), 0);
    for (Index i = 0; i < particles_; ++i) {
        if (!next() || !read_particle()) return false;
    }
    return true;
}

template <class Scalar, int Dim>
bool LammpsDump<Scalar, Dim>::read_columns(const char* names) {
    order_.clear();
    detail::Few<int, columns> times{};
    io_detail::for_each_word(names, [&](const std::string& name) {
        Column column = name == "id" ? id : other;
        for (int d = 0; d < Dim; ++d) {
            const std::string axis(1, "xyz"[d]);
            if (name == axis || name == axis + "u") column = static_cast<Column>(x + d);
            if (name == "v" + axis) column = static_cast<Column>(v + d);
        }
        order_.push_back(column);
        if (column != other) ++times[column];
    });
    has_velocities_ = times[v] > 0;
    for (int column = id; column < columns; ++column) {
        const bool needed = column < v || has_velocities_;
        if (times[column] == (needed ? 1 : 0)) continue;
        return stop(DumpStatus::foreign, "its columns are \"" + lines_.excerpt() +
                                             "\"; there must be id, x (or xu) and, if any, vx for "
                                             "each dimension, once");
    }
    return true;
}

template <class Scalar, int Dim>
bool LammpsDump<Scalar, Dim>::read_particle() {
    lines_.rewind();
    detail::Few<double, columns> value{};
    long long number = 0;
    for (const Column column : order_) {
        if (column == id && !lines_.read(number)) {
            return stop(DumpStatus::foreign, "the id is no whole number");
        }
        if (column == other && !lines_.skip()) {
            return stop(DumpStatus::foreign, "it has too few columns");
        }
        if (column != id && column != other) {
            if (!lines_.read(value[column])) {
                return stop(DumpStatus::foreign, "a column is no number");
            }
            // An overflow of Scalar, too.
            const auto held = static_cast<Scalar>(value[column]);
            if (!detail::is_finite(held)) return stop(DumpStatus::not_finite);
        }
    }
    if (!lines_.at_end()) return stop(DumpStatus::foreign, "it has too many columns");
    if (number < 1 || number > particles_) {
        return stop(DumpStatus::foreign, "the id " + std::to_string(number) +
                                             " is no particle; they are 1 to " +
                                             std::to_string(particles_));
    }
    const auto i = static_cast<Index>(number - 1);
    if (std::exchange(seen_[static_cast<std::size_t>(i)], 1) != 0) {
        return stop(DumpStatus::foreign, "the id " + std::to_string(number) + " comes twice");
    }
    for (int d = 0; d < Dim; ++d) {
        frame_.x(d, i) = static_cast<Scalar>(value[x + d]);
        frame_.v(d, i) = static_cast<Scalar>(value[v + d]);
    }
    return true;
}

}  // namespace taut
