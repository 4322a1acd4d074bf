// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// recommend() judged on a grid of scenes: whether its pick meets the goal, and what it costs beside
// the cheapest candidate that does. Prints CSV. Argument: the largest N, 100 by default.

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <taut/equilibrium/equilibrium.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/recommend/recommend.hpp>
#include <taut/taut.hpp>
#include <vector>
#include <taut/tradeoff/tradeoff.hpp>
#include <taut/proof/bracket.hpp>

#include "../measure.hpp"
#include "../outcome.hpp"

namespace {

using bench::Net;
using taut::Candidate;
using taut::Goal;
using taut::Index;
using taut::LinearSolver;
using taut::Method;
using taut::Mode;
using taut::Plan;

double thread_seconds() { return 1e-3 * bench::now(bench::thread_time); }

struct Cell {
    Index n;
    double stiffness;  // N/m
    bool heavy;        // damping
    bool pinned;
};

constexpr double fork = 20 * 3.141592653589793;  // rad/s, 10 Hz: the highest frequency that matters

/// A net of n rows and `columns` of columns, 1 m high, of the mass of that much of a 0.3 kg cloth:
/// hanging at rest from its pinned upper row, or afloat without load. Beside it, and joined to
/// nothing, a tuning fork: one particle on a spring of exactly 10 Hz, so that each scene has that
/// mode.
Net net(const Cell& cell, Index columns, Net::State& rest) {
    taut::ClothOptions options;
    options.rows = cell.n;
    options.columns = columns;
    options.width = static_cast<double>(columns - 1) / static_cast<double>(cell.n - 1);
    options.mass = 0.3 * static_cast<double>(columns) / static_cast<double>(cell.n);
    options.stretch = cell.stiffness;
    options.bend = cell.stiffness / 10;
    options.diagonals = false;  // they would compress the rows of a hanging net, which would buckle
    options.pin_corners = false;
    options.gravity = 0;
    Net result = taut::hanging_cloth<double>(options);
    if (cell.pinned) {
        for (Index c = 0; c < columns; ++c) result.pin(c);
        result.set_gravity({0, 9.81, 0});  // rows follow each other along +y
    }
    const double mass = 0.01;
    const double sag = result.gravity().y() / (fork * fork);
    const Index prong = result.add_particle({-1, 0.1 + sag, 0}, mass);
    const Index handle = result.add_particle({-1, 0, 0}, mass);
    result.pin(handle);
    result.add_spring(
        taut::Spring<double, taut::Hookean>{prong, handle, {mass * fork * fork}, 0.1});
    // Heavy: the stiffest vibration is damped at five times its critical damping.
    const double fastest = 2 / taut::any_pose_bracket(result).refuted;
    result.set_rayleigh({cell.heavy ? 5.0 : 0.5, cell.heavy ? 10 / fastest : 0});
    rest = result.initial_state();
    return result;
}

/// The pose of rest of a column, which is that of every column: rows do not pull on each other.
void relax(const Cell& cell, const Net& whole, Net::State& rest) {
    if (!cell.pinned) return;
    Net::State strip_rest;
    const Net strip = net(cell, 2, strip_rest);
    if (!taut::static_equilibrium(strip, strip_rest)) std::fprintf(stderr, "no equilibrium\n");
    const Index columns = (whole.size() - 2) / cell.n;
    for (Index r = 0; r < cell.n; ++r) {
        for (Index c = 0; c < columns; ++c) rest.x(1, r * columns + c) = strip_rest.x(1, 2 * r);
    }
}

/// The fork's mode, and the lowest and highest, up to `highest`, rad/s, of those in which every row
/// moves as one, out of the plane (hanging) or in it (afloat): an invariant space of K, so these
/// are modes of the whole net. Modes damped by 0.9 of critical damping and more do not swing.
std::vector<Mode> row_modes(const Cell& cell, const Net& system,
                            const taut::LinearSystem<double>& linear, double highest) {
    const Index columns = (system.size() - 2) / cell.n;
    const Index held = cell.pinned ? 1 : 0;
    const Index rows = cell.n - held;
    Eigen::MatrixXd rigid = Eigen::MatrixXd::Zero(linear.size(), rows);
    for (Index r = 0; r < rows; ++r) {
        for (Index c = 0; c < columns; ++c)
            rigid(3 * (r * columns + c) + (cell.pinned ? 2 : 1), r) = 1;
    }
    const Eigen::MatrixXd K = rigid.transpose() * (linear.stiffness() * rigid);
    const Eigen::MatrixXd M = rigid.transpose() * linear.mass().asDiagonal() * rigid;
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(K, M);
    std::vector<Mode> chosen;
    for (Index j = 0; j < rows; ++j) {
        Mode mode;
        mode.k = modes.eigenvalues()[j];
        if (mode.omega() < 0.1 || mode.omega() > highest) continue;
        mode.shape = rigid * modes.eigenvectors().col(j);
        mode.d = 2 * mode.omega() * taut::damping_ratio(system.rayleigh(), mode.omega());
        if (mode.zeta() < 0.9) chosen.push_back(mode);
    }
    if (chosen.size() > 2) chosen = {chosen.front(), chosen.back()};
    Mode prong;
    prong.k = fork * fork;
    prong.d = 2 * fork * taut::damping_ratio(system.rayleigh(), fork);
    prong.shape = Eigen::VectorXd::Unit(linear.size(), linear.size() - 2) / std::sqrt(0.01);
    if (prong.zeta() < 0.9) chosen.push_back(prong);
    return chosen;
}

/// One candidate as it turned out.
struct Trial {
    Plan plan;
    bool recommended = false;  // one of the plans that recommend() compares
};

class Judge {
public:
    Judge(const Cell& cell, const Goal& goal) : cell_(cell), goal_(goal) {
        system_ = net(cell, cell.n, start_);
        relax(cell, system_, start_);
        // A kick: 1 m/s along a wave in every direction, so that the net moves as a scene does.
        for (Index i = 0; i < system_.size(); ++i) {
            if (system_.is_pinned(i)) continue;
            const double s = 3 * (start_.x(0, i) + 2 * start_.x(1, i));
            start_.v.col(i) << 0.3 * std::sin(s), 0.3 * std::cos(s), std::sin(s + 1);
        }
        if (!goal.accuracy) return;
        // Whole nets of up to 16 rows; of larger ones a strip of two columns, which has the modes.
        Net::State rest;
        const Net judged = net(cell, cell.n > 16 ? 2 : cell.n, rest);
        relax(cell, judged, rest);
        const auto loaded = taut::linearize(judged, rest);
        linear_.emplace(loaded.mass(), loaded.damping(), loaded.stiffness());
        modes_ = row_modes(cell, judged, *linear_, goal.up_to_frequency);
    }

