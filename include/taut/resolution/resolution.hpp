// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "../core/clock.hpp"
#include "../integrator/energy_stable_euler.hpp"
#include "../proof/energy_limit.hpp"
#include "levels.hpp"

namespace taut {
namespace tradeoff_detail {

/// Positions at the samples of a duration, the first of them at the start.
template <class System>
using Samples = std::vector<Points<typename System::Scalar, System::Dim>>;

/// How a system is stepped through a duration: by EnergyStableEuler, in even parts of its samples.
struct Pace {
    double h = 0;     // s; 0: no step is certified
    Index steps = 0;  // from sample to sample
    double cost = 0;  // spring-steps of the duration
};

template <class System>
Pace pace_of(const System& system, double duration, Index samples) {
    const auto limit = energy_limit(system);
    const double interval = duration / static_cast<double>(samples);
    Pace pace;
    if (!(limit.certified > 0)) return pace;
    const auto most = static_cast<double>(limit.certified);
    const double steps = (std::max)(1.0, std::ceil(interval / most));
    if (steps > 1e12) return pace;
    pace.steps = static_cast<Index>(steps);
    pace.h = interval / steps;
    pace.cost = static_cast<double>(system.spring_count()) * steps * static_cast<double>(samples);
    return pace;
}

/// @returns fewer samples than wanted where the motion does not stay finite, or `go_on` says no
template <class System, class GoOn>
Samples<System> run(const System& system, typename System::State state, const Pace& pace,
                    Index samples, const GoOn& go_on) {
    EnergyStableEuler<System> stepper(system);
    Samples<System> path{state.x};
    for (Index s = 0; s < samples && go_on(); ++s) {
        const auto h = static_cast<typename System::Scalar>(pace.h);
        if (!stepper.step(state, h, pace.steps) || !state.finite()) break;
        path.push_back(state.x);
    }
    return path;
}

/// The largest over the samples of the root mean square over particles, m.
/// @param many   how many particles of the scene each stands for
/// @param apart  apart(s, i): how far particle i is from where it ought to be in sample s, a vector
template <class Apart>
double worst_rms(std::size_t samples, const Eigen::VectorXd& many, const Apart& apart) {
    double worst = 0;
    for (std::size_t s = 0; s < samples; ++s) {
        double squares = 0;
        for (Index i = 0; i < many.size(); ++i)
            squares += many[i] * static_cast<double>(apart(s, i).squaredNorm());
        worst = (std::max)(worst, std::sqrt(squares / many.sum()));
    }
    return worst;
}

/// How many particles of the scene each of a coarse network stands for.
template <class System>
Eigen::VectorXd cluster_sizes(const Coarsening<System>& coarsening) {
    Eigen::VectorXd many = Eigen::VectorXd::Zero(coarsening.system.size());
    for (const int c : coarsening.cluster) ++many[c];
    return many;
}

/// A free particle's start moved by `size` along each axis, this way or that.
template <class System>
void disturb(const System& system, double size, typename System::State& state) {
    std::uint32_t bits = 1;
    for (Index i = 0; i < system.size(); ++i) {
        if (system.is_pinned(i)) continue;
        for (int d = 0; d < System::Dim; ++d) {
            bits = bits * 1664525U + 1013904223U;
            const bool up = (bits >> 31U) != 0;
            state.x(d, i) += static_cast<typename System::Scalar>(up ? size : -size);
        }
    }
}

/// The levels of one search.
template <class System>
class ResolutionSearch {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;

    ResolutionSearch(const System& system, const State& state, double duration, double goal,
                     const ResolveOptions& options)
        : system_(system), state_(state), duration_(duration), options_(options) {
        clock_ = options.clock != nullptr ? options.clock : &cpu_seconds;
        start_ = clock_();
        found_.goal = goal;
        found_.size = static_cast<double>(
            (state.x.rowwise().maxCoeff() - state.x.rowwise().minCoeff()).norm());
    }

    Resolution<System> search() {
        found_.outcome = find();
        found_.why = sentence(found_, system_.size(), duration_);
        return std::move(found_);
    }

private:
    struct Level {
        Coarsening<System> coarsening;
        State start;
        Pace pace;
        Samples<System> path;
    };

    bool in_time() const { return clock_() - start_ <= options_.seconds; }
    bool whole(const Samples<System>& path) const {
        return static_cast<Index>(path.size()) == options_.samples + 1;
    }

