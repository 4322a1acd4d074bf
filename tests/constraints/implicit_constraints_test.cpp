// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <taut/constraints/constraints.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/newton/newton.hpp>
#include <taut/own_matrices/linear_system.hpp>
#include <taut/model/spring_system.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/solver/conjugate_gradient.hpp>

#include "../support/catch.hpp"
#include "../support/dense.hpp"
#include "../support/direct_euler.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::implicit_constraints_test {

using taut::ParticleConstraints;

namespace {

using Springs = taut::SpringSystem<double, 3>;

Springs draw_system(Random& random) {
    RandomOptions options;
    options.dampers = true;
    options.rayleigh = true;
    return random_system<double, 3>(random, options);
}

/// With a direct solver: exact to rounding.
template <class System>
struct Constrained : taut::ConstrainedEuler<System, taut::SparseCholesky<typename System::Scalar>> {
    explicit Constrained(const System& system)
        : taut::ConstrainedEuler<System, taut::SparseCholesky<typename System::Scalar>>(system) {}
};

}  // namespace

TEST_CASE("implicit_constraints: a particle held at a point moves as a pinned one",
          "[integrator]") {
    Random random(2);
    auto system = draw_system(random);
    auto state = random_state(random, system);
    state.v.col(5).setZero();
    auto expected = state;
    auto pinned = system;
    pinned.pin(5);
    Constrained stepper(system);
    stepper.constraints().fix(5);
    DirectEuler reference(pinned);
    REQUIRE(stepper.step(state, 0.02, 5));
    REQUIRE(reference.step(expected, 0.02, 5));
    CHECK(distance(state.x, expected.x) <= Tolerance<double>::accumulated);
}

