// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What a game pays, in float on one core: a step alone beside steps taken together, a law that does
// not push beside Hooke's, a frame of Guarded beside one of bare steps, and thirty capes. Prints
// Markdown; no arguments.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <taut/between/between.hpp>
#include <taut/guard/guard.hpp>
#include <taut/network/buckling.hpp>
#include <taut/network/tension_only.hpp>
#include <taut/scene/with_law.hpp>
#include <taut/taut.hpp>
#include <taut/tight/tight.hpp>
#include <tuple>
#include <utility>
#include <vector>

#include "capes.hpp"
#include "measure.hpp"
#include "outcome.hpp"

namespace {

using taut::Index;
using Cloth = taut::SpringSystem<float, 3>;

constexpr float frame = 1.0f / 60;  // s
constexpr int turns = 15;

Cloth square(Index side) {
    taut::ClothOptions options;
    options.rows = options.columns = side;
    return taut::hanging_cloth<float>(options);
}

/// For turns of about 20 ms.
template <class System>
Index steps_for(const System& system) {
    return 40000000 / system.spring_count();
}

/// For times in ns a spring and step.
template <class System>
double updates(const System& system) {
    return 1e-6 * static_cast<double>(steps_for(system) * system.spring_count());
}

template <class System>
void step_row(const char* law, Index side, const System& cloth) {
    const float h = 0.5f * taut::any_pose_limit(cloth).certified;
    const Index steps = steps_for(cloth);
    taut::SymplecticEuler<System> stepper(cloth);
    auto state = cloth.initial_state();
    bool ok = true;
    const auto together = [&] { ok &= bool(stepper.step(state, h, steps)); };
    const auto alone = [&] {
        for (Index i = 0; i < steps; ++i) ok &= bool(stepper.step(state, h));
    };
    const auto between = [&] {
        Index calls = 0;
        ok &= bool(taut::step_between(stepper, state, h, steps, [&](auto&) { ++calls; }));
        ok &= calls == steps;
    };
    bench::Turns ways(updates(cloth));
    ways.run(turns, together, alone, between);
    if (!ok) std::abort();
    std::printf("| %d × %d, %s | %s | %s |\n", int(side), int(side), law, ways.cells().c_str(),
                ways.cells_beside(2).c_str());
}

void step_table() {
    std::printf(
        "## Steps of SymplecticEuler: n together; step(state, h) one at a time; step_between\n\n"
        "ns a spring and step.\n\n"
        "| cloth, law | n steps together | one at a time | ratio | with a call between | ratio |\n"
        "|---|---|---|---|---|---|\n");
    for (const Index side : {16, 32, 64, 100}) {
        const auto cloth = square(side);
        step_row("Hookean", side, cloth);
        step_row("tension-only", side, taut::with_law<taut::TensionOnly>(cloth));
    }
}

/// The springs of a cloth, which buckle: the law is its line for the first 3.6 % and then its arc.
auto buckling(const Cloth& cloth) {
    using Copy = taut::SpringSystem<float, 3, taut::Buckling>;
    return taut::with_springs<Copy>(cloth, [](Copy& copy, const auto& spring, Index) {
        const float k = spring.parameters.stiffness, length = spring.rest_length;
        copy.add_spring(taut::Spring<float, taut::Buckling>{
            spring.a, spring.b, {k, 0.003f * k * length * length * length, k}, length, 0});
    });
}

/// Steps of a system, its stepper beside it.
template <class System>
class Steps {
public:
    explicit Steps(System system) : system_(std::move(system)) {}

