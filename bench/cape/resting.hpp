// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdio>
#include <string>
#include <taut/contact/contact.hpp>
#include <taut/guard/guard.hpp>
#include <vector>

#include "../measure.hpp"
#include "bullet_on_bodies.hpp"
#include "frames.hpp"
#include "taut_wears.hpp"
#include "xpbd_on_bodies.hpp"

namespace bench {

/// A square cloth in the plane z = height, 0.25 kg/m², 500 N/m, a little off the axis.
inline Cloth flat_cloth(taut::Index n, float height) {
    Cloth cloth;
    for (taut::Index i = 0; i < n * n; ++i) {
        cloth.add_particle(
            {float(i % n) / float(n - 1) - 0.47f, float(i / n) / float(n - 1) - 0.52f, height},
            0.25f / float(n * n));
    }
    for (taut::Index i = 0; i < n * n; ++i) {
        const bool right = i % n + 1 < n, down = i / n + 1 < n;
        const auto pull = [&](taut::Index a, taut::Index b) {
            cloth.add_spring<taut::TensionOnly>(a, b, {500.0f});
        };
        if (right) pull(i, i + 1);
        if (down) pull(i, i + n);
        if (right && down) {
            pull(i, i + n + 1);
            pull(i + 1, i + n);
        }
        if (i % n + 2 < n) cloth.add_spring<taut::Hookean>(i, i + 2, {1.0f});
        if (i / n + 2 < n) cloth.add_spring<taut::Hookean>(i, i + 2 * n, {1.0f});
    }
    cloth.set_gravity({0, 0, -9.81f});
    cloth.set_rayleigh({1, 2e-5});
    return cloth;
}

constexpr float ball_radius = 0.3f;  // m
constexpr Touch ball_touch{0.005f, 0.5f};

/// @param advance  a frame   @param at  positions
template <class Advance, class At>
void resting_row(const std::string& name, const Cloth& cloth, Advance&& advance, At&& at) {
    constexpr int settled = 600, frames = 3600;
    taut::Points<float, 3> then = cloth.initial_state().x;
    float deepest = 0;
    for (int f = 0; f < frames; ++f) {
        advance();
        if (f + 1 == settled) then = at();
        if (f < settled) continue;
        const taut::Points<float, 3> x = at();
        deepest = std::max(deepest, ball_radius - x.colwise().norm().minCoeff());
    }
    const taut::Points<float, 3> x = at();
    std::vector<float> slid;
    for (taut::Index i = 0; i < cloth.size(); ++i) {
        constexpr float touches = ball_radius + ball_touch.thickness + 1e-4f;
        if (then.col(i).norm() < touches && x.col(i).norm() < touches)
            slid.push_back((x.col(i) - then.col(i)).norm());
    }
    std::sort(slid.begin(), slid.end());
    if (slid.empty()) {
        std::printf("| %s | 0 | it left the ball | | |\n", name.c_str());
    } else {
        std::printf("| %s | %d | %.3f | %.3f | %.3f |\n", name.c_str(), int(slid.size()),
                    1e3 * double(slid.back()), 1e3 * double(slid[slid.size() / 2]),
                    1e3 * std::max(0.0, double(deepest)));
    }
    std::fflush(stdout);
}

inline void resting_table(const std::vector<taut::Index>& xpbd_steps,
                          const std::vector<BulletSettings>& bullet) {
    std::printf(
        "\n## A cloth at rest on a ball of 30 cm, 33 × 33, friction 0.5: how far it slides from 10 "
        "s to 60 s\n\n"
        "Touching: particles within 0.1 mm of what is kept, at 10 s and at 60 s; it is these that "
        "are "
        "followed.\n\n"
        "| | touching | slides, mm: largest | median | deepest, mm below the skin |\n"
        "|---|---|---|---|---|\n");
    const Cloth cloth = flat_cloth(33, 0.31f);
    const Net net = net_of(cloth);
    const std::vector<Round> ball{{Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(), ball_radius}};
    const Places here(1);
    TautWears taut(cloth, ball, here, ball_touch);
    resting_row(
        "Taut, Guarded and Contacts", cloth,
        [&] {
            if (!taut.advance(here)) std::exit(1);
        },
        [&]() -> const auto& { return taut.state().x; });
    for (const taut::Index steps : xpbd_steps) {
        XpbdOnBodies xpbd(cloth, steps, ball, ball_touch);
        resting_row(
            "XPBD, small steps: " + std::to_string(steps), cloth,
            [&] { xpbd.advance(here, here); }, [&]() -> const auto& { return xpbd.state().x; });
    }
    for (const BulletSettings& settings : bullet) {
        BulletOnBodies peer(net, settings, ball, here, ball_touch);
        resting_row(
            "Bullet soft body: " + settings.name(), cloth, [&] { peer.advance(here, here); },
            [&] { return taut::Points<float, 3>(peer.state().x.cast<float>()); });
    }
    std::printf("\nTaut: %d of %d frames taken again.\n", taut.again(), taut.frames());
}

/// A cloth that lies on the ground, beside one that falls.
inline void many_contacts() {
    const Cloth cloth = flat_cloth(104, 0.006f);
    taut::Contacts contacts(cloth);
    taut::BodyOptions options;
    options.friction = 0.3;
    options.thickness = 0.005;
    contacts.add(taut::HalfSpace<float, 3>({0, 0, 0}, {0, 0, 1}), options);
    taut::Guarded lying(cloth), falling(cloth);
    auto state = cloth.initial_state(), free = state;
    bool ok = true;
    const auto with = [&] { ok = bool(lying.advance(state, frame, contacts)) && ok; };
    const auto without = [&] { ok = bool(falling.advance(free, frame)) && ok; };
    for (int f = 0; f < 60; ++f) with();
    Turns turns;
    taut::Index least = cloth.size();
    turns.run(60, without, [&] {
        with();
        least = std::min(least, contacts.touching());
    });
    std::printf(
        "\n## Many contacts at once\n\nA cloth of %d × %d lies on the ground: at least %d of its "
        "%d particles touch in every frame. A frame\nof Guarded:\n\n"
        "| falls freely, ms | lies, ms: least (median) | ratio |\n|---|---|---|\n| %s |\n%s",
        104, 104, int(least), int(cloth.size()), turns.cells().c_str(),
        ok ? "" : "\nA FRAME WAS REFUSED.\n");
}

}  // namespace bench
