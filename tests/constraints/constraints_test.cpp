// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include <taut/integrator/implicit_euler.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "held.hpp"

namespace taut_test::constraints_test {

using taut::ParticleConstraints;

namespace {

using Free = Tight<taut::ImplicitEuler<Springs>>;

}  // namespace

TEST_CASE("constraints: a particle held at a point moves as a pinned one", "[constraints]") {
    Random random(2);
    const auto system = draw_system(random);
    auto state = random_state(random, system);
    state.v.col(5).setZero();
    auto expected = state;
    auto pinned = system;
    pinned.pin(5);
    Constrained stepper(system);
    stepper.constraints().fix(5);
    REQUIRE(stepper.step(state, 0.02, 5));
    REQUIRE(Free(pinned).step(expected, 0.02, 5));
    CHECK(distance(state.x, expected.x) <= Tolerance<double>::accumulated);
}

TEMPLATE_TEST_CASE("constraints: planes, lines and prescribed velocities are held", "[constraints]",
                   float, double) {
    using System = taut::SpringSystem<TestType, 3>;
    using Vector = typename System::Vector;
    Random random(3);
    const auto system = random_like<System>(random);
    auto state = random_state(random, system);
    const auto start = state;
    const Vector normal = random.vector<TestType, 3>(-1, 1);
    const Vector line = random.vector<TestType, 3>(-1, 1);
    const Vector velocity = random.vector<TestType, 3>(-1, 1);
    Tight<taut::ConstrainedEuler<System>> stepper(system);
    stepper.constraints().hold_in_plane(3, normal, TestType(0.25));
    stepper.constraints().hold_on_line(4, line);
    stepper.constraints().prescribe(6, velocity);
    stepper.constraints().fix(0);  // pinned: it keeps its own velocity
    const TestType h = TestType(0.02);
    REQUIRE(stepper.step(state, h, 10));
    const double tolerance = Tolerance<TestType>::rounding;
    CHECK_THAT(static_cast<double>(normal.normalized().dot(state.v.col(3))),
               WithinAbs(0.25, tolerance));
    CHECK(static_cast<double>(Vector(state.v.col(4)).cross(line).norm()) <= 10 * tolerance);
    CHECK(distance(state.v.col(6), velocity) <= tolerance);
    CHECK(distance(state.x.col(6), start.x.col(6) + TestType(10) * h * velocity) <= tolerance);
    CHECK(distance(state.v.col(0), start.v.col(0)) == 0);
    CHECK(distance(state.v.col(5), start.v.col(5)) > 0.1);
}

TEST_CASE("constraints: with their forces a step is that of free particles", "[constraints]") {
    check_forces<Constrained>(Tolerance<double>::accumulated);
}

TEST_CASE("constraints: of one particle they add up, and the filter takes their part away",
          "[constraints]") {
    ParticleConstraints<double, 3> constraints;
    constraints.hold_in_plane(2, {1, 0, 0}, 3);
    constraints.hold_in_plane(2, {1, 1, 0}, 5);
    CHECK(constraints.held().at(2).count == 2);
    const Eigen::Vector3d velocity = constraints.held().at(2).velocity();
    CHECK_THAT(velocity.x(), WithinRel(3.0, Tolerance<double>::rounding));
    CHECK_THAT((velocity.x() + velocity.y()) / std::sqrt(2.0),
               WithinRel(5.0, Tolerance<double>::rounding));
    constraints.hold_in_plane(2, {1, -2, 0}, (3 - 2 * velocity.y()) / std::sqrt(5.0));  // implied
    CHECK(constraints.held().at(2).count == 2);
    Random random(6);
    auto values = random.points<double, 3>(4, -1, 1);
    const auto before = values;
    constraints.filter(values);
    CHECK(values.col(2).head(2).norm() <= Tolerance<double>::rounding);
    CHECK_THAT(values(2, 2), WithinRel(before(2, 2), Tolerance<double>::rounding));
    CHECK((values.leftCols(2) == before.leftCols(2)));
}

TEST_CASE("constraints: contradictions and bad values are named by their particle",
          "[constraints][bad_input]") {
    ParticleConstraints<double, 2> constraints;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto says = [&](std::initializer_list<const char*> words, auto change) {
        CHECK(missing(message_of([&] { change(); }), words) == "");
    };
    constraints.hold_in_plane(7, {0, 2}, 1);
    constraints.hold_in_plane(7, {0, -1}, -1);
    says({"particle 7", "speed of -1", "contradicts"}, [&] {
        constraints.hold_in_plane(7, {0, -1}, 1);
    });
    says({"particle 7", "contradicts"}, [&] { constraints.fix(7); });
    says({"particle 3"}, [&] { constraints.prescribe(3, {0, nan}); });
    says({"particle 4"}, [&] { constraints.hold_in_plane(4, {0, 0}); });
    says({"particle 5"}, [&] { constraints.hold_on_line(5, {nan, 0}); });
    says({"particle is -1"}, [&] { constraints.fix(-1); });
    CHECK(constraints.held().size() == 1);  // nothing is left of what was refused
    CHECK(constraints.held().at(7).count == 1);

    // Beside a large speed a small contradiction is one, too.
    constraints.hold(4, {0, 1}, 100);
    constraints.hold(4, {1, 0}, 0);
    says({"particle 4", "contradicts"}, [&] { constraints.hold(4, {1, 0}, 0.03); });
    constraints.hold(4, {3, 4}, 80);  // implied

    // Directions that are nearly one do not make a speed across them.
    for (const double angle : {1e-3, 1e-5, 1e-9}) {
        INFO("angle " << angle);
        constraints.release(2);
        constraints.hold(2, {1, 0}, 0);
        const auto hold = [&] { constraints.hold(2, {std::cos(angle), std::sin(angle)}, 1); };
        if (angle < 1e-4) {
            says({"particle 2", "contradicts"}, hold);
            continue;
        }
        hold();
        CHECK_THAT(constraints.held().at(2).velocity().norm(),
                   WithinRel(1 / std::sin(angle), 1e-9));
    }

    Random random(7);
    const auto system = draw_system(random);
    auto state = random_state(random, system);
    const auto before = state;
    Constrained stepper(system);
    stepper.constraints().fix(8);
    const auto report = stepper.step(state, 0.01);
    CHECK(report.status == taut::Status::invalid_state);
    CHECK(report.where == 8);
    CHECK(same_bits(state, before));
}

}  // namespace taut_test::constraints_test