    Resolved find() {
        if (!(found_.size > 0) || !detail::is_finite(found_.size))
            fail("resolve: the scene's size is ", found_.size, " m; it must be finite and > 0");
        if (!may_move()) return Resolved::nothing_moves;
        const Pace fine = pace_of(system_, duration_, options_.samples);
        if (!(fine.h > 0))
            fail("resolve: no step of the scene is certified, or the duration of ", duration_,
                 " s holds more than 1e12 of them");
        found_.fine_cost = fine.cost;
        const Index least = least_count(system_);
        // Small scenes begin with fewer, so that three levels fit.
        const Index most = system_.size() / 2 - least;
        for (Index free = std::clamp<Index>(most / 16, 1, 16); free <= most; free *= 4) {
            Coarsening<System> coarsening = coarsen(system_, least + free);
            State start = coarsening.restricted(state_);
            const Pace pace = pace_of(coarsening.system, duration_, options_.samples);
            if (!(pace.h > 0)) break;
            const double disturbed = levels_.empty() ? 0 : little * pace.cost;
            if (found_.search_cost + pace.cost + disturbed > options_.budget * fine.cost) break;
            auto path =
                run(coarsening.system, start, pace, options_.samples, [&] { return in_time(); });
            found_.search_cost += pace.cost;
            found_.levels.push_back(
                {coarsening.system.size(), coarsening.system.spring_count(), pace.h, pace.cost});
            if (!whole(path)) return in_time() ? Resolved::diverged : Resolved::cut_short;
            levels_.push_back({std::move(coarsening), std::move(start), pace, std::move(path)});
            estimate();
            // Two levels that are both too coarse may agree by chance; three did not.
            if (levels_.size() < 3) continue;
            if (choose_level()) break;
        }
        return judge();
    }

    /// Whether any particle can get farther than 1e-9 of the size by the speed and the force that
    /// it begins with, or a compressed spring may buckle.
    bool may_move() const {
        bool compressed = false;
        system_.visit_springs([&](const auto& spring) {
            if (system_.is_pinned(spring.a) && system_.is_pinned(spring.b)) return;
            const Scalar l = (state_.x.col(spring.b) - state_.x.col(spring.a)).norm();
            compressed |= l > 0 && spring.tension(l) < Scalar(-1e-9) * l * spring.stiffness_bound();
        });
        if (compressed) return true;
        typename System::Force f;
        system_.force(state_, f);
        double farthest = 0;
        for (Index i = 0; i < system_.size(); ++i) {
            double way = duration_ * static_cast<double>(state_.v.col(i).norm());
            if (!system_.is_pinned(i)) {
                way += duration_ * duration_ / 2 *
                       static_cast<double>(f.col(i).norm() / system_.mass(i));
            }
            farthest = (std::max)(farthest, way);
        }
        return !(farthest <= 1e-9 * found_.size);
    }

    /// How far a level is from the last one, on whose particles it is lifted; of the size.
    double apart_from_last(const Level& level) const {
        const Level& last = levels_.back();
        const auto& seeds = last.coarsening.seeds;
        std::size_t lifted_of = 0;
        Points<Scalar, System::Dim> moved =
            Points<Scalar, System::Dim>::Zero(System::Dim, level.coarsening.system.size());
        return worst_rms(last.path.size(), cluster_sizes(last.coarsening),
                         [&](std::size_t s, Index i) {
                             if (s != lifted_of) moved = level.path[lifted_of = s] - level.path[0];
                             const auto at = static_cast<std::size_t>(i);
                             return (last.path[s].col(i) - last.path[0].col(i) -
                                     level.coarsening.lifted(moved, seeds[at]))
                                 .eval();
                         }) /
               found_.size;
    }

    /// Estimates every level's error anew from the last one. That errs, too: by half of what the
    /// one before it is apart from it, in a direction of its own, since errors about halve from
    /// level to level. A level that agrees with the last by chance is caught by the one before it.
    void estimate() {
        const std::size_t last = levels_.size() - 1;
        for (std::size_t l = 0; l < last; ++l)
            found_.levels[l].difference = apart_from_last(levels_[l]);
        if (last < 1) return;
        const double tail = found_.levels[last - 1].difference / 2;
        for (std::size_t l = 0; l < last; ++l) {
            double apart = found_.levels[l].difference;
            if (l > 0 && l + 1 == last)
                apart = (std::max)(apart, found_.levels[l - 1].difference / 3);
            found_.levels[l].error = std::hypot(apart, tail);
        }
    }