TEMPLATE_TEST_CASE("implicit_constraints: planes, lines and prescribed velocities are held",
                   "[integrator]", float, double) {
    Random random(3);
    const auto system = random_system<TestType, 3>(random);
    auto state = random_state(random, system);
    const auto start = state;
    using Vector = Eigen::Matrix<TestType, 3, 1>;
    const Vector normal = random.vector<TestType, 3>(-1, 1);
    const Vector line = random.vector<TestType, 3>(-1, 1);
    const Vector velocity = random.vector<TestType, 3>(-1, 1);
    Constrained stepper(system);
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

TEST_CASE("implicit_constraints: with its constraint forces a step is that of free particles",
          "[integrator]") {
    // The same forces as external ones, and no constraint, give the same step.
    Random random(4);
    auto system = draw_system(random);
    const auto start = random_state(random, system);
    Constrained stepper(system);
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
    DirectEuler free_stepper(system);
    REQUIRE(free_stepper.step(pushed, 0.05));
    CHECK(distance(held.v, pushed.v) <= Tolerance<double>::accumulated * largest(held.v));
}

TEST_CASE("implicit_constraints: constraints of a linear system, and their release",
          "[integrator]") {
    Random random(5);
    const auto springs = random_system<double, 2>(random);
    auto pose = springs.initial_state();
    pose.x *= 3;
    const auto linear = taut::linearize(springs, pose);
    auto u = linear.initial_state();
    Constrained stepper(linear);
    stepper.constraints().fix(4);
    REQUIRE(stepper.step(u, 0.1, 5));
    CHECK(u.x(0, 4) == 0);
    CHECK(u.x(0, 5) != 0);
    stepper.constraints().release(4);
    auto expected = u;
    REQUIRE(stepper.step(u, 0.1));
    DirectEuler reference(linear);
    REQUIRE(reference.step(expected, 0.1));
    CHECK(distance(u.v, expected.v) <= Tolerance<double>::accumulated);
}

TEST_CASE("implicit_constraints: filtered conjugate gradients take the direct solver's step",
          "[integrator]") {
    Random random(8);
    const auto system = draw_system(random);
    auto by_factors = random_state(random, system);
    auto by_gradients = by_factors;
    Constrained direct(system);
    taut::ConstrainedEuler<Springs, taut::ConjugateGradient<double, 3>> filtered(system);
    filtered.configure([](auto& solver) { solver.setTolerance(1e-12); });
    const auto hold = [](auto& stepper, int phase) {
        auto& constraints = stepper.constraints();
        constraints.clear();
        constraints.hold_in_plane(3, {1, -1, 2}, 0.5 * phase);
        if (phase != 1) constraints.prescribe(6, {0, 1.0 * phase, 0});
        if (phase != 2) constraints.hold_on_line(4, {1, 1, 0});
    };
    for (const int phase : {0, 1, 2}) {
        hold(direct, phase);
        hold(filtered, phase);
        REQUIRE(direct.step(by_factors, 0.02, 3));
        REQUIRE(filtered.step(by_gradients, 0.02, 3));
        CHECK(distance(by_factors.v, by_gradients.v) <= 1e-9 * largest(by_factors.v));
        CHECK(distance(direct.constraint_forces(), filtered.constraint_forces()) <=
              1e-7 * largest(direct.constraint_forces()));
    }
}

TEST_CASE("implicit_constraints: Newton's step holds them and its forces stand in for them",
          "[integrator]") {
    Random random(9);
    auto system = random_system<double, 3>(random);
    const auto start = random_state(random, system);
    using Newton = taut::NewtonEuler<Springs>;
    Newton::Options options;
    options.tolerance = 1e-12;
    Newton stepper(system, options);
    stepper.constraints().hold_in_plane(3, {1, 2, -1}, 0.5);
    stepper.constraints().prescribe(7, {0, 0, 1});
    auto held = start;
    REQUIRE(stepper.step(held, 0.05));
    CHECK_THAT(Eigen::Vector3d(1, 2, -1).normalized().dot(held.v.col(3)),
               WithinAbs(0.5, Tolerance<double>::accumulated));
    CHECK(distance(held.v.col(7), Eigen::Vector3d(0, 0, 1)) <= Tolerance<double>::accumulated);
    const auto forces = stepper.constraint_forces();
    CHECK((forces.col(5).array() == 0).all());
    auto released = held;
    stepper.constraints().clear();
    REQUIRE(stepper.step(released, 0.05));
    CHECK(stepper.constraint_forces().cols() == 0);
    system.set_external_force([forces](const auto&, auto& f) { f += forces; });
    auto pushed = start;
    Newton free_stepper(system, options);
    REQUIRE(free_stepper.step(pushed, 0.05));
    CHECK(distance(held.v, pushed.v) <= 1e-8 * largest(held.v));
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
    Constrained stepper(system);
    stepper.constraints().fix(8);
    const auto report = stepper.step(state, 0.01);
    CHECK(report.status == taut::Status::invalid_state);
    CHECK(report.where == 8);
    CHECK(same_bits(state, before));
}

TEST_CASE("particle_constraints: a small contradiction beside a large speed is one",
          "[model][bad_input]") {
    ParticleConstraints<double, 2> constraints;
    constraints.hold(4, {0, 1}, 100);
    constraints.hold(4, {1, 0}, 0);
    CHECK(missing(message_of([&] {
                      constraints.hold(4, {1, 0}, 0.03);
                  }),
                  {"particle 4", "contradicts"}) == "");
    constraints.hold(4, {3, 4}, 80);  // implied
}

TEST_CASE("particle_constraints: directions that are nearly one do not make a speed across them",
          "[model][bad_input]") {
    for (const double angle : {1e-3, 1e-5, 1e-9}) {
        INFO("angle " << angle);
        ParticleConstraints<double, 2> constraints;
        constraints.hold(2, {1, 0}, 0);
        const auto hold = [&] { constraints.hold(2, {std::cos(angle), std::sin(angle)}, 1); };
        if (angle > 1e-4) {
            hold();
            CHECK_THAT(constraints.held().at(2).velocity().norm(),
                       WithinRel(1 / std::sin(angle), 1e-9));
        } else {
            CHECK(missing(message_of(hold), {"particle 2", "contradicts"}) == "");
        }
    }
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

}  // namespace taut_test::implicit_constraints_test
