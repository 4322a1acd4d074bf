// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/step/waves.hpp>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include "../support/catch.hpp"

namespace taut_test::waves_test {

namespace {

using taut::Index;
using taut::step_detail::Waves;
using Visits = std::vector<std::pair<int, int>>;  // step, block

/// Threads that take their visits in turns drawn at random, and how many steps blocks have taken.
class Scene {
public:
    Scene(int blocks, int reach) : reach_(reach), taken_(static_cast<std::size_t>(blocks), 0) {}

    void take(std::vector<Visits> threads, std::mt19937& random) {
        std::vector<std::size_t> next(threads.size(), 0);
        for (;;) {
            std::vector<std::size_t> waiting;
            for (std::size_t t = 0; t < threads.size(); ++t) {
                if (next[t] < threads[t].size()) waiting.push_back(t);
            }
            if (waiting.empty()) return;
            const std::size_t t = waiting[random() % waiting.size()];
            const auto [step, block] = threads[t][next[t]++];
            visit(step, block);
        }
    }
    bool in_order() const { return in_order_; }
    bool all_have_taken(int steps) const {
        return std::all_of(taken_.begin(), taken_.end(), [&](int n) { return n == steps; });
    }

private:
    void visit(int step, int block) {
        const int blocks = static_cast<int>(taken_.size());
        if (block < 0 || block >= blocks || taken_[block] != step) {
            in_order_ = false;
            return;
        }
        const int end = std::min(blocks, block + reach_ + 1);
        for (int other = std::max(0, block - reach_); other < end; ++other) {
            // A state is there from the step that made it to the second after, which writes over
            // it.
            in_order_ = in_order_ && (taken_[other] == step || taken_[other] == step + 1);
        }
        ++taken_[block];
    }

    int reach_;
    std::vector<int> taken_;
    bool in_order_ = true;
};

}  // namespace

TEST_CASE("in waves every block takes each step between those of the blocks within reach",
          "[integrator]") {
    std::mt19937 random(7);
    const auto draw = [&](int from, int to) {
        return std::uniform_int_distribution<int>(from, to)(random);
    };
    int scenes_with_borders = 0;
    for (int drawn = 0; drawn < 400; ++drawn) {
        const int blocks = draw(1, drawn % 2 == 0 ? 12 : 300);
        const int reach = draw(0, std::min(blocks - 1, 5));
        const int threads = draw(1, std::min(blocks, 9));
        const int steps = draw(0, 20);
        CAPTURE(blocks, reach, threads, steps);
        const Waves waves(blocks, reach, threads);
        if (waves.has_borders()) ++scenes_with_borders;
        Scene scene(blocks, reach);
        // What each thread does between two waits.
        std::vector<std::vector<Visits>> phases;
        for (int thread = 0; thread < threads; ++thread) {
            std::size_t phase = 0;
            const auto here = [&]() -> Visits& {
                while (phases.size() <= phase) {
                    phases.emplace_back(static_cast<std::size_t>(threads));
                }
                return phases[phase][static_cast<std::size_t>(thread)];
            };
            waves.run(
                thread, steps,
                [&](Index step, int b) {
                    here().push_back({static_cast<int>(step), b});
                },
                [&] { ++phase; });
        }
        for (auto& phase : phases) scene.take(std::move(phase), random);
        CHECK(scene.in_order());
        CHECK(scene.all_have_taken(steps));
    }
    CHECK(scenes_with_borders > 20);
}

}  // namespace taut_test::waves_test
