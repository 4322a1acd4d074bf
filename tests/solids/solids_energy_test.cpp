// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/solids/solids.hpp>

#include "../contact/random_scenes.hpp"
#include "../support/catch.hpp"
#include "meshes.hpp"

namespace taut_test::solids_energy_test {

using taut::ConvexHull;
using taut::SolidMesh;

TEMPLATE_TEST_CASE("solids: no step raises the energy beyond their work", "[solids]", float,
                   double) {
    Random random(66);
    const auto with = [&](bool convex) {
        return gained_in_scenes<TestType, 3>(random, 100, [&](auto& contacts, auto& pose) {
            taut::BodyOptions options;
            if (random.below(2) > 0) options.friction = random.uniform(0, 2);
            if (random.below(2) > 0) options.thickness = random.uniform(0, 0.1);
            if (convex) {
                contacts.add(ConvexHull<TestType>(random.points<TestType, 3>(12, -0.5, 0.5)),
                             options, pose);
                return;
            }
            const ClosedMesh mesh =
                random.below(2) ? bumpy_ring(random, 8, 5) : bumpy_ball(random, 1);
            contacts.add(SolidMesh<TestType>(mesh.points.cast<TestType>(), mesh.triangles), options,
                         pose);
        });
    };
    for (const bool convex : {true, false}) {
        const Gained gained = with(convex);
        INFO("convex " << convex);
        CHECK(gained.worst < 100);
        CHECK(gained.touched > 200);
    }
}

}  // namespace taut_test::solids_energy_test
