// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <taut/step/force_plan.hpp>
#include <taut/step/planner-inl.hpp>
#include <taut/scene/cloth.hpp>
#include <vector>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"

namespace taut_test::force_plan_test {

TEST_CASE("force_plan: planes give back the points they took, whatever the order", "[integrator]") {
    Random random(52);
    RandomOptions options;
    options.particles = 70;
    options.springs = 200;
    const auto check = [&](const auto& system) {
        using System = std::decay_t<decltype(system)>;
        taut::step_detail::ForcePlan<System> plan;
        CHECK(plan.update(system));
        CHECK_FALSE(plan.update(system));
        const auto& layout = plan.layout();
        const auto state = random_state(random, system);
        std::vector<double> memory(static_cast<std::size_t>(3 * layout.stride()));
        const taut::step_detail::Planes<double> planes{memory.data(), layout.stride()};
        layout.to_planes(state.x, planes, layout.all());
        auto back = state;
        back.x.setZero();
        layout.from_planes(planes, back.x, layout.all());
        CHECK(same_bits(back, state));
    };
    check(random_system<double, 3>(random, options));
    check(taut::hanging_cloth<double>({9, 8}));
}

TEST_CASE("force_plan: springs without order are in stars, those of grids and chains are not",
          "[integrator]") {
    Random random(54);
    RandomOptions options;
    options.particles = 70;
    options.springs = 200;
    const auto stars = [](const auto& system) {
        taut::step_detail::ForcePlan<std::decay_t<decltype(system)>> plan;
        plan.update(system);
        return plan.layout().has_stars();
    };
    CHECK(stars(random_system<double, 3>(random, options)));
    CHECK(stars(random_system<float, 2>(random, options)));
    CHECK_FALSE(stars(random_system<double, 1>(random, options)));
    CHECK_FALSE(stars(taut::hanging_cloth<double>({30, 40})));
    CHECK_FALSE(stars(taut::SpringSystem<double, 3>()));
}

TEST_CASE("force_plan: no batch gathers more places than fit, and some are full", "[integrator]") {
    namespace step_detail = taut::step_detail;
    Random random(55);
    const int places = 5000, springs = 20001;
    std::vector<int> a, b;
    for (int s = 0; s < springs; ++s) {
        a.push_back(static_cast<int>(random.below(places)));
        b.push_back((a.back() + 1 + static_cast<int>(random.below(places - 1))) % places);
    }
    const step_detail::SortedSprings sorted({a, b});
    taut::Buffer<int> index;
    const auto plan =
        step_detail::Planner<float>::batches(sorted, step_detail::Blocks(places), index);
    REQUIRE(index.size() >= static_cast<std::size_t>(springs));  // twice between two blocks
    int most = 0, all = 0;
    for (const auto& batch : plan.batches) {
        most = std::max(most, batch.gathered);
        all += batch.springs;
        for (int s = 0; s < batch.springs; ++s) {
            const auto& ends = plan.ends[static_cast<std::size_t>(batch.first_spring + s)];
            CHECK(std::max(ends.a, ends.b) < batch.gathered);
        }
    }
    CHECK(static_cast<std::size_t>(all) == index.size());
    CHECK(most <= step_detail::most_gathered);
    CHECK(most >= step_detail::most_gathered - 1);
}

TEST_CASE("force_plan: stars come in the least groups that fill whole registers", "[integrator]") {
    const auto check = [](auto scalar) {
        using Planner = taut::step_detail::Planner<decltype(scalar)>;
        const int stars = Planner::group * taut::step_detail::star_size;
        CHECK(stars == std::max<int>(Planner::StarRegister::width, taut::step_detail::star_size));
    };
    check(0.f);
    check(0.0);
}

TEST_CASE("force_plan: it changes with the springs and not with masses or damping",
          "[integrator]") {
    Random random(53);
    auto system = random_system<double, 3>(random);
    taut::step_detail::ForcePlan<taut::SpringSystem<double, 3>> plan;
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