    void print() {
        taut::Calibration calibration;
        calibration.clock = &thread_seconds;
        calibration.seconds = 0.02;
        const auto advice = taut::recommend(system_, start_, goal_, calibration);
        std::vector<Trial> trials = candidates(advice.plans);
        time(trials);
        std::stable_sort(trials.begin(), trials.end(),
                         [](const Trial& a, const Trial& b) { return a.plan.cost < b.plan.cost; });
        const Trial* best = nullptr;
        for (const Trial& trial : trials) {
            if (meets(trial.plan)) {
                best = &trial;
                break;
            }
        }
        const Trial* pick = nullptr;
        double explicit_cost = NAN;
        double implicit_cost = NAN;
        for (const Trial& trial : trials) {
            const auto& c = trial.plan.candidate;
            const auto& p = advice.pick.candidate;
            if (c.method == p.method && c.solver == p.solver &&
                trial.plan.substeps == advice.pick.substeps) {
                pick = &trial;
            }
            if (!trial.recommended) continue;
            double& side = is_implicit(c.method) ? implicit_cost : explicit_cost;
            if (!(side <= trial.plan.cost)) side = trial.plan.cost;
        }
        const bool met = meets(pick->plan);
        std::printf(
            "%s,%lld,%.0e,%s,%s,\"%s\",%lld,%.5g,%.5g,%d,\"%s\",%lld,%.5g,%.4g,%zu,%.4g,%.4g,"
            "%.5g,%.5g\n",
            goal_.accuracy ? "accurate" : "stable", static_cast<long long>(cell_.n),
            cell_.stiffness, cell_.heavy ? "heavy" : "light", cell_.pinned ? "pinned" : "free",
            name(pick->plan.candidate).c_str(), static_cast<long long>(pick->plan.substeps),
            1e3 * advice.pick.cost, 1e3 * pick->plan.cost, met ? 1 : 0,
            best ? name(best->plan.candidate).c_str() : "",
            best ? static_cast<long long>(best->plan.substeps) : 0,
            best ? 1e3 * best->plan.cost : NAN, best ? pick->plan.cost / best->plan.cost : NAN,
            modes_.size(), worst_.artificial_damping, worst_.period_error, 1e3 * explicit_cost,
            1e3 * implicit_cost);
        std::fflush(stdout);
    }

private:
    /// The plans of recommend(), and the implicit ones with fewer steps, which its prediction says
    /// are too few.
    std::vector<Trial> candidates(const std::vector<Plan>& plans) const {
        std::vector<Trial> trials;
        for (const Plan& plan : plans) {
            trials.push_back({plan, true});
            trials.back().plan.cost = INFINITY;
            if (!goal_.accuracy || !is_implicit(plan.candidate.method)) continue;
            for (const Index fewer : {3 * plan.substeps / 4, plan.substeps / 2}) {
                if (fewer < 1 || fewer == trials.back().plan.substeps) continue;
                Trial trial = trials.back();
                trial.recommended = false;
                trial.plan.substeps = fewer;
                trial.plan.candidate.h = goal_.frame / static_cast<double>(fewer);
                trials.push_back(trial);
            }
        }
        return trials;
    }
    /// What comes within twice the cheapest is measured twice, with longer batches than recommend()
    /// takes. The time of a factorisation does not depend on h.
    void time(std::vector<Trial>& trials) const {
        taut::Calibration calibration;
        calibration.clock = &thread_seconds;
        calibration.seconds = 0.015;
        calibration.least_steps = 1;
        double least = INFINITY;
        for (int repeat = 0; repeat < 2; ++repeat) {
            double last = INFINITY;
            for (Trial& trial : trials) {
                const auto& c = trial.plan.candidate;
                const auto substeps = static_cast<double>(trial.plan.substeps);
                const bool known = !trial.recommended && c.solver == LinearSolver::direct;
                if (!known && repeat > 0 && trial.plan.cost > 2 * least) {
                    last = INFINITY;
                } else if (!known) {
                    last = taut::step_cost(system_, start_, c, calibration, 5 * least / substeps);
                }
                trial.plan.cost = std::min(trial.plan.cost, substeps * last);
                least = std::min(least, trial.plan.cost);
            }
            calibration.seconds = 0.05;
            calibration.least_steps = 4;
        }
    }
    bool meets(const Plan& plan) {
        worst_ = {};
        for (const Mode& mode : modes_) {
            const auto error = taut::measured_mode_error(*linear_, mode, plan.candidate, 800);
            if (!error) return false;
            if (std::abs(error->artificial_damping) > std::abs(worst_.artificial_damping)) {
                worst_.artificial_damping = error->artificial_damping;
            }
            if (std::abs(error->period_error) > std::abs(worst_.period_error)) {
                worst_.period_error = error->period_error;
            }
        }
        if (goal_.accuracy && !goal_.accuracy->admits(worst_)) return false;
        return survives(plan);
    }
    /// Ten frames from the kick, or as many steps as 0.05 s of processor allow.
    bool survives(const Plan& plan) const {
        Net::State state = start_;
        bool alive = true;
        const double start = thread_seconds();
        with_stepper(system_, plan.candidate, [&](auto& stepper) {
            const Index steps = 10 * plan.substeps;
            const Index batch = std::max<Index>(1, std::min<Index>(plan.substeps, steps / 50));
            for (Index taken = 0; alive && taken < steps && thread_seconds() - start < 0.05;
                 taken += batch) {
                alive = static_cast<bool>(stepper.step(state, plan.candidate.h, batch));
            }
        });
        return alive && bench::largest_stretch(system_, state) < bench::Outcome::explosion;
    }

