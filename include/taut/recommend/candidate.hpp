// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "../bdf2/bdf2.hpp"
#include "../integrator/energy_stable_euler.hpp"
#include "../integrator/explicit_euler.hpp"
#include "../integrator/implicit_euler.hpp"
#include "../integrator/symplectic_euler.hpp"
#include "../integrator/velocity_verlet.hpp"
#include "../conditions/visit.hpp"
#include "../solver/conjugate_gradient.hpp"
#include "../solver/sparse_cholesky.hpp"

namespace taut {

/// How an implicit step solves its linear system.
enum class LinearSolver {
    direct,             ///< sparse Cholesky (Eigen::SimplicialLLT, particles ordered)
    conjugate_gradient  ///< ConjugateGradient
};

/// One way to advance a scene.
struct Candidate {
    Method method = Method::energy_stable_euler;
    double h = 0;                                ///< s
    LinearSolver solver = LinearSolver::direct;  ///< of an implicit method
    double solver_tolerance = 1e-3;              ///< of conjugate gradients
};

/// The method, and the solver where there is one; without the step.
inline std::string name(const Candidate& candidate) {
    std::string text = name(candidate.method);
    if (!is_implicit(candidate.method)) return text;
    if (candidate.solver == LinearSolver::conjugate_gradient)
        return text + " by conjugate gradients";
    return text + " by sparse Cholesky";
}

namespace tradeoff_detail {

/// The stepper of each method; Solver is that of an implicit one.
template <class Descriptor, class System, class Solver>
struct StepperOf;
template <class System, class Solver>
struct StepperOf<method::ExplicitEuler, System, Solver> {
    using type = ExplicitEuler<System>;
};
template <class System, class Solver>
struct StepperOf<method::SymplecticEuler, System, Solver> {
    using type = SymplecticEuler<System>;
};
template <class System, class Solver>
struct StepperOf<method::VelocityVerlet, System, Solver> {
    using type = VelocityVerlet<System>;
};
template <class System, class Solver>
struct StepperOf<method::ImplicitEuler, System, Solver> {
    using type = ImplicitEuler<System, Solver>;
};
template <class System, class Solver>
struct StepperOf<method::Bdf2, System, Solver> {
    using type = Bdf2<System, Solver>;
};
template <class System, class Solver>
struct StepperOf<method::EnergyStableEuler, System, Solver> {
    using type = EnergyStableEuler<System>;
};

/// The stepper with this descriptor and this solver.
template <class Descriptor, class Solver, class System>
auto make_stepper(const System& system) {
    using Stepper = typename StepperOf<Descriptor, System, Solver>::type;
    return Stepper(system);
}

}  // namespace tradeoff_detail

/// action(stepper) with the stepper of `candidate` on `system`, as fresh from its constructor.
template <class System, class Action>
void with_stepper(const System& system, const Candidate& candidate, Action&& action) {
    using Scalar = typename System::Scalar;
    using Direct = SparseCholesky<Scalar>;
    using Gradients = ConjugateGradient<Scalar, System::Dim>;
    method::visit(candidate.method, [&](auto descriptor) {
        using Descriptor = decltype(descriptor);
        if constexpr (Descriptor::method == Method::energy_stable_euler &&
                      !network_detail::is_spring_system_v<System>) {
            fail("with_stepper: ", Descriptor::name, " needs the springs of a SpringSystem");
        } else {
            if constexpr (Descriptor::is_implicit) {
                if (candidate.solver == LinearSolver::conjugate_gradient) {
                    auto stepper = tradeoff_detail::make_stepper<Descriptor, Gradients>(system);
                    stepper.configure([&](Gradients& solver) {
                        solver.setTolerance(static_cast<Scalar>(candidate.solver_tolerance));
                    });
                    return action(stepper);
                }
            }
            auto stepper = tradeoff_detail::make_stepper<Descriptor, Direct>(system);
            return action(stepper);
        }
    });
}

}  // namespace taut
