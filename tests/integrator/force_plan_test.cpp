// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/integrator/sweep/force_plan.hpp>
#include <taut/scene/cloth.hpp>

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
        taut::integrator_detail::sweep::ForcePlan<System> plan;
        CHECK(plan.update(system));
        CHECK_FALSE(plan.update(system));
        const auto& layout = plan.layout();
        const auto state = random_state(random, system);
        std::vector<double> memory(static_cast<std::size_t>(3 * layout.stride()));
        const taut::integrator_detail::sweep::Planes<double> planes{memory.data(), layout.stride()};
        layout.to_planes(state.x, planes);
        auto back = state;
        back.x.setZero();
        layout.from_planes(planes, back.x);
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
        taut::integrator_detail::sweep::ForcePlan<std::decay_t<decltype(system)>> plan;
        plan.update(system);
        return plan.layout().has_stars();
    };
    CHECK(stars(random_system<double, 3>(random, options)));
    CHECK(stars(random_system<float, 2>(random, options)));
    CHECK_FALSE(stars(random_system<double, 1>(random, options)));
    CHECK_FALSE(stars(taut::hanging_cloth<double>({30, 40})));
    CHECK_FALSE(stars(taut::SpringSystem<double, 3>()));
}

TEST_CASE("force_plan: it changes with the springs and not with masses or damping",
          "[integrator]") {
    Random random(53);
    auto system = random_system<double, 3>(random);
    taut::integrator_detail::sweep::ForcePlan<taut::SpringSystem<double, 3>> plan;
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
