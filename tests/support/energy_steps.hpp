// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/integrator/energy_stable_euler.hpp>
#include <taut/network/buckling.hpp>
#include <taut/network/tension_only.hpp>

#include "energy_networks.hpp"

// The energy-stable step [T42], written from the theory's formula in long double, and the books of
// the steps that the library takes.

namespace taut_test {

/// What one spring does in a step.
template <int Dim>
struct SpringAhead {
    Eigen::Matrix<Real, Dim, 1> force;  ///< on its end a, damping included, N
    Real most;                          ///< what rounding errors of it are relative to, N
};

/// @param r  x_b − x_a, m   @param w  v_b − v_a, m/s   @param alpha  Rayleigh's, s
template <class Law, int Dim>
SpringAhead<Dim> spring_ahead(const typename Law::template Parameters<Real>& p, Real L, Real c,
                              const Eigen::Matrix<Real, Dim, 1>& r,
                              const Eigen::Matrix<Real, Dim, 1>& w, Real h, Real alpha) {
    using Vector = Eigen::Matrix<Real, Dim, 1>;
    const Real tiny = std::sqrt(std::numeric_limits<Real>::min());
    const Real k = Law::stiffness_bound(p, L);
    const Vector y = r + h * w;
    const Real lr = std::max(r.norm(), tiny), ly = std::max(y.norm(), tiny);
    const auto T = [&](Real l) { return Law::tension(p, L, l); };
    const auto E = [&](Real l) { return Law::energy(p, L, l); };
    Real phi = T(ly);
    const Real below = E(ly) + phi * (lr - ly) - E(lr);
    if (std::is_same_v<Law, Glue> && below > 0) {
        const Real square = k * (ly - lr) * (ly - lr) / 2;
        phi = (square * phi + below * (T(lr) + k * (ly - lr))) / (square + below);
    }
    const Vector n = y / ly;
    Vector force = phi < 0 ? Vector(phi * r / lr) : Vector(phi * n);
    const Real rate = n.dot(w);
    force += c * rate * n;
    const Real across = y.isZero(0) ? k : std::max(T(ly) / ly, Real(0));
    const Real along = y.isZero(0) ? k : std::max(Law::tension_slope(p, L, ly), Real(0));
    force += alpha * (across * (w - rate * n) + along * rate * n);
    const Real most = std::abs(T(lr)) + std::abs(T(ly)) + k * (lr + ly + L);
    return {force, most + (c + alpha * k) * w.norm()};
}

/// One step as the theory writes it.
template <class System>
struct StepAhead {
    static constexpr int Dim = System::Dim;
    using Points = Eigen::Matrix<Real, Dim, Eigen::Dynamic>;

    Points x, v;       ///< after the step
    Points springs;    ///< forces of springs and their damping on all particles, N
    RealVector noise;  ///< what rounding errors of the force on each are relative to, N
    Real size = 0;     ///< what rounding errors of the energy are relative to, J

    /// @param F  outside forces, Dim × n, N
    StepAhead(const System& system, const typename System::State& state, Real h, const Points& F)
        : x(state.x.template cast<Real>()),
          v(state.v.template cast<Real>()),
          springs(Points::Zero(Dim, system.size())),
          noise(RealVector::Zero(system.size())) {
        const auto alpha = static_cast<Real>(system.rayleigh().stiffness_proportional);
        const auto d0 = static_cast<Real>(system.rayleigh().mass_proportional);
        const auto gravity = system.gravity().template cast<Real>().eval();
        system.for_each_set([&](const auto& set) {
            using Law = typename std::decay_t<decltype(set)>::Law;
            for (std::size_t s = 0; s < set.a.size(); ++s) {
                const Eigen::Matrix<Real, Dim, 1> r = x.col(set.b[s]) - x.col(set.a[s]);
                const Eigen::Matrix<Real, Dim, 1> w = v.col(set.b[s]) - v.col(set.a[s]);
                const auto spring = spring_ahead<Law, Dim>(
                    set.parameters[s].template cast<Real>(), static_cast<Real>(set.rest_length[s]),
                    static_cast<Real>(set.damping_of(s)), r, w, h, alpha);
                springs.col(set.a[s]) += spring.force;
                springs.col(set.b[s]) -= spring.force;
                noise[set.a[s]] += spring.most;
                noise[set.b[s]] += spring.most;
            }
        });
        for (Index i = 0; i < system.size(); ++i) {
            const auto m = static_cast<Real>(system.mass(i));
            const Real speed = v.col(i).norm();
            if (!system.is_pinned(i)) {
                noise[i] += m * gravity.norm() + F.col(i).norm();
                v.col(i) += h * ((springs.col(i) + F.col(i)) / m + gravity - d0 * v.col(i));
                size += m * (speed * speed + v.col(i).squaredNorm());
            }
            size += noise[i] * (x.col(i).norm() + h * (speed + v.col(i).norm()));
            x.col(i) += h * v.col(i);
        }
    }
};

/// The books of one step that the library took.
struct Books {
    Real gain = 0;     ///< of energy, beyond the work of forces and pins, J
    Real slack = 0;    ///< what rounding may make of it, J
    Real kinetic = 0;  ///< ½ΔᵀMΔ, J

    bool rises() const { return gain > slack; }
};

/// Takes a step and keeps the books: by the forces written out above.
template <class Stepper, class System>
Books book_step(Stepper& stepper, const System& system, typename System::State& state,
                typename System::Scalar h, const typename StepAhead<System>::Points& F) {
    using Scalar = typename System::Scalar;
    constexpr Real epsilon = std::numeric_limits<Scalar>::epsilon();
    const auto time = static_cast<Real>(h);
    const StepAhead<System> exact(system, state, time, F);
    const auto before = state;
    const Real energy = total_energy(system, state);
    Books books;
    if (!stepper.step(state, h)) {
        books.gain = std::numeric_limits<Real>::infinity();
        return books;
    }
    Real work = 0;
    for (Index i = 0; i < system.size(); ++i) {
        const auto v = state.v.col(i).template cast<Real>().eval();
        const auto change = (v - before.v.col(i).template cast<Real>()).eval();
        work += time * (system.is_pinned(i) ? -v.dot(exact.springs.col(i)) : v.dot(F.col(i)));
        books.kinetic += static_cast<Real>(system.mass(i)) * change.squaredNorm() / 2;
    }
    books.gain = total_energy(system, state) - energy - work;
    books.slack = 8 * epsilon * exact.size;
    return books;
}

}  // namespace taut_test
