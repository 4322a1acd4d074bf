// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// What Choi and Ko claim for their springs: a strip pushed together at its ends buckles at once,
// and nothing has to be damped for it.
#include <algorithm>
#include <cmath>
#include <taut/bdf2/bdf2.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/network/spring_system.hpp>
#include <taut/network/buckling.hpp>
#include <taut/network/tension_only.hpp>

#include "../support/catch.hpp"
#include "../support/laws.hpp"

namespace taut_test::buckling_strip_test {

namespace {

using Strip = taut::SpringSystem<double, 3, TensionOnly, Buckling>;

constexpr Index columns = 21;
constexpr Index rows = 3;
constexpr double spacing = 0.05;  // m
constexpr double h = 1.0 / 60;    // s

/// 1 m × 0.1 m, flat but for 0.1 mm, undamped, its ends pinned.
Strip strip(double stiffness) {
    Strip system;
    const auto at = [](Index row, Index column) { return row * columns + column; };
    for (Index r = 0; r < rows; ++r) {
        for (Index c = 0; c < columns; ++c) {
            const double x = static_cast<double>(c);
            const double y = static_cast<double>(r);
            system.add_particle({spacing * x, spacing * y, 1e-4 * std::sin(1.3 * x + y)}, 0.01);
        }
    }
    const double bending = 0.01 * stiffness * std::pow(2 * spacing, 3);
    const auto join = [&](Index r, Index c, Index rise, Index run, bool bends) {
        if (r + rise >= rows || c + run >= columns || c + run < 0) return;
        const Index a = at(r, c);
        const Index b = at(r + rise, c + run);
        if (bends) {
            system.add_spring<Buckling>(a, b, {stiffness, bending, stiffness});
        } else {
            system.add_spring<TensionOnly>(a, b, {stiffness});
        }
    };
    for (Index r = 0; r < rows; ++r) {
        for (Index c = 0; c < columns; ++c) {
            join(r, c, 0, 1, false);
            join(r, c, 1, 0, false);
            join(r, c, 1, 1, false);
            join(r, c, 1, -1, false);
            join(r, c, 0, 2, true);
            join(r, c, 2, 0, true);
        }
        system.pin(at(r, 0));
        system.pin(at(r, columns - 1));
    }
    return system;
}

struct Outcome {
    bool stepped = true;
    double height = 0;   // m; an arc of the strip's length would rise by 0.30
    double fastest = 0;  // m/s
    double longest = 0;  // relative to the rest length

    /// Buckled, and nothing blown up.
    bool as_claimed() const { return stepped && height > 0.1 && fastest < 5 && longest < 1.25; }
};

/// Pushes one end in by 0.3 m within a second, then lets the strip swing for another one.
template <class Stepper>
Outcome push(double stiffness) {
    const auto system = strip(stiffness);
    auto state = system.initial_state();
    Stepper stepper(system);
    Outcome outcome;
    for (int frame = 0; frame < 120; ++frame) {
        for (Index r = 0; r < rows; ++r) {
            state.v(0, r * columns + columns - 1) = frame < 60 ? -0.3 : 0.0;
        }
        outcome.stepped = outcome.stepped && stepper.step(state, h);
        outcome.fastest = std::max(outcome.fastest, state.v.colwise().norm().maxCoeff());
    }
    const auto& springs = system.springs<TensionOnly>();
    for (std::size_t s = 0; s < springs.a.size(); ++s) {
        const double l = (state.x.col(springs.b[s]) - state.x.col(springs.a[s])).norm();
        outcome.longest = std::max(outcome.longest, l / springs.rest_length[s]);
    }
    outcome.height = state.x.row(2).cwiseAbs().maxCoeff();
    return outcome;
}

}  // namespace

TEST_CASE("strip: pushed together it buckles out of its plane, over six decades of stiffness",
          "[integrator][slow]") {
    for (const double stiffness : {1e1, 1e2, 1e3, 1e4, 1e5, 1e6}) {
        INFO("stiffness " << stiffness);
        CHECK(push<taut::Bdf2<Strip>>(stiffness).as_claimed());
        CHECK(push<taut::ImplicitEuler<Strip>>(stiffness).as_claimed());
        // What the claim is worth: the same push, by explicit steps of the same length.
        if (stiffness >= 1e3)
            CHECK_FALSE(push<taut::SymplecticEuler<Strip>>(stiffness).as_claimed());
    }
}

}  // namespace taut_test::buckling_strip_test
