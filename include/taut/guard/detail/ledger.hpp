// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "../../model/spring_system.hpp"
#include "parts.hpp"

namespace taut::guard_detail {

/// By which velocities a step damps, and so by which formula its work and loss are told. `ends`
/// are those of a frame of which no more is known.
enum class Rule { verlet, kick, implicit, ahead, ends };

/// W and Q of [T43], told step by step from the states between steps: Part::worked and lost.
template <class System>
class Ledger {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    using Force = typename System::Force;
    using Vector = Eigen::Matrix<double, System::Dim, 1>;

    /// A frame begins.
    void begin(const System& system, const State& state, Parts<System>& parts) {
        for (auto& part : parts) part.worked = part.lost = 0;
        moving_ = damped_ = false;
        for (const Index i : parts.pins()) moving_ = moving_ || !state.v.col(i).isZero(0);
        drag_ = system.rayleigh().mass_proportional;
        by_ = system.stiffness_damping();
        system.for_each_set([&](const auto& set) { damped_ = damped_ || !set.damping.empty(); });
        damped_ = damped_ || drag_ > 0 || by_;
        pushed_ = system.has_external_force();
        first_ = true;
        force_.resize(Eigen::NoChange, 0);
        if (pushed_) system.external_force(state, force_);
        excess_ = 0;
        spring_ = -1;
    }
    /// Whether steps must be told one by one.
    bool follows(const System& system) const {
        return moving_ || damped_ || system.external_forces().is_code();
    }
    /// Outside forces at the last state, N; empty where there are none.
    const Force& force() const { return force_; }
    /// The spring whose law broke the inequality that its bound promises in a step of
    /// EnergyStableEuler, beyond rounding; −1 for none.
    Index untrue_spring() const { return spring_; }
    const std::string& untrue_law() const { return law_; }

