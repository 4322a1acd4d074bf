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

template <class Scalar>
class LinearOn : public AnyLinear {
public:
    using System = taut::GeneralLinearSystem<Scalar>;  // of which a LinearSystem is a checked one
    using State = typename System::State;

    explicit LinearOn(System system) : system_(std::move(system)) {
        stiffness = system_.stiffness().toDense().template cast<double>();
        damping = system_.damping().toDense().template cast<double>();
        load = system_.load().template cast<double>();
        inverse_mass = system_.inverse_mass().template cast<double>();
        revision = system_.revision();
    }
    AnyState initial_state() const override { return to_any(system_.initial_state()); }
    Eigen::VectorXd force(const AnyState& u) const override {
        taut::Points<Scalar, 1> f;
        system_.force(from_any<State>(u), f);
        return f.transpose().template cast<double>();
    }
    double energy(const AnyState& u) const override {
        return static_cast<double>(system_.energy(from_any<State>(u)));
    }
    AnyState to_free(const AnyState& any) const override {
        AnyState u;
        with_state(any, [&](const auto& state) { u = to_any(system_.to_free(state)); });
        return u;
    }
    void from_free(const AnyState& u, AnyState& any) const override {
        with_state(any, [&](auto state) {
            system_.from_free(from_any<State>(u), state);
            any = to_any(state);
        });
    }

private:
    template <class Action>
    void with_state(const AnyState& any, Action&& action) const {
        if (any.x.rows() == 1) return action(from_any<taut::State<Scalar, 1>>(any));
        if (any.x.rows() == 2) return action(from_any<taut::State<Scalar, 2>>(any));
        action(from_any<taut::State<Scalar, 3>>(any));
    }
    System system_;
};

template <template <class> class System>
std::unique_ptr<AnyLinear> make_linear(const Matrices& m) {
    return with_scalar(m.digits, [&](auto scalar) -> std::unique_ptr<AnyLinear> {
        using Scalar = decltype(scalar);
        return std::make_unique<LinearOn<Scalar>>(system_of<System, Scalar>(m));
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

std::unique_ptr<AnyLinear> linear_system(const Matrices& m) {
    return make_linear<taut::LinearSystem>(m);
}
std::unique_ptr<AnyLinear> general_system(const Matrices& m) {
    return make_linear<taut::GeneralLinearSystem>(m);
}
std::unique_ptr<AnyLinear> linearized(const Scene& scene, const AnyState& pose) {
    std::unique_ptr<AnyLinear> made;
    visit_system<Plain<double, 1>, Plain<double, 2>, Plain<double, 3>, Plain<float, 3>>(
        scene, [&](const auto& system) {
            using System = std::decay_t<decltype(system)>;
            made = std::make_unique<LinearOn<typename System::Scalar>>(
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
