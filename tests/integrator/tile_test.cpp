// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <algorithm>
#include <random>
#include <taut/integrator/sweep/tile.hpp>
#include <vector>

#include "support/catch.hpp"

namespace taut_test::tile_test {

namespace sweep = taut::integrator_detail::sweep;
using taut::Index;

TEST_CASE("blocks hold every place once, begin with a tile, and are alike", "[integrator]") {
    std::mt19937 random(8);
    for (int scene = 0; scene < 500; ++scene) {
        const int most = scene % 2 == 0 ? 5000 : 200000;
        const int places = std::uniform_int_distribution<int>(0, most)(random);
        CAPTURE(places);
        const sweep::Blocks blocks(places);
        CHECK(blocks.size() % sweep::tile_size == 0);
        CHECK((blocks.size() > 0 && blocks.size() <= sweep::most_of_block));
        CHECK(blocks.count() * blocks.size() >= places);
        CHECK((blocks.count() - 1) * blocks.size() < std::max(places, 1));
        CHECK(blocks.tiles() * sweep::tile_size >= places);
        for (int place = 0; place < places; place += 97) {
            const int block = blocks.of(place);
            CHECK(blocks.begin(block) <= place);
            CHECK(place < blocks.begin(block + 1));
            CHECK(blocks.block_of_tile(place / sweep::tile_size) == block);
            CHECK(blocks.block_of_tile(blocks.first_tile(block)) == block);
        }
        const auto most_of_one = [&](int threads) {
            return (blocks.count() + threads - 1) / threads;
        };
        for (const int threads : {1, 2, 3, 8, 100}) {
            const int workers = blocks.workers(threads);
            CHECK((workers >= 1 && workers <= threads));
            CHECK(most_of_one(workers) == most_of_one(threads));
            if (workers > 1) CHECK(most_of_one(workers - 1) > most_of_one(workers));
        }
    }
}

TEST_CASE("in waves every block takes each step, between those of the blocks within reach",
          "[integrator]") {
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

}  // namespace taut_test::tile_test
