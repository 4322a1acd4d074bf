// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The other half of fast_math.cpp: what diverges is found, what is not finite is refused, and what
// limits nothing says so.

#include <taut/equilibrium/equilibrium.hpp>
#include <taut/guard/guard.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/proof/bracket.hpp>
#include <taut/taut.hpp>

#include <exception>

#include "referee.hpp"
#include "steppers.hpp"

namespace {

using referee::check;
using taut::Index;
using taut::Method;

bool is_finite(double x) { return referee::is_finite(&x, 1); }

template <class Scalar>
taut::SpringSystem<Scalar, 3> cloth() {
    auto system = taut::hanging_cloth<Scalar>({8, 8});
    system.set_rayleigh({0.5, 1e-5});
    return system;
}

template <class Stepper, class Scalar>
void diverges(const char* name, Scalar h, bool may_hold = false) {
    const auto system = cloth<Scalar>();
    auto state = system.initial_state();
    state.v.setRandom();
    const auto start = state;
    Stepper stepper(system);
    const taut::Report report = stepper.step(state, h, 3000);
    const bool finite = referee::is_finite(state.x.data(), static_cast<long>(state.x.size())) &&
                        referee::is_finite(state.v.data(), static_cast<long>(state.v.size()));
    check(finite, name);
    check(may_hold || (report.status == taut::Status::diverged && report.where >= 0), name);
    check(bool(report) || (state.x == start.x && state.v == start.v), name);
    // What is not finite is refused.
    for (int which = 0; which < 3; ++which) {
        const auto bad = static_cast<Scalar>(referee::not_finite(which));
        auto other = start;
        other.v(1, 7) = bad;
        const taut::Report refused = stepper.step(other, Scalar(1e-5));
        check(refused.status == taut::Status::invalid_state && refused.where == 7, name, which);
        check(stepper.step(state, bad).status == taut::Status::invalid_step, name, which);
    }
}

template <class Call>
void refuses(const char* what, const Call& call) {
    for (int which = 0; which < 3; ++which) {
        try {
            call(referee::not_finite(which));
            check(false, what, which);
        } catch (const std::exception&) {
        }
    }
}

template <class Scalar>
Scalar too_large_a_step() {
    const auto system = cloth<Scalar>();
    const taut::Stability<Scalar> stability(system, system.initial_state());
    return 10 * stability.max_step(Method::symplectic_euler).certified;
}

/// Of games, in float.
void judge_guard() {
    auto pulled = cloth<float>();
    float force = 0;
    pulled.set_external_force([&](const auto&, auto& f) { f(0, 3) += force; });
    auto state = pulled.initial_state();
    taut::Guarded guard(pulled);
    check(bool(guard.advance(state, 1.0f / 60)), "guarded");
    for (int which = 0; which < 3; ++which) {
        const auto bad = static_cast<float>(referee::not_finite(which));
        auto other = state;
        other.x(0, 0) = bad;
        check(!guard.advance(other, 1.0f / 60), "guarded, state", which);
        check(!guard.advance(state, bad), "guarded, frame", which);
        force = bad;
        bool refused = false;
        try {
            refused = !guard.advance(state, 1.0f / 60);
        } catch (const std::exception&) {
            refused = true;
        }
        check(refused, "guarded, force", which);
        force = 0;
    }
}

/// Of tools, in double.
void judge_solvers() {
    const auto system = cloth<double>();
    diverges<taut::ImplicitEuler<taut::SpringSystem<double, 3>>>("implicit_euler",
                                                                 too_large_a_step<double>(), true);
    auto state = system.initial_state();
    check(bool(taut::static_equilibrium(system, state)), "equilibrium");
    for (int which = 0; which < 3; ++which) {
        state.x(0, 0) = referee::not_finite(which);
        check(taut::static_equilibrium(system, state).status == taut::Status::invalid_state,
              "equilibrium", which);
    }
}

template <class Scalar>
void judge_core() {
    using System = taut::SpringSystem<Scalar, 3>;
    const auto system = cloth<Scalar>();
    const Scalar h = too_large_a_step<Scalar>();
    edges::each_explicit<System>(
        [&](auto kind) { diverges<typename decltype(kind)::Type>(kind.name, h); });

    auto changed = system;
    refuses("mass", [](double bad) { System().add_particle({0, 0, 0}, static_cast<Scalar>(bad)); });
    refuses("position", [](double bad) {
        System().add_particle({0, static_cast<Scalar>(bad), 0}, 1);
    });
    refuses("gravity", [&](double bad) { changed.set_gravity({0, static_cast<Scalar>(bad), 0}); });
    refuses("stiffness",
            [&](double bad) { changed.add_spring(0, 1, static_cast<Scalar>(bad), 1); });
    refuses("rest length", [&](double bad) {
        changed.add_spring(
            taut::Spring<Scalar, taut::Hookean>{0, 1, {1}, static_cast<Scalar>(bad)});
    });
    refuses("drag", [&](double bad) { changed.set_rayleigh({bad, 0}); });
    refuses("pose", [&](double bad) {
        auto other = system.initial_state();
        other.x(2, 5) = static_cast<Scalar>(bad);
        taut::Stability<Scalar>{system, other};
    });
    refuses("window",
            [](double bad) { taut::rayleigh_window(Method::symplectic_euler, bad, 0, 0, 1, 0); });
    refuses("k_max", [](double bad) {
        taut::rayleigh_window(Method::symplectic_euler, 1e-3, 0, 0, bad, 0);
    });
    const auto limit = taut::any_pose_limit(system);
    for (int which = 0; which < 3; ++which) {
        const double bad = referee::not_finite(which);
        check(!limit.step_for(system, static_cast<Scalar>(bad)), "safety", which);
        check(!limit.substeps(0.01, bad), "safety of substeps", which);
    }
    check(!taut::StepLimit<Scalar>{}.substeps(0.01), "substeps of nothing");

    // Nothing limits it.
    System loose;
    loose.add_particle({0, 0, 0}, 1);
    loose.add_particle({1, 0, 0}, 1);
    const taut::Stability<Scalar> still(loose, loose.initial_state());
    for (const auto& unlimited :
         {still.max_step(Method::symplectic_euler), still.max_step(Method::explicit_euler),
          taut::bracket(still, Method::symplectic_euler), taut::any_pose_limit(loose),
          taut::energy_limit(loose), taut::any_pose_limit(loose, Method::implicit_euler)}) {
        const auto certified = static_cast<double>(unlimited.certified);
        const auto refuted = static_cast<double>(unlimited.refuted);
        check(!is_finite(certified) && certified > 0 && unlimited.unbounded(), "without springs");
        check(!is_finite(refuted) && refuted > 0, "without springs");
        check(unlimited.substeps(0.01) == 1, "without springs");
        check(unlimited.step_for(loose, 1).has_value(), "without springs");
    }
    check(still.max_stiffness_scale(Method::symplectic_euler, 1) > 1e300, "scale");
}

}  // namespace

void judge_steps() {
    judge_core<float>();
    judge_core<double>();
    judge_guard();
    judge_solvers();
}
