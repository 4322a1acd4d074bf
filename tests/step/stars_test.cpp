// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/step/planner-inl.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "../support/catch.hpp"
#include "../support/random.hpp"

namespace taut_test::stars_test {

namespace {

namespace step_detail = taut::step_detail;

taut::Buffer<step_detail::PlacedSpring> random_springs(Random& random, int places, int springs,
                                                       int reach) {
    std::vector<int> a, b;
    for (int s = 0; s < springs; ++s) {
        a.push_back(static_cast<int>(random.below(places - 1)));
        b.push_back(std::min(places - 1, a.back() + 1 + static_cast<int>(random.below(reach))));
    }
    return step_detail::SortedSprings({a, b}).all();
}

}  // namespace

TEST_CASE("stars: each spring has one of its ends for its hub", "[integrator]") {
    Random random(71);
    for (const int reach : {1, 30, 5000}) {
        const auto springs = random_springs(random, 5000, 9001, reach);
        const auto by_hub = step_detail::choose_hubs(springs, 5000);
        REQUIRE(by_hub.size() == springs.size());
        std::map<int, std::pair<int, int>> ends;
        for (const auto& spring : springs) ends[spring.index] = {spring.a, spring.b};
        for (const auto& spring : by_hub) {
            const std::pair<int, int> found = std::minmax(spring.hub, spring.tip);
            CHECK(found == ends[spring.index]);
            ends.erase(spring.index);
        }
        CHECK(ends.empty());
        CHECK(std::is_sorted(by_hub.begin(), by_hub.end(), [](const auto& s, const auto& t) {
            return std::pair(s.hub, s.tip) < std::pair(t.hub, t.tip);
        }));
    }
}

TEST_CASE("stars: nearly all have four springs", "[integrator]") {
    Random random(72);
    const auto springs = random_springs(random, 2000, 12000, 60);
    int places_with_a_rest = 0;
    std::vector<int> count(2000, 0);
    for (const auto& spring : step_detail::choose_hubs(springs, 2000)) {
        ++count[static_cast<std::size_t>(spring.hub)];
    }
    for (const int springs_of_hub : count) {
        if (springs_of_hub % step_detail::star_size != 0) ++places_with_a_rest;
    }
    CHECK(places_with_a_rest <= 100);
}

TEST_CASE("stars: a tile is moved when its forces are whole, and each block has its springs once",
          "[integrator]") {
    Random random(73);
    for (const int reach : {25, 6000}) {
        const int places = 7000;
        const auto by_hub =
            step_detail::choose_hubs(random_springs(random, places, 20000, reach), places);
        const step_detail::Blocks blocks(places);
        const auto stars = step_detail::plan_stars(by_hub, blocks);
        std::set<std::pair<int, int>> seen;  // place, index of a spring that pulled it
        int last_tile = 0;
        for (const auto& star : stars) {
            CHECK(star.tile >= last_tile);
            last_tile = star.tile;
            const int block = blocks.block_of_tile(star.tile);
            for (int s = star.first; s < star.first + star.count; ++s) {
                const auto& spring = by_hub[static_cast<std::size_t>(s)];
                CHECK(spring.hub == by_hub[static_cast<std::size_t>(star.first)].hub);
                for (const int place : {spring.hub, spring.tip}) {
                    if (blocks.of(place) != block) continue;
                    CHECK(place / step_detail::tile_size >= star.tile);
                    CHECK(seen.insert({place, spring.index}).second);
                }
                if (!star.outer) CHECK(blocks.of(spring.tip) == block);
            }
        }
        CHECK(seen.size() == 2 * by_hub.size());
    }
}

}  // namespace taut_test::stars_test
