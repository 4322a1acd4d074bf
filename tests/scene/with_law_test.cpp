// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/scene/with_law.hpp>
#include <taut/network/tension_only.hpp>

#include "../support/catch.hpp"
#include "../support/scene_of.hpp"

namespace taut_test::with_law_test {

namespace {

Scene as_threads(const Scene& scene) {
    Scene threads({scene.kind().single, 3, Laws::strings});
    visit_system<Plain<float, 3>, Plain<double, 3>, Strings<float, 3>, Strings<double, 3>>(
        scene,
        [&](const auto& system) { threads = scene_of(taut::with_law<TensionOnly>(system)); });
    return threads;
}

}  // namespace

TEST_CASE(
    "with_law: a copy of the same law has the same forces, and of a law that does not push "
    "the forces of the springs that pull",
    "[scene]") {
    for (const bool single : {false, true}) {
        for (std::uint32_t seed = 1; seed <= 10; ++seed) {
            CAPTURE(single, seed);
            Random random(seed);
            RandomOptions options;
            options.dampers = options.rayleigh = true;
            const Scene scene = random_scene(random, {single, 3, Laws::strings}, options);
            const Scene same = as_threads(scene);
            const auto state = random_state(random, scene);
            CHECK(same.force(state) == scene.force(state));
            CHECK(same.initial_state() == scene.initial_state());
            for (Index i = 0; i < scene.size(); ++i) {
                CHECK(same.mass(i) == scene.mass(i));
                CHECK(same.is_pinned(i) == scene.is_pinned(i));
            }
            // Of springs without the pushing ones both laws say the same.
            const Scene pushing = random_scene(random, {single, 3}, options);
            long double energy = 0;
            for (const auto& spring : pushing.springs()) {
                const double l = (state.x.col(spring.b) - state.x.col(spring.a)).norm();
                if (l >= spring.rest_length) energy += law_at(spring, l).energy;
            }
            Scene threads = as_threads(pushing);
            threads.set_gravity(Eigen::Vector3d::Zero());
            CHECK_THAT(threads.potential_energy(state),
                       WithinRel(static_cast<double>(energy), pushing.kind().rounding()));
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
