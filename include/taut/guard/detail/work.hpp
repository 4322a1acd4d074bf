// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "../../step/sweep.hpp"
#include "parts.hpp"

namespace taut::guard_detail {

/// What was done on a part from outside in a frame, J.
struct Work {
    double booked = 0;  ///< W, of forces given as code by the trapezoid
    double turn = 0;    ///< of that, what their change in each step makes
    double jump = 0;  ///< what code forces changed in a step by half of the way, above a quarter of
                      ///< the step's kinetic energy, at most
    double swing = 0;  ///< what they may hold back of their work at the end
};

/// Books the work on every part, step by step where that is needed [T43].
template <class System>
class WorkMeter final : public step_detail::StepWatch<typename System::Scalar, System::Dim> {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    using Force = typename System::Force;
    using Vector = typename System::Vector;
    using Places = step_detail::PlaceVectors<Scalar, System::Dim>;
    /// How a step takes its forces: at both ends, at the new one, or one step ahead [T42].
    enum class Kind { at_both_ends, at_the_end, ahead };

    /// Forgets what was booked; steps of h, s, follow.
    /// @returns whether the states between them must be seen: pins move, or a force is given as
    /// code
    bool start(const System& system, const State& state, const Parts& parts, Scalar h, Kind kind) {
        system_ = &system;
        parts_ = &parts;
        h_ = h;
        kind_ = kind;
        const auto& forces = system.external_forces();
        code_ = forces.whole || forces.outside;
        pins_move_ = false;
        for (Index i = 0; i < system.size() && !pins_move_; ++i) {
            pins_move_ = system.is_pinned(i) && !state.v.col(i).isZero(0);
        }
        if (pins_move_) list_springs();
        works_.assign(parts.count(), {});
        seen_ = 0;
        repeated_ = false;
        x_ = state.x;
        return code_ || pins_move_;
    }
    /// Whether a force is given as code.
    bool code() const { return code_; }
    /// States that were seen since.
    Index seen() const { return seen_; }

    /// A state between two steps, or at either end of all.
    void see(const State& state) {
        see([&](Index i) { return state.x.col(i); }, [&](Index i) { return state.v.col(i); }, state,
            nullptr);
    }
    void see(const Places& x, const Places& v, Scalar time, const State* state,
             const Force* force) override {
        if (code_ && !state) {
            own_.x.resize(int(System::Dim), system_->size());
            own_.v.resize(int(System::Dim), system_->size());
            own_.time = time;
            for (Index i = 0; i < system_->size(); ++i) {
                own_.x.col(i) = x(i);
                own_.v.col(i) = v(i);
            }
        }
        see(x, v, state ? *state : own_, force);
    }
    bool passed(const step_detail::Layout<Scalar>&, const Buffer<int>&,
                step_detail::StateMemory<Scalar>&, Scalar, Scalar) override {
        return true;
    }
    /// The next state is seen for the second time.
    void repeat() { repeated_ = true; }
    /// Forces that held from the last state to this one, N, Dim × n or fewer columns.
    void add_held(const Force& held, const State& state) {
        for (Index i = 0; i < held.cols(); ++i) add(parts_->of(i), along(held, state, i));
    }
    /// All constant forces, once all steps are taken or after each. Where see() has counted them,
    /// nothing is left of their way.
    void add_constant(const State& state) {
        add_held(system_->external_forces().constant, state);
        x_ = state.x;
    }
    /// The work of contacts on each particle, J.
    void add_each(const Buffer<double>& work) {
        for (Index i = 0; i < system_->size(); ++i) add(parts_->of(i), work[i]);
    }
    /// By whatever changed the state between two steps: the next one begins at `state`.
    void add_change(const std::vector<Energy>& before, const std::vector<Energy>& after,
                    const State& state) {
        for (std::size_t p = 0; p < works_.size(); ++p) {
            add(static_cast<Index>(p), after[p].total - before[p].total);
        }
        seen_ = 0;
        x_ = state.x;
        see(state);
    }
    /// Once all steps are taken, to `state`: the energy swings about work by the trapezoid by ½h
    /// F·v, or in velocity Verlet by ⅛h² of what F adds to Σ |f|²/m.
    void add_swing(const State& state) {
        if (!code_) return;
        const double h = static_cast<double>(h_);
        const double weight = static_cast<double>(system_->gravity().norm());
        for (Index i = 0; i < force_.cols(); ++i) {
            if (parts_->of(i) < 0) continue;
            const auto f = static_cast<double>(force_.col(i).norm());
            const auto v = static_cast<double>(state.v.col(i).norm());
            works_[static_cast<std::size_t>(parts_->of(i))].swing +=
                h / 2 * f * v +
                h * h / 4 * f * (f / static_cast<double>(system_->mass(i)) + weight);
        }
    }
    const Work& operator[](std::size_t part) const { return works_[part]; }

private:
    /// A spring between a pin and a free particle, at the last state that was seen.
    struct PinnedSpring {
        std::size_t index;  // in its set
        Index pin, free;
        Vector x, v, u;  // of the free particle, m, m/s; of the pin, m/s
        Vector p;        // where the pin was, m
        Vector pull;     // of the spring on the pin, without damping, N
        Vector damper;   // of its damper on the free particle, N
    };

