// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// Needs the modules accuracy, mass_scaling, own_matrices, recommend.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../own_matrices/linearize.hpp"
#include "../proof/any_pose.hpp"
#include "../core/clock.hpp"
#include "extrapolation.hpp"
#include "mode_probe.hpp"
#include "pareto.hpp"
#include "trajectory.hpp"

namespace taut {

/// How closely runs are compared.
struct TradeoffOptions {
    Index samples = 60;  ///< of the duration, at which runs are compared
    double gain = 10;    ///< by which the reference must be better than the best run
    Index modes = 0;  ///< lowest modes to be measured, where no spring is compressed at the start
    double (*clock)() = &cpu_seconds;  ///< s
};

/// Every run with its cost and error, and how far the reference can be trusted.
struct Tradeoff {
    std::vector<TradeoffPoint> points;
    double reference_error = 0;      ///< position error of the last refinement but one
    bool reference_settled = false;  ///< reference_error ≤ the best point's error/gain
    std::vector<Mode> modes;
};

/// The trade between cost and error on one scene. Runs are added, of Taut's own steppers or of
/// anything that can advance a state; finish() then computes a reference fine enough to judge them:
/// GraggExtrapolation, its step halved until two refinements agree `gain` times better than the
/// best run agrees with the finer one.
template <class System>
class TradeoffMeter {
public:
    using Scalar = typename System::Scalar;
    static constexpr int Dim = System::Dim;
    using State = typename System::State;
    using Path = Trajectory<Scalar, Dim>;

    /// Keeps a reference to the system. @param duration  s, > 0
    TradeoffMeter(const System& system, const State& start, double duration,
                  const TradeoffOptions& options = {})
        : system_(system), start_(start), options_(options) {
        require_positive("measure_tradeoff", "duration", duration);
        if (options.samples < 1) {
            fail("measure_tradeoff: samples is ", options.samples, "; it must be >= 1");
        }
        interval_ = duration / static_cast<double>(options.samples);
        if (options.modes > 0) find_modes();
    }
    TradeoffMeter(const System&&, const State&, double, const TradeoffOptions& = {}) = delete;

    /// Runs one of Taut's own steppers; candidate.h is the step to take at most, s.
    void add(const Candidate& candidate) {
        require_positive("measure_tradeoff", "Candidate::h", candidate.h);
        with_stepper(system_, candidate, [&](auto& stepper) {
            auto& point = add(name(candidate), candidate.h, [&](State& state, double h, Index n) {
                return static_cast<bool>(stepper.step(state, static_cast<Scalar>(h), n));
            });
            const double h = point.candidate.h;
            point.candidate = candidate;
            point.candidate.h = h;
        });
        for (const Mode& mode : modes_) {
            auto& point = result_.points.back();
            point.modes.push_back(measured_mode_error(*linear_, mode, point.candidate));
        }
    }
    /// @param h        s, the step to take at most: whole steps fill an interval of the samples, or
    ///                 whole intervals a step
    /// @param advance  bool advance(State&, double h, Index count); whether all went well
    template <class Advance>
    TradeoffPoint& add(std::string name, double h, Advance&& advance) {
        Path path;
        require_positive("measure_tradeoff", "h", h);
        const double intervals = h / interval_ * (1 + 1e-9);
        path.stride = std::max<Index>(
            1, static_cast<Index>((std::min)(intervals, static_cast<double>(options_.samples))));
        const double span = static_cast<double>(path.stride) * interval_;
        const auto count = static_cast<Index>(std::ceil(span / h * (1 - 1e-9)));
        TradeoffPoint point;
        point.name = std::move(name);
        point.candidate.h = span / static_cast<double>(std::max<Index>(1, count));
        State state = start_;
        path.see(system_, state);
        point.finished = true;
        for (Index j = path.stride; point.finished && j <= options_.samples; j += path.stride) {
            const double begin = options_.clock();
            point.finished = advance(state, point.candidate.h, std::max<Index>(1, count));
            point.cost += options_.clock() - begin;
            point.steps += std::max<Index>(1, count);
            point.finished = point.finished && state.finite();
            if (point.finished) path.see(system_, state);
        }
        point.cost /= static_cast<double>(std::max<std::size_t>(1, path.x.size() - 1)) * span;
        paths_.push_back(std::move(path));
        result_.points.push_back(std::move(point));
        return result_.points.back();
    }

    /// Computes the reference and every error. The last call.
    Tradeoff finish() {
        const double limit = static_cast<double>(any_pose_limit(system_).certified);
        const double first = std::ceil(interval_ / limit);
        if (!(first < 1e9)) fail("measure_tradeoff: no step resolves this scene's stiffest mode");
        Index count = std::max<Index>(1, static_cast<Index>(first));
        Path coarse = reference(count);
        constexpr int most = 6;  // refinements, each of half the step
        for (int repeat = 0;; ++repeat) {
            reference_ = reference(count *= 2);
            const double earlier =
                repeat == 0 ? std::numeric_limits<double>::infinity() : result_.reference_error;
            result_.reference_error = position_error(coarse, reference_);
            double best = std::numeric_limits<double>::infinity();
            for (std::size_t p = 0; p < paths_.size(); ++p) {
                auto& point = result_.points[p];
                point.position_error = position_error(paths_[p], reference_);
                point.energy_drift = energy_drift(paths_[p], reference_);
                best = (std::min)(best, point.position_error);
            }
            result_.reference_settled = options_.gain * result_.reference_error <= best;
            const bool rounding =
                result_.reference_error < 1e-6 && !(result_.reference_error < earlier / 2);
            if (result_.reference_settled || rounding || repeat == most) break;
            coarse = std::move(reference_);
        }
        result_.modes = modes_;
        return std::move(result_);
    }
    /// The reference itself, once finished.
    const Path& reference() const { return reference_; }

private:
    Path reference(Index count) const {
        GraggExtrapolation<System> stepper(system_);
        Path path;
        State state = start_;
        path.see(system_, state);
        const auto h = static_cast<Scalar>(interval_ / static_cast<double>(count));
        for (Index j = 0; j < options_.samples; ++j) {
            if (!stepper.step(state, h, count)) break;
            path.see(system_, state);
        }
        return path;
    }
    void find_modes() {
        const auto pencil = Pencil::at_pose(system_, start_.x.template cast<TangentReal<Scalar>>());
        if (pencil.size() == 0 || !pencil.stiffness_semidefinite()) return;
        const auto linear = linearize(system_, start_);
        linear_.emplace(linear.mass(), linear.damping(), linear.stiffness());
        modes_ = lowest_modes(system_, start_, options_.modes);
    }

    const System& system_;
    State start_;
    TradeoffOptions options_;
    double interval_ = 0;  // s, from sample to sample
    std::vector<Mode> modes_;
    std::optional<LinearSystem<Scalar>> linear_;  // about the start, without load
    std::vector<Path> paths_;                     // of the points
    Path reference_;
    Tradeoff result_;
};

/// Cost and error of each candidate over `duration`, s, from `start`.
template <class Scalar, int Dim, class... Laws>
Tradeoff measure_tradeoff(const SpringSystem<Scalar, Dim, Laws...>& system,
                          const State<Scalar, Dim>& start, double duration,
                          const std::vector<Candidate>& candidates,
                          const TradeoffOptions& options = {}) {
    TradeoffMeter<SpringSystem<Scalar, Dim, Laws...>> meter(system, start, duration, options);
    for (const Candidate& candidate : candidates) meter.add(candidate);
    return meter.finish();
}

}  // namespace taut
