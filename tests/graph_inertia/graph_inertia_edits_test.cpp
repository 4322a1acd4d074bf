// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/IterativeLinearSolvers>
#include <functional>
#include <string>
#include <taut/graph_inertia/graph_inertia.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/stability/any_pose.hpp>

#include "../support/catch.hpp"
#include "../support/check_stepper.hpp"
#include "../support/graph_matrices.hpp"
#include "../support/message.hpp"

// When graph inertia factorises anew, and what it refuses.

namespace taut_test::graph_inertia_edits_test {

using taut::GraphInertia;
using taut::GraphInertiaOptions;
using taut::Hookean;
using taut::Status;
using System = taut::SpringSystem<double, 3>;

namespace {

/// A step that fails with `status` leaves the state as it was. @returns the particle it names
template <class AnySystem>
Index refused(const AnySystem& system, typename AnySystem::Scalar h, Status status) {
    GraphInertia<AnySystem> stepper(system);
    Random random(4500);
    auto state = random_state(random, system);
    const auto before = state;
    const taut::Report report = stepper.step(state, h, 3);
    CHECK(report.status == status);
    CHECK(same_bits(state, before));
    CHECK_FALSE(std::string(describe(report.status)).empty());
    return report.where;
}

}  // namespace

TEST_CASE("graph_inertia: a factor serves shorter steps and is renewed for what changes",
          "[integrator]") {
    Random random(4510);
    RandomOptions options;
    options.rayleigh = true;
    auto system = random_system<double, 3, Hookean>(random, options);
    const double h = 6 * taut::any_pose_limit(system).certified;
    auto state = random_state(random, system);
    GraphInertia stepper(system);
    CHECK(stepper.shares().step == 0);
    CHECK(stepper.factorizations() == 0);
    int expected = 1;
    const auto factorises = [&](double step, int times) {
        REQUIRE(stepper.step(state, step, 2));
        CHECK(stepper.factorizations() == (expected += times));
        CHECK(stepper.shares().revision == system.revision());
    };
    expected = 0;
    factorises(h, 1);
    for (const double part : {1.0, 0.5, 0.01, 1.0}) factorises(part * h, 0);
    factorises(1.5 * h, 1);
    factorises(h, 0);
    REQUIRE(stepper.prepare(h));
    ++expected;
    factorises(h, 0);
    // What no certificate depends on.
    system.set_gravity({0, 50, 0});
    factorises(h, 0);
    system.set_external_force([](const auto&, auto& f) { f.array() += 2.0; });
    factorises(h, 0);
    const std::vector<std::function<void()>> edits = {[&] { system.add_spring(2, 7, 300); },
                                                      [&] { system.set_stiffness(3, 2000); },
                                                      [&] { system.remove_spring(3); },
                                                      [&] { system.unpin(1); },
                                                      [&] { system.pin(4); },
                                                      [&] { system.set_mass(5, 7); },
                                                      [&] {
                                                          system.set_rayleigh({0, 0.1});
                                                      },
                                                      [&] { system.set_graph_damping(0.1); }};
    for (const auto& edit : edits) {
        edit();
        auto fresh_state = state;
        factorises(h, 1);
        GraphInertia fresh(system);
        REQUIRE(fresh.step(fresh_state, h, 2));
        CHECK(same_bits(state, fresh_state));
    }
}

TEST_CASE("graph_inertia: a torn spring leaves the inertia with its halves", "[integrator]") {
    auto system = hemmed_cloth<double, 3>(6, 6, 1e4);
    GraphInertia stepper(system);
    const double h = 0.9 * taut::any_pose_limit(hemmed_cloth<double, 3>(6, 6, 1)).certified;
    auto state = system.initial_state();
    REQUIRE(stepper.step(state, h));
    const Index touched = stepper.touched();
    CHECK(touched >= 6);
    CHECK(touched < 36);
    system.remove_springs([&](Index s) { return system.springs()[s].parameters.stiffness > 1; });
    REQUIRE(stepper.step(state, h));
    CHECK(stepper.touched() < touched);
    state.v.setOnes();
    CHECK(stepper.added_kinetic(state) == 0);
}

TEST_CASE("graph_inertia: what is not touched moves as under symplectic Euler", "[integrator]") {
    // A stiff part, a soft one and a particle alone: nothing joins them.
    System system;
    for (int i = 0; i < 7; ++i) system.add_particle({1.0 * i, 0, 0}, 1);
    system.add_spring(0, 1, 1e6);
    system.add_spring(1, 2, 1e6);
    system.add_spring(3, 4, 1);
    system.add_spring(4, 5, 1);
    system.set_gravity({0, -1, 0});
    Random random(4520);
    auto state = random_state(random, system);
    auto expected = state;
    GraphInertia stepper(system);
    REQUIRE(stepper.step(state, 0.1, 20));
    CHECK(stepper.touched() == 3);
    taut::SymplecticEuler plain(system);
    REQUIRE(plain.step(expected, 0.1, 20));
    CHECK(distance(state.x.rightCols(4), expected.x.rightCols(4)) <= 1e-12);
    CHECK(distance(state.x.leftCols(3), expected.x.leftCols(3)) > 1);
}

TEMPLATE_TEST_CASE("graph_inertia: bad input", "[integrator][bad_input]", float, double) {
    Random random(4530);
    const auto system = random_system<TestType, 2, Hookean>(random);
    check_bad_steps<GraphInertia>(system, random_state(random, system));
}

TEST_CASE("graph_inertia: steps and counts, pins, nothing free", "[integrator]") {
    check_counted_steps_are_single_steps<GraphInertia, double, 3>();
    check_pinned_particles_obey_their_velocity<GraphInertia, double>();
    check_nothing_free<GraphInertia>();
}

TEST_CASE("graph_inertia: steps too large for the masses, for numbers, for drag or for memory",
          "[integrator][bad_input]") {
    System system;
    for (int i = 0; i < 4; ++i) system.add_particle({1.0 * i, 0, 0}, i == 2 ? 1e9 : 1);
    system.add_spring(0, 1, 1);
    system.add_spring(2, 3, 1e16);
    // ¼h²k beside m = 1: more digits than double has.
    CHECK(refused(system, 1.0, Status::masses_lost) == 3);
    refused(system, 1e145, Status::masses_lost);
    GraphInertia stepper(system);
    auto state = system.initial_state();
    CHECK_FALSE(stepper.step(state, 1.0));
    CHECK(stepper.step(state, 0.01));  // none of it has broken the stepper
    for (const double k : {1e149, 1e300}) {
        System wild = system;
        wild.set_stiffness(0, k);
        GraphInertia any(wild);
        const auto before = state;
        CHECK_FALSE(any.step(state, 1e100));
        CHECK_FALSE(any.step(state, 1e300));
        CHECK(same_bits(state, before));
        CHECK(any.factorizations() == 0);
    }
    taut::SpringSystem<float, 3> single;
    for (int i = 0; i < 2; ++i) single.add_particle({1.0F * float(i), 0, 0}, 1);
    single.add_spring(0, 1, 1e7F);
    CHECK(refused(single, 1.0F, Status::masses_lost) == 0);

    const auto cloth = hemmed_cloth<double, 3>(6, 6, 1e4);
    const auto shares = taut::graph_shares(cloth, 1.0, GraphInertiaOptions().margin);
    taut::integrator_detail::GraphMatrix<std::decay_t<decltype(cloth)>> matrix;
    CHECK(matrix.build(cloth, shares, 0, 5).status == Status::too_large);
    CHECK(matrix.build(cloth, shares, 0, 10000));
    GraphInertia fits(cloth);
    auto hanging = cloth.initial_state();
    CHECK(fits.step(hanging, 1.0));

    auto dragged = hemmed_cloth<double, 3>(3, 3, 1);
    dragged.set_rayleigh({2, 0});
    refused(dragged, 0.84, Status::not_positive_definite);
    GraphInertia slow(dragged);
    auto sheet = dragged.initial_state();
    CHECK(slow.step(sheet, 0.8));
    CHECK_FALSE(slow.step(sheet, 0.84));
    CHECK(slow.step(sheet, 0.8));
}

TEST_CASE("graph_inertia: a scene with nothing to limit has no factor", "[integrator]") {
    System system;
    for (int i = 0; i < 3; ++i) system.add_particle({1.0 * i, 0, 0}, 1);
    system.set_gravity({0, 0, -2});
    GraphInertia stepper(system);
    auto state = system.initial_state();
    REQUIRE(stepper.step(state, 100.0, 3));
    CHECK(stepper.factorizations() == 0);
    CHECK_THAT(state.v(2, 1), WithinRel(-600.0, 1e-12));
}

TEST_CASE("graph_inertia: a step that diverges is found, and taken back", "[integrator]") {
    auto system = hemmed_cloth<double, 3>(5, 5, 1e4);
    system.set_external_force([](const auto& state, auto& f) {
        if (state.time > 3.5) f(1, 7) = std::numeric_limits<double>::infinity();
    });
    GraphInertia stepper(system);
    auto state = system.initial_state();
    const auto before = state;
    const auto report = stepper.step(state, 1.0, 10);
    CHECK(report.status == Status::diverged);
    CHECK(report.iterations == 4);
    CHECK(report.where >= 0);
    CHECK(same_bits(state, before));
    CHECK(stepper.step(state, 1.0, 4));
}

TEST_CASE("graph_inertia: options out of range", "[integrator][bad_input]") {
    System system;
    const auto message = [&](auto&& change) {
        GraphInertiaOptions options;
        change(options);
        return message_of([&] { GraphInertia<System> stepper(system, options); });
    };
    CHECK(missing(message([](auto& o) { o.threads = 0; }), {"threads is 0", ">= 1"}) == "");
    for (const double bad : {0.0, -0.1, 1.5, std::nan("")}) {
        CHECK(missing(message([&](auto& o) { o.margin = bad; }), {"margin", "(0, 1]"}) == "");
    }
    for (const double bad : {-0.1, 1.5, std::nan("")}) {
        CHECK(missing(message([&](auto& o) { o.dissipation = bad; }), {"dissipation", "[0, 1]"}) ==
              "");
    }
    CHECK(message([](auto& o) { o.dissipation = 1; }).empty());
}

TEST_CASE("graph_inertia: a solver that clears its destination serves as well", "[integrator]") {
    using Iterative =
        Eigen::ConjugateGradient<taut::SparseMatrix<double>, Eigen::Lower | Eigen::Upper>;
    const auto cloth = taut::hanging_cloth<double>({6, 6});
    taut::GraphInertia<System> direct(cloth);
    taut::GraphInertia<System, Iterative> iterative(cloth);
    auto state = cloth.initial_state();
    auto other = state;
    REQUIRE(direct.step(state, 0.01, 3));
    REQUIRE(iterative.step(other, 0.01, 3));
    CHECK(state.v.norm() > 0);
    CHECK((state.v - other.v).norm() <= 1e-9 * state.v.norm());
}

TEST_CASE("graph_inertia: a pin's change of velocity counts where its position is written as well",
          "[integrator]") {
    taut::SpringSystem<double, 2> rope;
    for (int i = 0; i < 4; ++i) rope.add_particle({0.1 * i, 0}, 0.01);
    for (int i = 0; i < 3; ++i) rope.add_spring(i, i + 1, 1e4);
    rope.pin(0);
    const auto speed_of_neighbour = [&](double nudge) {
        taut::GraphInertia stepper(rope);
        auto state = rope.initial_state();
        REQUIRE(stepper.step(state, 0.01));
        const auto seen = stepper.pins_seen();
        state.v(1, 0) = 1;
        state.x(1, 0) += nudge;
        auto next = state;
        REQUIRE(stepper.step(next, 0.01));
        const double first = next.v(1, 1);
        // Taken back and stepped once more, it is the same.
        stepper.see_pins(seen);
        next = state;
        REQUIRE(stepper.step(next, 0.01));
        CHECK(next.v(1, 1) == first);
        return first;
    };
    const double plain = speed_of_neighbour(0);
    CHECK(plain > 0.5);
    CHECK_THAT(speed_of_neighbour(1e-12), WithinRel(plain, 1e-6));
    CHECK_THAT(speed_of_neighbour(0.005), WithinRel(plain, 0.3));
}

}  // namespace taut_test::graph_inertia_edits_test
