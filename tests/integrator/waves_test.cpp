// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <algorithm>
#include <random>
#include <taut/integrator/sweep/tile.hpp>
#include <vector>

#include "support/catch.hpp"

namespace taut_test::waves {

namespace sweep = taut::integrator_detail::sweep;
using taut::Index;

TEST_CASE("in waves every block takes each step, between those of the blocks within reach") {
    std::mt19937 random(7);
    const auto draw = [&](int from, int to) {
        return std::uniform_int_distribution<int>(from, to)(random);
    };
    for (int scene = 0; scene < 300; ++scene) {
        const int blocks = draw(1, 40);
        const int reach = draw(0, std::min(blocks - 1, 6));
        const Index steps = draw(0, 3 * sweep::steps_of_wave);
        CAPTURE(blocks, reach, steps);
        std::vector<Index> taken(static_cast<std::size_t>(blocks), 0);
        bool in_order = true;
        sweep::for_each_in_waves(blocks, reach, steps, [&](Index step, int block) {
            in_order = in_order && taken[block] == step;
            const int end = std::min(blocks, block + reach + 1);
            for (int other = std::max(0, block - reach); other < end; ++other) {
                // A state is there from the step that made it to the second after, which writes
                // over it.
                in_order = in_order && (taken[other] == step || taken[other] == step + 1);
            }
            ++taken[block];
        });
        CHECK(in_order);
        CHECK(std::all_of(taken.begin(), taken.end(), [&](Index n) { return n == steps; }));
    }
}

}  // namespace taut_test::waves
