// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <taut/bdf2/bdf2.hpp>
#include <taut/integrator/explicit_euler.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/projective/projective.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/integrator/velocity_verlet.hpp>
#include <taut/lattice/chain.hpp>
#include <taut/stability/any_pose.hpp>
#include <taut/stability/stability.hpp>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"
#include "extreme_system.hpp"

// A step from anywhere, of any size: a finite state, or a Report and the state as it was.

namespace taut_test::extreme_step_test {

using taut::Method;
using taut::Stability;

namespace {

template <class Stepper, class System>
void check_step(const System& system, const typename System::State& start,
                typename System::Scalar h) {
    Stepper stepper(system);
    auto state = start;
    const taut::Report report = stepper.step(state, h, 3);
    if (report) {
        CHECK(state.finite());
    } else {
        INFO(describe(report.status));
        CHECK(same_bits(state, start));
    }
}

template <class System>
void check_all(const System& system, const typename System::State& start,
               typename System::Scalar h) {
    check_step<taut::ExplicitEuler<System>>(system, start, h);
    check_step<taut::SymplecticEuler<System>>(system, start, h);
    check_step<taut::VelocityVerlet<System>>(system, start, h);
    check_step<taut::ImplicitEuler<System>>(system, start, h);
    check_step<taut::Bdf2<System>>(system, start, h);
    check_step<taut::ProjectiveDynamics<System>>(system, start, h);
}

}  // namespace

TEMPLATE_TEST_CASE("extremes: a step leaves a finite state, or a Report and the state as it was",
                   "[extremes]", float, double) {
    Random random(1520);
    for (int repeat = 0; repeat < 200; ++repeat) {
        const auto system = extreme_system<TestType, 2>(random, repeat % 2 == 1);
        auto state = random_state(random, system);
        if (repeat % 3 == 0) state.x.array() += TestType(1e8);
        if (repeat % 5 == 0) state.x.col(0) = state.x.col(1);
        if (repeat % 7 == 0) state.v *= TestType(1e30);
        const double h = log_uniform(random, 1e-12, 1e6);
        INFO("system " << repeat << ", h = " << h);
        check_all(system, state, static_cast<TestType>(h));
    }
}

TEST_CASE("extremes: far from the origin a certified step is as safe as near it", "[extremes]") {
    Random random(1521);
    for (int repeat = 0; repeat < 20; ++repeat) {
        const auto system = extreme_system<double, 2>(random, false);
        const auto near = system.initial_state();
        auto far = near;
        far.x.array() += 134217728;  // 2^27 m; places keep 26 bits behind the point
        auto moved_back = far;
        moved_back.x.array() -= 134217728;
        const auto here = Stability<double>(system, moved_back).max_step(Method::symplectic_euler);
        const auto there = Stability<double>(system, far).max_step(Method::symplectic_euler);
        INFO("system " << repeat);
        CHECK_THAT(there.certified, WithinRel(here.certified, 1e-12));
    }
}

TEST_CASE("extremes: float and double agree on the analysis of one scene", "[extremes]") {
    for (int repeat = 0; repeat < 60; ++repeat) {
        Random first(static_cast<std::uint32_t>(1522 + repeat));
        const auto in_float = extreme_system<float, 2>(first, false);
        taut::SpringSystem<double, 2> in_double;
        const auto start = in_float.initial_state();
        for (Index i = 0; i < in_float.size(); ++i)
            in_double.add_particle(start.x.col(i).template cast<double>(),
                                   double(in_float.mass(i)));
        const auto& springs = in_float.springs();
        for (std::size_t s = 0; s < springs.a.size(); ++s) {
            in_double.add_spring(
                taut::Spring<double, taut::Hookean>{springs.a[s],
                                                    springs.b[s],
                                                    {double(springs.parameters[s].stiffness)},
                                                    double(springs.rest_length[s])});
        }
        for (Index i = 0; i < in_float.size(); ++i) {
            if (in_float.is_pinned(i)) in_double.pin(i);
        }
        const auto a = Stability<float>(in_float, start).max_step(Method::symplectic_euler);
        const auto b = Stability<double>(in_double, in_double.initial_state())
                           .max_step(Method::symplectic_euler);
        INFO("system " << repeat);
        CHECK(double(a.certified) <= b.certified);  // rounded down, never up
        CHECK(double(a.refuted) >= b.refuted);
        CHECK_THAT(double(a.certified), WithinRel(b.certified, 1e-6));
    }
}

TEST_CASE("extremes: a chain of 100 000 masses, condition 1e10", "[extremes][slow]") {
    taut::ChainOptions options;
    options.masses = 100'000;
    options.ends = taut::ChainEnds::fixed_free;
    const auto system = taut::chain<double, 3>(options);
    const auto start = system.initial_state();
    const auto limit = Stability<double>(system, start).max_step(Method::symplectic_euler);
    const double n = 100'000;
    const double half_angle = (2 * n - 1) * std::acos(-1.0) / (2 * (2 * n + 1));
    const double truth = 1 / std::sin(half_angle);  // 2/√k_max, k_max = 4 sin²
    CHECK(limit.certified <= truth);
    CHECK(limit.refuted >= truth);
    check_all(system, start, 0.9);
    check_all(system, start, 1e6);
}

}  // namespace taut_test::extreme_step_test
