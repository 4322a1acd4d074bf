// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// With floating-point traps on, as games and solvers switch them on to find their faults, no call
// of Taut is one: each runs once on scenes of all kinds, and none computes what is invalid, divides
// by zero or overflows. Where traps cannot be had, the flags that they go by are looked at; so do
// the tests of steppers in modules (support/faults.hpp).

#include <taut/arrays/arrays.hpp>
#include <taut/equilibrium/equilibrium.hpp>
#include <taut/guard/guard.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/proof/bracket.hpp>
#include <taut/taut.hpp>
#include <taut/tight/tight.hpp>

#include <cfenv>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "steppers.hpp"

#if defined(__GLIBC__)
#include <csetjmp>
#include <csignal>
#endif

namespace {

using taut::Index;
using taut::Method;

constexpr int faults = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;
int failures = 0;
std::string scene_name;

void complain(const char* what, const char* how) {
    ++failures;
    std::fprintf(stderr, "%s: %s %s\n", scene_name.c_str(), what, how);
}

#if defined(__GLIBC__)
sigjmp_buf before_call;
extern "C" void trapped(int) { siglongjmp(before_call, 1); }
#endif

/// Runs a call with traps on. What it refuses by name is no fault of floating point.
template <class Call>
void run(const char* what, const Call& call) {
    std::feclearexcept(FE_ALL_EXCEPT);
#if defined(__GLIBC__)
    if (sigsetjmp(before_call, 1) != 0) {
        fedisableexcept(faults);
        return complain(what, "trapped");
    }
    feenableexcept(faults);
#endif
    try {
        call();
    } catch (const std::exception& refused) {
        complain(what, refused.what());
    }
#if defined(__GLIBC__)
    fedisableexcept(faults);
#endif
    if (std::fetestexcept(faults) != 0) complain(what, "raised a flag");
}

void require(bool well, const char* what) {
    if (!well) complain(what, "failed");
}

template <class System>
void run_limits(const System& system, const typename System::State& state) {
    using Scalar = typename System::Scalar;
    using taut::any_pose_limit;
    using taut::energy_limit;
    const taut::Stability<Scalar> stability(system, state);
    for (int i = 0; i <= static_cast<int>(Method::last); ++i) {
        const auto method = static_cast<Method>(i);
        if (taut::method::is_limited_by<taut::method::Absent>(method)) continue;
        run("any_pose_limit of a method", [&] { (void)any_pose_limit(system, method); });
        run("max_step", [&] { (void)stability.max_step(method); });
        run("bracket", [&] { (void)taut::bracket(stability, method); });
        run("max_step, tight", [&] { (void)taut::max_step(stability, method, 1e-3); });
        run("rayleigh_window", [&] { (void)stability.rayleigh_window(method, 1e-3); });
        run("rayleigh_window, d0", [&] { (void)stability.rayleigh_window(method, 1e-3, 0.1); });
        run("max_stiffness_scale", [&] { (void)stability.max_stiffness_scale(method, 1e-3); });
        run("min_mass_scale", [&] { (void)stability.min_mass_scale(method, 1e-3); });
        run("certify", [&] { (void)taut::certify(stability, method, 1e-3); });
    }
    run("any_pose_limit", [&] { (void)any_pose_limit(system); });
    run("any_pose_limit, tight", [&] { (void)any_pose_limit(system, 1e-3); });
    run("any_pose_bracket", [&] { (void)taut::any_pose_bracket(system); });
    run("energy_limit", [&] { (void)energy_limit(system); });
    run("energy_limit, tight", [&] { (void)energy_limit(system, 1e-3); });
    run("energy_bracket", [&] { (void)taut::energy_bracket(system); });
    run("stiffness_spectrum", [&] { (void)taut::stiffness_spectrum(stability); });
    run("limiting_springs", [&] { (void)taut::limiting_springs(stability, 3); });
    run("limiting_particles", [&] { (void)taut::limiting_particles(stability, 3); });
    run("count_zero_modes", [&] { (void)taut::count_zero_modes(stability); });
    run("substeps, step_for", [&] {
        for (const auto& limit : {any_pose_limit(system), taut::StepLimit<Scalar>{}}) {
            (void)limit.substeps(0.01);
            (void)limit.step_for(system, 1);
        }
    });
}

template <class Stepper, class System>
void run_stepper(const char* name, const System& system, const typename System::State& start,
                 double step) {
    using Scalar = typename System::Scalar;
    run(name, [&] {
        Stepper stepper(system);
        auto state = start;
        require(bool(stepper.step(state, static_cast<Scalar>(step), 3)), name);
        require(bool(stepper.step(state, static_cast<Scalar>(step / 2))), name);
    });
}

template <class System>
void run_guarded(const System& system, const typename System::State& start) {
    using Scalar = typename System::Scalar;
    run("Guarded", [&] {
        taut::Guarded guard(system);
        auto state = start;
        for (int frame = 0; frame < 3; ++frame) {
            require(bool(guard.advance(state, Scalar(1) / 60)), "Guarded");
        }
    });
    run("a step that is not finite", [&] {
        taut::SymplecticEuler<System> stepper(system);
        auto state = start;
        state.x(0, 0) = std::numeric_limits<Scalar>::infinity();
        require(stepper.step(state, Scalar(1e-3)).status == taut::Status::invalid_state, "state");
    });
}

/// @param damped  so that explicit Euler has steps
template <class System>
void run_steps(const System& system, const typename System::State& start, bool damped) {
    const auto any = static_cast<double>(taut::any_pose_limit(system).certified);
    const auto energy = static_cast<double>(taut::energy_limit(system).certified);
    const auto h = [](double limit) { return limit < 1e-2 ? limit : 1e-2; };
    edges::each_explicit<System>([&](auto kind) {
        using taut::method::AnyPose;
        if (kind.any_pose == AnyPose::no_step && !damped) return;
        const double limit = kind.any_pose == AnyPose::proved    ? energy
                             : kind.any_pose == AnyPose::limited ? 0.9 * any
                                                                 : 0.1 * any;
        run_stepper<typename decltype(kind)::Type>(kind.name, system, start, h(limit));
    });
    run_stepper<taut::ImplicitEuler<System>>("ImplicitEuler", system, start, 1e-2);
    run_guarded(system, start);
}

template <class System>
void run_rest(const System& system, const typename System::State& start, bool balances) {
    using Scalar = typename System::Scalar;
    run("static_equilibrium", [&] {
        auto state = start;
        const auto report = taut::static_equilibrium(system, state);
        require(bool(report) || !balances, "static_equilibrium");
    });
    run("check_step", [&] {
        std::vector<Scalar> stiffness, rest;
        std::vector<int> ends;
        system.visit_springs([&](const auto& spring) {
            ends.push_back(static_cast<int>(spring.a));
            ends.push_back(static_cast<int>(spring.b));
            stiffness.push_back(spring.stiffness_bound());
            rest.push_back(spring.rest_length);
        });
        taut::SpringArrays<Scalar, System::Dim> arrays;
        arrays.particles = system.size();
        arrays.springs = system.spring_count();
        const auto inverse_mass = system.inverse_mass();
        arrays.inverse_mass = inverse_mass;
        arrays.position = start.x;
        arrays.ends = ends;
        arrays.stiffness = stiffness;
        arrays.rest_length = rest;
        (void)taut::check_step(arrays, Method::symplectic_euler, 1e-3);
    });
}

template <class System>
void run_all(const std::string& name, const System& system, bool damped, bool balances) {
    scene_name = name + (sizeof(typename System::Scalar) == 4 ? ", float" : ", double");
    auto start = system.initial_state();
    run_limits(system, start);
    run_rest(system, start, balances);
    start.v.setConstant(typename System::Scalar(0.1));
    start.v.col(0).setZero();
    run_steps(system, start, damped);
}

template <class Scalar>
void run_scenes() {
    using System = taut::SpringSystem<Scalar, 3>;
    const System cloth = taut::hanging_cloth<Scalar>({5, 4});
    run_all("undamped", cloth, false, true);
    System damped = cloth;
    damped.set_rayleigh({0.5, 1e-4});
    run_all("Rayleigh", damped, true, true);
    damped.add_spring(0, 7, Scalar(10), Scalar(0.1));
    run_all("dampers", damped, true, true);
    System free = cloth;
    for (Index i = 0; i < free.size(); ++i) free.unpin(i);
    free.set_gravity({0, 0, 0});
    run_all("free", free, false, false);
    System pinned = cloth;
    for (Index i = 0; i < pinned.size(); ++i) pinned.pin(i);
    run_all("pinned", pinned, false, true);
    System loose;
    for (int i = 0; i < 3; ++i) loose.add_particle({Scalar(i), 0, 0}, 1);
    run_all("without springs", loose, false, false);
    loose.set_rayleigh({0.5, 0});
    run_all("drag alone", loose, true, false);
    // Compressed, and with ends that coincide.
    System pressed;
    pressed.add_particle({0, 0, 0}, 1);
    pressed.add_particle({1, 0, 0}, 2);
    pressed.add_particle({1, 0, 0}, Scalar(0.5));
    pressed.pin(0);
    pressed.add_spring(taut::Spring<Scalar, taut::Hookean>{0, 1, {100}, 2});
    pressed.add_spring(taut::Spring<Scalar, taut::Hookean>{1, 2, {50}, Scalar(0.1)});
    pressed.add_spring(taut::Spring<Scalar, taut::Hookean>{0, 2, {0}, 1});
    run_all("pressed", pressed, false, false);
}

}  // namespace

int main() {
#if defined(__GLIBC__)
    std::signal(SIGFPE, trapped);
#endif
    run_scenes<float>();
    run_scenes<double>();
    return failures == 0 ? 0 : 1;
}