    void operator()() {
        auto state = system_.initial_state();  // what a spring costs may depend on its length
        if (!stepper_.step(state, h_, steps_for(system_))) std::abort();
    }

private:
    System system_;
    taut::SymplecticEuler<System> stepper_{system_};
    float h_ = 0.5f * taut::any_pose_limit(system_).certified;
};

void law_table() {
    std::printf(
        "\n## Laws that do not push, beside Hooke's: n steps of SymplecticEuler together\n\n"
        "ns a spring and step.\n\n"
        "| cloth | Hookean | TensionOnly | ratio | Buckling | ratio |\n"
        "|---|---|---|---|---|---|\n");
    for (const Index side : {16, 64, 100}) {
        const auto cloth = square(side);
        Steps hookean(cloth);
        Steps tension_only(taut::with_law<taut::TensionOnly>(cloth));
        Steps buckled(buckling(cloth));
        bench::Turns laws(updates(cloth));
        laws.run(turns, hookean, tension_only, buckled);
        std::printf("| %d × %d | %s | %s |\n", int(side), int(side), laws.cells().c_str(),
                    laws.cells_beside(2).c_str());
    }
}

/// One row of frames: by bare steps of velocity Verlet at the guard's own, by Guarded, and by
/// Guarded with a corner that moves.
void frame_rows(Index side, bool narrow) {
    const auto cloth = square(side);
    taut::Guarded guard(cloth), guard_of_moving(cloth);
    bench::Stopwatch asked(bench::thread_time);
    if (narrow) {
        const auto ask = [&](auto& of) {
            of.set_limits(taut::any_pose_limit(cloth, 0.01), taut::energy_limit(cloth, 0.01));
        };
        asked.run([&] { ask(guard); });
        ask(guard_of_moving);
    }
    taut::VelocityVerlet bare(cloth);
    auto state = cloth.initial_state(), moving = state, of_bare = state;
    const auto advance = [](auto& by, auto& with) {
        const auto report = by.advance(with, frame);
        if (!report) std::abort();
        return report;
    };
    const auto first = advance(guard, state);  // asks for its limits
    std::ignore = advance(guard_of_moving, moving);
    bench::Turns frames;
    Index trimmed = 0, again = 0;
    double stretch = 0;
    for (int i = 0; i < 60; ++i) {
        moving.v.col(0) = Eigen::Vector3f(0, std::cos(5 * float(i) * frame), 0);
        frames.turn(
            [&] {
                if (!bare.step(of_bare, first.h, first.substeps)) std::abort();
            },
            [&] { std::ignore = advance(guard, state); },
            [&] {
                const auto report = advance(guard_of_moving, moving);
                trimmed += report.trimmed > 0;
                again += report.again > 0;
            });
        stretch = std::max(stretch, bench::largest_stretch(cloth, state));
    }
    std::printf("| %d × %d, %s | %d | %s | %s | %d, %d | %.3f | ", int(side), int(side),
                narrow ? "with a tightness of 0.01" : "as they come", int(first.substeps),
                frames.cells().c_str(), frames.cells_beside(2, 1).c_str(), int(trimmed), int(again),
                stretch);
    narrow ? std::printf("%.1f |\n", asked.times().least) : std::printf("– |\n");
}

void frame_table() {
    std::printf(
        "\n## A frame of Guarded, 1/60 s, beside bare steps, and with a moving pin beside none\n\n"
        "ms. The cloth hangs by two corners and is let go; where a pin moves, one of them goes to "
        "and fro at\n1 m/s. Bare steps: VelocityVerlet, as many and as long as Guarded takes. "
        "Trimmed, again: how many of\nthe 60 frames with a moving pin. Widest: the largest l/L "
        "after any frame of Guarded.\n\n"
        "| cloth, limits | substeps | bare steps | Guarded | ratio | a pin moves | ratio to "
        "Guarded "
        "| trimmed, again | widest | limits asked once |\n"
        "|---|---|---|---|---|---|---|---|---|---|\n");
    for (const Index side : {64, 100}) {
        frame_rows(side, false);
        frame_rows(side, true);
    }
}

void capes() {
    std::vector<std::unique_ptr<bench::Wearer>> crowd;
    for (int i = 0; i < 30; ++i) crowd.push_back(std::make_unique<bench::Wearer>());
    bench::Stopwatch frames(bench::thread_time);
    Index substeps = 0, trimmed = 0, again = 0;
    constexpr int count = 120;
    for (int f = 0; f < count; ++f) {
        frames.run([&] {
            for (std::size_t i = 0; i < crowd.size(); ++i) {
                const auto report = crowd[i]->advance(f, float(i));
                if (!report) std::abort();
                substeps = report.substeps;
                trimmed += report.trimmed;
                again += report.again;
            }
        });
    }
    std::printf(
        "\n## 30 capes of 16 × 20 particles, tension-only, two moving corners each, Guarded, "
        "float\n\n"
        "A frame of 1/60 s for all of them: least %.2f ms, median %.2f ms; %d substeps; of %d "
        "frames of a cape %d were trimmed, %d taken again.\n",
        frames.times().least, frames.times().median, int(substeps), 30 * count, int(trimmed),
        int(again));
}

}  // namespace

int main(int argc, char**) {
    if (argc > 1) {
        std::fprintf(stderr, "frame_table takes no arguments\n");
        return 2;
    }
    std::printf("In float, on one thread; processor time, least of several turns (median).\n\n");
    step_table();
    law_table();
    frame_table();
    capes();
}
