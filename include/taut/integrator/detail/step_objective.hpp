// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "../../model/spring_system.hpp"

namespace taut::detail {

template <class System>
inline constexpr bool is_spring_system_v = false;
template <class Scalar, int Dim, class... Laws>
inline constexpr bool is_spring_system_v<SpringSystem<Scalar, Dim, Laws...>> = true;

/// What the nonlinear implicit Euler step of a spring system minimises over the new positions x:
///     φ(x) = ½(x − y)ᵀM(x − y) + h²U(x) + ½h(x − x₀)ᵀD(x₀)(x − x₀),
/// y = x₀ + hv₀ + h²M⁻¹f the inertial positions, f gravity and external force at the start, U the
/// energy of the springs. ∇φ = 0 is M(v⁺ − v₀) = h(f − ∇U(x) − D(x₀)v⁺) with x = x₀ + hv⁺. D is
/// held at the start, as ImplicitEuler's one linearised solve holds it. Pinned particles are not
/// variables: they are at x₀ + hv₀.
template <class System>
class StepObjective {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr int Dim = System::Dim;
    using Positions = Points<Scalar, Dim>;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;

    /// A step of h, s, from `state`.
    void begin(const System& system, const State& state, Scalar h);
    /// y, Dim × n, m: with the pinned particles where they will be.
    const Positions& inertial() const { return y_; }
    /// ∇φ is judged by this norm: that of ∇φ at the inertial positions, or of M(y − x₀). kg·m
    Scalar scale() const { return scale_; }
    /// @param g  ← ∇φ(x), Dim × n, kg·m, zero for pinned particles   @returns φ(x), kg·m²
    Scalar evaluate(const System& system, const Positions& x, Positions& g) const;
    /// What the rounding of x makes of ∇φ(x), relative to scale().
    double rounding(const System& system, const Positions& x) const;
    /// Whether `next` is no larger than `value` but for the rounding of such sums.
    static bool not_above(Scalar next, Scalar value) {
        return next <= value + 64 * std::numeric_limits<Scalar>::epsilon() * std::abs(value);
    }

private:
    struct Damper {  // h·block of D(x₀) = axial·d dᵀ + transverse·(I − d dᵀ)
        int a;
        int b;
        Scalar axial;
        Scalar transverse;
        Vector d;
    };
    void set_dampers(const System& system, const State& state);

    Scalar h_ = 0;
    Positions x0_;
    Positions y_;
    Positions f_;                  // external force, N; then ∇φ at the start
    std::vector<Damper> dampers_;  // of D without its mass-proportional part
    Scalar scale_ = 0;
};

template <class System>
void StepObjective<System>::begin(const System& system, const State& state, Scalar h) {
    h_ = h;
    x0_ = state.x;
    system.external_force(state, f_);
    y_ = state.x + h * state.v;
    scale_ = 0;
    for (Index i = 0; i < system.size(); ++i) {
        if (system.is_pinned(i)) continue;
        y_.col(i) += h * h * (system.gravity() + f_.col(i) / system.mass(i));
        scale_ += (system.mass(i) * (y_.col(i) - x0_.col(i))).squaredNorm();
    }
    set_dampers(system, state);
    evaluate(system, y_, f_);
    scale_ = std::max(std::sqrt(scale_), f_.norm());
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
double StepObjective<System>::rounding(const System& system, const Positions& x) const {
    Scalar squares = 0;
    system.for_each_tangent(x, [&](const SpringTangent<Scalar, Dim>& t) {
        const Scalar stiffness = h_ * h_ * t.bound + h_ * t.damping;
        squares += 2 * stiffness * stiffness;
    });
    for (Index i = 0; i < system.size(); ++i) squares += system.mass(i) * system.mass(i);
    return static_cast<double>(8 * std::numeric_limits<Scalar>::epsilon() * std::sqrt(squares) *
                               x.cwiseAbs().maxCoeff() / scale_);
}

template <class System>
auto StepObjective<System>::evaluate(const System& system, const Positions& x, Positions& g) const
    -> Scalar {
    g.setZero(Dim, x.cols());
    const Scalar h2 = h_ * h_;
    Scalar energy = 0;  // J
    system.for_each_set([&](const auto& set) {
        using Law = typename std::decay_t<decltype(set)>::Law;
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            const Vector dx = x.col(set.b[s]) - x.col(set.a[s]);
            const Scalar l = dx.norm();
            const Scalar L = set.rest_length[s];
            energy += Law::energy(set.parameters[s], L, l);
            if (!(l > 0)) continue;
            const Vector pull = h2 * Law::tension(set.parameters[s], L, l) / l * dx;
            g.col(set.a[s]) -= pull;
            g.col(set.b[s]) += pull;
        }
    });
    Scalar value = h2 * energy;
    for (const Damper& damper : dampers_) {
        const Vector move =
            (x.col(damper.b) - x0_.col(damper.b)) - (x.col(damper.a) - x0_.col(damper.a));
        const Scalar along = damper.d.dot(move);
        const Vector pull =
            damper.transverse * move + (damper.axial - damper.transverse) * along * damper.d;
        value += Scalar(0.5) * pull.dot(move);
        g.col(damper.a) -= pull;
        g.col(damper.b) += pull;
    }
    const Scalar drag = h_ * static_cast<Scalar>(system.rayleigh().mass_proportional);
    for (Index i = 0; i < system.size(); ++i) {
        if (system.is_pinned(i)) {
            g.col(i).setZero();
            continue;
        }
        const Vector from_inertial = x.col(i) - y_.col(i);
        const Vector from_start = x.col(i) - x0_.col(i);
        g.col(i) += system.mass(i) * (from_inertial + drag * from_start);
        value += Scalar(0.5) * system.mass(i) *
                 (from_inertial.squaredNorm() + drag * from_start.squaredNorm());
    }
    return value;
}

}  // namespace taut::detail
