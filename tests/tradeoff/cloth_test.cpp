// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/scene/cloth.hpp>
#include <taut/tradeoff/tradeoff.hpp>

#include "../support/catch.hpp"
#include "../support/compiled_once.hpp"

namespace taut_test::cloth_test {

using taut::Candidate;
using taut::Method;

TEST_CASE("measure_tradeoff: a cloth's energy under each stepper", "[tradeoff]") {
    const auto scene = taut::hanging_cloth<double>({4, 4});
    const double h = 0.25 * taut::any_pose_limit(scene).certified;
    taut::TradeoffMeter<taut::SpringSystem<double, 3>> meter(scene, scene.initial_state(), 0.3);
    for (const Candidate candidate :
         {Candidate{Method::symplectic_euler, h}, Candidate{Method::velocity_verlet, h},
          Candidate{Method::implicit_euler, 0.01}, Candidate{Method::bdf2, 0.01},
          Candidate{Method::symplectic_euler, 0.01}})
        meter.add(candidate);
    const auto points = meter.finish().points;
    CHECK(std::abs(points[0].energy_drift) < 0.01);
    CHECK(std::abs(points[1].energy_drift) < 0.001);
    CHECK(points[2].energy_drift < -0.05);
    CHECK(points[1].position_error < 0.1 * points[0].position_error);
    CHECK(points[3].finished);
    CHECK(points[3].position_error < 0.75 * points[2].position_error);
    CHECK(points[3].energy_drift > 0.75 * points[2].energy_drift);
    CHECK(!(points[4].position_error < 10));  // far above its limit
}

}  // namespace taut_test::cloth_test
