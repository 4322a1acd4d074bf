// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <taut/guard/guard.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/taut.hpp>

#if defined(__cpp_exceptions) || defined(__cpp_rtti)
#error "this unit must be compiled without exceptions and RTTI: the flags were lost"
#endif

#if defined(__GNUC__) && __cplusplus < 202002L
#error "this unit must be compiled as C++20: the flag was lost"
#endif

#if defined(_GLIBCXX_IOSTREAM) || defined(_LIBCPP_IOSTREAM)
#error "a header includes <iostream>, whose static constructors every unit would pay for"
#endif

// Members of a template are compiled only when asked for: ask for all of them.
template class taut::SpringSystem<double, 3>;
template class taut::SpringSystem<float, 2>;
template class taut::LinearSystem<double>;
template class taut::ExplicitEuler<taut::SpringSystem<double, 3>>;
template class taut::SymplecticEuler<taut::SpringSystem<double, 3>>;
template class taut::VelocityVerlet<taut::SpringSystem<double, 3>>;
template class taut::ImplicitEuler<taut::SpringSystem<double, 3>>;
template class taut::Guarded<taut::SymplecticEuler<taut::SpringSystem<float, 3>>>;
template struct taut::StateView<float, 3>;
template struct taut::StateView<double, 1>;
template class taut::Stability<double>;

int main() {
    taut::SpringSystem<double, 3> cloth = taut::hanging_cloth<double>({4, 4});
    auto state = cloth.initial_state();
    taut::SymplecticEuler stepper(cloth);
    return stepper.step(state, 0.95 * taut::any_pose_limit(cloth).certified) ? 0 : 1;
}
