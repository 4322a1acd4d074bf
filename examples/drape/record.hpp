// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "../common/output_text.hpp"
#include "cloth.hpp"
#include "earlier_frames.hpp"
#include "source_obj.hpp"

namespace drape {

/// The files of a run. Everything throws naming the option and the file.
class Record {
public:
    /// @param first   the first frame that will be written; those before it stay
    /// @param frames  the last one
    Record(const Options& options, const example::Scene& scene, int first, int frames);

    /// The next frame. @param kinetic, potential  J
    void add(const Cloth& cloth, const State& state, double kinetic, double potential);
    /// The energy of a frame that is not shown.
    void add_energy(double time, double kinetic, double potential);
    void close();
    const std::string& energy_path() const { return energy_path_; }

private:
    static void require(const char* option, const taut::FileReport& report) {
        if (!report) throw std::runtime_error(std::string(option) + ": " + report.message());
    }
    using Frames = std::variant<taut::ObjSequence, taut::PlySequence, SourceSequence>;

    static Frames make_frames(const Options& options, const example::Scene& scene, int first);
    /// What the frames and the cache show: the mesh's own vertices, or in PLY files the particles.
    taut::Points<double, 3> shown(const taut::Points<double, 3>& particles) const {
        if (std::holds_alternative<SourceSequence>(frames_)) return scene_.drawn(particles);
        return particles / scene_.unit;
    }
    std::string path(taut::Index frame) const {
        return std::visit([frame](const auto& frames) { return frames.path(frame); }, frames_);
    }
    /// Of the next frame.
    std::string path() const {
        return path(std::visit([](const auto& frames) { return frames.frames(); }, frames_));
    }
    std::string springs_path(std::string frame) const;
    void require_different_files(const Options& options, int first, int frames) const;
    void open_cache(const std::string& path, int first);
    /// A longer run before this one would be taken for the end of it.
    void warn_of_old_frames() const;

    const example::Scene& scene_;
    std::string energy_path_;
    bool springs_;
    Frames frames_;
    std::optional<taut::Pc2Writer> cache_;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> energy_{nullptr, &std::fclose};
};

inline Record::Frames Record::make_frames(const Options& options, const example::Scene& scene,
                                          int first) {
    std::string prefix = options.output + "/frame_";
    if (options.format == "obj" && !options.scene.is_built_in())
        return SourceSequence(options.output, options.scene.mesh, scene.vertices.cols(), first);
    taut::MeshFaces polygons;
    taut::MeshEdges lines;
    for (const auto& face : scene.faces) {
        if (face.size() > 2) polygons.push_back(face);
        if (face.size() == 2) lines.push_back({face[0], face[1]});
    }
    if (options.format == "ply")
        return taut::PlySequence(std::move(prefix), std::move(polygons), std::move(lines), first);
    if (options.format == "obj")
        return taut::ObjSequence(std::move(prefix), std::move(polygons), std::move(lines), first);
    throw std::logic_error("--format: no frames as " + options.format);
}

inline void Record::require_different_files(const Options& options, int first, int frames) const {
    const example::FileOption mesh{"MESH", options.scene.mesh, false};
    const example::FileOption cache{"--cache", options.cache, true};
    example::require_different({mesh, cache, {"--output", energy_path_, true}});
    example::require_different({mesh, cache, {"--output", options.state_path(), true}});
    for (taut::Index frame = first; frame <= frames; ++frame) {
        example::require_different({mesh, cache, {"--output", path(frame), true}});
        if (!springs_) continue;
        example::require_different({mesh, cache, {"--springs", springs_path(path(frame)), true}});
    }
}

inline Record::Record(const Options& options, const example::Scene& scene, int first, int frames)
    : scene_(scene),
      energy_path_(options.output + "/energy.csv"),
      springs_(options.springs),
      frames_(make_frames(options, scene, first)) {
    require_different_files(options, first, frames);
    std::error_code failed;
    std::filesystem::create_directories(options.output, failed);
    const auto earlier = first > 0 ? earlier_energies(energy_path_, first) : std::string();
    if (!failed) energy_.reset(std::fopen(energy_path_.c_str(), "w"));
    if (energy_ == nullptr) {
        throw std::runtime_error("--output: " + energy_path_ + " cannot be written");
    }
    std::fprintf(energy_.get(), "time_s,kinetic_J,potential_J,total_J\n%s", earlier.c_str());
    if (!options.cache.empty()) open_cache(options.cache, first);
}

inline void Record::open_cache(const std::string& path, int first) {
    const auto points = shown(scene_.system.initial_state().x).cols();
    const auto earlier = first > 0 ? earlier_samples(path, points, first) : EarlierSamples();
    cache_.emplace(path, points);
    for (const auto& x : earlier) require("--cache", cache_->write(x));
}

inline void Record::add_energy(double time, double kinetic, double potential) {
    std::fprintf(energy_.get(), "%.9g,%.9g,%.9g,%.9g\n", time, kinetic, potential,
                 kinetic + potential);
}

inline void Record::add(const Cloth& cloth, const State& state, double kinetic, double potential) {
    add_energy(state.time, kinetic, potential);
    std::fflush(energy_.get());
    if (springs_) {
        require("--springs", taut::write_vtk(springs_path(path()), cloth, state));
    }
    const taut::Points<double, 3> x = shown(state.x);
    if (cache_) require("--cache", cache_->write(x));
    require("--output", std::visit([&](auto& frames) { return frames.write(x); }, frames_));
}

inline void Record::close() {
    const bool written = std::ferror(energy_.get()) == 0;
    if (std::fclose(energy_.release()) != 0 || !written) {
        throw std::runtime_error("--output: " + energy_path_ + " cannot be written");
    }
    if (cache_) require("--cache", cache_->close());
    warn_of_old_frames();
}

inline std::string Record::springs_path(std::string frame) const {
    return frame.replace(frame.rfind('.') + 1, std::string::npos, "vtk");
}

inline void Record::warn_of_old_frames() const {
    std::error_code failed;
    const std::string next = path();
    if (!std::filesystem::exists(next, failed)) return;
    std::fprintf(stderr, "drape: --output: %s and any after it are of an earlier run\n",
                 next.c_str());
}

}  // namespace drape
