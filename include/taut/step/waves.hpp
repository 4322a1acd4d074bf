// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "../core/types.hpp"

namespace taut::step_detail {

/// The order in which threads take several steps of all blocks. A block takes a step when all
/// blocks within `reach` have taken the one before, and none of them two more, which would write
/// over what it reads. So a few blocks stay in a cache for all steps of a wave. Neither the order
/// nor the values of a block's sums change.
///
///     step 2   a a a a c c c c c c b b b b      A wave of three steps by the threads a and b, with
///     step 1   a a a a a c c c c b b b b b      a reach of 1: first all of a and b, then c, by
///     step 0   a a a a a a a b b b b b b b      one of them.
class Waves {
public:
    Waves(int blocks, int reach, int threads)
        : blocks_(blocks), reach_(reach), threads_(threads), steps_(most_steps) {
        // What is left to one thread stays a small part.
        const int share = blocks / threads;
        if (threads > 1 && reach > 0) steps_ = std::clamp(1 + share / (10 * reach), 1, most_steps);
    }
    /// Of a wave, at most.
    int steps() const { return steps_; }
    /// Whether something is left when each thread has visited its own blocks.
    bool has_borders() const { return threads_ > 1 && steps_ > 1 && reach_ > 0; }

    /// visit(step, block) for all that a thread does of `count` steps.
    /// @param wait  wait() returns when all threads have called it as often
    template <class Visitor, class Wait>
    void run(int thread, Index count, Visitor&& visit, Wait&& wait) const {
        for (Index first = 0; first < count; first += steps_) {
            const int steps = static_cast<int>(std::min<Index>(steps_, count - first));
            const auto visit_here = [&](int step, int block) { visit(first + step, block); };
            visit_own(thread, steps, visit_here);
            wait();
            if (!has_borders()) continue;
            visit_border(thread, steps, visit_here);
            wait();
        }
    }

    /// visit(step, block) for what a thread does of the first `steps` steps by itself.
    template <class Visitor>
    void visit_own(int thread, int steps, Visitor&& visit) const {
        const int begin = first_of(thread);
        const int end = first_of(thread + 1);
        const int left = thread > 0 ? reach_ : 0;
        const int right = thread + 1 < threads_ ? reach_ : 0;
        for (int front = begin; front < end + (steps - 1) * reach_; ++front) {
            for (int step = 0; step < steps; ++step) {
                const int block = front - step * reach_;
                if (block >= begin + step * left && block < end - step * right) visit(step, block);
            }
        }
    }
    /// The same for what is left between a thread's blocks and those before them, once all threads
    /// have visited their own.
    template <class Visitor>
    void visit_border(int thread, int steps, Visitor&& visit) const {
        if (thread == 0) return;
        const int border = first_of(thread);
        for (int step = 1; step < steps; ++step) {
            const int half = step * reach_;
            for (int block = border - half; block < border + half; ++block) visit(step, block);
        }
    }

private:
    static constexpr int most_steps = 8;

    /// The first block of a thread.
    int first_of(int thread) const {
        return static_cast<int>(static_cast<long long>(blocks_) * thread / threads_);
    }

    int blocks_;
    int reach_;
    int threads_;
    int steps_;
};

}  // namespace taut::step_detail
