// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "../../examples/common/remedies.hpp"

#include <taut/tight/tight.hpp>

#include "../../examples/common/number.hpp"
#include "../support/catch.hpp"
#include "../support/compiled_once.hpp"
#include "../support/random.hpp"
#include "../support/random_system.hpp"

namespace taut_test::remedies_test {

namespace {

using System = taut::SpringSystem<double, 3>;
using taut::any_pose_limit;

System with_stiffness(System system, double scale) {
    for (Index s = 0; s < system.spring_count(); ++s) {
        const double k = system.springs()[static_cast<std::size_t>(s)].parameters.stiffness;
        system.set_stiffness(s, k * scale);
    }
    return system;
}

System with_masses(System system, double scale) {
    for (Index i = 0; i < system.size(); ++i) system.set_mass(i, system.mass(i) * scale);
    return system;
}

System with_added(System system, const taut::AddedMass& added) {
    for (Index i = 0; i < system.size(); ++i)
        system.set_mass(i, system.mass(i) + added.mass[static_cast<std::size_t>(i)]);
    return system;
}

RandomOptions some_damping(int repeat) {
    RandomOptions options;
    options.dampers = repeat % 2 == 1;
    options.rayleigh = repeat % 4 >= 2;
    return options;
}

}  // namespace

TEST_CASE("remedies: a scene on a line has the limit of every pose", "[programs]") {
    Random random(4611);
    for (int repeat = 0; repeat < 40; ++repeat) {
        const auto system = random_system<double, 3>(random, some_damping(repeat));
        const auto line = example::on_a_line(system);
        const taut::Stability<double> stability(line, line.initial_state());
        CHECK_THAT(stability.max_step(taut::Method::symplectic_euler).certified,
                   WithinRel(any_pose_limit(system).certified, 1e-12));
    }
}

TEST_CASE("remedies: with each cure the step is safe at any pose", "[programs]") {
    Random random(4612);
    int reached = 0, by_stiffness = 0;
    for (int repeat = 0; repeat < 120; ++repeat) {
        const auto system = random_system<double, 3>(random, some_damping(repeat));
        const double h = any_pose_limit(system).certified * log_uniform(random, 0.5, 30);
        const auto cures = example::cures_at_any_pose(system, system.initial_state(), h);
        INFO("system " << repeat << ", h = " << h);
        const auto safe = [&](const System& cured) {
            return any_pose_limit(cured).substeps(h, 0.95) == 1;
        };
        // As the report prints them.
        if (cures.stiffness_scale > 0) {
            ++by_stiffness;
            CHECK(safe(with_stiffness(system, cures.stiffness_scale)));
            CHECK(safe(with_stiffness(
                system, std::stod(example::rounded_down(cures.stiffness_scale, 4, 'g')))));
        }
        REQUIRE(std::isfinite(cures.mass_scale) == cures.added_mass->reached);
        if (!cures.added_mass->reached) continue;
        ++reached;
        CHECK(safe(with_masses(system, cures.mass_scale)));
        CHECK(safe(with_masses(system, std::stod(example::rounded_up(cures.mass_scale, 4, 'g')))));
        // Other weights may prove it than those that the bound finds: by a factorisation.
        const auto heavier = with_added(system, *cures.added_mass);
        CHECK(any_pose_limit(heavier, 1e-6).substeps(h, 0.95 * (1 + 2e-6)) == 1);
        // No cure asks for much more than it must.
        if (some_damping(repeat).dampers) continue;
        CHECK_FALSE(safe(with_stiffness(system, 1.001 * cures.stiffness_scale)));
        CHECK_FALSE(safe(with_masses(system, cures.mass_scale / 1.001)));
    }
    CHECK(reached > 100);
    CHECK(by_stiffness > 60);
}

TEST_CASE("remedies: where damping alone forbids the step no stiffness is named", "[programs]") {
    System system;
    for (int i = 0; i < 3; ++i) system.add_particle({1.0 * i, 0, 0}, 0.1);
    for (int i = 0; i < 2; ++i) system.add_spring(i, i + 1, 100, 5);
    const auto dampers = example::cures_at_any_pose(system, system.initial_state(), 0.1);
    CHECK(dampers.stiffness_scale == 0);
    CHECK(any_pose_limit(with_masses(system, dampers.mass_scale)).substeps(0.1, 0.95) == 1);
    system.set_rayleigh({25, 0});  // h·d0 > 2, whatever the masses
    const auto drag = example::cures_at_any_pose(system, system.initial_state(), 0.1);
    CHECK(drag.stiffness_scale == 0);
    CHECK(std::isinf(drag.mass_scale));
    CHECK_FALSE(drag.added_mass->reached);
}

}  // namespace taut_test::remedies_test
