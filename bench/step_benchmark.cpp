// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Steps and answers about steps under Google Benchmark, for `--benchmark_format=json` and
// comparisons over commits. The argument is the size of the hanging cloth; an item is a step.

#include <benchmark/benchmark.h>
#include <taut/projective/projective.hpp>
#include <taut/solver/conjugate_gradient.hpp>
#include <taut/taut.hpp>

#include "plain_loop.hpp"

namespace {

using taut::Index;
template <class Scalar>
using Net = taut::SpringSystem<Scalar, 3>;
using Gradients = taut::ConjugateGradient<double, 3>;

constexpr Index explicit_count = 100;  // steps of a call
constexpr double frame = 1.0 / 60;     // s, an implicit step

template <class Scalar>
Net<Scalar> cloth(const benchmark::State& run) {
    return taut::hanging_cloth<Scalar>({run.range(0), run.range(0)});
}

template <class Scalar>
void symplectic_euler(benchmark::State& run) {
    const auto net = cloth<Scalar>(run);
    const Scalar h = Scalar(0.9) * taut::any_pose_limit(net).certified;
    taut::SymplecticEuler<Net<Scalar>> stepper(net);
    auto state = net.initial_state();
    for (auto _ : run) {
        if (!stepper.step(state, h, explicit_count)) {
            run.SkipWithError("diverged");
            break;
        }
    }
    run.SetItemsProcessed(run.iterations() * explicit_count);
}

template <class Scalar>
void plain_loop(benchmark::State& run) {
    const auto net = cloth<Scalar>(run);
    const Scalar h = Scalar(0.9) * taut::any_pose_limit(net).certified;
    bench::PlainLoop<Scalar> plain(net);
    for (auto _ : run) {
        for (Index i = 0; i < explicit_count; ++i) plain.step(h);
    }
    run.SetItemsProcessed(run.iterations() * explicit_count);
}

template <class Stepper>
void frame_step(benchmark::State& run) {
    const auto net = cloth<double>(run);
    Stepper stepper(net);
    auto state = net.initial_state();
    for (auto _ : run) {
        if (!stepper.step(state, frame)) {
            run.SkipWithError("the step failed");
            break;
        }
    }
    run.SetItemsProcessed(run.iterations());
}

void stability_bound(benchmark::State& run) {
    const auto net = cloth<double>(run);
    const auto state = net.initial_state();
    for (auto _ : run) {
        const taut::Stability<double> stability(net, state);
        auto limit = stability.max_step(taut::Method::symplectic_euler);
        benchmark::DoNotOptimize(limit);
    }
}

void any_pose_limit(benchmark::State& run) {
    const auto net = cloth<double>(run);
    for (auto _ : run) {
        auto limit = taut::any_pose_limit(net);
        benchmark::DoNotOptimize(limit);
    }
}

void sizes(benchmark::internal::Benchmark* of) {
    for (const int n : {32, 64, 100}) of->Arg(n);
    of->Unit(benchmark::kMillisecond);
}

BENCHMARK_TEMPLATE(symplectic_euler, double)->Apply(sizes);
BENCHMARK_TEMPLATE(symplectic_euler, float)->Apply(sizes);
BENCHMARK_TEMPLATE(plain_loop, double)->Apply(sizes);
BENCHMARK_TEMPLATE(plain_loop, float)->Apply(sizes);
BENCHMARK_TEMPLATE(frame_step, taut::ImplicitEuler<Net<double>, Gradients>)
    ->Name("implicit_euler<ConjugateGradient>")
    ->Apply(sizes);
BENCHMARK_TEMPLATE(frame_step, taut::ProjectiveDynamics<Net<double>>)
    ->Name("projective_dynamics")
    ->Apply(sizes);
BENCHMARK(stability_bound)->Apply(sizes);
BENCHMARK(any_pose_limit)->Apply(sizes);

}  // namespace

BENCHMARK_MAIN();
