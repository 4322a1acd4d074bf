// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <taut/integrator/constrained_implicit_euler.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/model/spring_system.hpp>

#include "../support/catch.hpp"
#include "../support/dense.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::constrained_implicit_euler_test {

using taut::ConstrainedImplicitEuler;
using taut::ParticleConstraints;

namespace {

using Springs = taut::SpringSystem<double, 3>;

Springs draw_system(Random& random) {
    RandomOptions options;
    options.dampers = true;
    options.rayleigh = true;
    return random_system<double, 3>(random, options);
}

}  // namespace

TEST_CASE("constrained_implicit_euler: without constraints it is implicit Euler", "[integrator]") {
    Random random(1);
    const auto system = draw_system(random);
    auto state = random_state(random, system);
    auto expected = state;
    ConstrainedImplicitEuler stepper(system);
    taut::ImplicitEuler reference(system);
    REQUIRE(stepper.step(state, 0.02, 5));
    REQUIRE(reference.step(expected, 0.02, 5));
    CHECK(distance(state.x, expected.x) <= Tolerance<double>::accumulated);
    CHECK(distance(state.v, expected.v) <= Tolerance<double>::accumulated * 10);
    CHECK((stepper.constraint_forces().array() == 0).all());
}

TEST_CASE("constrained_implicit_euler: a particle held at a point moves as a pinned one",
          "[integrator]") {
    Random random(2);
    auto system = draw_system(random);
    auto state = random_state(random, system);
    state.v.col(5).setZero();
    auto expected = state;
    auto pinned = system;
    pinned.pin(5);
    ConstrainedImplicitEuler stepper(system);
    stepper.constraints().fix(5);
    taut::ImplicitEuler reference(pinned);
    REQUIRE(stepper.step(state, 0.02, 5));
    REQUIRE(reference.step(expected, 0.02, 5));
    CHECK(distance(state.x, expected.x) <= Tolerance<double>::accumulated);
}

TEMPLATE_TEST_CASE("constrained_implicit_euler: planes, lines and prescribed velocities are held",
                   "[integrator]", float, double) {
    Random random(3);
    const auto system = random_system<TestType, 3>(random);
    auto state = random_state(random, system);
    const auto start = state;
    using Vector = Eigen::Matrix<TestType, 3, 1>;
    const Vector normal = random.vector<TestType, 3>(-1, 1);
    const Vector line = random.vector<TestType, 3>(-1, 1);
    const Vector velocity = random.vector<TestType, 3>(-1, 1);
    ConstrainedImplicitEuler stepper(system);
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

TEST_CASE("constrained_implicit_euler: with its constraint forces a step is that of free particles",
          "[integrator]") {
    // The same forces as external ones, and no constraint, give the same step.
    Random random(4);
    auto system = draw_system(random);
    const auto start = random_state(random, system);
    ConstrainedImplicitEuler stepper(system);
    stepper.constraints().hold_in_plane(3, {1, 2, -1}, 0.5);
    stepper.constraints().hold_on_line(4, {0, 1, 1});
    stepper.constraints().fix(7);
    auto held = start;
    REQUIRE(stepper.step(held, 0.05));
    const auto forces = stepper.constraint_forces();
    CHECK(largest(forces.col(3)) > 0);
    CHECK(Eigen::Vector3d(forces.col(3)).cross(Eigen::Vector3d(1, 2, -1)).norm() <=
          Tolerance<double>::accumulated * largest(forces));
    CHECK((forces.col(5).array() == 0).all());
    system.set_external_force([forces](const auto&, auto& f) { f += forces; });
    auto pushed = start;
    taut::ImplicitEuler free_stepper(system);
    REQUIRE(free_stepper.step(pushed, 0.05));
    CHECK(distance(held.v, pushed.v) <= Tolerance<double>::accumulated * largest(held.v));
}

TEST_CASE("constrained_implicit_euler: constraints of a linear system, and their release",
          "[integrator]") {
    Random random(5);
    const auto springs = random_system<double, 2>(random);
    auto pose = springs.initial_state();
    pose.x *= 3;
    const auto linear = springs.linearize(pose);
    auto u = linear.initial_state();
    ConstrainedImplicitEuler stepper(linear);
    stepper.constraints().fix(4);
    REQUIRE(stepper.step(u, 0.1, 5));
    CHECK(u.x(0, 4) == 0);
    CHECK(u.x(0, 5) != 0);
    stepper.constraints().release(4);
    auto expected = u;
    REQUIRE(stepper.step(u, 0.1));
    taut::ImplicitEuler reference(linear);
    REQUIRE(reference.step(expected, 0.1));
    CHECK(distance(u.v, expected.v) <= Tolerance<double>::accumulated);
}

TEST_CASE("particle_constraints: they add up, and the filter takes their part away", "[model]") {
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

TEST_CASE("particle_constraints: contradictions and bad values are named by their particle",
          "[model][bad_input]") {
    ParticleConstraints<double, 2> constraints;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto message = [&](auto change) { return message_of([&] { change(); }); };
    constraints.hold_in_plane(7, {0, 2}, 1);
    CHECK(missing(message([&] {
                      constraints.hold_in_plane(7, {0, -1}, 1);
                  }),
                  {"particle 7", "speed of -1", "contradicts"}) == "");
    CHECK(message([&] { constraints.hold_in_plane(7, {0, -1}, -1); }) == "");
    CHECK(missing(message([&] { constraints.fix(7); }), {"particle 7", "contradicts"}) == "");
    CHECK(missing(message([&] { constraints.prescribe(3, {0, nan}); }), {"particle 3"}) == "");
    CHECK(missing(message([&] { constraints.hold_in_plane(4, {0, 0}); }), {"particle 4"}) == "");
    CHECK(missing(message([&] { constraints.hold_on_line(5, {nan, 0}); }), {"particle 5"}) == "");
    CHECK(missing(message([&] { constraints.fix(-1); }), {"particle is -1"}) == "");

    Random random(7);
    const auto system = random_system<double, 2>(random);
    auto state = random_state(random, system);
    const auto before = state;
    ConstrainedImplicitEuler stepper(system);
    stepper.constraints().fix(8);
    const auto report = stepper.step(state, 0.01);
    CHECK(report.status == taut::Status::invalid_state);
    CHECK(report.where == 8);
    CHECK(same_bits(state, before));
}

TEST_CASE("particle_constraints: what is refused changes nothing", "[integrator][bad_input]") {
    taut::ParticleConstraints<double, 3> constraints;
    CHECK_THROWS_AS(constraints.prescribe(3, {1, std::nan(""), 0}), std::invalid_argument);
    CHECK(constraints.held().empty());
    constraints.hold(3, {0, 1, 0}, 2);
    CHECK_THROWS_AS(constraints.fix(3), std::invalid_argument);
    CHECK(constraints.held().at(3).count == 1);
    CHECK_THROWS_AS(constraints.hold_on_line(3, {1, 0, 0}), std::invalid_argument);
    CHECK(constraints.held().at(3).count == 1);
}

}  // namespace taut_test::constrained_implicit_euler_test