    template <class X, class V>
    void see(const X& x, const V& v, const State& state, const Force* force) {
        add_pins(x, v, seen_ > 0 && !repeated_);
        repeated_ = false;
        if (code_) add_code(state, force);
        ++seen_;
    }
    void add(Index part, double work) {
        if (part >= 0) works_[static_cast<std::size_t>(part)].booked += work;
    }
    double along(const Force& f, const State& state, Index i) const {
        return static_cast<double>(f.col(i).dot(state.x.col(i) - x_.col(i)));
    }
    /// By forces given as code, from the last state, where they were force_, to this one.
    void add_code(const State& state, const Force* known) {
        if (!known) system_->external_force(state, next_);
        const Force& next = known ? *known : next_;
        if (seen_ == 0) {
            force_ = next;
            x_ = state.x;
            return;
        }
        jumps_.assign(works_.size(), 0);
        const double h = static_cast<double>(h_);
        for (Index i = 0; i < next.cols(); ++i) {
            const Vector change = next.col(i) - force_.col(i);
            const Vector way = state.x.col(i) - x_.col(i);
            const auto begun = static_cast<double>(force_.col(i).dot(way));
            force_.col(i) = next.col(i);
            x_.col(i) = state.x.col(i);
            if (parts_->of(i) < 0) continue;
            const auto part = static_cast<std::size_t>(parts_->of(i));
            const auto turn = static_cast<double>(change.dot(way)) / 2;
            works_[part].booked += begun + turn;
            works_[part].turn += turn;
            const auto way2 = static_cast<double>(way.squaredNorm());
            jumps_[part] += std::sqrt(static_cast<double>(change.squaredNorm()) * way2) / 2 -
                            static_cast<double>(system_->mass(i)) * way2 / (8 * h * h);
        }
        for (std::size_t p = 0; p < works_.size(); ++p) {
            // What is not a number stays so.
            if (!(jumps_[p] <= works_[p].jump)) works_[p].jump = jumps_[p];
        }
    }
    void list_springs() {
        if (listed_ == system_->topology_revision() + 1) return;
        listed_ = system_->topology_revision() + 1;
        pulls_.clear();
        system_->for_each_set([&](const auto& set) {
            auto& list = pulls_.emplace_back();
            for (std::size_t s = 0; s < set.a.size(); ++s) {
                const bool first = system_->is_pinned(set.a[s]);
                if (first == system_->is_pinned(set.b[s])) continue;
                PinnedSpring& spring = list.emplace_back();
                spring.index = s;
                spring.pin = first ? set.a[s] : set.b[s];
                spring.free = first ? set.b[s] : set.a[s];
            }
        });
    }
    /// By the springs and dampers between a moving pin and a free particle, since the last state.
    template <class X, class V>
    void add_pins(const X& x, const V& v, bool stepped) {
        const auto alpha = static_cast<Scalar>(system_->rayleigh().stiffness_proportional);
        std::size_t law = 0;
        if (!pins_move_) return;
        system_->for_each_set([&](const auto& set) {
            for (PinnedSpring& old : pulls_[law++]) {
                const Vector u = v(old.pin);
                if (u.isZero(0)) continue;
                const auto spring = set[old.index];
                const Vector here = x(old.free), p = x(old.pin), speed = v(old.free);
                if (stepped && kind_ == Kind::ahead) {
                    // The pin is the end a of a spring turned round.
                    const Vector dx = old.x - old.p, dv = old.v - old.u;
                    auto undamped = spring;
                    undamped.damping = 0;
                    const Vector f = pull_ahead(undamped, dx, dv, h_, Scalar(0));
                    const Vector damper = pull_ahead(spring, dx, dv, h_, alpha) - f;
                    add(parts_->of(old.free),
                        -double(f.dot(p - old.p)) - double(h_) * double(damper.dot(old.u)));
                }
                // What a damper gives the free particle: the rest of its work is heat.
                const Vector dx = here - p, dv = speed - u, f = pull(spring, dx);
                const Vector damper = f - pull(spring, dx, dv, alpha);
                if (stepped && kind_ != Kind::ahead) {
                    const double pulled = -double(Vector(old.pull + f).dot(p - old.p)) / 2;
                    const Vector held = kind_ == Kind::at_both_ends
                                            ? Vector((old.damper + damper) / Scalar(2))
                                            : damper;
                    // By speeds: of a short step's ways rounding may leave nothing.
                    add(parts_->of(old.free), pulled + double(h_) * double(held.dot(speed)));
                }
                old.x = here;
                old.v = speed;
                old.u = u;
                old.p = p;
                old.pull = f;
                old.damper = damper;
            }
        });
    }

    const System* system_ = nullptr;
    const Parts* parts_ = nullptr;
    Scalar h_ = 0;
    Kind kind_ = Kind::ahead;
    bool code_ = false, pins_move_ = false;
    std::uint64_t listed_ = 0;  // the topology_revision() of pulls_, and one
    Index seen_ = 0;
    bool repeated_ = false;
    std::vector<Work> works_;
    std::vector<std::vector<PinnedSpring>> pulls_;  // of each law
    Force x_;                                       // at the last state, m
    Force force_;                                   // outside forces there, N
    Force next_;                                    // workspace
    std::vector<double> jumps_;                     // of the step, by part, J
    State own_;                                     // workspace
};

}  // namespace taut::guard_detail
