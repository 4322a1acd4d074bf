// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <taut/integrator/energy_stable_euler.hpp>
#include <taut/resolution/coarsen.hpp>
#include <taut/resolution/resolution.hpp>

#include "lab.hpp"
#include "scene.hpp"

namespace {

using lab::Cloth;
using taut::Index;

constexpr Index samples = taut::ResolveOptions{}.samples;  // resolve() compares at the same

struct Run {
    taut::tradeoff_detail::Pace pace;
    Cloth::State state;
    std::optional<taut::EnergyStableEuler<Cloth>> stepper;
    Index taken = 0;
    bool failed = false;

    void begin(const Cloth& cloth, Cloth::State start, double duration) {
        pace = taut::tradeoff_detail::pace_of(cloth, duration, samples);
        state = std::move(start);
        stepper.emplace(cloth);
        taken = 0;
        failed = false;
    }
    void take(Index steps) {
        failed = failed || (steps > 0 && !stepper->step(state, pace.h, steps));
        taken += steps;
    }
};

struct Beside {
    Cloth cloth;  // as it was when the answer was found
    std::optional<taut::Coarsening<Cloth>> coarsening;
    Run fine, coarse;
    taut::Points<double, 3> seeds_at_start;
    bool stands = false;
    double apart = 0;
    taut::Points<float, 3> drawn;
};

Beside beside;

const Run& leader() { return beside.stands ? beside.coarse : beside.fine; }

/// As lifted, now. Between two steps of the coarser network it goes on as it went.
taut::Points<double, 3> lifted_now() {
    const Run& coarse = beside.coarse;
    const Run& first = leader();
    const double behind = static_cast<double>(first.taken) * first.pace.h -
                          static_cast<double>(coarse.taken) * coarse.pace.h;
    const taut::Points<double, 3> moved =
        coarse.state.x + behind * coarse.state.v - beside.seeds_at_start;
    return beside.cloth.initial_state().x + beside.coarsening->lifted(moved);
}

void compare() {
    if (beside.fine.failed || beside.coarse.failed) {
        beside.apart = std::numeric_limits<double>::infinity();
        return;
    }
    const auto x = beside.cloth.initial_state().x;
    const double size = (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).norm();
    const double apart =
        std::sqrt((beside.fine.state.x - lifted_now()).colwise().squaredNorm().mean());
    beside.apart = std::max(beside.apart, apart / size);
}

}  // namespace

void lab_beside_start(int particles, double duration, int fine) {
    beside.fine.stepper.reset();
    beside.coarse.stepper.reset();
    beside.cloth = lab::scene().cloth;
    beside.coarsening.emplace(taut::coarsen(beside.cloth, particles));
    beside.stands = fine == 0;
    const auto& coarsening = *beside.coarsening;
    const auto start = beside.cloth.initial_state();
    beside.fine.begin(beside.cloth, start, duration);
    beside.coarse.begin(coarsening.system, coarsening.restricted(start), duration);
    beside.seeds_at_start = beside.coarse.state.x;
    beside.apart = 0;
}

double lab_beside_step(int count) {
    const Index from_sample_to_sample = leader().pace.steps;
    const Index taken = leader().taken;
    const Index next =
        std::min(from_sample_to_sample * (taken / from_sample_to_sample + 1), taken + count);
    if (!beside.stands) beside.fine.take(next - taken);
    // Both have as many steps from sample to sample each time, so they meet at every sample.
    const Index coarse = next * beside.coarse.pace.steps / from_sample_to_sample;
    beside.coarse.take(coarse - beside.coarse.taken);
    if (!beside.stands && next % from_sample_to_sample == 0) compare();
    return static_cast<double>(next) * leader().pace.h;
}

double lab_beside_steps() { return static_cast<double>(samples * leader().pace.steps); }
double lab_beside_apart() { return beside.apart; }

const float* lab_beside_positions(int which) {
    if (which == 0)
        beside.drawn = beside.fine.state.x.cast<float>();
    else
        beside.drawn = lifted_now().cast<float>();
    return beside.drawn.data();
}

const int* lab_beside_seeds() { return beside.coarsening->seeds.data(); }
int lab_beside_seed_count() { return static_cast<int>(beside.coarsening->seeds.size()); }
