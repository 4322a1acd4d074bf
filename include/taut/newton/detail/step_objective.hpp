// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "../../network/spring_system.hpp"

namespace taut::integrator_detail {

/// What the nonlinear implicit Euler step of a spring system minimises over the moves u = x⁺ − x:
///     φ(u) = ½(u − w)ᵀM(u − w) + h²U(x + u) + ½h uᵀD(x)u,
/// w = hv + h²M⁻¹f the inertial move, f gravity and external force at the start, U the energy of
/// the springs. ∇φ = 0 is M(v⁺ − v) = h(f − ∇U(x⁺) − D(x)v⁺) with u = hv⁺. D is held at the start,
/// as ImplicitEuler's one linearised solve holds it. Pinned particles are not variables: they move
/// by hv. (Moves and not positions, since a float's position has no digits left for a velocity.)
template <class System>
class StepObjective {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr int Dim = System::Dim;
    using Moves = Points<Scalar, Dim>;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;

    /// A step of h, s, from `state`. @param filter  takes what constraints hold out of a gradient
    template <class Filter>
    void begin(const System& system, const State& state, Scalar h, Filter&& filter);
    void begin(const System& system, const State& state, Scalar h) {
        begin(system, state, h, [](Moves&) {});
    }
    /// w, Dim × n, m, and hv for pinned particles.
    const Moves& inertial() const { return w_; }
    /// ‖∇φ‖ relative to that of the inertial move or to ‖Mw‖.
    double force_residual(const Moves& g) const {
        const double norm = g.template cast<double>().norm();  // a float's square may overflow
        return norm == 0 ? 0 : norm / scale_;                  // NaN stays
    }
    /// @param g     ← ∇φ(u), Dim × n, kg·m
    /// @param pins  whether pinned particles get what springs and dampers do to them, and not zero
    /// @returns φ(u), kg·m²
    Scalar evaluate(const System& system, const Moves& u, Moves& g, bool pins = false);
    /// Whether `next` is no larger than `value` but for the rounding of such sums.
    static bool not_above(Scalar next, Scalar value) {
        return next <= value + 64 * std::numeric_limits<Scalar>::epsilon() * (std::abs)(value);
    }

private:
    struct Damper {  // h·block of D(x) = axial·d dᵀ + transverse·(I − d dᵀ)
        int a;
        int b;
        Scalar axial;
        Scalar transverse;
        Vector d;
    };
    void set_dampers(const System& system, const State& state);

    Scalar h_ = 0;                 // s
    Moves start_;                  // x, Dim × n, m
    Moves x_;                      // x + u of the last evaluation
    Moves w_;                      // the inertial move
    Moves f_;                      // external force, N; then ∇φ(w)
    std::vector<Damper> dampers_;  // of D without its mass-proportional part
    double scale_ = 0;             // what ‖∇φ‖ is relative to, kg·m
};

template <class System>
template <class Filter>
void StepObjective<System>::begin(const System& system, const State& state, Scalar h,
                                  Filter&& filter) {
    h_ = h;
    start_ = state.x;
    system.external_force(state, f_);
    w_ = h * state.v;
    double momentum2 = 0;
    for (Index i = 0; i < system.size(); ++i) {
        if (system.is_pinned(i)) continue;
        w_.col(i) += h * h * (system.gravity() + f_.col(i) / system.mass(i));
        momentum2 +=
            (static_cast<double>(system.mass(i)) * w_.col(i).template cast<double>()).squaredNorm();
    }
    set_dampers(system, state);
    evaluate(system, w_, f_);
    filter(f_);
    scale_ = (std::max)(std::sqrt(momentum2), f_.template cast<double>().norm());
}

template <class System>
void StepObjective<System>::set_dampers(const System& system, const State& state) {
    dampers_.clear();
    const auto alpha = static_cast<Scalar>(system.rayleigh().stiffness_proportional);
    bool damped = alpha > 0;
    system.for_each_set([&](const auto& set) { damped = damped || !set.damping.empty(); });
    if (!damped) return;
    system.for_each_tangent(state.x, [&](const SpringTangent<Scalar, Dim>& raw) {
        const auto t = raw.projected();
        const Scalar axial = h_ * (alpha * t.axial + t.damping);
        const Scalar transverse = h_ * alpha * t.transverse;
        if (axial > 0 || transverse > 0) {
            dampers_.push_back(
                {static_cast<int>(t.a), static_cast<int>(t.b), axial, transverse, t.d});
        }
    });
}

template <class System>
auto StepObjective<System>::evaluate(const System& system, const Moves& u, Moves& g, bool pins)
    -> Scalar {
    x_ = start_ + u;
    g.setZero(Dim, u.cols());
    const Scalar h2 = h_ * h_;
    Scalar energy = 0;  // J
    system.for_each_set([&](const auto& set) {
        for (const auto spring : set) {
            const Vector dx = x_.col(spring.b) - x_.col(spring.a);
            energy += spring.energy(spring_length(dx));
            const Vector force = h2 * pull(spring, dx);
            g.col(spring.a) -= force;
            g.col(spring.b) += force;
        }
    });
    Scalar value = h2 * energy;
    for (const Damper& damper : dampers_) {
        const Vector move = u.col(damper.b) - u.col(damper.a);
        const Vector force = spring_product(damper.d, damper.axial, damper.transverse, move);
        value += Scalar(0.5) * force.dot(move);
        g.col(damper.a) -= force;
        g.col(damper.b) += force;
    }
    const Scalar drag = h_ * static_cast<Scalar>(system.rayleigh().mass_proportional);
    for (Index i = 0; i < system.size(); ++i) {
        if (system.is_pinned(i)) {
            if (!pins) g.col(i).setZero();
            continue;
        }
        const Vector from_inertial = u.col(i) - w_.col(i);
        g.col(i) += system.mass(i) * (from_inertial + drag * u.col(i));
        value += Scalar(0.5) * system.mass(i) *
                 (from_inertial.squaredNorm() + drag * u.col(i).squaredNorm());
    }
    return value;
}

}  // namespace taut::integrator_detail
