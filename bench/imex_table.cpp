// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A cloth let go with a hem 1000 times as stiff: ImexEuler at the cloth's step beside
// EnergyStableEuler at the hem's, half a second each. Prints Markdown. Argument: particles along an
// edge.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <taut/imex/imex.hpp>
#include <taut/taut.hpp>

#include "../examples/common/number.hpp"
#include "measure.hpp"

namespace {

using Cloth = taut::SpringSystem<double, 3>;
using taut::Index;

constexpr double duration = 0.5;  // s

Cloth hemmed(Index side, double times) {
    taut::ClothOptions options;
    options.rows = options.columns = side;
    Cloth cloth = taut::hanging_cloth<double>(options);
    Index first = 0;  // of the row without pins
    for (Index i = 0; i < side; ++i) first = cloth.is_pinned(i) ? cloth.size() - side : first;
    Index index = 0;
    const auto& set = cloth.springs();
    for (; index < cloth.spring_count(); ++index) {
        const auto s = static_cast<std::size_t>(index);
        const auto in_hem = [&](Index i) { return i >= first && i < first + side; };
        if (!in_hem(set.a[s]) || !in_hem(set.b[s])) continue;
        cloth.set_stiffness(index, times * set.parameters[s].stiffness);
    }
    return cloth;
}

struct Run {
    Cloth::State end;
    double time = 0;  // ms
    double energy = 0;
};

template <class Stepper>
Run run(const Cloth& cloth, Stepper&& stepper, double longest) {
    const auto count = static_cast<Index>(std::ceil(duration / longest));
    Run result;
    bench::Stopwatch watch(bench::thread_time);
    for (int repeat = 0; repeat < 3; ++repeat) {
        result.end = cloth.initial_state();
        watch.run([&] {
            if (!stepper.step(result.end, duration / static_cast<double>(count), count))
                std::abort();
        });
    }
    result.time = watch.times().least;
    result.energy = cloth.energy(result.end) - cloth.energy(cloth.initial_state());
    return result;
}

void row(const char* name, double h, const Run& run, const Run& reference, const Run& explicitly) {
    const double off = (run.end.x - reference.end.x).colwise().norm().maxCoeff();
    std::printf("| %s | %s | %.1f | %.3f | %.1f | %+.4f |\n", name,
                example::rounded_down(h, 3).c_str(), run.time, run.time / explicitly.time,
                1e3 * off, run.energy);
}

}  // namespace

int main(int argc, char** argv) {
    const Index side = argc > 1 ? std::atoi(argv[1]) : 48;
    const Cloth cloth = hemmed(side, 1000);
    const double rest = taut::energy_limit(hemmed(side, 1)).certified;
    const double own = taut::energy_limit(cloth).certified;
    const double fine = 0.2 * taut::any_pose_limit(cloth).certified;
    const Run reference = run(cloth, taut::VelocityVerlet<Cloth>(cloth), fine);
    const Run stable = run(cloth, taut::EnergyStableEuler<Cloth>(cloth), own);
    std::printf(
        "## hanging_cloth %d, a hem 1000 times as stiff, half a second\n\n"
        "| step | h, s | ms, least of 3 | of explicit | off by at most, mm | energy, J |\n"
        "|---|---|---|---|---|---|\n",
        static_cast<int>(side));
    row("VelocityVerlet, fine", fine, reference, reference, stable);
    row("EnergyStableEuler", own, stable, reference, stable);
    for (const double share : {0.5, 0.8, 0.95}) {
        taut::ImexOptions options;
        options.step = share * rest;
        taut::ImexEuler<Cloth> stepper(cloth, options);
        const double h = stepper.limit().certified;
        char name[64];
        std::snprintf(name, sizeof name, "ImexEuler, %g of the cloth's, %d springs", share,
                      static_cast<int>(stepper.implicit_springs()));
        row(name, h, run(cloth, stepper, h), reference, stable);
    }
}
