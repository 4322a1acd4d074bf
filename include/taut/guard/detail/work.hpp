// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "parts.hpp"

namespace taut::guard_detail {

/// What was done on a part from outside in a frame, J.
struct Work {
    double booked = 0;   ///< W of the promise
    double checked = 0;  ///< the same with code forces by the trapezoid, less their curvature
};

/// Books the work on every part, step by step where that is needed [T43].
template <class System>
class WorkMeter {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    using Force = typename System::Force;
    using Vector = typename System::Vector;

    /// Whether steps must be seen one by one: pins move, or a force is given as code.
    bool stepwise(const System& system, const State& state) {
        const auto& forces = system.external_forces();
        code_ = forces.whole || forces.outside;
        pins_move_ = false;
        for (Index i = 0; i < system.size() && !pins_move_; ++i) {
            pins_move_ = system.is_pinned(i) && !state.v.col(i).isZero(0);
        }
        return code_ || pins_move_;
    }
    bool code() const { return code_; }

    /// Forgets what was booked; steps from `state` follow.
    void start(const System& system, const State& state, const Parts& parts) {
        works_.assign(parts.count(), {});
        if (code_) {
            system.external_force(state, force_);
        } else {
            force_ = system.external_forces().constant;
        }
        bend_.setZero(int(System::Dim), code_ ? system.size() : 0);
        bent_ = false;
        if (pins_move_) list_springs(system);
        x_ = state.x;
        v_ = state.v;
    }
    /// How a step takes its forces: at both ends, at the new one, or one step ahead [T42].
    enum class Kind { at_both_ends, at_the_end, ahead };
    /// After a step of h, s; or once after all, unless stepwise.
    void step(const System& system, const State& state, const Parts& parts, Scalar h, Kind kind) {
        if (pins_move_) add_pins(system, state, parts, h, kind);
        if (code_) {
            system.external_force(state, next_);
            add_forces(state, parts, kind);
            std::swap(force_, next_);
            bent_ = true;
        } else {
            add_held(force_, state, parts);
        }
        x_ = state.x;
        v_ = state.v;
    }
    /// Forces that held all through the last step, N, Dim × n; before step().
    void add_held(const Force& held, const State& state, const Parts& parts) {
        for (Index i = 0; i < held.cols(); ++i) add(parts.of(i), along(held, state, i));
    }
    /// By whatever changed the state between two steps.
    void add_change(const System& system, const std::vector<Energy>& before,
                    const std::vector<Energy>& after, const State& state) {
        for (std::size_t p = 0; p < works_.size(); ++p) {
            add(static_cast<Index>(p), after[p].total - before[p].total);
        }
        if (code_) {
            system.external_force(state, force_);
            bent_ = false;
        }
        x_ = state.x;
        v_ = state.v;
    }
    const Work& operator[](std::size_t part) const { return works_[part]; }

private:
    void add(Index part, double work) {
        if (part < 0) return;
        works_[static_cast<std::size_t>(part)].booked += work;
        works_[static_cast<std::size_t>(part)].checked += work;
    }
    double along(const Force& f, const State& state, Index i) const {
        return static_cast<double>(f.col(i).dot(state.x.col(i) - x_.col(i)));
    }
    /// force_ at the start of the step, next_ at its end.
    void add_forces(const State& state, const Parts& parts, Kind kind) {
        for (Index i = 0; i < force_.cols(); ++i) {
            const Vector change = next_.col(i) - force_.col(i);
            const auto way = static_cast<double>((state.x.col(i) - x_.col(i)).norm());
            const double begun = along(force_, state, i);
            const double mean = (begun + along(next_, state, i)) / 2;
            const double doubt =
                bent_ ? static_cast<double>((change - bend_.col(i)).norm()) * way / 2 : 0;
            bend_.col(i) = change;
            if (parts.of(i) < 0) continue;
            auto& work = works_[static_cast<std::size_t>(parts.of(i))];
            work.booked += kind == Kind::ahead ? begun : mean - doubt;
            work.checked += mean - doubt;
        }
    }
    void list_springs(const System& system) {
        if (known_ && revision_ == system.topology_revision()) return;
        known_ = true;
        revision_ = system.topology_revision();
        springs_.clear();
        system.for_each_set([&](const auto& set) {
            auto& list = springs_.emplace_back();
            for (std::size_t s = 0; s < set.a.size(); ++s) {
                if (system.is_pinned(set.a[s]) != system.is_pinned(set.b[s])) list.push_back(s);
            }
        });
    }
    /// By the springs and dampers between a pin and a free particle.
    void add_pins(const System& system, const State& state, const Parts& parts, Scalar h,
                  Kind kind) {
        const auto by = system.stiffness_damping().template cast<Scalar>();
        std::size_t law = 0;
        system.for_each_set([&](const auto& set) {
            for (const std::size_t s : springs_[law++]) {
                const auto spring = set[s];
                const bool first = system.is_pinned(spring.a);
                const Index pin = first ? spring.a : spring.b;
                const Index free = first ? spring.b : spring.a;
                const Vector u = v_.col(pin);
                if (u.isZero(0)) continue;
                const auto to_b = [&](const Vector& p, const Vector& q) -> Vector {
                    return first ? Vector(q - p) : Vector(p - q);
                };
                const Vector old_x = to_b(x_.col(pin), x_.col(free));
                const Vector old_v = to_b(u, v_.col(free));
                if (kind == Kind::ahead) {
                    const Vector f = pull_ahead(spring, old_x, old_v, h, by);
                    add(parts.of(free), -double(h) * double((first ? f : Vector(-f)).dot(u)));
                    continue;
                }
                const Vector new_x = to_b(state.x.col(pin), state.x.col(free));
                const Vector new_v = to_b(u, state.v.col(free));
                const auto energy = [&](const Vector& dx) {
                    return static_cast<double>(spring.energy(spring_length(dx)));
                };
                const double pulled = energy(to_b(state.x.col(pin), x_.col(free))) - energy(old_x) +
                                      energy(new_x) - energy(to_b(x_.col(pin), state.x.col(free)));
                // What a damper gives the free particle: the rest of its work is heat.
                const auto given = [&](const Vector& dx, const Vector& dv) {
                    const Vector f = pull(spring, dx, dv, by) - pull(spring, dx);
                    return double(
                        (first ? Vector(-f) : f).dot(first ? Vector(dv + u) : Vector(u - dv)));
                };
                double power = given(new_x, new_v);
                if (kind == Kind::at_both_ends) power = (power + given(old_x, old_v)) / 2;
                add(parts.of(free), pulled / 2 + double(h) * power);
            }
        });
    }

    std::vector<Work> works_;
    std::vector<std::vector<std::size_t>> springs_;  // of each law, from a pin to a free particle
    std::uint64_t revision_ = 0;                     // that they were listed at
    bool known_ = false, code_ = false, pins_move_ = false;
    bool bent_ = false;  // whether bend_ is known
    Force x_, v_;        // at the step's start, m, m/s
    Force force_;        // outside forces there, N
    Force next_;         // at its end
    Force bend_;         // the last change of the force, N
};

}  // namespace taut::guard_detail
