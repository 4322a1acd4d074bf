// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "frames.hpp"

namespace bench {

/// A peer that is a program of its own: it reads a scene that write_scene wrote and writes, for
/// each frame, the milliseconds that it took and the positions at its end, in floats.
class ProgramWears {
public:
    /// @param command  of the shell; the scene's path is appended
    ProgramWears(const std::string& command, const std::string& scene, taut::Index particles)
        : pipe_(popen((command + " '" + scene + "'").c_str(), "r")), numbers_(1 + 3 * particles) {}
    ~ProgramWears() {
        if (pipe_) pclose(pipe_);
    }
    ProgramWears(const ProgramWears&) = delete;
    ProgramWears& operator=(const ProgramWears&) = delete;

    /// @returns whether there was a frame
    bool advance() {
        return pipe_ && std::fread(numbers_.data(), sizeof(float), std::size_t(numbers_.size()),
                                   pipe_) == std::size_t(numbers_.size());
    }
    double ms() const { return double(numbers_[0]); }
    taut::Points<float, 3> x() const {
        return Eigen::Map<const taut::Points<float, 3>>(numbers_.data() + 1, 3,
                                                        (numbers_.size() - 1) / 3);
    }

private:
    std::FILE* pipe_;
    Eigen::VectorXf numbers_;
};

}  // namespace bench
