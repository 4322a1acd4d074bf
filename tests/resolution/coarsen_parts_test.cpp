// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <set>
#include <taut/model/tension_only.hpp>
#include <taut/resolution/coarsen.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"

namespace taut_test::coarsen_parts_test {

using taut::coarsen;
using taut::Index;

TEST_CASE("coarsen: each part keeps a particle, and springs without length do no harm", "[scene]") {
    taut::SpringSystem<double, 3> system;
    for (int part = 0; part < 3; ++part)
        for (int i = 0; i < 10; ++i) {
            system.add_particle({i * 0.1, part * 1.0, 0}, 0.1);
            if (i > 0) system.add_spring(10 * part + i - 1, 10 * part + i, 50);
        }
    // Two seams: particles that lie on each other, joined by springs of no length.
    for (const Index i : {4, 5}) {
        const Index twin = system.add_particle(system.initial_state().x.col(i), 0.1);
        system.add_spring(taut::Spring<double, taut::Hookean>{i, twin, {1000}, 0, 0});
        system.add_spring(twin, i + 1, 50);
    }
    system.pin(4);
    for (const Index count : {3, 8, 31, 32}) {
        const auto coarse = coarsen(system, count);
        std::set<int> parts;
        for (const int seed : coarse.seeds) parts.insert(seed < 30 ? seed / 10 : 0);
        CHECK(parts.size() == 3);
        CHECK(coarse.system.initial_state().finite());
        coarse.system.visit_springs([](const auto& spring) {
            CHECK(std::isfinite(spring.parameters.stiffness));
            CHECK(std::isfinite(spring.rest_length));
        });
        if (count == 32) {
            Index glued = 0;
            coarse.system.visit_springs(
                [&](const auto& spring) { glued += spring.rest_length == 0; });
            CHECK(glued == 2);
        }
    }
    CHECK(taut::least_count(system) == 3);
    CHECK(missing(message_of([&] { coarsen(system, 2); }), {"count is 2", "at least 3"}) == "");
}

TEST_CASE("coarsen: slack and taut threads between the same ends stay apart", "[scene]") {
    taut::SpringSystem<double, 1, taut::TensionOnly> threads;
    using Vector = Eigen::Matrix<double, 1, 1>;
    threads.add_particle(Vector(0.0), 1);
    threads.add_particle(Vector(1.0), 1);
    for (const double rest : {0.7, 1.3})
        threads.add_spring(taut::Spring<double, taut::TensionOnly>{0, 1, {20}, rest, 0});
    const auto coarse = coarsen(threads, 2);
    CHECK(coarse.system.spring_count() == 2);
    taut::Points<double, 1> f;
    coarse.system.force(coarse.system.initial_state(), f);
    CHECK_THAT(std::abs(f(0, 0)), Catch::Matchers::WithinRel(6, 1e-12));
}

}  // namespace taut_test::coarsen_parts_test
