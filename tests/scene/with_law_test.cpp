// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/scene/with_law.hpp>

#include "../support/catch.hpp"
#include "../support/scene_of.hpp"

namespace taut_test::with_law_test {

TEST_CASE(
    "with_law: a copy of the same law has the same forces, and of a law that does not push "
    "the forces of the springs that pull",
    "[scene]") {
    for (const Kind kind : {Kind{true}, Kind{false}}) {
        for (std::uint32_t seed = 1; seed <= 10; ++seed) {
            CAPTURE(kind, seed);
            Random random(seed);
            SceneOptions options;
            options.dampers = options.rayleigh = true;
            const Scene scene = random_scene(random, kind, options);
            const auto state = random_state(random, scene);
            Scene threads({kind.single, 3, Laws::strings});
            visit_system<Plain<float, 3>, Plain<double, 3>>(scene, [&](const auto& system) {
                using State = typename std::decay_t<decltype(system)>::State;
                const auto same = taut::with_law<taut::Hookean>(system);
                decltype(State::x) f;
                same.force(from_any<State>(state), f);
                CHECK(f.template cast<double>() == scene.force(state));
                CHECK(to_any(same.initial_state()) == scene.initial_state());
                CHECK(same.inverse_mass() == system.inverse_mass());
                threads = scene_of(taut::with_law<TensionOnly>(system));
            });
            // Of springs without the pushing ones both laws say the same.
            long double energy = 0;
            for (const auto& spring : scene.springs()) {
                const double l = (state.x.col(spring.b) - state.x.col(spring.a)).norm();
                if (l >= spring.rest_length) energy += law_at(spring, l).energy;
            }
            threads.set_gravity(Eigen::Vector3d::Zero());
            CHECK_THAT(threads.potential_energy(state),
                       WithinRel(static_cast<double>(energy), kind.rounding()));
        }
    }
}

TEST_CASE("with_springs: springs are given in index order, over all laws", "[scene]") {
    Random random(11);
    const Scene scene = random_scene(random, {false, 2, Laws::mixed});
    visit_system<Mixed<double, 2>>(scene, [&](const auto& system) {
        Index next = 0;
        const auto bare =
            taut::with_springs<Plain<double, 2>>(system, [&](auto&, const auto& spring, Index s) {
                CHECK(s == next++);
                CHECK(spring.a != spring.b);
            });
        CHECK(next == system.spring_count());
        CHECK(bare.spring_count() == 0);
        CHECK(bare.gravity() == system.gravity());
    });
}

}  // namespace taut_test::with_law_test
