// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "../energy_guarantee.hpp"
#include "../../core/buffer.hpp"
#include "../../network/spring_system.hpp"
#include "step_objective.hpp"

namespace taut::integrator_detail {

/// Judges whether a move u solves the nonlinear implicit step, particle by particle, so that the
/// rounding of one stiff spring excuses no other, and whether its energy keeps to [T24].
template <class System>
class StepJudge {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    static constexpr int Dim = System::Dim;
    using Moves = Points<Scalar, Dim>;

    /// What became of a move.
    struct Verdict {
        bool solved = false;
        Scalar rounding = 0;  ///< what the rounding of positions makes of φ, kg·m²
        /// The largest quotient of judge(), > tolerance unless solved.
        double residual = std::numeric_limits<double>::infinity();
    };

    /// A step of h, s, from `state`. @param objective  begun with the same
    void begin(const System& system, const State& state, Scalar h,
               const StepObjective<System>& objective);
    /// Judges u by quotients that rounding alone may lift above `tolerance`: of each particle |∇φ|
    /// over the sizes of the terms in it; |uᵀ∇φ|/h², and where the energy is convex what the step
    /// gains beyond the work of forces, pins and constraints, over the energy before the step and
    /// the work of forces in it.
    /// @param g       ∇φ(u), Dim × n, kg·m, filtered
    /// @param filter  filter(p), Dim × n: takes what constraints hold out of p
    template <class Filter>
    Verdict judge(const System& system, StepObjective<System>& objective, const Moves& u,
                  const Moves& g, double tolerance, Filter&& filter);

private:
    using Wide = std::common_type_t<Scalar, double>;  // a float's energies are judged in double
    using Vector = Eigen::Matrix<Wide, Dim, 1>;
    using Sizes = Buffer<Wide>;
    static constexpr Wide epsilon = std::numeric_limits<Scalar>::epsilon();

    struct Energy {
        Wide springs = 0;   // J
        Wide kinetic = 0;   // J
        Wide rounding = 0;  // R of [T24], J
    };
    template <class Column>
    static Wide length(const Column& column) {
        return column.template cast<Wide>().norm();
    }
    template <class Visitor>
    Energy weigh(const System& system, const Moves& x, const Moves& v, Visitor&& visit) const;
    void size_up(const System& system, const StepObjective<System>& objective, const Moves& u);
    template <class Filter>
    Wide work_of_holding(const System& system, StepObjective<System>& objective, const Moves& u,
                         Filter&& filter);