    Cell cell_;
    Goal goal_;
    Net system_;
    Net::State start_;
    std::optional<taut::LinearSystem<double>> linear_;
    std::vector<Mode> modes_;
    taut::ModeError worst_;
};

}  // namespace

int main(int argc, char** argv) {
    const Index largest = argc > 1 ? std::atoi(argv[1]) : 100;
    std::printf(
        "goal,n,stiffness_n_per_m,damping,pins,pick,pick_substeps,recommended_cost_ms,pick_cost_ms,"
        "pick_meets,best,best_substeps,best_cost_ms,ratio,modes_judged,worst_damping,"
        "worst_period,explicit_cost_ms,implicit_cost_ms\n");
    Goal stable;
    Goal accurate;
    accurate.accuracy = taut::ModeTolerance{0.05, 0.05};
    accurate.up_to_frequency = fork;
    for (const Index n : {8, 16, 32, 64, 100}) {
        if (n > largest) break;
        const double step = n > 32 ? 100 : 10;
        for (double stiffness = 10; stiffness < 2e7; stiffness *= step) {
            for (const bool heavy : {false, true}) {
                for (const bool pinned : {false, true}) {
                    for (const Goal& goal : {stable, accurate}) {
                        Judge({n, stiffness, heavy, pinned}, goal).print();
                    }
                }
            }
        }
    }
}
