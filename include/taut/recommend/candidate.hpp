// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <tuple>

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

/// The steppers of all methods, in the order of the enum, as a std::tuple or std::variant.
/// @tparam Solver  of the implicit ones
template <template <class...> class List, class System, class Solver>
using Steppers =
    List<ExplicitEuler<System>, SymplecticEuler<System>, VelocityVerlet<System>,
         ImplicitEuler<System, Solver>, Bdf2<System, Solver>, EnergyStableEuler<System>>;

/// action(stepper) with the stepper of `candidate` on `system`, as fresh from its constructor.
template <class System, class Action>
void with_stepper(const System& system, const Candidate& candidate, Action&& action) {
    using Scalar = typename System::Scalar;
    using Gradients = ConjugateGradient<Scalar, System::Dim>;
    method::visit(candidate.method, [&](auto descriptor) {
        using Descriptor = decltype(descriptor);
        constexpr auto place = static_cast<std::size_t>(Descriptor::method);
        if constexpr (Descriptor::method == Method::energy_stable_euler &&
                      !network_detail::is_spring_system_v<System>) {
            fail("with_stepper: ", Descriptor::name, " needs the springs of a SpringSystem");
        } else {
            if constexpr (Descriptor::is_implicit) {
                if (candidate.solver == LinearSolver::conjugate_gradient) {
                    std::tuple_element_t<place, Steppers<std::tuple, System, Gradients>> stepper(
                        system);
                    stepper.configure([&](Gradients& solver) {
                        solver.setTolerance(static_cast<Scalar>(candidate.solver_tolerance));
                    });
                    return action(stepper);
                }
            }
            std::tuple_element_t<place, Steppers<std::tuple, System, SparseCholesky<Scalar>>>
                stepper(system);
            static_assert(decltype(stepper)::method == Descriptor::method);
            return action(stepper);
        }
    });
}

}  // namespace taut
