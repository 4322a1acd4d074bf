// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/step/planner-inl.hpp>
#include <taut/scene/cloth.hpp>

#include <algorithm>
#include <tuple>
#include <vector>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"

namespace taut_test::sorted_springs_test {

namespace {

namespace step_detail = taut::step_detail;

/// @returns the share of the springs that lie in runs
template <class System>
double check_sorted(const System& system) {
    double in_runs = 0;
    system.for_each_set([&](const auto& set) {
        const step_detail::SortedSprings sorted({set.a, set.b});
        const auto& all = sorted.all();
        REQUIRE(all.size() == set.a.size());
        std::vector<int> found(all.size(), 0);
        const auto check = [&](int which) {
            const auto& spring = all[static_cast<std::size_t>(which)];
            const auto s = static_cast<std::size_t>(spring.index);
            ++found[s];
            CHECK(spring.a < spring.b);
            CHECK(std::minmax(set.a[s], set.b[s]) == std::minmax(spring.a, spring.b));
        };
        for (const auto& run : sorted.runs()) {
            CHECK(run.end - run.begin >= step_detail::shortest_run);
            in_runs += run.end - run.begin;
            for (int at = run.begin; at < run.end; ++at) {
                check(at);
                CHECK(all[at].offset() == all[run.begin].offset());
                if (at != run.begin) CHECK(all[at - 1].a < all[at].a);
            }
        }
        for (const int spring : sorted.scattered()) check(spring);
        CHECK(found == std::vector<int>(found.size(), 1));
        const auto key = [](const auto& spring) {
            return std::tuple(spring.offset(), spring.a, spring.index);
        };
        CHECK(std::is_sorted(all.begin(), all.end(),
                             [&](const auto& s, const auto& t) { return key(s) < key(t); }));
        CHECK(std::is_sorted(sorted.scattered().begin(), sorted.scattered().end()));
    });
    return in_runs / static_cast<double>(system.spring_count());
}

}  // namespace

TEST_CASE("sorted_springs: each spring is in one run or scattered", "[integrator]") {
    Random random(61);
    for (const Index springs : {1, 40, 900}) {
        RandomOptions options;
        options.particles = 100;
        options.springs = springs;
        check_sorted(random_system<double, 3>(random, options));
    }
}

TEST_CASE("sorted_springs: a grid is all runs", "[integrator]") {
    CHECK(check_sorted(taut::hanging_cloth<double>({20, 30})) == 1);
}

}  // namespace taut_test::sorted_springs_test
