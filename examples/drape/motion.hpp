// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include "cloth.hpp"

namespace drape {

/// Advances by a span, s. Empty, or what went wrong, and then the state is that of its start.
using Advance = std::function<std::string(State&, double)>;

/// How a frame is cut: `spans` of `steps` steps of h each, contacts resolved after each span.
struct Plan {
    int frames = 0;
    double frame = 0;  // s
    taut::Index spans = 1;
    taut::Index steps = 1;  // at least, with a guard
    double h = 0;           // s, at most

    double span() const { return frame / static_cast<double>(spans); }
};

namespace detail {

inline std::string name_particle(taut::Status status, taut::Index particle) {
    std::string text = describe(status);
    if (particle >= 0) text += ", particle " + std::to_string(particle);
    return text;
}

template <class Stepper>
Advance by_stepper(std::shared_ptr<Stepper> stepper, const Plan& plan) {
    return [stepper, plan](State& state, double) {
        const taut::Report report = stepper->step(state, plan.h, plan.steps);
        return report ? std::string() : name_particle(report.status, report.where);
    };
}

template <class Stepper, class... Arguments>
Advance by_guard(const Cloth& cloth, const Plan& plan, const Arguments&... arguments) {
    using Guard = taut::Guarded<Stepper>;
    typename Guard::Options options;
    options.max_step = plan.h;
    options.max_substeps = std::numeric_limits<taut::Index>::max() / 64;
    auto guard = std::make_shared<Guard>(cloth, options, arguments...);
    return [guard](State& state, double span) {
        const auto report = guard->advance(state, span);
        if (report) return std::string();
        std::string text = name_particle(report.status, report.particle);
        if (report.spring >= 0) text += ", spring " + std::to_string(report.spring);
        return text + "; given up after " + std::to_string(report.retries) + " retries";
    };
}

/// @param arguments  further ones of the stepper's constructor
template <class Stepper, class... Arguments>
Advance plain_or_guarded(bool guarded, const Cloth& cloth, const Plan& plan,
                         const Arguments&... arguments) {
    if (guarded) return by_guard<Stepper>(cloth, plan, arguments...);
    return by_stepper(std::make_shared<Stepper>(cloth, arguments...), plan);
}

}  // namespace detail

/// The chosen integrator behind one call; `cloth` must outlive it.
inline Advance make_motion(const Options& options, const Cloth& cloth, const Plan& plan) {
    using detail::plain_or_guarded;
    using Implicit = taut::ImplicitEuler<Cloth>;
    if (options.integrator == "newton") {
        typename Implicit::Options newton;
        newton.newton_iterations = 100;
        return plain_or_guarded<Implicit>(options.guard, cloth, plan, newton);
    }
    if (options.integrator == "explicit") {
        return detail::by_stepper(std::make_shared<taut::ExplicitEuler<Cloth>>(cloth), plan);
    }
    if (options.integrator == "verlet") {
        return plain_or_guarded<taut::VelocityVerlet<Cloth>>(options.guard, cloth, plan);
    }
    if (options.integrator == "implicit") {
        return plain_or_guarded<Implicit>(options.guard, cloth, plan);
    }
    if (options.integrator == "bdf2") {
        return plain_or_guarded<taut::Bdf2<Cloth>>(options.guard, cloth, plan);
    }
    if (options.integrator == "projective") {
        return plain_or_guarded<taut::ProjectiveDynamics<Cloth>>(options.guard, cloth, plan);
    }
    return plain_or_guarded<taut::SymplecticEuler<Cloth>>(options.guard, cloth, plan);
}

/// A particle that falls at 3 m/s enters an obstacle by 12 mm within this time, s.
constexpr double between_contacts = 1.0 / 240;

/// The step that --step leaves open, s. Throws when there is none.
inline double default_step(const Options& options, const Cloth& cloth, double frame) {
    // One linearised solve is wrong about springs that turn taut in a long step.
    const bool linearised = options.integrator == "implicit" || options.integrator == "bdf2";
    const double usual = linearised ? 1.0 / 60 : frame;
    const double contact = options.collide.empty() ? frame : between_contacts;
    const double longest = std::min({frame, usual, contact});
    if (options.implicit()) return longest;
    const auto limit = taut::any_pose_limit(cloth);
    if (limit.unbounded()) return longest;
    if (!(limit.certified > 0)) {
        throw std::runtime_error("no step is certified: " + std::string(describe(limit.cause)));
    }
    return std::min(longest, 0.95 * limit.certified);
}

/// Throws naming the options that ask for too much.
inline Plan make_plan(const Options& options, const Cloth& cloth) {
    Plan plan;
    const double frames = std::round(options.duration * options.frame_rate);
    if (frames > 99999) {
        throw std::runtime_error("--duration, --frame-rate: more than 99999 frames");
    }
    plan.frames = std::max(1, static_cast<int>(frames));
    plan.frame = options.duration / plan.frames;
    const double wanted =
        options.step > 0 ? options.step : default_step(options, cloth, plan.frame);
    if (!(plan.frame / wanted <= 1e9)) {
        throw std::runtime_error("--step: more than 1e9 steps for each frame");
    }
    const auto steps = std::max<taut::Index>(
        1, static_cast<taut::Index>(std::ceil(plan.frame / wanted * (1 - 1e-12))));
    plan.h = plan.frame / static_cast<double>(steps);
    if (options.collide.empty()) {
        plan.steps = steps;
    } else {
        // A guard audits every span: not more of them than contacts need.
        const auto contacts = static_cast<taut::Index>(std::ceil(plan.frame / between_contacts));
        plan.spans = options.guard ? std::min(steps, contacts) : steps;
        plan.steps = (steps + plan.spans - 1) / plan.spans;
    }
    return plan;
}

}  // namespace drape
