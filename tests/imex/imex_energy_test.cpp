// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/imex/imex.hpp>
#include <taut/stability/energy_limit.hpp>

#include "../support/catch.hpp"
#include "../support/tolerance.hpp"
#include "direct_imex.hpp"

// [T41] with A in place of M: at what is certified no step raises ½vᵀAv + U by more than the work.

namespace taut_test::imex_energy_test {

using taut::Hookean;
using taut::ImexEuler;

namespace {

template <class System>
using Forces = typename DirectImex<System>::Points;

struct Count {
    int steps = 0, rises = 0, implicit = 0;
};

/// Violent networks stepped at h₀ and h₀/3 of their own choice of springs, up to a thousand times
/// what the explicit step bears.
template <class System>
Count rises_of_networks(std::uint32_t seed, int networks) {
    using Scalar = typename System::Scalar;
    Random random(seed);
    Count count;
    for (int repeat = 0; repeat < networks; ++repeat) {
        auto system = random_network<System>(random, 3, repeat % 4 == 1);
        const auto bears = static_cast<double>(taut::energy_limit(system).certified);
        if (!(bears < 1e30)) continue;
        const double step = bears * log_uniform(random, 0.5, 1000);
        if (repeat % 5 == 1) system.set_rayleigh({random.uniform(0, 1) / step, 0});
        if (repeat % 5 == 2) system.set_rayleigh({0, log_uniform(random, 1e-2, 1) * step});
        ImexEuler<System> stepper(system, {step, {}, 1});
        REQUIRE(stepper.limit().certified == static_cast<Scalar>(step));
        const auto matrices =
            imex_matrices(system, step, [&](Index s) { return stepper.share(s); });
        count.implicit += stepper.implicit_springs() > 0;
        auto state = thrown(random, system);
        const auto speed = static_cast<Scalar>(state.v.cwiseAbs().maxCoeff());
        Forces<System> forces = Forces<System>::Zero(System::Dim, system.size());
        for (int i = 0; i < 30; ++i) {
            for (Index p = 0; repeat % 3 == 1 && p < system.size(); ++p) {
                if (system.is_pinned(p))
                    state.v.col(p) = speed * random.vector<Scalar, System::Dim>(-1, 1);
            }
            for (Index p = 0; repeat % 4 == 2 && i % 5 == 0 && p < system.size(); ++p) {
                const auto impulse = static_cast<Scalar>(random.uniform(0, 1)) * speed *
                                     system.mass(p) / stepper.limit().certified;
                const typename System::Vector force =
                    impulse * random.vector<Scalar, System::Dim>(-1, 1);
                system.set_constant_force(p, force);
                if (!system.is_pinned(p)) forces.col(p) = force.template cast<Real>();
            }
            const Scalar h = stepper.limit().certified / (i % 2 == 0 ? 1 : 3);
            const Books books = book_imex(stepper, system, matrices, state, h, forces);
            ++count.steps;
            count.rises += books.rises();
            if (books.rises()) {
                WARN("network " << repeat << ", step " << i << ": " << books.gain << " J of "
                                << books.kinetic << ", slack " << books.slack);
            }
        }
    }
    return count;
}

/// What stands beside a line of springs, each of them partly implicit.
enum class Beside { nothing, dampers, rayleigh, drag, forces, pins };
constexpr Beside everything[] = {Beside::nothing, Beside::dampers, Beside::rayleigh,
                                 Beside::drag,    Beside::forces,  Beside::pins};

template <class System, class Law>
System line(Random& random, Beside beside) {
    using Scalar = typename System::Scalar;
    System system;
    for (Index i = 0; i < 3; ++i) {
        typename System::Vector x = System::Vector::Zero();
        x[0] = static_cast<Scalar>(i);
        system.add_particle(x, static_cast<Scalar>(random.uniform(0.5, 2)));
    }
    const auto damping =
        static_cast<Scalar>(beside == Beside::dampers ? random.uniform(100, 300) : 0);
    for (Index i = 0; i < 2; ++i) {
        const typename Law::template Parameters<Scalar> p{
            static_cast<Scalar>(random.uniform(50, 200))};
        system.add_spring(taut::Spring<Scalar, Law>{i, i + 1, p, Scalar(1), damping});
    }
    if (beside == Beside::pins) system.pin(2);
    if (beside == Beside::rayleigh) system.set_rayleigh({0, random.uniform(2, 4)});
    if (beside == Beside::drag) system.set_rayleigh({random.uniform(100, 300), 0});
    return system;
}

/// Hill climbing on the state, and on the force from outside, for the step that gains the most.
/// @returns whether one rises
template <class System>
bool climbs(Random& random, System& system, const ImexMatrices& matrices,
            ImexEuler<System>& stepper, typename System::Scalar h, bool forced) {
    using Scalar = typename System::Scalar;
    constexpr int Dim = System::Dim;
    auto best = system.initial_state();
    best.x += random.points<Scalar, Dim>(system.size(), -0.1, 0.1);
    best.v = random.points<Scalar, Dim>(system.size(), -1, 1);
    typename System::Force best_force = System::Force::Zero(Dim, system.size());
    Real height = -std::numeric_limits<Real>::infinity();
    double stride = 0.3;
    for (int i = 0; i < 500; ++i) {
        auto next = best;
        auto force = best_force;
        const auto by = static_cast<Scalar>(stride);
        next.x += by * random.points<Scalar, Dim>(system.size(), -1, 1);
        next.v += by / h * random.points<Scalar, Dim>(system.size(), -1, 1);
        if (forced) force += by / (h * h) * random.points<Scalar, Dim>(system.size(), -1, 1);
        for (Index p = 0; forced && p < system.size(); ++p)
            system.set_constant_force(p, force.col(p));
        auto state = next;
        const Books books =
            book_imex(stepper, system, matrices, state, h, force.template cast<Real>());
        if (books.rises()) return true;
        const Real here = (books.gain - books.slack) / books.kinetic;
        if (here > height) {
            height = here;
            best = next;
            best_force = force;
            stride *= 1.6;
        } else {
            stride = std::max(stride * 0.92, 1e-7);
        }
    }
    return false;
}

/// With A made for the edge of its rest, that edge is A's own: no step rises at it or below, and
/// above it some do.
template <class System, class Law>
void check_edge(Random& random, Beside beside) {
    using Scalar = typename System::Scalar;
    const bool forced = beside == Beside::forces;
    bool above = false;
    for (int repeat = 0; repeat < 6; ++repeat) {
        auto system = line<System, Law>(random, beside);
        const double even = random.uniform(0.2, 0.8), other = random.uniform(0, 1);
        const auto share = [=](Index s) { return s % 2 == 0 ? even : other; };
        double low = 0, high = 1e3;
        for (int i = 0; i < 60; ++i) {
            const double h = (low + high) / 2;
            (imex_matrices(system, h, share).holds(static_cast<Real>(h)) ? low : high) = h;
        }
        ImexEuler<System> stepper(system, {low, share, 1});
        const auto certified = static_cast<double>(stepper.limit().certified);
        CHECK(certified <= low * (1 + 1e-6));
        CHECK(certified >= 0.98 * low);
        const auto matrices = imex_matrices(system, low, share);
        const auto edge = static_cast<double>(matrices.edge(2 * static_cast<Real>(low)));
        CHECK(edge <= low * (1 + 1e-5));
        CHECK_FALSE(climbs(random, system, matrices, stepper, stepper.limit().certified, forced));
        CHECK_FALSE(
            climbs(random, system, matrices, stepper, stepper.limit().certified / 3, forced));
        above = above ||
                climbs(random, system, matrices, stepper, static_cast<Scalar>(1.05 * edge), forced);
    }
    CHECK(above);
}

}  // namespace

TEMPLATE_TEST_CASE("imex: no step gains energy at the step that was wished for, or a third of it",
                   "[imex]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>),
                   (Case<float, 3>)) {
    using System = AnyLaw<typename TestType::Scalar, TestType::Dim>;
    const Count count = rises_of_networks<System>(8810, 150);
    INFO(count.steps << " steps, " << count.implicit << " networks with implicit springs");
    CHECK(count.rises == 0);
    CHECK(count.steps > 3000);
    CHECK(count.implicit > 80);
}

TEMPLATE_TEST_CASE("imex: hill climbing finds no gain at what is certified, and some above",
                   "[imex]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>),
                   (Case<float, 3>)) {
    using System = AnyLaw<typename TestType::Scalar, TestType::Dim>;
    Random random(8820);
    for (const Beside beside : everything) {
        INFO("beside " << static_cast<int>(beside));
        check_edge<System, Hookean>(random, beside);
        check_edge<System, TensionOnly>(random, beside);
    }
}

}  // namespace taut_test::imex_energy_test
