// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "types.hpp"

namespace taut {

/// Why a numerical call stopped. Wrong input at set-up is reported by fail(), not here.
enum class Status {
    ok,
    invalid_step,           ///< h is not finite and > 0
    invalid_state,          ///< the state has the wrong size or holds NaN or infinity
    diverged,               ///< the new state would not be finite
    not_positive_definite,  ///< the factorisation of the step matrix failed
    solver_failed,          ///< the solver returned no finite solution
    not_converged,          ///< the iteration cap was reached
    masses_lost,            ///< a step so large that rounding loses masses beside stiffness
    too_large,              ///< a factor would not fit the memory allowed
    frozen,                 ///< a part was stopped: no step resolves a force given as code
    saddle                  ///< forces balance in a pose that the smallest push would leave
};

/// One sentence for people.
constexpr const char* describe(Status status) {
    switch (status) {
        case Status::ok: return "ok";
        case Status::invalid_step: return "the time step must be finite and > 0";
        case Status::invalid_state:
            return "the state has the wrong size for this system, or holds NaN or infinity";
        case Status::diverged: return "the state diverged: a position or velocity is not finite";
        case Status::not_positive_definite: return "the step matrix is not positive definite";
        case Status::solver_failed: return "the linear solver returned no finite solution";
        case Status::not_converged: return "the iteration limit was reached";
        case Status::masses_lost:
            return "the step is so large that rounding loses the masses beside the stiffness";
        case Status::too_large:
            return "the factor of the step matrix would not fit the memory allowed";
        case Status::frozen:
            return "a part was stopped: no step that was tried resolves a force given as code";
        case Status::saddle:
            return "forces balance, but not stably: the smallest push would leave this pose";
    }
    return "unknown status";
}

/// Outcome of a step or a solve; false when not ok, and then the state is as it was before.
struct [[nodiscard]] Report {
    Status status = Status::ok;
    int iterations = 0;   ///< steps taken by an integrator, iterations by a solver
    double residual = 0;  ///< relative residual of the linear or nonlinear equation; 0 if explicit
    Index where = -1;     ///< index of the offending particle, or -1
    int solves = 0;       ///< linear solves of an integrator's last step

    /// Whether status is ok.
    explicit operator bool() const { return status == Status::ok; }
};

}  // namespace taut
