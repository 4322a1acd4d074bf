// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "matrices.hpp"

#include "../support/compiled_once.hpp"
#include "../support/scene_on.hpp"

namespace taut_test::own_matrices {

namespace {

template <class Visit>
auto with_scalar(Digits digits, Visit&& visit) {
    if (digits == Digits::of_float) return visit(float());
    return visit(double());
}
template <template <class> class System, class Scalar>
System<Scalar> system_of(const Matrices& m) {
    const auto sparse = [](const RealMatrix& A) {
        return taut::SparseMatrix<Scalar>(A.cast<Scalar>().eval().sparseView());
    };
    return {m.mass.cast<Scalar>(), sparse(m.D), sparse(m.K), m.load.cast<Scalar>()};
}

template <class Scalar, class Action>
void with_state(const AnyState& any, Action&& action) {
    if (any.x.rows() == 1) return action(from_any<taut::State<Scalar, 1>>(any));
    if (any.x.rows() == 2) return action(from_any<taut::State<Scalar, 2>>(any));
    action(from_any<taut::State<Scalar, 3>>(any));
}
template <class Scalar>
AnyLinear any_linear(const taut::GeneralLinearSystem<Scalar>& system) {
    using State = taut::State<Scalar, 1>;
    return {system.stiffness().toDense().template cast<double>(),
            system.damping().toDense().template cast<double>(),
            system.load().template cast<double>(),
            system.inverse_mass().template cast<double>(),
            system.revision(),
            to_any(system.initial_state()),
            [system](const AnyState& u) -> Eigen::VectorXd {
                taut::Points<Scalar, 1> f;
                system.force(from_any<State>(u), f);
                return f.transpose().template cast<double>();
            },
            [system](const AnyState& u) {
                return static_cast<double>(system.energy(from_any<State>(u)));
            },
            [system](const AnyState& any) {
                AnyState u;
                with_state<Scalar>(any, [&](const auto& s) { u = to_any(system.to_free(s)); });
                return u;
            },
            [system](const AnyState& u, AnyState& any) {
                with_state<Scalar>(any, [&](auto state) {
                    try {
                        system.from_free(from_any<State>(u), state);
                    } catch (...) {  // what it has done to the state is to be seen
                        any = to_any(state);
                        throw;
                    }
                    any = to_any(state);
                });
            }};
}
template <template <class> class System>
AnyLinear make_linear(const Matrices& m) {
    return with_scalar(m.digits, [&](auto scalar) {
        using Scalar = decltype(scalar);
        return any_linear<Scalar>(system_of<System, Scalar>(m));
    });
}

}  // namespace

Matrices::Matrices(const RealVector& mass_of, const RealMatrix& D_of, const RealMatrix& K_of,
                   Digits digits_of, const RealVector& load_of)
    : mass(mass_of), D(D_of), K(K_of), load(load_of), digits(digits_of) {
    const auto round = [this](auto& A) {
        if (digits == Digits::of_float) A = A.template cast<float>().template cast<Real>().eval();
        if (digits == Digits::of_double) A = A.template cast<double>().template cast<Real>().eval();
    };
    round(mass), round(D), round(K), round(load);
}

AnyLinear linear_system(const Matrices& m) { return make_linear<taut::LinearSystem>(m); }
AnyLinear general_system(const Matrices& m) { return make_linear<taut::GeneralLinearSystem>(m); }
AnyLinear linearized(const Scene& scene, const AnyState& pose) {
    AnyLinear made;
    visit_system<Plain<double, 1>, Plain<double, 2>, Plain<double, 3>, Plain<float, 3>>(
        scene, [&](const auto& system) {
            using System = std::decay_t<decltype(system)>;
            made = any_linear<typename System::Scalar>(
                taut::linearize(system, from_any<typename System::State>(pose)));
        });
    return made;
}

AnyPencil pencil_of(const Matrices& m) {
    if (m.digits == Digits::of_long_double)
        return make_pencil(system_of<taut::LinearSystem, long double>(m));
    return with_scalar(m.digits, [&](auto scalar) -> AnyPencil {
        return make_pencil(system_of<taut::LinearSystem, decltype(scalar)>(m));
    });
}
taut::StepLimit<double> limit_of(const Matrices& m, taut::Method method, double tightness) {
    return with_scalar(m.digits, [&](auto scalar) {
        using Scalar = decltype(scalar);
        const taut::Stability<Scalar> stability(system_of<taut::LinearSystem, Scalar>(m));
        return to_any(taut::max_step(stability, method, tightness));
    });
}

}  // namespace taut_test::own_matrices
