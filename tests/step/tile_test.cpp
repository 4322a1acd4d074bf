// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <algorithm>
#include <random>
#include <taut/step/tile.hpp>

#include "support/catch.hpp"

namespace taut_test::tile_test {

namespace step_detail = taut::step_detail;

TEST_CASE("blocks hold every place once, begin with a tile, and are alike", "[integrator]") {
    std::mt19937 random(8);
    for (int scene = 0; scene < 500; ++scene) {
        const int most = scene % 2 == 0 ? 5000 : 200000;
        const int places = std::uniform_int_distribution<int>(0, most)(random);
        CAPTURE(places);
        const step_detail::Blocks blocks(places);
        CHECK(blocks.size() % step_detail::tile_size == 0);
        CHECK((blocks.size() > 0 && blocks.size() <= step_detail::most_of_block));
        CHECK(blocks.count() * blocks.size() >= places);
        CHECK((blocks.count() - 1) * blocks.size() < std::max(places, 1));
        CHECK(blocks.tiles() * step_detail::tile_size >= places);
        for (int place = 0; place < places; place += 97) {
            const int block = blocks.of(place);
            CHECK(blocks.begin(block) <= place);
            CHECK(place < blocks.begin(block + 1));
            CHECK(blocks.block_of_tile(place / step_detail::tile_size) == block);
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

}  // namespace taut_test::tile_test