    Wide h_ = 0;             // s
    Moves start_, end_;      // x and x + u, Dim × n, m
    Moves v_;                // at the end, m/s
    Moves load_;             // gravity and external force, h² times, kg·m
    Energy before_, after_;  // at both
    Moves held_, whole_;     // what pins and constraints move; ∇φ with their forces
    Sizes inertial_;      // of each particle, springs' terms of ∇φ at the inertial move, kg·m
    Sizes size_;          // the terms of ∇φ(u), kg·m
    Sizes blur_;          // their rounding, kg·m
    Wide open_blur_ = 0;  // what this makes of uᵀ∇φ, kg·m²
};

/// @param visit  visit(a, b, |T|, stiffness bound, damping) of every spring: N, N/m, N·s/m
template <class System>
template <class Visitor>
auto StepJudge<System>::weigh(const System& system, const Moves& x, const Moves& v,
                              Visitor&& visit) const -> Energy {
    Energy sum;
    const auto blur = [&](Index i) { return 4 * epsilon * length(x.col(i)); };
    system.visit_springs([&](const auto& its) {
        const auto spring = its.template cast<Wide>();
        const Wide l =
            (x.col(spring.b).template cast<Wide>() - x.col(spring.a).template cast<Wide>()).norm();
        const Wide tension = l > 0 ? (std::abs)(spring.tension(l)) : Wide(0);
        const Wide bound = spring.stiffness_bound();
        const Wide stretch = blur(spring.a) + blur(spring.b);
        sum.springs += spring.energy(l);
        sum.rounding += (tension + bound * stretch / 2) * stretch;
        visit(spring.a, spring.b, tension, bound, spring.damping);
    });
    const Wide gravity = length(system.gravity());
    for (Index i = 0; i < system.size(); ++i) {
        if (system.is_pinned(i)) continue;
        const Wide speed = length(v.col(i));
        sum.kinetic += system.mass(i) / 2 * speed * speed;
        sum.rounding += system.mass(i) * gravity * blur(i);
    }
    return sum;
}

template <class System>
void StepJudge<System>::begin(const System& system, const State& state, Scalar h,
                              const StepObjective<System>& objective) {
    h_ = h;
    start_ = state.x;
    v_ = state.v;
    load_ = objective.inertial() - h * state.v;
    for (Index i = 0; i < system.size(); ++i) load_.col(i) *= system.mass(i);  // 0 if pinned
    before_ = weigh(system, start_, v_, [](auto&&...) {});
    inertial_.assign(system.size(), 0);
    end_ = start_ + objective.inertial();
    weigh(system, end_, v_, [&](Index a, Index b, Wide tension, Wide, Wide) {
        for (const Index i : {a, b}) inertial_[i] += h_ * h_ * tension;
    });
}

/// end_, v_, after_, size_, blur_ and open_blur_ of a move.
template <class System>
void StepJudge<System>::size_up(const System& system, const StepObjective<System>& objective,
                                const Moves& u) {
    end_ = start_ + u;
    v_ = u / static_cast<Scalar>(h_);
    size_.assign(system.size(), 0);
    blur_.assign(system.size(), 0);
    open_blur_ = 0;
    const auto alpha = static_cast<Wide>(system.rayleigh().stiffness_proportional);
    const auto reach = [&](Index i) { return length(start_.col(i)) + length(end_.col(i)); };
    after_ = weigh(system, end_, v_, [&](Index a, Index b, Wide tension, Wide bound, Wide damping) {
        const Wide move = length(u.col(b) - u.col(a));
        const Wide drag = h_ * (alpha * bound + damping);
        const Wide blur = 8 * epsilon * (h_ * h_ * bound + drag) * (reach(a) + reach(b));
        for (const Index i : {a, b}) {
            size_[i] += h_ * h_ * tension + drag * move;
            blur_[i] += blur;
        }
        open_blur_ += blur * move;
    });
    const Wide drag = 1 + h_ * static_cast<Wide>(system.rayleigh().mass_proportional);
    for (Index i = 0; i < system.size(); ++i) {
        const Wide move = length(u.col(i));
        const Wide inertia = system.mass(i) * (drag * move + length(objective.inertial().col(i)));
        size_[i] = (std::max)(size_[i], inertial_[i]) + inertia;
        blur_[i] += 8 * epsilon * inertia;
        open_blur_ += 8 * epsilon * inertia * move;
    }
}

/// Of pins and constraints that move, J; held_ ← their part of u.
template <class System>
template <class Filter>
auto StepJudge<System>::work_of_holding(const System& system, StepObjective<System>& objective,
                                        const Moves& u, Filter&& filter) -> Wide {
    held_ = u;
    filter(held_);
    for (Index i = 0; i < system.size(); ++i) {
        if (system.is_pinned(i)) held_.col(i).setZero();
    }
    held_ = u - held_;
    if ((held_.array() == 0).all()) return 0;
    objective.evaluate(system, u, whole_, true);
    return held_.template cast<Wide>().cwiseProduct(whole_.template cast<Wide>()).sum() / (h_ * h_);
}

template <class System>
template <class Filter>
auto StepJudge<System>::judge(const System& system, StepObjective<System>& objective,
                              const Moves& u, const Moves& g, double tolerance, Filter&& filter)
    -> Verdict {
    Wide worst = 0;
    const auto raise = [&](Wide part, Wide whole) {
        const Wide ratio = part == 0 ? Wide(0) : part / whole;
        if (!(ratio <= worst) && detail::is_finite(worst)) worst = ratio;  // NaN stays
    };
    const auto tol = static_cast<Wide>(tolerance);
    size_up(system, objective, u);
    bool solved = true;
    Wide work = 0;  // of gravity and external force, J
    for (Index i = 0; i < system.size(); ++i) {
        if (system.is_pinned(i)) continue;
        const Wide open = length(g.col(i));
        raise(open, size_[i]);
        solved = solved && open <= tol * size_[i] + blur_[i];
        const Vector move = end_.col(i).template cast<Wide>() - start_.col(i).template cast<Wide>();
        work += move.dot(load_.col(i).template cast<Wide>()) / (h_ * h_);
    }
    const Wide stake = before_.kinetic + before_.springs + (std::abs)(work);
    if (!detail::is_finite(stake)) return {};
    const Wide open =
        (std::abs)(u.template cast<Wide>().cwiseProduct(g.template cast<Wide>()).sum()) / (h_ * h_);
    solved = solved && open <= tol * stake + open_blur_ / (h_ * h_);
    raise(open, stake);
    if constexpr (energy_never_rises_v<System>) {
        const Wide holding = work_of_holding(system, objective, u, filter);
        const Wide gain =
            after_.kinetic - before_.kinetic + after_.springs - before_.springs - work - holding;
        Wide rounding = before_.rounding + after_.rounding +
                        64 * epsilon * (stake + after_.kinetic + after_.springs);
        for (Index i = 0; holding != 0 && i < system.size(); ++i) {
            rounding += blur_[i] * length(held_.col(i)) / (h_ * h_);
        }
        solved = solved && gain <= tol * stake + rounding;
        raise((std::max)(gain, Wide(0)), stake);
    }
    return {solved, static_cast<Scalar>(h_ * h_ * after_.rounding), static_cast<double>(worst)};
}

}  // namespace taut::integrator_detail
