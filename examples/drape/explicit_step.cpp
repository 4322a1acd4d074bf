// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The steppers that solve no linear systems, and the guard, which has one of them.

#include <limits>
#include <memory>
#include <taut/guard/guard.hpp>

#include "step.hpp"

namespace drape {

namespace {

template <class Stepper>
Step by(const Cloth& cloth) {
    return [stepper = std::make_shared<Stepper>(cloth)](State& state, double h, taut::Index count) {
        return stepper->step(state, h, count);
    };
}

/// What the guard asks of a stepper.
template <taut::Method like>
struct StepLike {
    static constexpr taut::Method method = like;
    taut::Report step(State& state, double h, taut::Index count) { return take(state, h, count); }
    Step take;
};

template <taut::Method like>
Guard guarded(const Cloth& cloth, const Step& step, double max_step) {
    using Guarded = taut::Guarded<StepLike<like>, Cloth>;
    typename Guarded::Options options;
    options.max_step = max_step;
    options.max_substeps = std::numeric_limits<taut::Index>::max();  // a frame is never cut short
    const auto stepper = std::make_shared<StepLike<like>>(StepLike<like>{step});
    const auto guard = std::make_shared<Guarded>(cloth, *stepper, options);
    return
        [stepper, guard](State& state, double frame, const std::function<void(State&)>& respond) {
            return respond ? guard->advance(state, frame, respond) : guard->advance(state, frame);
        };
}

}  // namespace

Step explicit_step(const Cloth& cloth, const std::string& integrator) {
    if (integrator == "energy_stable") return by<taut::EnergyStableEuler<Cloth>>(cloth);
    if (integrator == "symplectic") return by<taut::SymplecticEuler<Cloth>>(cloth);
    if (integrator == "verlet") return by<taut::VelocityVerlet<Cloth>>(cloth);
    return by<taut::ExplicitEuler<Cloth>>(cloth);
}

Guard guarded(const Cloth& cloth, const Step& step, taut::Method like, double max_step) {
    using taut::Method;
    if (like == Method::implicit_euler) {
        return guarded<Method::implicit_euler>(cloth, step, max_step);
    }
    if (like == Method::energy_stable_euler) {
        return guarded<Method::energy_stable_euler>(cloth, step, max_step);
    }
    return guarded<Method::symplectic_euler>(cloth, step, max_step);
}

}  // namespace drape
