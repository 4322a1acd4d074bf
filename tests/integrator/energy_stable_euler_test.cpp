// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/integrator/energy_stable_euler.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/model/state_view.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/stability/energy_limit.hpp>
#include <taut/tight/tight.hpp>

#include "../support/catch.hpp"
#include "../support/energy_steps.hpp"
#include "../support/message.hpp"
#include "../support/sweep_checks.hpp"
#include "../support/tolerance.hpp"

// [T42]: at energy_limit no step raises the energy by more than the work.

namespace taut_test::energy_stable_euler_test {

using taut::EnergyStableEuler;
using taut::Hookean;
using taut::SpringSystem;

namespace {

template <class System>
using Forces = typename StepAhead<System>::Points;

/// Rayleigh damping of a strength that the step feels.
template <class System>
void set_some_rayleigh(Random& random, System& system, Index kind) {
    const auto h = static_cast<double>(taut::energy_limit(system).certified);
    if (!(h < 1e30)) return;
    if (kind == 1) system.set_rayleigh({log_uniform(random, 1e-2, 1) / h, 0});
    if (kind == 2) system.set_rayleigh({0, log_uniform(random, 1e-2, 1) * h});
}

/// Some forces from outside, of the size of what a step feels.
template <class System>
Forces<System> some_forces(Random& random, System& system, double size) {
    using Scalar = typename System::Scalar;
    constexpr int Dim = System::Dim;
    Forces<System> forces = Forces<System>::Zero(Dim, system.size());
    for (Index i = 0; i < system.size(); ++i) {
        typename System::Vector force =
            static_cast<Scalar>(size) * random.vector<Scalar, Dim>(-1, 1);
        system.set_constant_force(i, force);
        if (!system.is_pinned(i)) forces.col(i) = force.template cast<Real>();
    }
    return forces;
}

/// By the sweep, and by the plain force: the step of the theory's formula.
template <class System>
void check_written_out(std::uint32_t seed) {
    using Scalar = typename System::Scalar;
    Random random(seed);
    for (int repeat = 0; repeat < 24; ++repeat) {
        RandomOptions options;
        options.particles = 40;
        options.springs = 60;
        options.dampers = repeat % 3 == 0;
        options.rayleigh = repeat % 4 < 2;
        auto system = random_like<System>(random, options);
        // Where a tension falls, φ hangs on what is left of a difference of energies.
        const bool falls = repeat % 2 == 1;
        if (!falls) system.template remove_springs<Glue>([](Index) { return true; });
        auto state = random_state(random, system);  // of pins that move, too
        for (Index i = 0; i < 4; ++i) state.x.col(9 + i) = state.x.col(20 + i);
        system.template add_spring<TensionOnly>({9, 20, {100}, 1});
        const auto forces = some_forces(random, system, repeat % 5 == 0 ? 10 : 0);
        const auto h = static_cast<Scalar>(0.05);
        const StepAhead<System> exact(system, state, static_cast<Real>(h), forces);
        auto swept = state;
        EnergyStableEuler<System> stepper(system);
        REQUIRE(stepper.step(swept, h));
        typename System::Force f;
        system.force_ahead(state, h, f);
        auto plain = state;
        plain.v.array() += h * (f.array().rowwise() * system.inverse_mass().transpose().array());
        plain.x += h * plain.v;
        for (const auto* found : {&swept, &plain}) {
            const Real off = (found->v.template cast<Real>() - exact.v).cwiseAbs().maxCoeff();
            const Real far = (found->x.template cast<Real>() - exact.x).cwiseAbs().maxCoeff();
            const Real tolerance = (falls ? 4096 : 64) * std::numeric_limits<Scalar>::epsilon();
            INFO("system " << repeat);
            CHECK(off <= tolerance * exact.v.cwiseAbs().maxCoeff());
            CHECK(far <= tolerance * exact.v.cwiseAbs().maxCoeff());
        }
    }
}

/// Violent networks stepped at exactly what is certified. @returns how many steps rose
template <class System>
int rises_at_the_edge(std::uint32_t seed, int networks) {
    using Scalar = typename System::Scalar;
    Random random(seed);
    int count = 0;
    for (int repeat = 0; repeat < networks; ++repeat) {
        auto system = random_network<System>(random, repeat % 3 == 0 ? 12 : 3, repeat % 4 == 1);
        set_some_rayleigh(random, system, repeat % 5);
        const auto limit = taut::energy_limit(system, repeat % 2 == 0 ? 0.0 : 1e-3);
        if (limit.unbounded()) continue;
        REQUIRE(limit.certified > 0);
        const Scalar h = limit.certified;
        auto state = thrown(random, system);
        const auto speed = static_cast<Scalar>(state.v.cwiseAbs().maxCoeff());
        EnergyStableEuler<System> stepper(system);
        Forces<System> forces = Forces<System>::Zero(System::Dim, system.size());
        for (int i = 0; i < 60; ++i) {
            if (repeat % 3 == 1 && i % 7 == 0) {
                for (Index p = 0; p < system.size(); ++p) {
                    if (system.is_pinned(p))
                        state.v.col(p) = speed * random.vector<Scalar, System::Dim>(-1, 1);
                }
            }
            if (repeat % 4 == 2 && i % 5 == 0) {
                const double impulse = static_cast<double>(speed * system.mass(0) / h);
                forces = some_forces(random, system, random.uniform(0, 1) * impulse);
            }
            const Books books = book_step(stepper, system, state, h, forces);
            if (books.rises()) {
                ++count;
                WARN("network " << repeat << ", step " << i << ": " << books.gain << " J of "
                                << books.kinetic << ", slack " << books.slack);
            }
        }
    }
    return count;
}

/// A line of particles, springs of one law at about their rest lengths, with what may stand beside
/// them. Damping is strong, so that it is what holds the step down: with springs as strong only
/// rare steps meet the condition, see the next test.
enum class Beside { nothing, dampers, rayleigh, drag, forces, pins };
constexpr Beside everything[] = {Beside::nothing, Beside::dampers, Beside::rayleigh,
                                 Beside::drag,    Beside::forces,  Beside::pins};

template <class System, class Law>
System line(Random& random, const typename Law::template Parameters<typename System::Scalar>& p,
            Beside beside) {
    using Scalar = typename System::Scalar;
    System system;
    const Index particles = 2 + random.below(2);
    for (Index i = 0; i < particles; ++i) {
        typename System::Vector x = System::Vector::Zero();
        x[0] = static_cast<Scalar>(i);
        system.add_particle(x, static_cast<Scalar>(random.uniform(0.5, 2)));
    }
    const auto damping =
        static_cast<Scalar>(beside == Beside::dampers ? random.uniform(300, 600) : 0);
    for (Index i = 0; i + 1 < particles; ++i)
        system.add_spring(taut::Spring<Scalar, Law>{i, i + 1, p, Scalar(1), damping});
    if (beside == Beside::pins) system.pin(particles - 1);
    if (beside == Beside::rayleigh) system.set_rayleigh({0, random.uniform(4, 8)});
    if (beside == Beside::drag) system.set_rayleigh({random.uniform(300, 600), 0});
    if (random.below(2) == 0 && beside != Beside::drag)
        system.set_gravity(random.vector<Scalar, System::Dim>(-1, 1));
    return system;
}

struct Climb {
    Real best = -std::numeric_limits<Real>::infinity();  ///< gain beyond slack, of ½ΔᵀMΔ
    int steps = 0;
    int rises = 0;
};

/// Hill climbing on the state, and on the force from outside, for the step that gains the most.
template <class System>
void climb(Random& random, System& system, typename System::Scalar h, bool forced, Climb& climb) {
    using Scalar = typename System::Scalar;
    constexpr int Dim = System::Dim;
    EnergyStableEuler<System> stepper(system);
    auto best = system.initial_state();
    best.x += random.points<Scalar, Dim>(system.size(), -0.1, 0.1);
    best.v = random.points<Scalar, Dim>(system.size(), -1, 1);
    typename System::Force best_force = System::Force::Zero(Dim, system.size());
    Real height = -std::numeric_limits<Real>::infinity();
    double stride = 0.3;
    for (int i = 0; i < 700; ++i) {
        auto next = best;
        auto next_force = best_force;
        const auto by = static_cast<Scalar>(stride);
        next.x += by * random.points<Scalar, Dim>(system.size(), -1, 1);
        next.v += by / h * random.points<Scalar, Dim>(system.size(), -1, 1);
        if (forced) next_force += by / (h * h) * random.points<Scalar, Dim>(system.size(), -1, 1);
        for (Index p = 0; forced && p < system.size(); ++p)
            system.set_constant_force(p, next_force.col(p));
        auto state = next;
        const Books books = book_step(stepper, system, state, h, next_force.template cast<Real>());
        ++climb.steps;
        climb.rises += books.rises();
        const Real here = (books.gain - books.slack) / books.kinetic;
        if (here > height) {
            height = here;
            best = next;
            best_force = next_force;
            stride *= 1.6;
        } else {
            stride = std::max(stride * 0.92, 1e-7);
        }
    }
    climb.best = std::max(climb.best, height);
}

template <class System, class Law>
Climb climb_all(Random& random, const typename Law::template Parameters<typename System::Scalar>& p,
                Beside beside, double beyond) {
    using Scalar = typename System::Scalar;
    Climb found;
    for (int repeat = 0; repeat < 8; ++repeat) {
        auto system = line<System, Law>(random, p, beside);
        const auto limit = taut::energy_limit(system, 1e-3);
        REQUIRE(static_cast<double>(limit.refuted) <=
                1.0011 * static_cast<double>(limit.certified));
        const Scalar h = beyond > 1 ? static_cast<Scalar>(beyond) * limit.refuted : limit.certified;
        climb(random, system, h, beside == Beside::forces, found);
        if (beyond > 1 && found.rises > 0) break;
    }
    return found;
}

template <class System>
void check_edge(std::uint32_t seed) {
    Random random(seed);
    for (const Beside beside : everything) {
        INFO("beside " << static_cast<int>(beside));
        const auto check = [&](auto law, const auto& p) {
            using Law = decltype(law);
            const Climb at = climb_all<System, Law>(random, p, beside, 1);
            INFO("best " << at.best << " of " << at.steps);
            CHECK(at.rises == 0);
            const Climb above = climb_all<System, Law>(random, p, beside, 1.02);
            INFO("above: best " << above.best << " of " << above.steps);
            CHECK(above.rises > 0);
        };
        check(Hookean{}, Hookean::Parameters<typename System::Scalar>{100});
        check(TensionOnly{}, TensionOnly::Parameters<typename System::Scalar>{100});
        check(Buckling{}, Buckling::Parameters<typename System::Scalar>{100, 0, 100});
        check(Glue{}, Glue::Parameters<typename System::Scalar>{100, 2});
    }
}

/// A pressed spring that turns by 60° and, by a force from outside, collapses: spring and damping
/// give all that the condition allows at once.
template <class Scalar, int Dim>
Books collapse(double damping, double alpha, double share) {
    using System = AnyLaw<Scalar, Dim>;
    System system;
    typename System::Vector x = System::Vector::Zero();
    system.add_particle(x, Scalar(1));
    x[0] = Scalar(0.5);
    system.add_particle(x, Scalar(1));
    system.add_spring(taut::Spring<Scalar, Hookean>{
        0, 1, {Scalar(100)}, Scalar(2), static_cast<Scalar>(damping)});
    system.pin(0);
    system.set_rayleigh({0, alpha});
    const auto limit = taut::energy_limit(system, 1e-6);
    const Scalar h = static_cast<Scalar>(share) * limit.certified;
    auto state = system.initial_state();
    state.v(0, 1) = Scalar(-0.25) / h;
    state.v(1, 1) = static_cast<Scalar>(std::sqrt(0.1875)) / h;
    // What leaves x⁺ = 0.
    Forces<System> forces = Forces<System>::Zero(Dim, 2);
    const auto time = static_cast<Real>(h);
    const StepAhead<System> free(system, state, time, forces);
    forces.col(1) = -free.x.col(1) / (time * time);
    system.set_constant_force(1, forces.col(1).template cast<Scalar>());
    EnergyStableEuler<System> stepper(system);
    return book_step(stepper, system, state, h,
                     forces.template cast<Scalar>().template cast<Real>());
}

}  // namespace

TEMPLATE_TEST_CASE(
    "energy_stable_euler: the limit counts springs and damping together, and is "
    "sharp",
    "[integrator]", (Case<double, 2>), (Case<double, 3>), (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    for (const double size : {0.0, 0.1, 1.0, 10.0}) {
        for (const bool dampers : {false, true}) {
            const double c = dampers ? 10 * size : 0, alpha = dampers ? 0 : 0.1 * size;
            INFO("damping " << c << ", alpha " << alpha);
            CHECK_FALSE(collapse<Scalar, Dim>(c, alpha, 1).rises());
            CHECK(collapse<Scalar, Dim>(c, alpha, 1.001).rises());
        }
    }
}

TEMPLATE_TEST_CASE("energy_stable_euler: a step is that of T42 written out", "[integrator]",
                   (Case<double, 1>), (Case<double, 2>), (Case<double, 3>), (Case<float, 3>),
                   (Case<long double, 2>)) {
    check_written_out<AnyLaw<typename TestType::Scalar, TestType::Dim>>(4200 + TestType::Dim);
}

TEMPLATE_TEST_CASE("energy_stable_euler: at what is certified no step raises the energy",
                   "[integrator]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>),
                   (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    CHECK(rises_at_the_edge<AnyLaw<Scalar, Dim>>(4210 + Dim, 160) == 0);
    if (Dim > 1) CHECK(rises_at_the_edge<Strings<Scalar, Dim>>(4220 + Dim, 80) == 0);
}

TEMPLATE_TEST_CASE("energy_stable_euler: hill climbing finds no gain at the edge, and one above it",
                   "[integrator]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>),
                   (Case<float, 3>)) {
    check_edge<AnyLaw<typename TestType::Scalar, TestType::Dim>>(4230 + TestType::Dim);
}

}  // namespace taut_test::energy_stable_euler_test
