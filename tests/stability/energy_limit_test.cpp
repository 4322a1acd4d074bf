// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/integrator/velocity_verlet.hpp>
#include <taut/stability/any_pose.hpp>
#include <taut/stability/energy_limit.hpp>
#include <taut/tight/tight.hpp>

#include "../support/catch.hpp"
#include "../support/energy_networks.hpp"
#include "../support/message.hpp"
#include "../support/tolerance.hpp"

// [T34]: with graph damping inside the range, no step raises the energy.

namespace taut_test::energy_limit_test {

namespace matrices = taut::matrices;

using taut::Hookean;
using taut::Method;
using taut::SpringSystem;

namespace {

/// Networks stepped within their limit and range of damping.
template <class System>
void check_no_rise(std::uint32_t seed) {
    Random random(seed);
    for (int repeat = 0; repeat < 60; ++repeat) {
        auto system = random_network<System>(random, repeat % 3 == 0 ? 12 : 3);
        const auto scene = random.below(3);
        if (scene == 1) system.set_rayleigh({log_uniform(random, 1e-3, 1), 0});
        if (scene == 2) system.set_rayleigh({0, log_uniform(random, 1e-6, 1e-2)});
        const auto limit = taut::energy_limit(system, repeat % 2 == 0 ? 0.0 : 1e-6);
        if (limit.unbounded()) continue;
        REQUIRE(limit.certified > 0);
        const double h =
            static_cast<double>(limit.certified) * (repeat % 4 == 0 ? 1 : random.uniform(0.1, 1));
        const auto range = limit.alpha(h);
        REQUIRE_FALSE(range.empty());
        const double top = std::min(range.upper, 3 * range.lower + 3 * h);
        system.set_graph_damping(range.lower + random.uniform(0, 1) * (top - range.lower));
        INFO("network " << repeat << ", h = " << h << ", alpha = " << system.graph_damping());
        CHECK(rises<taut::SymplecticEuler<System>>(system, thrown(random, system), h, 300) == 0);
    }
}

}  // namespace

TEMPLATE_TEST_CASE("energy_limit: no step within the range raises the energy", "[stability][slow]",
                   (Case<double, 1>), (Case<double, 2>), (Case<double, 3>), (Case<float, 1>),
                   (Case<float, 2>), (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    if constexpr (Dim == 1) {
        check_no_rise<SpringSystem<Scalar, 1, Hookean, TensionOnly, Buckling>>(3401);
    } else {
        check_no_rise<Mixed<Scalar, Dim>>(3400 + Dim);
        check_no_rise<Strings<Scalar, Dim>>(3410 + Dim);
    }
}

TEMPLATE_TEST_CASE("energy_limit: above the edge a network gains energy, whatever the damping",
                   "[stability]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>),
                   (Case<float, 2>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using System = SpringSystem<Scalar, Dim>;
    Random random(3420 + Dim);
    for (int repeat = 0; repeat < 60; ++repeat) {
        // On a line L_k is the stiffness itself. Let go from rest in its stiffest mode, a step at
        // the edge brings all of the energy into motion, and a longer one more than that.
        System system;
        const Index particles = 3 + random.below(6);
        for (Index i = 0; i < particles; ++i) {
            system.add_particle(static_cast<Scalar>(i) * Eigen::Matrix<Scalar, Dim, 1>::Unit(0),
                                static_cast<Scalar>(log_uniform(random, 0.1, 10)));
        }
        for (Index i = 0; i < 2 * particles; ++i) {
            const Index a = random.below(particles);
            system.add_spring(a, (a + 1 + random.below(particles - 1)) % particles,
                              static_cast<Scalar>(log_uniform(random, 1, 100)));
        }
        const auto limit = taut::energy_limit(system, 1e-9);
        const auto laplacian = taut::SpringPencil<1>::any_pose(system);
        const auto mode = taut::largest_ritz_pair(laplacian, matrices::K_plus).vector;
        auto state = system.initial_state();
        state.x.row(0) += (0.3 / mode.cwiseAbs().maxCoeff() * mode).template cast<Scalar>();
        const auto edge = static_cast<double>(limit.refuted);
        for (const double share : {0.95, 1.05}) {
            for (const double alpha : {0.0, 0.3, 1.0}) {
                system.set_graph_damping(alpha * edge);
                INFO("network " << repeat << ", " << share << " of the edge, alpha/h " << alpha);
                CHECK(rises<taut::SymplecticEuler<System>>(system, state, share * edge, 1) ==
                      (share > 1 ? 1 : 0));
            }
        }
    }
}

TEMPLATE_TEST_CASE("energy_limit: half of the any-pose limit, and about h/2 of damping",
                   "[stability]", (Case<double, 1>), (Case<double, 3>), (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using System = Strings<Scalar, Dim>;
    Random random(3440);
    for (int repeat = 0; repeat < 30; ++repeat) {
        const auto system = random_network<System>(random, 4);
        const auto linear = taut::any_pose_limit(system, 1e-6);
        const auto limit = taut::energy_limit(system, 1e-6);
        if (limit.unbounded()) continue;
        const auto certified = static_cast<double>(limit.certified);
        CHECK_THAT(certified, WithinRel(static_cast<double>(linear.certified) / 2, 1e-5));
        CHECK(limit.refuted >= limit.certified);
        CHECK(limit.cause == taut::Cause::stiffness);
        CHECK(limit.revision == system.revision());
        CHECK_THAT(limit.alpha(certified).lower, WithinRel(certified, 0.02));
        const double small = 0.01 * certified;
        CHECK_THAT(limit.alpha(small).lower, WithinRel(small / 2, 1e-3));
        CHECK(limit.alpha(static_cast<double>(limit.refuted) * 1.001).empty());
    }
}

TEMPLATE_TEST_CASE("energy_limit: the condition of the theorem holds on the exact matrices",
                   "[stability]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>)) {
    constexpr int Dim = TestType::Dim;
    Random random(3460 + Dim);
    for (int repeat = 0; repeat < 60; ++repeat) {
        RandomOptions options;
        options.dampers = repeat % 2 == 0;
        auto system = random_like<Mixed<double, Dim>>(random, options);
        system.set_rayleigh({repeat % 3 == 0 ? 0 : random.uniform(0, 3),
                             repeat % 5 == 0 ? 0 : log_uniform(random, 1e-5, 1e-2)});
        const auto limit = taut::energy_limit(system, 1e-4);
        REQUIRE(limit.certified > 0);
        const double h = limit.certified * random.uniform(0.05, 1);
        const auto range = limit.alpha(h);
        REQUIRE_FALSE(range.empty());
        // L_k ⊗ I is the damping matrix of graph damping by 1 s alone.
        const auto without = exact_matrices(system, system.initial_state().x).D;
        auto with = system;
        with.set_graph_damping(1);
        const RealMatrix L = exact_matrices(with, system.initial_state().x).D - without;
        for (const double alpha : {range.lower, range.upper, (range.lower + range.upper) / 2}) {
            system.set_graph_damping(alpha);
            const auto state = random_state(random, system);
            const Exact e = exact_matrices(system, state.x);
            const Real t = static_cast<Real>(h);
            const RealMatrix S =
                2 * e.D - t * e.D * e.mass.cwiseInverse().asDiagonal() * e.D - t * L;
            INFO("system " << repeat << ", h = " << h << ", alpha = " << alpha);
            CHECK(eigenvalues(S)[0] >= -1e-13L * S.cwiseAbs().maxCoeff());
        }
    }
}

TEMPLATE_TEST_CASE("energy_limit: velocity Verlet's energy never rises at its half steps",
                   "[stability][slow]", (Mixed<double, 3>), (Strings<double, 3>)) {
    using System = TestType;
    Random random(3480);
    for (int repeat = 0; repeat < 30; ++repeat) {
        auto system = random_network<System>(random, 3);
        const auto limit = taut::energy_limit(system);
        if (limit.unbounded()) continue;
        const double h = limit.certified;
        system.set_graph_damping(limit.alpha(h).lower);
        auto state = thrown(random, system);
        taut::VelocityVerlet<System> verlet(system);
        double energy = std::numeric_limits<double>::infinity();
        for (int i = 0; i < 200; ++i) {
            REQUIRE(verlet.step(state, h));
            // v½ = v − ½h M⁻¹f(x, v½): the force that ended the step is that of the half step.
            auto half = state;
            typename System::Force f;
            for (int solve = 0; solve < 60; ++solve) {
                system.force(half, f);
                half.v.array() =
                    state.v.array() -
                    h / 2 * (f.array().rowwise() * system.inverse_mass().transpose().array());
            }
            const auto next = static_cast<double>(total_energy(system, half));
            CHECK(next <= energy + rounding(system, state, h) + 1e-9 * std::abs(next));
            energy = next;
        }
    }
}

TEST_CASE("energy_limit: wrong input and scenes without a limit", "[stability][bad_input]") {
    SpringSystem<double, 2> system;
    system.add_particle({0, 0}, 1);
    system.add_particle({1, 0}, 1);
    CHECK(taut::energy_limit(system).unbounded());
    CHECK(taut::energy_limit(system).alpha(1e9).contains(0));
    system.add_spring(0, 1, 100);
    const auto limit = taut::energy_limit(system);
    CHECK_THAT(limit.certified, WithinRel(1 / std::sqrt(200), 1e-6));
    CHECK(limit.alpha(2 * limit.certified).empty());
    for (const double h : {0.0, -1.0, std::nan("")}) {
        CHECK_THROWS_AS(limit.alpha(h), std::invalid_argument);
    }
    CHECK_THROWS_AS(taut::energy_limit(system, -1.0), std::invalid_argument);
    CHECK_THROWS_AS(system.set_graph_damping(-1), std::invalid_argument);
    CHECK_THROWS_AS(system.set_graph_damping(std::nan("")), std::invalid_argument);
    // The scene's own dampers hold the step down, and are named.
    system.set_rayleigh({0, 10});
    CHECK(taut::energy_limit(system).cause == taut::Cause::damping);
    CHECK(taut::energy_limit(system).certified < limit.certified / 10);
    // Beyond double: nothing is proved, and no damping is said to do.
    system.set_rayleigh({0, 1e307});
    CHECK(taut::energy_limit(system).cause == taut::Cause::overflow);
    CHECK(taut::energy_limit(system).certified == 0);
    CHECK(taut::energy_limit(system).alpha(1e-3).empty());
    CHECK(taut::EnergyLimit<double>().alpha(1).empty());
    system.set_rayleigh({5, 0});
    system.pin(0);
    system.pin(1);
    CHECK(taut::energy_limit(system).unbounded());
}

}  // namespace taut_test::energy_limit_test