    /// The coarsest level that is estimated to meet the goal.
    bool choose_level() {
        for (std::size_t l = 0; l + 1 < levels_.size(); ++l) {
            if (!(options_.safety * found_.levels[l].error <= found_.goal)) continue;
            found_.chosen = static_cast<Index>(l);
            return true;
        }
        return false;
    }

    /// What a disturbance grows to, on a level that costs little beside the last, and what that
    /// means.
    Resolved judge() {
        if (levels_.size() < 2) return Resolved::fine;
        std::size_t at = 0;
        for (std::size_t l = 0; l + 1 < levels_.size(); ++l)
            if (levels_[l].pace.cost <= little * levels_.back().pace.cost) at = l;
        const Level& level = levels_[at];
        const double size =
            (std::max)(1e-7, 4 * static_cast<double>(std::numeric_limits<Scalar>::epsilon())) *
            found_.size;
        State start = level.start;
        disturb(level.coarsening.system, size, start);
        const auto path = run(level.coarsening.system, start, level.pace, options_.samples,
                              [&] { return in_time(); });
        found_.search_cost += level.pace.cost;
        if (!whole(path)) {
            found_.chosen = -1;
            return in_time() ? Resolved::diverged : Resolved::cut_short;
        }
        found_.floor = worst_rms(path.size(), cluster_sizes(level.coarsening),
                                 [&](std::size_t s, Index i) {
                                     return (path[s].col(i) - level.path[s].col(i)).eval();
                                 }) /
                       found_.size;
        if (!(options_.safety * found_.floor <= found_.goal)) {
            found_.chosen = -1;
            return Resolved::unpredictable;
        }
        if (found_.chosen < 0) return Resolved::fine;
        found_.coarsening.emplace(
            std::move(levels_[static_cast<std::size_t>(found_.chosen)].coarsening));
        return Resolved::coarse;
    }

    static constexpr double little = 0.15;

    const System& system_;
    const State& state_;
    double duration_;  // s
    ResolveOptions options_;
    double (*clock_)() = nullptr;
    double start_ = 0;  // s, of the clock
    std::vector<Level> levels_;
    Resolution<System> found_;
};

}  // namespace tradeoff_detail

/// How few particles will do? The coarsest network (coarsen) whose motion from `state` is estimated
/// to stay within `goal` of the scene's for `duration`.
///
///     auto found = taut::resolve(cloth, state, 2.0, 0.03);   // within 3 % for 2 s
///     found.why, found.coarsening->system, found.cheaper()
///
/// Levels of 16, 64, 256 … free particles (fewer in scenes of some hundred) are stepped by
/// EnergyStableEuler, each at its own energy_limit. The estimate of a level's error is its distance
/// from the finest level, of three at the least, and half the distance of the last two. It is
/// an estimate: nothing here is certified but the steps. The last run disturbs a level by 1e-7 of
/// the scene's size: what that grows to, no resolution can predict better.
///
/// Deterministic, unless ResolveOptions::seconds cut it short. The scene itself is never run; the
/// search costs at most ResolveOptions::budget of it.
/// @param duration  s, > 0   @param goal  > 0, the error of positions over the scene's size, root
///                  mean square over particles at the worst time: 0.03 is 3 %
/// @throws (fail) for other values, particles that all lie in one point, a state that does not fit,
/// forces that coarsen() refuses, and a
///         scene of which no step is certified
template <class Scalar, int Dim, class... Laws>
Resolution<SpringSystem<Scalar, Dim, Laws...>> resolve(
    const SpringSystem<Scalar, Dim, Laws...>& system, const State<Scalar, Dim>& state,
    double duration, double goal, const ResolveOptions& options = {}) {
    require_positive("resolve", "duration", duration);
    require_positive("resolve", "goal", goal);
    if (!(options.safety >= 1)) fail("resolve: safety is ", options.safety, "; it must be >= 1");
    require_positive("resolve", "budget", options.budget);
    if (!(options.seconds > 0)) fail("resolve: seconds is ", options.seconds, "; it must be > 0");
    if (options.samples < 1) fail("resolve: samples is ", options.samples, "; it must be >= 1");
    detail::require_fits("resolve", state, system.size());
    if (!state.finite())
        fail("resolve: the state of particle ", state.first_not_finite(), " is not finite");
    scene_detail::require_coarsenable(system, system.size());
    return tradeoff_detail::ResolutionSearch<SpringSystem<Scalar, Dim, Laws...>>(
               system, state, duration, goal, options)
        .search();
}

}  // namespace taut
