// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What Guarded costs beside bare velocity Verlet at the same step, and how often it trims: a second
// of a falling cloth, at rest and with its corners shaken. Prints Markdown. Argument: particles
// along an edge.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <taut/guard/guard.hpp>
#include <taut/taut.hpp>
#include <taut/network/tension_only.hpp>
#include <taut/scene/with_law.hpp>

#include "measure.hpp"

namespace {

using taut::Index;

constexpr double frame = 1.0 / 60;  // s
constexpr int frames = 60;

template <class Cloth>
void row(const char* name, const Cloth& cloth, bool shaken) {
    bench::Stopwatch guarded(bench::thread_time), bare(bench::thread_time);
    const auto shake = [&](auto& state, int i) {
        for (Index p = 0; shaken && p < cloth.size(); ++p) {
            if (cloth.is_pinned(p)) state.v(1, p) = std::cos(5.0 * i * frame);
        }
    };
    int trimmed = 0, again = 0;
    for (int repeat = 0; repeat < 5; ++repeat) {
        auto state = cloth.initial_state();
        taut::Guarded guard(cloth);
        const auto first = guard.advance(state, frame);
        trimmed = again = 0;
        guarded.run([&] {
            for (int i = 0; i < frames; ++i) {
                shake(state, i);
                const auto report = guard.advance(state, frame);
                trimmed += report.trimmed > 0;
                again += report.again > 0;
            }
        });
        state = cloth.initial_state();
        taut::VelocityVerlet<Cloth> verlet(cloth);
        if (!verlet.step(state, first.h, first.substeps)) std::abort();
        bare.run([&] {
            for (int i = 0; i < frames; ++i) {
                shake(state, i);
                if (!verlet.step(state, first.h, first.substeps)) break;
            }
        });
    }
    std::printf("| %s | %.1f | %.1f | %.3f | %d | %d |\n", name, guarded.times().least,
                bare.times().least, guarded.times().least / bare.times().least, trimmed, again);
}

}  // namespace

int main(int argc, char** argv) {
    taut::ClothOptions options;
    options.rows = options.columns = argc > 1 ? std::atoi(argv[1]) : 64;
    if (argc > 2 || options.rows < 2) {
        std::fprintf(stderr, "guard_costs [SIZE], particles along an edge, at least 2\n");
        return 2;
    }
    auto cloth = taut::hanging_cloth<double>(options);
    const auto strings = taut::with_law<taut::TensionOnly>(cloth);
    std::printf(
        "## hanging_cloth %d, %d frames of 1/60 s\n\n"
        "| scene | guard, ms | bare Verlet, ms | ratio | frames trimmed | taken again |\n"
        "|---|---|---|---|---|---|\n",
        static_cast<int>(options.rows), frames);
    row("Hookean, let go", cloth, false);
    row("tension-only, let go", strings, false);
    row("Hookean, corners shaken", cloth, true);
    row("tension-only, corners shaken", strings, true);
    cloth.set_external_force([](const auto& state, auto& force) { force -= 1e-4 * state.v; });
    row("Hookean, corners shaken, a force given as code", cloth, true);
}
