// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "../../core/types.hpp"
#include "../../model/spring_mechanics.hpp"

namespace taut::integrator_detail {

/// The pins that move, and what springs do to them: only springs with a pinned end are visited.
template <class System>
class PinWork {
public:
    using State = typename System::State;

    /// Whether a pinned particle has a velocity.
    bool moves(const System& system, const State& state) {
        update(system);
        return std::any_of(pins_.begin(), pins_.end(),
                           [&](Index i) { return !state.v.col(i).isZero(0); });
    }
    /// v·f over the pinned particles, f of springs, W.
    double spring_power(const System& system, const State& state) {
        return power(system, state, [](const auto& spring, const Vector& dx, const Vector&) {
            return pull(spring, dx);
        });
    }
    /// The same with f of springs and of all that damps them, W.
    /// @param added  a stepper's own, StepDamping::times(h)
    double damped_power(const System& system, const State& state, const StepDamping& added) {
        using Scalar = typename System::Scalar;
        const auto by = system.stiffness_damping(added).template cast<Scalar>();
        const auto ahead = static_cast<Scalar>(added.look_ahead);
        return power(system, state, [&](const auto& spring, const Vector& dx, const Vector& dv) {
            const Vector then = dx + ahead * dv;
            return pull(spring, then, dv, by);
        });
    }

private:
    using Vector = typename System::Vector;

    template <class Force>
    double power(const System& system, const State& state, Force&& force) {
        update(system);
        double sum = 0;
        std::size_t which = 0;
        system.for_each_set([&](const auto& set) {
            for (const std::size_t s : springs_[which++]) {
                const auto spring = set[s];
                const Vector dx = state.x.col(spring.b) - state.x.col(spring.a);
                const Vector dv = state.v.col(spring.b) - state.v.col(spring.a);
                Vector v = Vector::Zero();
                if (system.is_pinned(spring.a)) v += state.v.col(spring.a);
                if (system.is_pinned(spring.b)) v -= state.v.col(spring.b);
                sum += static_cast<double>(force(spring, dx, dv).dot(v));
            }
        });
        return sum;
    }
    void update(const System& system) {
        if (known_ && revision_ == system.topology_revision()) return;
        known_ = true;
        revision_ = system.topology_revision();
        pins_.clear();
        for (Index i = 0; i < system.size(); ++i) {
            if (system.is_pinned(i)) pins_.push_back(i);
        }
        springs_.clear();
        system.for_each_set([&](const auto& set) {
            auto& list = springs_.emplace_back();
            if (pins_.empty()) return;
            for (std::size_t s = 0; s < set.a.size(); ++s) {
                if (system.is_pinned(set.a[s]) || system.is_pinned(set.b[s])) list.push_back(s);
            }
        });
    }

    std::vector<Index> pins_;
    std::vector<std::vector<std::size_t>> springs_;  // of each law, those with a pinned end
    std::uint64_t revision_ = 0;
    bool known_ = false;
};

}  // namespace taut::integrator_detail