    /// Adds a step of h.
    void add(const System& system, const State& before, const State& after, Scalar h, Rule rule,
             Parts<System>& parts) {
        if (pushed_) add_force(system, before, after, parts);
        const bool first = std::exchange(first_, false);
        if (!moving_ && !damped_ && rule != Rule::ahead) return;
        if (rule == Rule::verlet) {
            half_.swap(last_half_);
            half_ = ((after.x - before.x) / h).template cast<double>();
            for (Index i = 0; i < system.size(); ++i)
                if (system.is_pinned(i)) half_.col(i) = before.v.col(i).template cast<double>();
            if (first) last_half_ = before.v.template cast<double>();
        }
        for (auto& part : parts) part.step_lost = 0;
        Index index = 0;
        system.for_each_set([&](const auto& set) {
            for (const auto spring : set)
                add_spring(system, spring, index++, before, after, static_cast<double>(h), rule,
                           parts);
        });
        if (drag_ > 0 && rule != Rule::ends) {
            for (Index i = 0; i < system.size(); ++i) {
                if (parts.of(i) < 0) continue;
                const auto [braked, mean] = velocities(before, after, rule, i);
                parts[parts.of(i)].step_lost += static_cast<double>(h) * drag_ *
                                                static_cast<double>(system.mass(i)) *
                                                braked.dot(mean);
            }
        }
        for (auto& part : parts) part.lost += std::max(0.0, part.step_lost);
    }
    /// After a step: F ← F − a v⁺ with an implicit a = s|F⁺ − F|/|v⁺| [T43]. @param s  > 0
    void soften(const System& system, const State& before, State& after, Scalar h, double s) {
        system.external_force(after, last_force_);
        for (Index i = 0; i < system.size(); ++i) {
            const double speed = column(after.v, i).norm();
            if (system.is_pinned(i) || !(speed > 0)) continue;
            const double change = (column(last_force_, i) - column(force_, i)).norm();
            const double mass = static_cast<double>(system.mass(i));
            const double share = mass / (mass + s * static_cast<double>(h) * change / speed);
            after.v.col(i) *= static_cast<Scalar>(share);
            after.x.col(i) = before.x.col(i) + h * after.v.col(i);
        }
    }
    /// The function that set the force which differs most between two states.
    static const char* stiffest_force(const System& system, const State& one, const State& two) {
        const auto& all = system.external_forces();
        if (!all.outside) return "set_external_force";
        if (!all.whole) return all.outside->name();
        const auto change = [&](const auto& add) {
            Force f = Force::Zero(System::Dim, system.size()), g = f;
            add(one, f);
            add(two, g);
            const auto norm = static_cast<double>((f - g).norm());
            return std::isfinite(norm) ? norm : std::numeric_limits<double>::infinity();
        };
        const double outside = change([&](const State& s, Force& f) { all.outside->add(s, f); });
        return outside > change(all.whole) ? all.outside->name() : "set_external_force";
    }
    /// Adds the work of constraints.
    void add_held(const Force& force, const State& before, const State& after,
                  Parts<System>& parts) const {
        for (Index i = 0; i < force.cols(); ++i)
            if (parts.of(i) >= 0)
                parts[parts.of(i)].worked += column(force, i).dot(way(before, after, i));
    }

private:
    template <class Field>
    static Vector column(const Field& field, Index i) {
        return field.col(i).template cast<double>();
    }
    static Vector way(const State& before, const State& after, Index i) {
        return column(after.x, i) - column(before.x, i);
    }
    /// What damping acts on, and what its impulse is told by.
    std::pair<Vector, Vector> velocities(const State& before, const State& after, Rule rule,
                                         Index i) const {
        const Vector v = column(before.v, i), next = column(after.v, i);
        switch (rule) {
            case Rule::verlet: return {(last_half_.col(i) + half_.col(i)) / 2, (v + next) / 2};
            case Rule::kick: return {v, (v + next) / 2};
            case Rule::implicit: return {next, next};
            default: return {v, next};
        }
    }
    /// The trapezoid, less what the bend of the force over two steps may have made of it.
    void add_force(const System& system, const State& before, const State& after,
                   Parts<System>& parts) {
        std::swap(last_force_, force_);
        system.external_force(after, force_);
        for (Index i = 0; i < system.size(); ++i) {
            if (parts.of(i) < 0) continue;
            const Vector dx = way(before, after, i);
            const Vector f = column(last_force_, i), next = column(force_, i);
            double work = (f + next).dot(dx) / 2;
            if (!first_) work -= (next - 2 * f + column(earlier_force_, i)).norm() * dx.norm() / 2;
            parts[parts.of(i)].worked += work;
        }
        std::swap(earlier_force_, last_force_);
    }
    /// Of the spring's damping alone, on its end a, N.
    template <class Spring>
    Vector damper(const Spring& spring, const Vector& dx, const Vector& dv) const {
        if (!damped_) return Vector::Zero();
        const SpringLength<double> length(dx.squaredNorm());
        const double over_l = length.divide(spring.tension(length.l));
        Pull<double> pull{0, 0};
        add_damping<true, Proportional::projected>(spring, by_, length, dx.squaredNorm(), over_l,
                                                   dx.dot(dv), pull);
        return pull.of_dx * dx + pull.of_dv * dv;
    }
    template <class Own>
    void add_spring(const System& system, const Own& own, Index index, const State& before,
                    const State& after, double h, Rule rule, Parts<System>& parts) {
        const int which = parts.of(own.a, own.b);
        const bool at_pin = system.is_pinned(own.a) || system.is_pinned(own.b);
        if (which < 0 || (!damped_ && rule != Rule::ahead && !at_pin)) return;
        auto& part = parts[which];
        const auto spring = own.template cast<double>();
        const Vector xa = column(before.x, own.a), xb = column(before.x, own.b);
        const Vector sa = column(after.x, own.a), sb = column(after.x, own.b);
        const Vector r = xb - xa, s = sb - sa;
        const auto [va, mean_a] = velocities(before, after, rule, own.a);
        const auto [vb, mean_b] = velocities(before, after, rule, own.b);
        Vector impulse = Vector::Zero();  // on a, of dampers and, one step ahead, of the spring
        if (damped_ && rule == Rule::verlet) {
            impulse = h / 2 *
                      (damper(spring, r, last_half_.col(own.b) - last_half_.col(own.a)) +
                       damper(spring, s, half_.col(own.b) - half_.col(own.a)));
        } else if (damped_ && rule != Rule::ends) {
            impulse =
                h * damper(spring, rule == Rule::ahead ? Vector(r + h * (vb - va)) : r, vb - va);
        }
        part.step_lost += impulse.dot(mean_b - mean_a);
        if (rule == Rule::ahead) {
            auto undamped = spring;
            undamped.damping = 0;
            const Vector f = pull_ahead(undamped, r, Vector(vb - va), h, {});
            impulse += h * f;
            judge(spring, index, r, Vector(r + h * (vb - va)), s, f, xa.norm() + xb.norm());
        }
        if (!at_pin || !moving_) return;
        const bool pin_a = system.is_pinned(own.a);
        const Vector u = column(before.v, pin_a ? own.a : own.b) * (pin_a ? 1 : -1);
        part.worked -= u.dot(impulse);
        if (rule == Rule::ahead) return;
        const auto e = [&](const Vector& dx) { return spring.energy(spring_length(dx)); };
        if (rule == Rule::ends) {
            part.worked -=
                (pull(spring, r) + pull(spring, s)).dot(pin_a ? Vector(sa - xa) : Vector(xb - sb)) /
                2;
        } else if (pin_a) {
            part.worked += (e(xb - sa) - e(r) + e(s) - e(sb - xa)) / 2;
        } else {
            part.worked += (e(sb - xa) - e(r) + e(s) - e(xb - sa)) / 2;
        }
    }
    /// (E) of [T42]: e(s) − e(r) − f·(s − r) ≤ ½k|s − y|², f the pull on end a.
    template <class Spring>
    void judge(const Spring& spring, Index index, const Vector& r, const Vector& y, const Vector& s,
               const Vector& f, double reach) {
        const double k = spring.stiffness_bound();
        const double excess = spring.energy(spring_length(s)) - spring.energy(spring_length(r)) -
                              f.dot(s - r) - k * (s - y).squaredNorm() / 2;
        const double grain = 64 * static_cast<double>(std::numeric_limits<Scalar>::epsilon()) *
                             (f.norm() + k * (y - r).norm() + k * (s - y).norm()) *
                             (reach + r.norm() + s.norm());
        if (!(excess - grain > excess_)) return;
        excess_ = excess - grain;
        spring_ = index;
        law_ = model_detail::law_name<typename Spring::Law>();
    }

    StiffnessDamping<double> by_;
    double drag_ = 0;  // 1/s
    bool moving_ = false, damped_ = false, pushed_ = false, first_ = true;
    Force earlier_force_, last_force_, force_;      // N, at the last three states
    Points<double, System::Dim> last_half_, half_;  // velocities within the last two steps, m/s
    double excess_ = 0;                             // J, of the worst spring
    Index spring_ = -1;
    std::string law_;
};

}  // namespace taut::guard_detail
