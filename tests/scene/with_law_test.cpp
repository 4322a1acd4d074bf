// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/scene/with_law.hpp>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::with_law_test {

using taut::Hookean;

TEMPLATE_TEST_CASE(
    "with_law: a copy of the same law has the same forces, and of a law that does "
    "not push the forces of the springs that pull",
    "[scene]", float, double) {
    using Scalar = TestType;
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        INFO("seed " << seed);
        Random random(seed);
        RandomOptions options;
        options.dampers = true;
        options.rayleigh = true;
        auto system = random_system<Scalar, 3>(random, options);
        const auto state = random_state(random, system);
        taut::Points<Scalar, 3> expected;
        taut::Points<Scalar, 3> f;
        system.force(state, expected);

        const auto same = taut::with_law<Hookean>(system);
        same.force(state, f);
        CHECK(f == expected);
        CHECK(same.pinned_count() == system.pinned_count());
        CHECK(same_bits(same.initial_state(), system.initial_state()));
        CHECK(same.inverse_mass() == system.inverse_mass());

        // Of springs without the pushing ones both laws say the same.
        const auto threads = taut::with_law<TensionOnly>(system);
        const auto& springs = system.springs();
        const auto pushes = [&](Index s) {
            const auto d = state.x.col(springs.b[s]) - state.x.col(springs.a[s]);
            return d.norm() < springs.rest_length[s];
        };
        Scalar energy = 0;
        for (Index s = 0; s < springs.size(); ++s) {
            if (pushes(s)) continue;
            const auto d = state.x.col(springs.b[s]) - state.x.col(springs.a[s]);
            energy += Hookean::energy(springs.parameters[s], springs.rest_length[s], d.norm());
        }
        auto weightless = threads;
        weightless.set_gravity({0, 0, 0});
        CHECK_THAT(weightless.potential_energy(state),
                   WithinRel(energy, static_cast<Scalar>(Tolerance<Scalar>::rounding)));
    }
}

TEST_CASE("with_springs: springs are given in index order, over all laws", "[scene]") {
    Random random(11);
    const auto system = random_system<double, 2, Hookean, Buckling>(random);
    Index next = 0;
    const auto bare = taut::with_springs<taut::SpringSystem<double, 2>>(
        system, [&](auto&, const auto& spring, Index s) {
            CHECK(s == next++);
            CHECK(spring.a != spring.b);
        });
    CHECK(next == system.spring_count());
    CHECK(bare.spring_count() == 0);
    CHECK(bare.gravity() == system.gravity());
}

}  // namespace taut_test::with_law_test
