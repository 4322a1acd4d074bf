// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <type_traits>
#include <vector>

#include "../graph_inertia/inertia_price.hpp"
#include "../stability/rayleigh.hpp"
#include "choose.hpp"

namespace taut {

/// The errors of graph inertia in a mode that its shares slow from ω to ω̃ [T33]: those of
/// symplectic Euler on the heavier mode, with the default dissipation, beside what is lost to the
/// inertia. Springs are taken to have no dampers. Infinity where the mode does not swing.
/// @param h  s, > 0   @param zeta  the mode's own damping ratio, in [0, 1)
inline ModeError slowed_mode_error(const SlowedMode& mode, double h, double zeta = 0) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr double delta = method::GraphInertia::dissipation;
    const double slowing = mode.frequency / mode.slowed_frequency;
    const double q = std::max(0.0, (slowing - 1) * (slowing + 1));
    // A = M̃ + ½hD_i and D_i, which is 2δ/h of the springs' part of M̃ − M.
    const double root = std::sqrt(1 + (1 + delta) * q);
    const double heavier = (zeta + delta * q / (h * mode.frequency)) / root;
    if (!(heavier < 1)) return {infinity, infinity};
    ModeError error = mode_error(Method::symplectic_euler, h * mode.frequency / root, heavier);
    error.artificial_damping += heavier - zeta;
    const double lively = (1 - zeta) * (1 + zeta) / ((1 - heavier) * (1 + heavier));
    error.period_error = (1 + error.period_error) * root * std::sqrt(lively) - 1;
    return error;
}

namespace tradeoff_detail {

/// Whether no spring can turn slack or buckle. Springs that do feed graph inertia, which has no
/// damping of its own, with energy: tension-only cloths exploded within minutes at each margin
/// tried.
template <class System>
bool springs_stay_taut(const System& system) {
    bool all = true;
    system.visit_springs([&](const auto& spring) {
        all = all && std::is_same_v<typename std::decay_t<decltype(spring)>::Law, Hookean>;
    });
    return all;
}

/// The steps of graph inertia that are worth a try: each the largest that makes at most a given
/// share of the springs implicit and whose price the goal admits. Half of them at most: where more
/// are, folds are slowed all over the scene, which the modes of a flat pose do not show.
template <class Scalar, int Dim, class... Laws>
class GraphInertiaPlans {
public:
    using System = SpringSystem<Scalar, Dim, Laws...>;

    GraphInertiaPlans(const System& system, const State<Scalar, Dim>& state, const Goal& goal)
        : system_(system), state_(state), goal_(goal), springs_taut_(springs_stay_taut(system)) {}

    /// @param below  substeps a frame: only fewer are tried
    std::vector<Plan> plans(const Candidate& candidate, Index below) {
        std::vector<Plan> found;
        if (!springs_taut_ || system_.size() > most_particles || below < 2) return found;
        for (const double share : {1.0 / 16, 1.0 / 4, 1.0 / 2}) {
            const auto most =
                static_cast<Index>(share * static_cast<double>(system_.spring_count()));
            const Index substeps = fewest(most, below - 1);
            if (substeps == 0) continue;
            const Trial& trial = trials_.find(substeps)->second;
            // None implicit: symplectic Euler, beyond its recipe.
            if (trial.implicit == 0) continue;
            if (!found.empty() && found.back().substeps == substeps) continue;
            found.push_back(plan(candidate, substeps, trial, most));
        }
        return found;
    }

private:
    struct Price {
        double added = 0;
        double slowing = 0;  // the largest of the modes judged
        ModeError worst;     // each of its own mode
        bool admitted = false;
    };
    struct Trial {
        GraphShares shares;
        Index implicit = 0;
        std::optional<Price> price;
    };
    // Modes of larger scenes take longer than what else is measured.
    static constexpr Index most_particles = 20'000;
    static constexpr Index judged_modes = 10;
    // As many as are found of a large scene. More would let short waves that the inertia makes slow
    // pass for changes of the low ones.
    static constexpr Index known_modes = 20;
    /// Where the goal asks for no accuracy: motion must not freeze all the same.
    static constexpr ModeTolerance lax{std::numeric_limits<double>::infinity(), 0.05};

