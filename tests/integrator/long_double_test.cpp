// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/definitions.hpp>
#include <taut/integrator/energy_stable_euler.hpp>
#include <taut/integrator/symplectic_euler.hpp>

#include "../support/catch.hpp"
#include "../support/energy_steps.hpp"
#include "../support/plain_steps.hpp"
#include "../support/random_system.hpp"

// Scenes pass numbers as double; this scalar has more digits, and a sweep has no pack of it.

namespace taut_test::long_double_test {

namespace {

using System = taut::SpringSystem<long double, 2, taut::Hookean, Glue>;

void check_equal(const System::State& found, const System::State& exact, Real tolerance) {
    const Real most = tolerance * exact.v.cwiseAbs().maxCoeff();
    CHECK((found.v - exact.v).cwiseAbs().maxCoeff() <= most);
    CHECK((found.x - exact.x).cwiseAbs().maxCoeff() <= most);
}

}  // namespace

TEST_CASE("integrator: steps in long double are those that are written out", "[integrator]") {
    constexpr Real epsilon = std::numeric_limits<long double>::epsilon();
    constexpr long double h = 0.05L;
    for (std::uint32_t seed = 3720; seed < 3744; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        RandomOptions options;
        options.particles = 40;
        options.springs = 60;
        options.dampers = seed % 3 == 0;
        options.rayleigh = seed % 4 < 2;
        auto system = random_like<System>(random, options);
        // Where a tension falls, φ hangs on what is left of a difference of energies.
        const bool falls = seed % 2 == 1;
        if (!falls) system.remove_springs<Glue>([](Index) { return true; });
        auto state = random_state(random, system);  // of pins that move, too
        for (Index i = 0; i < 4; ++i) state.x.col(9 + i) = state.x.col(20 + i);
        system.add_spring<taut::Hookean>({9, 20, {100}, 1});
        StepAhead<System>::Points forces = StepAhead<System>::Points::Zero(2, system.size());
        for (Index i = 0; i < system.size() && seed % 5 == 0; ++i) {
            const System::Vector force = 10 * random.vector<long double, 2>(-1, 1);
            system.set_constant_force(i, force);
            if (!system.is_pinned(i)) forces.col(i) = force;
        }

        const StepAhead<System> exact(system, state, h, forces);
        const Real tolerance = (falls ? 4096 : 64) * epsilon;
        auto swept = state;
        REQUIRE(taut::EnergyStableEuler<System>(system).step(swept, h));
        check_equal(swept, {exact.x, exact.v}, tolerance);
        System::Force f;
        system.force_ahead(state, h, f);
        auto plain = state;
        plain.v.array() += h * (f.array().rowwise() * system.inverse_mass().transpose().array());
        plain.x += h * plain.v;
        check_equal(plain, {exact.x, exact.v}, tolerance);

        auto symplectic = state, written = state;
        REQUIRE(taut::SymplecticEuler<System>(system).step(symplectic, h));
        plain_steps<taut::Method::symplectic_euler>(system, written, h, 1);
        check_equal(symplectic, written, 64 * epsilon);
    }
}

}  // namespace taut_test::long_double_test
