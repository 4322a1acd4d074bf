// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../solver/solver_concept.hpp"

namespace taut {
namespace integrator_detail {

/// The linear system of an implicit step x⁺ = x + su + τΔv for Δv = v⁺ − v [T6], [T27]:
///     (M + τD + τ²K) Δv = τ (f(x, v) − sK u),  K⁺ for K where springs are behind it.
/// Implicit Euler of step h has s = τ = h, u = v; BDF2 adds the momentum of its history.
/// One for each kind of system. Its `constant` says whether the values are the same for one τ, its
/// `symmetric` whether the matrix is.
template <class System, class = void>
class StepEquation;

}  // namespace integrator_detail

/// `type`, the solver of an implicit step that names none; one for each kind of system.
template <class System, class = void>
struct DefaultSolverOf;
template <class System>
using DefaultSolver = typename DefaultSolverOf<System>::type;

namespace integrator_detail {

/// What every implicit stepper asks of its arguments.
template <class System, class Solver>
constexpr void require_implicit() {
    require_system<System>();
    require_solver<Solver, typename System::Scalar>();
    static_assert(StepEquation<System>::symmetric || !is_symmetric_solver_v<Solver>,
                  "taut: an implicit step of an unsymmetric system needs an unsymmetric solver "
                  "(Eigen::SparseLU, say); a symmetric one would read one triangle only");
}

}  // namespace integrator_detail
}  // namespace taut
