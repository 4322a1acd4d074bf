// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <taut/bdf2/bdf2.hpp>
#include <taut/constraints/constraints.hpp>
#include <taut/equilibrium/equilibrium.hpp>
#include <taut/guard/guard.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/mass_scaling/mass_scaling.hpp>
#include <taut/modal/modal.hpp>
#include <taut/newton/newton.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/projective/projective.hpp>
#include <taut/tight/tight.hpp>
#include <taut/proof/bracket.hpp>

#include "soup.hpp"

// What must hold for every scene: build, analyse, step.

namespace taut_fuzz {

template <class Scalar>
void require_numbers(const taut::StepLimit<Scalar>& limit) {
    require(limit.certified >= 0, "a certified step is a number >= 0");
    require(limit.refuted >= limit.certified, "no certified step is refuted");
    require(!std::isnan(limit.growth_rate), "a growth rate is a number");
    require(!std::isnan(limit.estimate), "an estimate is a number");
}

/// Brackets of two widths must overlap, and a step that is proved is not refuted.
template <class Stability>
void require_sound(const Stability& stability) {
    using taut::Method;
    for (int i = 0; i <= static_cast<int>(Method::last); ++i) {
        const auto method = static_cast<Method>(i);
        if (taut::method::is_limited_by<taut::method::Absent>(method)) continue;
        const auto bound = taut::bracket(stability, method);
        const auto narrow = taut::max_step(stability, method, 1e-3);
        require_numbers(bound);
        require_numbers(narrow);
        require(bound.certified <= narrow.refuted, "a bound is below a narrower refutation");
        require(narrow.certified <= bound.refuted, "a narrower proof is below a refutation");
        const auto h = static_cast<double>(bound.refuted);
        if (h > 0 && std::isfinite(h) && h > static_cast<double>(bound.certified)) {
            require(!taut::certify(stability, method, h).proved, "a refuted step is not proved");
        }
        accepted([&] {
            require(taut::spectral_radius(stability, method, 0.01) >= 0,
                    "a radius is a number >= 0");
        });
    }
    (void)taut::count_zero_modes(stability);
    const auto spectrum = taut::stiffness_spectrum(stability);
    require(spectrum.k_max.lower <= spectrum.k_max.upper, "the bracket of k_max is not empty");
    require(spectrum.k_min.lower <= spectrum.k_min.upper, "the bracket of k_min is not empty");
    accepted([&] { (void)stability.rayleigh_window(Method::explicit_euler, 0.01); });
    (void)taut::limiting_springs(stability, 3);
    (void)taut::limiting_particles(stability, 3);
}

/// Five steps: each leaves a finite state, or a Report and the state as it was.
template <class Stepper, class State, class Scalar>
void require_steps(Stepper& stepper, State state, Scalar h) {
    for (int i = 0; i < 5; ++i) {
        const State before = state;
        const taut::Report report = stepper.step(state, h, 1 + i);
        if (report) {
            require(state.finite(), "after a step the state is finite");
        } else {
            require(same(state, before), "a step that failed leaves the state as it was");
            require(report.status != taut::Status::ok, "a Report says why");
        }
    }
}

template <class System>
void require_all_steppers(const System& system, const typename System::State& state,
                          typename System::Scalar h) {
    taut::ExplicitEuler explicit_euler(system);
    taut::SymplecticEuler symplectic_euler(system);
    taut::VelocityVerlet velocity_verlet(system);
    taut::ImplicitEuler<System> implicit_euler(system);
    taut::Bdf2<System> bdf2(system);
    require_steps(explicit_euler, state, h);
    require_steps(symplectic_euler, state, h);
    require_steps(velocity_verlet, state, h);
    require_steps(implicit_euler, state, h);
    require_steps(bdf2, state, h);
}

/// What only a SpringSystem has.
template <class System>
void require_wrappers(Bytes& bytes, const System& system, const typename System::State& state,
                      typename System::Scalar h) {
    using Scalar = typename System::Scalar;
    typename taut::NewtonEuler<System>::Options few_solves;
    few_solves.iterations = 5;
    taut::NewtonEuler<System> nonlinear(system, few_solves);
    require_steps(nonlinear, state, h);
    taut::ProjectiveDynamics<System> projective(system);
    require_steps(projective, state, h);
    taut::ConstrainedEuler<System> constrained(system);
    if (system.size() > 0) {
        const Index held = bytes.below(system.size());
        const auto direction = place<Scalar, System::Dim>(bytes);
        accepted([&] { constrained.constraints().hold(held, direction); });
    }
    require_steps(constrained, state, h);

    taut::GuardedOptions<Scalar> few;
    few.max_substeps = 20;
    taut::Guarded guard(system, few);
    auto moved = state;
    for (int frame = 0; frame < 3; ++frame) {
        const auto before = moved;
        const auto report = guard.advance(moved, h);
        const bool refused = !report && report.status != taut::Status::frozen;
        require(refused ? same(moved, before) : moved.finite(),
                "a guarded frame is finite, or refused");
    }
}

/// Modes that were found can be stepped: finite amplitudes, or a Report and the amplitudes as they
/// were.
template <class Linear, class System>
void require_modes(const Linear& linear, const System& system, const typename System::State& state,
                   double h) {
    using Scalar = typename System::Scalar;
    taut::ModalBasis basis;
    if (linear.size() == 0 ||
        !taut::modal_analysis(linear, std::min<Index>(4, linear.size()), basis))
        return;
    require(basis.k.allFinite() && basis.shapes.allFinite(), "modes are finite");
    taut::ModalDynamics<Scalar, System::Dim> modal(linear, state, basis);
    for (int i = 0; i < 5; ++i) {
        const Eigen::ArrayXd q = modal.amplitudes();
        const taut::Report report = modal.step(h, 1 + i);
        require(
            report ? modal.amplitudes().allFinite() : (modal.amplitudes() == q || q.isNaN()).all(),
            "a modal step is finite, or changes nothing");
    }
    require(modal.state().x.cols() == system.size(), "modes have the scene's particles");
}

template <class System>
void run(Bytes bytes) {
    using Scalar = typename System::Scalar;
    const auto system = decode_system<System>(bytes);
    const auto state = decode_state(bytes, system);
    const auto h = static_cast<Scalar>(bytes.positive());

    accepted([&] {
        const taut::Stability<Scalar> stability(system, state);
        require_sound(stability);
        const auto any = taut::any_pose_bracket(system);
        const auto narrow_any = taut::any_pose_limit(system, 1e-3);
        require_numbers(any);
        require_numbers(narrow_any);
        require(any.certified <= narrow_any.refuted && narrow_any.certified <= any.refuted,
                "any-pose brackets overlap");
        const auto here = taut::max_step(stability, taut::Method::symplectic_euler, 1e-3);
        require(any.certified <= here.refuted, "what holds at any pose holds at this one");
    });
    if (h > 0 && std::isfinite(h))
        accepted([&] { (void)taut::added_mass(system, state, static_cast<double>(h)); });

    require_all_steppers(system, state, h);
    require_wrappers(bytes, system, state, h);
    auto hanging = state;
    accepted([&] { (void)taut::static_equilibrium(system, hanging); });

    accepted([&] {
        const auto linear = taut::linearize(system, state);
        require_sound(taut::Stability<Scalar>(linear));
        taut::State<Scalar, 1> u = linear.to_free(state);
        require_all_steppers(linear, u, h);
        require_modes(linear, system, state, static_cast<double>(h));
    });
}

}  // namespace taut_fuzz
