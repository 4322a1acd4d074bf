// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "coarsen.hpp"

namespace taut {

/// How resolve() searches.
struct ResolveOptions {
    double safety = 2;  ///< ≥ 1: a level is chosen where this times its estimated error is within
                        ///< the goal
    double budget = 0.3;  ///< of the spring-steps of the scene itself: the search takes no more
    Index samples = 30;   ///< ≥ 1, of the duration, at which levels are compared
    double seconds = std::numeric_limits<double>::infinity();  ///< of `clock`: a search that takes
                                                               ///< longer ends, and says so
    double (*clock)() = nullptr;                               ///< s; none: cpu_seconds
};

/// What resolve() found out about one number of particles.
struct ResolutionLevel {
    Index particles = 0;
    Index springs = 0;
    double h = 0;     ///< s, at most its own energy_limit
    double cost = 0;  ///< spring-steps of the duration
    double difference =
        std::numeric_limits<double>::infinity();  ///< from the finest level, of the scene's size
    double error = std::numeric_limits<double>::infinity();  ///< estimated, likewise; infinity of
                                                             ///< the finest
};

/// How a search ended.
enum class Resolved {
    coarse,         ///< a level meets the goal
    fine,           ///< none does: the scene's own particles are needed
    unpredictable,  ///< none can: a disturbance that nobody sees grows beyond the goal
    nothing_moves,  ///< in the whole duration: any number of particles will do
    diverged,       ///< a level's motion did not stay finite
    cut_short       ///< ResolveOptions::seconds were over
};

/// In snake_case, for logs and files.
constexpr const char* name(Resolved outcome) {
    switch (outcome) {
        case Resolved::coarse: return "coarse";
        case Resolved::fine: return "fine";
        case Resolved::unpredictable: return "unpredictable";
        case Resolved::nothing_moves: return "nothing_moves";
        case Resolved::diverged: return "diverged";
        case Resolved::cut_short: return "cut_short";
    }
    return "unknown";
}

/// The answer of resolve(). Errors are those of positions relative to the scene's size: the root of
/// their mean square over particles, at the worst sample.
template <class System>
struct Resolution {
    Resolved outcome = Resolved::fine;
    std::vector<ResolutionLevel> levels;           ///< those that were run, the coarsest first
    Index chosen = -1;                             ///< its index in levels; −1: none
    std::optional<Coarsening<System>> coarsening;  ///< of the chosen level
    double goal = 0;
    double size = 0;         ///< m, the diagonal of the box around the scene
    double fine_cost = 0;    ///< spring-steps of the scene itself
    double search_cost = 0;  ///< spring-steps of all that was run
    double floor = 0;        ///< what a disturbance of 1e-7 of the size grows to
    std::string why;         ///< one sentence

    /// The spring-steps of the scene itself over those of the chosen level; 1 where there is none.
    double cheaper() const {
        if (chosen < 0) return 1;
        return fine_cost / (std::max)(1.0, levels[static_cast<std::size_t>(chosen)].cost);
    }
};

namespace tradeoff_detail {

template <class... Values>
std::string formatted(const char* format, Values... values) {
    char text[256];
    std::snprintf(text, sizeof text, format, values...);
    return text;
}
inline std::string percent(double share) { return formatted("%.2g %%", 100 * share); }
/// 4080, not 4.08e+03.
inline std::string ratio(double value) { return formatted(value < 100 ? "%.3g" : "%.0f", value); }
inline std::string particles(Index count) {
    return formatted("%lld particles", static_cast<long long>(count));
}

/// The sentence that says how a search ended.
template <class System>
std::string sentence(const Resolution<System>& found, Index all, double duration) {
    const auto over = formatted("over %.3g s ", duration);
    switch (found.outcome) {
        case Resolved::coarse: {
            const auto& level = found.levels[static_cast<std::size_t>(found.chosen)];
            std::string text = particles(level.particles) + formatted(" at about %.3g s", level.h) +
                               " are estimated to stay within " + percent(level.error) + " " +
                               over + "(goal " + percent(found.goal) + "), " +
                               ratio(found.cheaper()) + " times cheaper than all " +
                               std::to_string(all);
            if (found.chosen > 0) {
                const auto& coarser = found.levels[static_cast<std::size_t>(found.chosen) - 1];
                text += "; " + std::to_string(coarser.particles) + " would err by " +
                        percent(coarser.error);
            }
            return text + ".";
        }
        case Resolved::fine: {
            std::string text = "The scene's own " + particles(all) + " are needed";
            if (found.levels.size() < 3) {
                text += ": it, or the budget, is too small for three coarser levels to compare";
            } else {
                const auto& last = found.levels[found.levels.size() - 2];
                text += ": " + over + "even " + std::to_string(last.particles) +
                        " are estimated to err by " + percent(last.error) + " (goal " +
                        percent(found.goal) + ", to be met with some room)";
            }
            return text + ".";
        }
        case Resolved::unpredictable:
            return "No number of particles is known to keep this scene within " +
                   percent(found.goal) + " " + over + "since a disturbance of 1e-7 of its size " +
                   "grows to " + percent(found.floor) + " of it.";
        case Resolved::nothing_moves:
            return "Nothing moves" + formatted(" for %.3g s", duration) +
                   ": any number of particles will do.";
        case Resolved::diverged:
            return "The motion of a network of " + particles(found.levels.back().particles) +
                   " does not stay finite.";
        case Resolved::cut_short:
            return "The time for the search was over after " +
                   formatted(
                       "%.3g of the cost of the scene itself: nothing is known of finer "
                       "levels.",
                       found.search_cost / found.fine_cost);
    }
    return {};
}

}  // namespace tradeoff_detail
}  // namespace taut
