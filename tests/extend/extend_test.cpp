// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <taut/guard/guard.hpp>
#include <taut/integrator/energy_stable_euler.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/lattice/chain.hpp>
#include <taut/proof/stability.hpp>
#include <taut/taut.hpp>
#include <vector>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/scene_on.hpp"
#include "../support/stepper_battery.hpp"
#include "../support/sweep_checks.hpp"
#include "../support/temporary_file.hpp"
#include "drag_leapfrog.hpp"
#include "ring.hpp"
#include "stiffening.hpp"
#include "xyz_format.hpp"

// A law, an integrator with its limit, a scene and a file format of a program's own: by what Taut's
// headers offer, nothing added to them. CONTRIBUTING.md lists the files.

namespace taut_test::extend_test {

namespace {

template <class Scalar>
using Chain = taut::SpringSystem<Scalar, 1>;

constexpr Index masses = 40;

template <class Scalar>
Chain<Scalar> chain() {
    return taut::chain<Scalar>({masses, taut::ChainEnds::fixed_fixed, 0.5, 200});
}

}  // namespace

TEST_CASE("extend: an integrator of one's own keeps what steppers promise", "[extend]") {
    test_stepper(
        {[](const Scene& scene) {
             return make_stepper<DragLeapfrog, Plain<float, 3>, Plain<double, 2>, Plain<double, 3>>(
                 scene, 0.0);
         },
         {{true, 3}, {false, 2}, {false, 3}},
         {},
         {},
         DragLeapfrog<Plain<double, 3>>::order,
         true});
}

TEMPLATE_TEST_CASE("extend: the limit of an integrator of one's own is the chain's closed form",
                   "[extend]", float, double) {
    const auto system = chain<TestType>();
    const auto rest = system.initial_state();
    const taut::Stability<TestType> stability(system, rest);
    const auto limit = stability.max_step(DragLeapfrog<Chain<TestType>>::certified);
    const double angle = double(masses) / double(masses + 1) * std::acos(-1.0) / 2;
    const double exact = 1 / (std::sqrt(200 / 0.5) * std::sin(angle));
    CHECK(limit.certified <= exact);
    CHECK(limit.certified >= 0.998 * exact);
    CHECK(limit.cause == taut::Cause::stiffness);
    CHECK(limit.revision == system.revision());
    CHECK(limit.step_for(system, TestType(0.5)) == limit.certified / 2);

    // Drag of the system is taken whole, as by symplectic Euler, and costs both as much.
    auto dragged = system;
    dragged.set_rayleigh({8, 0});
    const taut::Stability<TestType> whole(dragged, rest);
    const auto symplectic = whole.max_step(taut::Method::symplectic_euler).certified;
    const auto own = whole.max_step(DragLeapfrog<Chain<TestType>>::certified).certified;
    CHECK((own <= symplectic && own >= TestType(0.99) * symplectic));

    for (const double drag : {0.0, 1e-3, 8.0, 1000.0}) {
        INFO("drag " << drag);
        DragLeapfrog<Chain<TestType>> stepper(system, drag);
        auto state = rest;
        for (Index i = 0; i < masses; ++i) state.v(0, i) = TestType(i % 2 == 0 ? 1e-3 : -1e-3);
        const auto start = state;
        REQUIRE(stepper.step(state, TestType(0.999) * limit.certified, 4000));
        CHECK((state.x - rest.x).cwiseAbs().maxCoeff() < TestType(0.1));
        state = start;
        const bool finite = bool(stepper.step(state, TestType(1.01 * exact), 4000));
        if (drag <= 1e-3) CHECK((!finite || (state.x - rest.x).cwiseAbs().maxCoeff() > 10));
    }
}

TEMPLATE_TEST_CASE("extend: a condition of one's own is rounded, and says what limits nothing",
                   "[extend]", float, double) {
    const auto system = chain<TestType>();
    const taut::Stability<TestType> stability(system, system.initial_state());
    const auto of = [&](double h) {
        return stability.max_step([=](const taut::Pencil&) { return h; });
    };
    constexpr double infinity = std::numeric_limits<double>::infinity();
    CHECK(static_cast<double>(of(0.1).certified) <= 0.1);
    CHECK(std::isinf(of(infinity).certified));
    CHECK(of(infinity).cause == taut::Cause::nothing_to_limit);
    for (const double nothing : {0.0, -1.0, -infinity, std::nan(""), 1e-320})
        CHECK(of(nothing).certified <= TestType(1e-320));
    Chain<TestType> held;
    held.add_particle(typename Chain<TestType>::Vector(TestType(0)), TestType(1));
    held.pin(0);
    const taut::Stability<TestType> empty(held, held.initial_state());
    CHECK(std::isinf(empty.max_step([](const taut::Pencil&) { return 1.0; }).certified));
}

TEST_CASE("extend: a condition of one's own holds at any pose, by the graph's pencil", "[extend]") {
    const auto cloth = taut::hanging_cloth<double>({9, 7});
    const auto graph = taut::Pencil::any_pose(cloth);
    REQUIRE(graph.lost().empty());  // else it says nothing about the cloth
    const double own = DragLeapfrog<decltype(cloth)>::certified(graph);
    CHECK(std::abs(own / taut::any_pose_limit(cloth).certified - 1) <= 1e-12);
}

TEST_CASE("extend: a condition tells of compressed springs", "[extend]") {
    auto cloth = taut::hanging_cloth<double>({9, 7});
    auto state = cloth.initial_state();
    state.x *= 0.9;
    const taut::Stability<double> stability(cloth, state);
    const auto limit = stability.max_step(DragLeapfrog<decltype(cloth)>::certified);
    CHECK(limit.admitted_growth > 0);
    CHECK(limit.admitted_growth ==
          stability.max_step(taut::Method::symplectic_euler).admitted_growth);
}

TEMPLATE_TEST_CASE("extend: the guard cuts a frame into steps of one's own limit", "[extend]",
                   float, double) {
    const auto cloth = taut::hanging_cloth<TestType>({12, 12});
    const double limit =
        DragLeapfrog<taut::SpringSystem<TestType, 3>>::certified(taut::Pencil::any_pose(cloth));
    DragLeapfrog stepper(cloth, 2);
    taut::GuardedOptions<TestType> options;  // without `method` it would be given whole frames
    options.max_step = static_cast<TestType>(0.95 * limit);
    taut::Guarded guard(cloth, stepper, options);
    auto state = cloth.initial_state();
    state.v.row(2).tail(11 * 12).setConstant(20);
    const double before = cloth.energy(state);
    for (int frame = 0; frame < 60; ++frame) {
        const auto report = guard.advance(state, TestType(1) / 60);
        REQUIRE(report);
        CHECK(report.h <= options.max_step);
        CHECK(report.substeps >= 2);
        CHECK(report.energy < 1.1 * before);
    }
    CHECK(static_cast<double>(cloth.energy(state)) < 0.5 * before);  // by the drag
}

TEST_CASE("extend: a stepper of one's own takes an engine's arrays", "[extend]") {
    const auto cloth = taut::hanging_cloth<double>({5, 4});
    auto state = cloth.initial_state();
    state.v.row(2).setConstant(1);
    std::vector<double> x(60), v(60);
    taut::StateView<double, 3> view(x.data(), v.data(), 20);
    view.copy_from(state);
    DragLeapfrog stepper(cloth, 2);
    REQUIRE(stepper.step(view, 1e-3, 10));
    REQUIRE(stepper.step(state, 1e-3, 10));
    CHECK(view.x == state.x);
    CHECK(view.v == state.v);
    CHECK(state.v(2, 0) == 1);  // a pin knows no drag
    CHECK_FALSE(stepper.step(view, -1, 10));
    CHECK(view.x == state.x);
}

TEMPLATE_TEST_CASE("extend: a scene of one's own has its counts, masses, lengths and spectrum",
                   "[extend]", float, double) {
    const auto system = ring<TestType>({10, 2, 0.25, 40});
    REQUIRE((system.size() == 10 && system.spring_count() == 10));
    system.visit_springs([](const auto& spring) {
        CHECK_THAT(static_cast<double>(spring.rest_length),
                   WithinRel(4 * std::sin(std::acos(-1.0) / 10), Tolerance<TestType>::rounding));
    });
    CHECK(system.inverse_mass().minCoeff() == 4);
    CHECK(system.inverse_mass().maxCoeff() == 4);
    const double exact = 2 / std::sqrt(4 * 40 / 0.25);
    const auto certified = static_cast<double>(taut::any_pose_limit(system).certified);
    CHECK((certified <= exact && certified >= 0.999 * exact));
    CHECK(missing(message_of([] { (void)ring<TestType>({2}); }), {"ring: particles is 2", ">= 3"})
              .empty());
    CHECK(missing(message_of([] { (void)ring<TestType>({3, 0}); }), {"ring: radius is 0"}).empty());
}

TEST_CASE("extend: a file format of one's own is written frame by frame", "[extend]") {
    const TemporaryFile first("own00000.xyz"), second("own00001.xyz");
    taut::MeshSequence<XyzFormat> frames(temporary_prefix() + "own", {});
    const auto system = ring<double>();
    auto state = system.initial_state();
    REQUIRE(frames.write(state.x));
    state.x *= 2;
    REQUIRE(frames.write(state.x));
    std::ifstream in(second.path);
    std::string count, words, name;
    REQUIRE(std::getline(in, count));
    REQUIRE(std::getline(in, words));
    CHECK(count == "12");
    for (Index i = 0; i < 12; ++i) {
        Eigen::Vector3d p;
        REQUIRE(in >> name >> p[0] >> p[1] >> p[2]);
        CHECK((p == Eigen::Vector3d(state.x(0, i), state.x(1, i), 0)));
    }
    state.x(1, 7) = std::nan("");
    const auto report = frames.write(state.x);
    CHECK((report.status == taut::FileStatus::not_finite && report.where == 7));
    CHECK(frames.frames() == 2);
}

namespace {

template <class Scalar, int Dim>
void check_law(Random& random) {
    RandomOptions options;
    options.particles = 60;
    options.springs = 200;
    options.pinned = 0;
    options.gravity = false;
    const auto system = random_system<Scalar, Dim, Stiffening>(random, options);
    const auto start = random_state(random, system);
    check_equals_plain_path<taut::SymplecticEuler>(system, start);

    const auto limit = taut::energy_limit(system);
    taut::EnergyStableEuler stepper(system);
    auto state = start;
    double energy = system.energy(state);
    const double rounding = 4000 * std::numeric_limits<Scalar>::epsilon() * energy;
    for (int i = 0; i < 200; ++i) {
        REQUIRE(stepper.step(state, limit.certified));
        const double now = system.energy(state);
        REQUIRE(now <= energy + rounding);
        energy = now;
    }
}

}  // namespace

TEST_CASE("extend: a law of one's own runs in the sweep and keeps the promise of its bound",
          "[extend]") {
    Random random(91);
    for (int repeat = 0; repeat < 5; ++repeat) {
        check_law<float, 1>(random);
        check_law<float, 2>(random);
        check_law<float, 3>(random);
        check_law<double, 1>(random);
        check_law<double, 2>(random);
        check_law<double, 3>(random);
    }
}

}  // namespace taut_test::extend_test
