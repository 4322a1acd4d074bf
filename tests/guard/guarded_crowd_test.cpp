// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <memory>
#include <vector>

#include "../../bench/capes.hpp"
#include "../support/catch.hpp"
#include "../support/random_system.hpp"

namespace taut_test::guarded_crowd_test {

TEST_CASE("guarded_crowd: thirty capes, each as if it were alone", "[guard]") {
    constexpr int capes = 30, frames = 20;
    std::vector<std::unique_ptr<bench::Wearer>> crowd;
    for (int i = 0; i < capes; ++i) crowd.push_back(std::make_unique<bench::Wearer>());
    double energy = 0, work = 0, largest = 0;
    for (int frame = 0; frame < frames; ++frame) {
        for (int i = 0; i < capes; ++i) {
            const auto report = crowd[std::size_t(i)]->advance(frame, float(i));
            REQUIRE(report);
            CHECK(report.again == 0);
            if (i > 0) continue;
            if (frame > 0) work += report.work;
            if (frame == 0) energy = report.energy;
            largest = std::max(largest, double(crowd[0]->cape.kinetic_energy(crowd[0]->state)));
            CHECK(report.energy <= energy + work + 0.1 * largest + report.balance + report.slack);
        }
    }
    for (const int i : {0, 7, 29}) {
        bench::Wearer alone;
        for (int frame = 0; frame < frames; ++frame) REQUIRE(alone.advance(frame, float(i)));
        CHECK(same_bits(alone.state, crowd[std::size_t(i)]->state));
    }
    CHECK_FALSE(same_bits(crowd[1]->state, crowd[2]->state));
}

}  // namespace taut_test::guarded_crowd_test
