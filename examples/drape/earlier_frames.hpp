// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>
#include <taut/core/types.hpp>
#include <vector>

// What an earlier run wrote of the frames before the one that --resume begins with.

namespace drape {

/// The lines of energy.csv, its heading apart. Throws when there are fewer than `frames`.
inline std::string earlier_energies(const std::string& path, int frames) {
    std::ifstream file(path);
    std::string line, kept;
    std::getline(file, line);
    for (int i = 0; i < frames; ++i) {
        if (!std::getline(file, line))
            throw std::runtime_error("--resume: " + path + " ends before the saved frame");
        kept += line + '\n';
    }
    return kept;
}

using EarlierSamples = std::vector<taut::Points<float, 3>>;

/// The samples of a PC2 cache of `points` points. Throws when they are not there.
inline EarlierSamples earlier_samples(const std::string& path, taut::Index points, int frames) {
    std::ifstream file(path, std::ios::binary);
    char header[32] = {};
    file.read(header, sizeof header);
    std::int32_t counts = 0;
    std::memcpy(&counts, header + 16, sizeof counts);
    if (!file || std::string(header) != "POINTCACHE2" || counts != points) {
        throw std::runtime_error("--resume: " + path +
                                 " is no point cache of this scene's earlier frames");
    }
    EarlierSamples samples;
    for (int i = 0; i < frames; ++i) {
        samples.emplace_back(3, points);
        auto& x = samples.back();
        file.read(reinterpret_cast<char*>(x.data()),
                  static_cast<std::streamsize>(sizeof(float)) * x.size());
        if (!file) throw std::runtime_error("--resume: " + path + " ends before the saved frame");
    }
    return samples;
}

}  // namespace drape
