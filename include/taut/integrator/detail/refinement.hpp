// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace taut::integrator_detail {

/// How finely a guard cuts its frames: into 2^level times the substeps that the limit asks for. A
/// level that retries have reached is kept for a while.
///
/// A scene that is stuck does not pay all retries in every frame. After a frame that was given up
/// each further one is attempted once; the n-th of them takes as its level how often 2 divides n.
/// So every level k is tried in each 2^(k+1)-th frame, and with M levels above the first a frame
/// costs M/2 + 1 plain ones on average, where all retries cost 2^(M+1) − 1.
class Refinement {
public:
    /// Frames without a retry after which a level is given back.
    static constexpr int calm_frames = 30;

    /// @param most  the highest level
    explicit Refinement(int most) : most_(most) {}

    /// Begins a frame; a system that was edited since one was given up is worth all retries.
    void begin(std::uint64_t revision) {
        if (revision != revision_) given_up_ = 0;
        revision_ = revision;
    }
    /// Of the frame's first attempt.
    int level() const { return level_; }
    /// Whether the last frame was given up.
    bool stuck() const { return given_up_ > 0; }
    /// Whether a frame that failed after so many retries is tried again.
    bool again(int retries) const { return !stuck() && level_ + retries < most_; }
    /// The frame stands after so many retries.
    void settle(int retries) {
        calm_ = retries > 0 || stuck() ? 0 : calm_ + 1;
        given_up_ = 0;
        level_ += retries;
        if (level_ > 0 && calm_ == calm_frames) {
            --level_;
            calm_ = 0;
        }
    }
    /// The frame was given up.
    void give_up() {
        ++given_up_;
        level_ = 0;
        for (auto n = given_up_; n % 2 == 0 && level_ < most_; n /= 2) ++level_;
    }

private:
    int most_;
    int level_ = 0;
    int calm_ = 0;                // frames without a retry since the level changed
    std::uint64_t given_up_ = 0;  // frames in a row
    std::uint64_t revision_ = 0;  // of the system
};

}  // namespace taut::integrator_detail
