// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>

#include "cloth.hpp"

namespace drape {

/// Where a run stands, for --resume: the state after a frame, in a file of the output's folder.
struct SavedState {
    taut::Index frame = 0;
    double start_energy = 0;  // J
    double frame_length = 0;  // s
    std::string settings;     // as of Options
    State state;
};

/// Throws naming the option by which a run differs from the one that it is to go on from.
inline void require_same(const SavedState& saved, const Options& options, double frame_length) {
    std::istringstream before(saved.settings), now(options.settings);
    for (std::string was, is; was != is || before || now;) {
        const bool more_before = static_cast<bool>(std::getline(before, was));
        const bool more_now = static_cast<bool>(std::getline(now, is));
        if (!more_before && !more_now) break;
        if (more_before && more_now && was == is) continue;
        throw std::runtime_error("--resume: the run before this one had \"" +
                                 (more_before ? was : "no more options") + "\", not \"" +
                                 (more_now ? is : "no more options") + "\"");
    }
    if (std::abs(saved.frame_length - frame_length) > 1e-9 * frame_length) {
        throw std::runtime_error(
            "--resume: --duration: frames would be of another length; a whole number of frames "
            "keeps it");
    }
}

namespace detail {

/// What begins the file. Another machine's order of bytes, or another mesh, shows here.
struct SavedHeader {
    std::array<char, 16> mark{};
    std::uint64_t order = 1;
    std::uint64_t particles = 0;
    std::uint64_t scene = 0;
    std::int64_t frame = 0;
    double start_energy = 0;
    double time = 0;
    double frame_length = 0;
    std::uint64_t settings = 0;  // bytes of text that follow
};

inline std::array<char, 16> saved_mark() {
    std::array<char, 16> mark{};
    std::memcpy(mark.data(), "taut drape 3\n", 13);
    return mark;
}

/// FNV-1a over the particles as they were laid out.
inline std::uint64_t fingerprint(const Cloth& cloth) {
    const auto x = cloth.initial_state().x;
    std::uint64_t hash = 14695981039346656037U;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, x.data() + i, sizeof bits);
        hash = (hash ^ bits) * 1099511628211U;
    }
    return hash;
}

template <class Values>
void put(std::ofstream& file, const Values* values, Eigen::Index count) {
    file.write(reinterpret_cast<const char*>(values),
               static_cast<std::streamsize>(sizeof(Values)) * count);
}
template <class Values>
void take(std::ifstream& file, Values* values, Eigen::Index count) {
    file.read(reinterpret_cast<char*>(values),
              static_cast<std::streamsize>(sizeof(Values)) * count);
}

}  // namespace detail

/// Replaces the file in one go, so that a run that is killed leaves a whole one. Throws naming it.
inline void save(const std::string& path, const Cloth& cloth, const SavedState& saved) {
    const std::string draft = path + ".part";
    std::ofstream file(draft, std::ios::binary);
    const detail::SavedHeader header{detail::saved_mark(),
                                     1,
                                     static_cast<std::uint64_t>(cloth.size()),
                                     detail::fingerprint(cloth),
                                     saved.frame,
                                     saved.start_energy,
                                     saved.state.time,
                                     saved.frame_length,
                                     saved.settings.size()};
    detail::put(file, &header, 1);
    detail::put(file, saved.settings.data(), static_cast<Eigen::Index>(saved.settings.size()));
    detail::put(file, saved.state.x.data(), saved.state.x.size());
    detail::put(file, saved.state.v.data(), saved.state.v.size());
    file.close();
    std::error_code failed;
    if (file) std::filesystem::rename(draft, path, failed);
    if (!file || failed) throw std::runtime_error("--output: " + path + " cannot be written");
}

/// Throws naming the file when it is no saved state of this cloth.
inline SavedState restore(const std::string& path, const Cloth& cloth) {
    const auto refuse = [&](const char* why) {
        throw std::runtime_error("--resume: " + path + " " + why);
    };
    std::ifstream file(path, std::ios::binary);
    if (!file) refuse("cannot be opened: no earlier run wrote it");
    detail::SavedHeader header;
    detail::take(file, &header, 1);
    if (!file || header.mark != detail::saved_mark() || header.order != 1)
        refuse("is no saved state of drape on such a machine");
    if (header.particles != static_cast<std::uint64_t>(cloth.size()) ||
        header.scene != detail::fingerprint(cloth))
        refuse("is of another scene: the particles are not laid out as they were");
    if (header.settings > 1'000'000) refuse("is damaged");
    SavedState saved{header.frame, header.start_energy, header.frame_length,
                     std::string(header.settings, ' '), cloth.initial_state()};
    detail::take(file, saved.settings.data(), static_cast<Eigen::Index>(header.settings));
    detail::take(file, saved.state.x.data(), saved.state.x.size());
    detail::take(file, saved.state.v.data(), saved.state.v.size());
    if (!file || !saved.state.x.allFinite() || !saved.state.v.allFinite())
        refuse("is cut short or damaged");
    saved.state.time = header.time;
    return saved;
}

}  // namespace drape
