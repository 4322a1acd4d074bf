// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A cloth in an engine's loop, on the engine's own vertices: ticks of 1/60 s out of frames of any
// length, a pin that is dragged away, gusts of wind, and springs that tear.

#include <cmath>
#include <cstdio>
#include <taut/guard/guard.hpp>
#include <taut/taut.hpp>
#include <vector>

#include "common/number.hpp"

namespace {

using Cloth = taut::SpringSystem<float, 3>;
using taut::Index;

/// What an engine keeps for each vertex; the library reads and writes the first six numbers.
struct Vertex {
    float position[3];  // m
    float velocity[3];  // m/s
    float uv[2];
};

constexpr int side = 24;
constexpr float tick = 1.0f / 60;  // s
constexpr float tears_at = 1.15f;  // of the rest length
constexpr float drag = 4;          // 1/s, of the air
constexpr Index hand = side - 1;   // the pin that is dragged

/// A gust blows for half of every two seconds.
Eigen::Vector3f wind(float time) {
    return {0, std::fmod(time, 2.0f) < 1 ? 6.0f : 0.0f, 0};  // m/s
}

/// Where the hand is at a time: it holds still for a second and then moves away at 1 m/s.
Eigen::Vector3f hand_at(float time, const Eigen::Vector3f& start) {
    return start + Eigen::Vector3f(std::fmin(std::fmax(time - 1, 0.0f), 1.5f), 0, 0);
}

float stretch(const Cloth& cloth, const taut::StateView<float, 3>& view, Index s) {
    const auto& set = cloth.springs();
    return (view.x.col(set.b[s]) - view.x.col(set.a[s])).norm() / set.rest_length[s];
}

}  // namespace

int main() {
    taut::ClothOptions options;
    options.rows = options.columns = side;
    Cloth cloth = taut::hanging_cloth<float>(options);  // its upper corners are pinned
    for (Index i = 4; i < hand; i += 4) cloth.pin(i);
    cloth.set_rayleigh({drag, 2e-4});

    std::vector<Vertex> vertices(side * side);
    constexpr Index stride = sizeof(Vertex) / sizeof(float);
    taut::StateView<float, 3> view(vertices[0].position, vertices[0].velocity,
                                   static_cast<Index>(vertices.size()), stride);
    view.copy_from(cloth.initial_state());
    const Eigen::Vector3f start = view.x.col(hand);

    taut::Guarded guard(cloth);
    const float first_limit = taut::any_pose_limit(cloth).certified;
    int ticks = 0, trimmed = 0, again = 0, cuts = 0;
    Index torn = 0, substeps = 0;
    float accumulator = 0;
    float longest = 0;  // of the springs that held
    for (int frame = 0; frame < 240; ++frame) {
        accumulator += frame % 3 == 0 ? 1.0f / 30 : 1.0f / 90;  // what the engine's clock would say
        for (; accumulator >= tick; accumulator -= tick, ++ticks) {
            // A pinned particle moves with the velocity that it is given.
            const Eigen::Vector3f target = hand_at(static_cast<float>(view.time) + tick, start);
            view.v.col(hand) = (target - view.x.col(hand)) / tick;
            // Damping that is declared slows the cloth in still air; this is what wind adds.
            const Eigen::Vector3f blow = drag * wind(static_cast<float>(view.time));
            for (Index i = 0; i < cloth.size(); ++i) {
                cloth.set_constant_force(i, cloth.mass(i) * blow);
            }

            const auto report = guard.advance(view, tick);
            if (!report) {
                std::printf("tick %d: %s, near particle %d\n", ticks, describe(report.status),
                            static_cast<int>(report.where));
                return 1;
            }
            substeps += report.substeps;
            trimmed += report.taken == taut::Taken::trimmed;
            again += report.taken == taut::Taken::again;

            // The revision moves on with every cut, and so the guard certifies its step anew.
            const Index cut =
                cloth.remove_springs([&](Index s) { return stretch(cloth, view, s) > tears_at; });
            torn += cut;
            cuts += cut > 0 ? 1 : 0;
            for (Index s = 0; s < cloth.spring_count(); ++s) {
                longest = std::fmax(longest, stretch(cloth, view, s));
            }
        }
    }

    const float off = (view.x.col(hand) - hand_at(static_cast<float>(view.time), start)).norm();
    std::printf("%d ticks, %.1f substeps each, %d trimmed and %d taken again\n", ticks,
                static_cast<double>(substeps) / ticks, trimmed, again);
    std::printf("%d springs torn in %d ticks, longest of the others %.2f of its rest length\n",
                static_cast<int>(torn), cuts, static_cast<double>(longest));
    std::printf("any-pose limit %s s before, %s s after\n",
                example::rounded_down(static_cast<double>(first_limit), 4).c_str(),
                example::rounded_down(static_cast<double>(guard.limit()->certified), 4).c_str());
    std::printf("hand within %.0e m of where it should be, highest %.2f m, lowest %.2f m\n",
                static_cast<double>(off), static_cast<double>(view.x.row(2).maxCoeff()),
                static_cast<double>(view.x.row(2).minCoeff()));
}
