// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/integrator/sweep/sorted_springs.hpp>
#include <taut/scene/cloth.hpp>

#include <algorithm>
#include <vector>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"

namespace taut_test::sorted_springs_test {

namespace {

namespace sweep = taut::integrator_detail::sweep;

/// @returns the share of the springs that lie in runs
template <class System>
double check_sorted(const System& system) {
    double in_runs = 0;
    system.for_each_set([&](const auto& set) {
        const sweep::SortedSprings sorted(set, [](int i) { return i; });
        std::vector<int> found(static_cast<std::size_t>(set.size()), 0);
        const auto check = [&](const sweep::PlacedSpring& spring) {
            const auto s = static_cast<std::size_t>(spring.index);
            ++found[s];
            CHECK(spring.a < spring.b);
            CHECK(std::minmax(set.a[s], set.b[s]) == std::minmax(spring.a, spring.b));
        };
        for (const auto& run : sorted.runs()) {
            CHECK(run.end - run.begin >= sweep::shortest_run);
            in_runs += static_cast<double>(run.end - run.begin);
            for (auto at = run.begin; at != run.end; ++at) {
                check(*at);
                CHECK(at->offset() == run.front().offset());
                if (at != run.begin) CHECK((at - 1)->a < at->a);
            }
        }
        for (const auto& spring : sorted.scattered()) check(spring);
        CHECK(found == std::vector<int>(found.size(), 1));
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
