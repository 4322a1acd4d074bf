// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/model/force_plan.hpp>
#include <taut/scene/cloth.hpp>

#include <algorithm>
#include <numeric>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"

namespace taut_test::force_plan_test {

TEST_CASE("force_plan: the numbering of a shuffled grid is a permutation that brings ends together",
          "[model]") {
    Random random(51);
    const int side = 40;
    std::vector<int> name(side * side);
    std::iota(name.begin(), name.end(), 0);
    for (std::size_t i = name.size() - 1; i > 0; --i) {
        std::swap(name[i], name[static_cast<std::size_t>(random.below(static_cast<Index>(i) + 1))]);
    }
    std::vector<taut::detail::Joint> joints;
    for (int r = 0; r < side; ++r) {
        for (int c = 0; c < side; ++c) {
            if (c + 1 < side) joints.emplace_back(name[r * side + c], name[r * side + c + 1]);
            if (r + 1 < side) joints.emplace_back(name[r * side + c], name[(r + 1) * side + c]);
        }
    }
    const auto order = taut::detail::cache_order(side * side, joints);
    auto sorted = order;
    std::sort(sorted.begin(), sorted.end());
    for (int i = 0; i < side * side; ++i) REQUIRE(sorted[i] == i);
    std::vector<int> place(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<int>(i);
    int farthest = 0;
    for (const auto& [a, b] : joints) farthest = std::max(farthest, std::abs(place[a] - place[b]));
    CHECK(farthest <= 2 * side);
}

TEST_CASE("force_plan: particles without springs keep a place of their own", "[model]") {
    const auto order = taut::detail::cache_order(5, {{1, 3}});
    auto sorted = order;
    std::sort(sorted.begin(), sorted.end());
    CHECK(sorted == std::vector<int>{0, 1, 2, 3, 4});
}

TEST_CASE("force_plan: planes give back the points they took, whatever the numbering", "[model]") {
    Random random(52);
    RandomOptions options;
    options.particles = 70;
    options.springs = 200;
    const auto check = [&](const auto& system) {
        using System = std::decay_t<decltype(system)>;
        taut::ForcePlan<System> plan;
        CHECK(plan.update(system));
        CHECK_FALSE(plan.update(system));
        const auto state = random_state(random, system);
        std::vector<double> memory(static_cast<std::size_t>(3 * plan.stride()));
        const taut::detail::Planes<double> planes{memory.data(), plan.stride()};
        plan.to_planes(state.x, planes);
        auto back = state;
        back.x.setZero();
        plan.from_planes(planes, back.x);
        CHECK(same_bits(back, state));
    };
    check(random_system<double, 3>(random, options));
    check(taut::hanging_cloth<double>({9, 8}));
}

TEST_CASE("force_plan: it changes with the springs and not with masses or damping", "[model]") {
    Random random(53);
    auto system = random_system<double, 3>(random);
    taut::ForcePlan<taut::SpringSystem<double, 3>> plan;
    CHECK(plan.update(system));
    system.set_mass(3, 2);
    system.set_rayleigh({0, 0.1});
    CHECK_FALSE(plan.update(system));
    system.add_spring(2, 5, 10);
    CHECK(plan.update(system));
    system.set_stiffness(1, 20);
    CHECK(plan.update(system));
    system.remove_spring(0);
    CHECK(plan.update(system));
    CHECK_FALSE(plan.update(system));
}

}  // namespace taut_test::force_plan_test
