// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCholesky>
#include <string>

#include "../integrator/bdf2.hpp"
#include "../integrator/explicit_euler.hpp"
#include "../integrator/implicit_euler.hpp"
#include "../integrator/symplectic_euler.hpp"
#include "../integrator/velocity_verlet.hpp"
#include "../solver/conjugate_gradient.hpp"
#include "scheme.hpp"

namespace taut {

/// How an implicit step solves its linear system.
enum class LinearSolver {
    direct,             ///< sparse Cholesky (Eigen::SimplicialLLT, particles ordered)
    conjugate_gradient  ///< ConjugateGradient with incomplete Cholesky
};

/// One way to advance a scene.
struct Candidate {
    Scheme scheme = Scheme::symplectic_euler;
    double h = 0;                                ///< s
    LinearSolver solver = LinearSolver::direct;  ///< of an implicit scheme
    double solver_tolerance = 1e-3;              ///< of conjugate gradients
    int newton_iterations = 1;                   ///< of implicit Euler
    StepDamping damping{};                       ///< ExplicitOptions::damping of an explicit scheme
};

/// The scheme, and the solver where there is one; without the step.
inline std::string name(const Candidate& candidate) {
    std::string text = name(candidate.scheme);
    if (!is_implicit(candidate.scheme)) return text;
    if (candidate.solver == LinearSolver::conjugate_gradient)
        return text + " by conjugate gradients";
    return text + " by sparse Cholesky";
}

/// action(stepper) with the stepper of `candidate` on `system`, as fresh from its constructor.
template <class System, class Action>
void with_stepper(const System& system, const Candidate& candidate, Action&& action) {
    using Scalar = typename System::Scalar;
    using Direct = Eigen::SimplicialLLT<SparseMatrix<Scalar>, Eigen::Lower, BlockOrdering<>>;
    using Gradients = ConjugateGradient<Scalar, System::Dim>;
    const auto tune = [&](Gradients& solver) {
        solver.setTolerance(static_cast<Scalar>(candidate.solver_tolerance));
    };
    const ExplicitOptions own{1, candidate.damping};
    const bool direct = candidate.solver == LinearSolver::direct;
    switch (candidate.scheme) {
        case Scheme::explicit_euler: {
            ExplicitEuler<System> stepper(system, own);
            return action(stepper);
        }
        case Scheme::symplectic_euler: {
            SymplecticEuler<System> stepper(system, own);
            return action(stepper);
        }
        case Scheme::velocity_verlet: {
            VelocityVerlet<System> stepper(system, own);
            return action(stepper);
        }
        case Scheme::implicit_euler: {
            if (direct) {
                using Stepper = ImplicitEuler<System, Direct>;
                typename Stepper::Options options;
                options.newton_iterations = candidate.newton_iterations;
                Stepper stepper(system, options);
                return action(stepper);
            }
            using Stepper = ImplicitEuler<System, Gradients>;
            typename Stepper::Options options;
            options.newton_iterations = candidate.newton_iterations;
            Stepper stepper(system, options);
            stepper.configure(tune);
            return action(stepper);
        }
        case Scheme::bdf2: {
            if (direct) {
                Bdf2<System, Direct> stepper(system);
                return action(stepper);
            }
            Bdf2<System, Gradients> stepper(system);
            stepper.configure(tune);
            return action(stepper);
        }
    }
    fail("with_stepper: unknown scheme");
}

}  // namespace taut
