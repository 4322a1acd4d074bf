// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What a game pays, in float on one core: a step alone beside steps taken together, a frame of
// Guarded with everything in it, and thirty capes. Prints Markdown; the times are the least of
// several runs, of the processor.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <taut/guard/guard.hpp>
#include <taut/network/tension_only.hpp>
#include <taut/scene/with_law.hpp>
#include <taut/taut.hpp>
#include <taut/tight/tight.hpp>
#include <vector>

#include "measure.hpp"

namespace {

using taut::Index;

constexpr float frame = 1.0f / 60;  // s
constexpr int runs = 7;

taut::SpringSystem<float, 3> square(Index side) {
    taut::ClothOptions options;
    options.rows = options.columns = side;
    return taut::hanging_cloth<float>(options);
}

template <class Cloth>
void step_row(const char* law, Index side, const Cloth& cloth) {
    const float h = 0.5f * taut::any_pose_limit(cloth).certified;
    const Index steps = 4000000 / cloth.spring_count();
    taut::SymplecticEuler<Cloth> stepper(cloth);
    auto state = cloth.initial_state();
    bool ok = true;
    bench::Stopwatch together(bench::thread_time), alone(bench::thread_time);
    for (int run = 0; run < runs; ++run) {
        together.run([&] { ok &= bool(stepper.step(state, h, steps)); });
        alone.run([&] {
            for (Index i = 0; i < steps; ++i) ok &= bool(stepper.step(state, h));
        });
    }
    if (!ok) std::abort();
    const double springs = 1e-6 * static_cast<double>(steps * cloth.spring_count());  // to ns
    std::printf("| %s, %d × %d | %.2f | %.2f | %.2f |\n", law, int(side), int(side),
                together.times().least / springs, alone.times().least / springs,
                alone.times().least / together.times().least);
}

void step_table() {
    std::printf(
        "## A step of SymplecticEuler, float\n\n"
        "| cloth | together, ns a spring | alone, ns a spring | ratio |\n|---|---|---|---|\n");
    for (const Index side : {16, 32, 64, 100}) {
        const auto cloth = square(side);
        step_row("Hookean", side, cloth);
        step_row("tension-only", side, taut::with_law<taut::TensionOnly>(cloth));
    }
}

void frame_row(Index side, bool narrow) {
    const auto cloth = square(side);
    taut::Guarded guard(cloth);
    bench::Stopwatch asked(bench::thread_time), frames(bench::thread_time);
    if (narrow) {
        asked.run([&] {
            guard.set_limits(taut::any_pose_limit(cloth, 0.01), taut::energy_limit(cloth, 0.01));
        });
    }
    auto state = cloth.initial_state();
    Index substeps = 0;
    for (int i = 0; i < 60; ++i) {
        frames.run([&] {
            const auto report = guard.advance(state, frame);
            if (!report) std::abort();
            substeps = report.substeps;
        });
    }
    std::printf("| %d × %d, %s | %d | %.2f | %.2f | %.1f |\n", int(side), int(side),
                narrow ? "limits with a tightness of 0.01" : "limits as they come", int(substeps),
                frames.times().least, frames.times().median, asked.times().least);
}

void frame_table() {
    std::printf(
        "\n## A frame of Guarded, 1/60 s: hanging_cloth<float>, let go\n\n"
        "| cloth | substeps | least, ms | median, ms | asked once, ms |\n|---|---|---|---|---|\n");
    for (const Index side : {64, 100}) {
        frame_row(side, false);
        frame_row(side, true);
    }
}

using Cape = taut::SpringSystem<float, 3, taut::TensionOnly, taut::Hookean>;

/// 0.6 m × 0.9 m, 0.4 kg, by its upper corners, particles 0 and 15.
Cape cape() {
    constexpr int rows = 20, columns = 16;
    Cape cape;
    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < columns; ++c) {
            cape.add_particle({0.6f * float(c) / (columns - 1), 0, -0.9f * float(r) / (rows - 1)},
                              0.4f / (rows * columns));
        }
    }
    const auto join = [&](int r, int c, int down, int across) {
        const int s = r + down, d = c + across;
        if (s >= rows || d < 0 || d >= columns) return;
        const Index a = r * columns + c, b = s * columns + d;
        if (down == 2 || across == 2) {
            cape.add_spring<taut::Hookean>(a, b, {5.0f}, 0.0f);
        } else {
            cape.add_spring<taut::TensionOnly>(a, b, {500.0f}, 0.0f);
        }
    };
    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < columns; ++c) {
            for (const auto& [down, across] :
                 {std::pair{0, 1}, {1, 0}, {1, 1}, {1, -1}, {0, 2}, {2, 0}}) {
                join(r, c, down, across);
            }
        }
    }
    cape.pin(0);
    cape.pin(columns - 1);
    cape.set_gravity({0, 0, -9.81f});
    return cape;
}

struct Wearer {
    Cape cape = ::cape();
    Cape::State state = cape.initial_state();
    taut::Guarded<taut::VelocityVerlet<Cape>> guard{cape};
};

void capes() {
    std::vector<std::unique_ptr<Wearer>> crowd;
    for (int i = 0; i < 30; ++i) crowd.push_back(std::make_unique<Wearer>());
    bench::Stopwatch frames(bench::thread_time);
    Index substeps = 0, trimmed = 0, again = 0;
    constexpr int count = 120;
    for (int f = 0; f < count; ++f) {
        frames.run([&] {
            for (std::size_t i = 0; i < crowd.size(); ++i) {
                auto& [cape, state, guard] = *crowd[i];
                const float speed = 1.5f * std::cos(6.28f * float(f) / 60 + float(i));
                for (const Index corner : {0, 15}) {
                    state.v.col(corner) = Eigen::Vector3f(speed, 0.3f * speed, 0);
                }
                const auto report = guard.advance(state, frame);
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

int main() {
    step_table();
    frame_table();
    capes();
}