    /// The fewest substeps, ≤ `largest`, that pass; 0 if these do not. More pass as well, as a
    /// rule.
    Index fewest(Index most_implicit, Index largest) {
        if (!passes(largest, most_implicit)) return 0;
        fails_ = 0;
        while (largest - fails_ > 1 && 100 * largest > 103 * fails_) {
            const auto product =
                static_cast<double>(std::max<Index>(1, fails_)) * static_cast<double>(largest);
            const Index next =
                std::clamp(static_cast<Index>(std::sqrt(product)), fails_ + 1, largest - 1);
            (passes(next, most_implicit) ? largest : fails_) = next;
        }
        return largest;
    }
    bool passes(Index substeps, Index most_implicit) {
        const auto [at, is_new] = trials_.try_emplace(substeps);
        Trial& trial = at->second;
        if (is_new) {
            trial.shares = graph_shares(system_, goal_.frame / static_cast<double>(substeps),
                                        GraphInertiaOptions{}.margin);
            trial.implicit = trial.shares.implicit_springs();
        }
        if (trial.shares.status != Status::ok || trial.implicit > most_implicit) return false;
        if (trial.implicit == 0) return true;
        if (!trial.price) trial.price = price(trial.shares);
        return trial.price->admitted;
    }
    Price price(const GraphShares& shares) {
        if (!modes_) modes_ = LowModes::of(system_, state_, known_modes);
        const auto answer = inertia_price(system_, shares, *modes_, known_modes);
        Price price;
        price.added = answer.added;
        price.admitted = !answer.modes.empty();  // else its price is not known
        const ModeTolerance& tolerance = goal_.accuracy ? *goal_.accuracy : lax;
        const auto judge = [&](SlowedMode mode) {
            price.admitted = price.admitted && mode.slowed_frequency > 0;
            if (!price.admitted) return;
            price.slowing = std::max(price.slowing, -mode.change());
            double zeta = 0;
            if (goal_.accuracy) {
                // Faster ones are judged as slow motion of the same shape.
                const double slower = std::min(1.0, goal_.up_to_frequency / mode.frequency);
                mode = {slower * mode.frequency, slower * mode.slowed_frequency};
                zeta = std::min(0.95, damping_ratio(system_.rayleigh(), mode.frequency));
            }
            const ModeError error = slowed_mode_error(mode, shares.step, zeta);
            price.admitted = price.admitted && tolerance.admits(error);
            keep_larger(price.worst.artificial_damping, error.artificial_damping);
            keep_larger(price.worst.period_error, error.period_error);
        };
        for (std::size_t j = 0; j < answer.modes.size(); ++j) {
            const bool low = j < static_cast<std::size_t>(judged_modes);
            if (low || (goal_.accuracy && answer.modes[j].frequency <= goal_.up_to_frequency))
                judge(answer.modes[j]);
        }
        if (goal_.accuracy && !answer.modes.empty() && !modes_->all) judge_beyond(answer, judge);
        return price;
    }
    /// Of the modes above those known: added inertia weighs as the square of the frequency.
    template <class Judge>
    void judge_beyond(const InertiaPrice& answer, Judge& judge) const {
        const double ratio = goal_.up_to_frequency / answer.modes.back().frequency;
        if (!(ratio > 1)) return;
        double q = 0;
        for (const SlowedMode& mode : answer.modes)
            q = std::max(q, std::pow(mode.frequency / mode.slowed_frequency, 2) - 1);
        judge({goal_.up_to_frequency, goal_.up_to_frequency / std::sqrt(1 + q * ratio * ratio)});
    }
    static void keep_larger(double& kept, double value) {
        if (!(std::abs(value) <= std::abs(kept))) kept = value;
    }
    Plan plan(const Candidate& candidate, Index substeps, const Trial& trial, Index most) const {
        Plan plan;
        plan.candidate = candidate;
        plan.candidate.h = goal_.frame / static_cast<double>(substeps);
        plan.substeps = substeps;
        if (fails_ > 0) {
            const Trial& larger = trials_.find(fails_)->second;
            const bool dear = larger.implicit <= most && larger.price;
            plan.bound = dear ? StepBound::accuracy : StepBound::stability;
        }
        if (goal_.accuracy) plan.error = trial.price->worst;
        plan.inertia = {trial.implicit, system_.spring_count(), trial.price->added,
                        trial.price->slowing};
        return plan;
    }

    const System& system_;
    const State<Scalar, Dim>& state_;
    Goal goal_;
    bool springs_taut_;
    std::map<Index, Trial> trials_;  // by substeps
    Index fails_ = 0;                // the most substeps that did not pass the last search
    std::optional<LowModes> modes_;
};

}  // namespace tradeoff_detail
}  // namespace taut
