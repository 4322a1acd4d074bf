// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include "cloth.hpp"
#include "obstacle.hpp"

namespace drape {

/// Advances by a frame. Empty, or what went wrong.
using Advance = std::function<std::string(State&)>;

/// How a frame is cut: `steps` of h each, contacts resolved after each.
struct Plan {
    int frames = 0;
    double frame = 0;       // s
    taut::Index steps = 1;  // at least, with a guard
    double h = 0;           // s, at most
};

/// What a motion is made of; cloth and obstacle must outlive it.
struct Scene {
    const Cloth& cloth;
    const Obstacle& obstacle;
    const Plan& plan;
};

namespace detail {

inline std::string name_particle(taut::Status status, taut::Index particle) {
    std::string text = describe(status);
    if (particle >= 0) text += ", particle " + std::to_string(particle);
    return text;
}

template <class Stepper>
Advance by_stepper(const Scene& scene, std::shared_ptr<Stepper> stepper) {
    const Plan plan = scene.plan;
    const bool contacts = bool(scene.obstacle);
    return [plan, contacts, stepper, &cloth = scene.cloth,
            &obstacle = scene.obstacle](State& state) -> std::string {
        const taut::Index at_once = contacts ? 1 : plan.steps;
        for (taut::Index done = 0; done < plan.steps; done += at_once) {
            const taut::Report report = stepper->step(state, plan.h, at_once);
            if (!report) return name_particle(report.status, report.where);
            obstacle.resolve(cloth, state);
        }
        return {};
    };
}

template <class Report>
std::string name_trouble(const Report& report) {
    if (report) return {};
    std::string text = name_particle(report.status, report.where);
    if (report.spring >= 0) text += ", spring " + std::to_string(report.spring);
    return text + "; given up after " + std::to_string(report.retries) + " retries";
}

/// @param arguments  further ones of the stepper's constructor
template <class Stepper, class... Arguments>
Advance by_guard(const Options& chosen, const Scene& scene, const Arguments&... arguments) {
    using Guard = taut::Guarded<Stepper>;
    typename Guard::Options options;
    options.damping = chosen.own_damping();
    options.max_step = scene.plan.h;
    options.max_substeps = std::numeric_limits<taut::Index>::max() / 64;
    auto guard = std::make_shared<Guard>(scene.cloth, options, arguments...);
    return [guard, frame = scene.plan.frame, &cloth = scene.cloth,
            &obstacle = scene.obstacle](State& state) {
        if (!obstacle) return name_trouble(guard->advance(state, frame));
        return name_trouble(
            guard->advance(state, frame, [&](State& s) { obstacle.resolve(cloth, s); }));
    };
}

template <class Stepper, class... Arguments>
Advance plain_or_guarded(const Options& chosen, const Scene& scene, const Arguments&... arguments) {
    if (chosen.guard) return by_guard<Stepper>(chosen, scene, arguments...);
    return by_stepper(scene, std::make_shared<Stepper>(scene.cloth, arguments...));
}

template <class Stepper>
Advance damped_or_guarded(const Options& chosen, const Scene& scene) {
    if (chosen.guard) return by_guard<Stepper>(chosen, scene);
    const taut::ExplicitOptions options{1, chosen.own_damping()};
    return by_stepper(scene, std::make_shared<Stepper>(scene.cloth, options));
}

}  // namespace detail

/// The chosen integrator behind one call.
inline Advance make_motion(const Options& options, const Scene& scene) {
    using detail::damped_or_guarded;
    using detail::plain_or_guarded;
    using Implicit = taut::ImplicitEuler<Cloth>;
    if (options.integrator == "newton") {
        typename Implicit::Options newton;
        newton.newton_iterations = 100;
        return plain_or_guarded<Implicit>(options, scene, newton);
    }
    if (options.integrator == "explicit") {
        return detail::by_stepper(scene, std::make_shared<taut::ExplicitEuler<Cloth>>(scene.cloth));
    }
    if (options.integrator == "graph_inertia") {
        return detail::by_stepper(scene, std::make_shared<taut::GraphInertia<Cloth>>(scene.cloth));
    }
    if (options.integrator == "verlet") {
        return damped_or_guarded<taut::VelocityVerlet<Cloth>>(options, scene);
    }
    if (options.integrator == "implicit") return plain_or_guarded<Implicit>(options, scene);
    if (options.integrator == "bdf2") return plain_or_guarded<taut::Bdf2<Cloth>>(options, scene);
    if (options.integrator == "projective") {
        return plain_or_guarded<taut::ProjectiveDynamics<Cloth>>(options, scene);
    }
    return damped_or_guarded<taut::SymplecticEuler<Cloth>>(options, scene);
}

/// A particle that falls at 3 m/s enters an obstacle by 12 mm within this time, s.
constexpr double between_contacts = 1.0 / 240;

/// Of the any-pose limit, which does not count the steps' own damping [T23].
inline double share_of_limit(const Options& options) {
    if (!options.damps()) return 0.95;
    return taut::share_of_limit(taut::recipe.safety, options.own_damping());
}

/// The step that --step leaves open, s. Throws when there is none.
inline double default_step(const Options& options, const Cloth& cloth, double frame) {
    // One linearised solve is wrong about springs that turn taut in a long step.
    const bool linearised = options.integrator == "implicit" || options.integrator == "bdf2";
    const double usual = linearised ? 1.0 / 60 : frame;
    const double contact = options.collide.empty() ? frame : between_contacts;
    const double longest = std::min({frame, usual, contact});
    if (options.integrator == "graph_inertia") {
        taut::Goal goal;
        goal.frame = longest;
        const auto plans =
            taut::feasible_plans(cloth, goal, {taut::Candidate{taut::Method::graph_inertia}});
        if (!plans.empty()) return plans.back().candidate.h;
    } else if (options.implicit()) {
        return longest;
    }
    const auto limit = taut::any_pose_limit(cloth);
    if (limit.unbounded()) return longest;
    if (!(limit.certified > 0)) {
        throw std::runtime_error("no step is certified: " + std::string(describe(limit.cause)));
    }
    return std::min(longest, share_of_limit(options) * limit.certified);
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
    plan.steps = steps;
    plan.h = plan.frame / static_cast<double>(steps);
    return plan;
}

}  // namespace drape
