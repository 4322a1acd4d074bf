// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/stability/stability.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"
#include "../support/referee.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::stability_range_test {

using taut::Method;

TEMPLATE_TEST_CASE(
    "stability: a scene is analysed if double holds the squares of its numbers, or "
    "refused by name",
    "[stability][bad_input]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>)) {
    constexpr int Dim = TestType::Dim;
    using Vector = Eigen::Matrix<double, Dim, 1>;
    Random random(29);
    int refused = 0;
    for (int i = 0; i < 400; ++i) {
        // One of four numbers near the ends of the range, on either side.
        const double size = std::exp2(random.uniform(495, 505) * (random.below(2) == 0 ? 1 : -1));
        const Index which = random.below(4);
        const auto number = [&](Index place) { return place == which ? size : 1.0; };
        taut::SpringSystem<double, Dim> system;
        system.add_particle(Vector::Zero(), 1);
        system.add_particle(Vector(number(0) * Vector::Unit(0)), number(1));
        system.add_spring(taut::Spring<double, taut::Hookean>{0, 1, {number(2)}, number(3)});
        system.pin(0);
        const bool length = which == 0 || which == 3;
        const bool holds = size <= 0x1p500 && (length || size >= 0x1p-500);
        const char* const names[] = {"position of particle 1", "mass of particle 1",
                                     "stiffness of spring 0", "rest length of spring 0"};
        INFO(names[which] << " is " << size);
        const auto message = message_of([&] {
            const taut::Stability<double> stability(system, system.initial_state());
            const auto limit = stability.max_step(Method::symplectic_euler);
            const Real k = number(2) / static_cast<Real>(number(1));
            CHECK(limit.certified > 0);
            CHECK(static_cast<Real>(limit.certified) <= 2 / std::sqrt(k));
        });
        CHECK((message == "") == holds);
        if (!holds) CHECK(missing(message, {names[which]}) == "");
        refused += !holds;
    }
    CHECK(refused > 50);
    CHECK(refused < 200);
}

TEMPLATE_TEST_CASE(
    "stability: damping is analysed if the system's scalars hold it, or refused by name",
    "[stability][bad_input]", float, double) {
    constexpr double most = static_cast<double>(std::numeric_limits<TestType>::max());
    Random random(30);
    int refused = 0;
    for (int i = 0; i < 200; ++i) {
        const double size = std::exp2(random.uniform(-400, 400));
        const Index which = random.below(2);
        const double k = log_uniform(random, 1e-3, 1e3);
        INFO("damping " << which << " is " << size);
        const auto message = message_of([&] {
            taut::SpringSystem<TestType, 2> system;
            system.add_particle({0, 0}, 1);
            system.add_particle({1, 0}, 1);
            system.add_spring(0, 1, static_cast<TestType>(k));
            system.pin(0);
            system.set_rayleigh({which == 0 ? size : 0, which == 1 ? size : 0});
            const taut::Stability<TestType> stability(system, system.initial_state());
            const auto largest = stability.stiffness_spectrum().k_max;
            CHECK(largest.upper >= static_cast<double>(static_cast<TestType>(k)));
            CHECK(largest.lower <= largest.upper);
        });
        CHECK((message == "") == (size <= most));
        if (size > most) {
            const char* const names[] = {"mass_proportional", "stiffness_proportional"};
            CHECK(missing(message, {names[which], "end at"}) == "");
        }
        refused += size > most;
    }
    CHECK((refused > 50) == (sizeof(TestType) == sizeof(float)));
}

}  // namespace taut_test::stability_range_test
