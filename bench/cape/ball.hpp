// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdio>
#include <random>
#include <string>
#include <taut/scene/cloth.hpp>
#include <taut/scene/with_law.hpp>
#include <vector>

#include "../nearest.hpp"
#include "bullet_on_bodies.hpp"
#include "frames.hpp"
#include "taut_wears.hpp"
#include "xpbd_on_bodies.hpp"

// A ball of 5 cm at 20 m/s through a cloth of 1 m, 64 × 64, that is held at its corners.

namespace bench {

using BallCloth = taut::SpringSystem<float, 3, taut::TensionOnly>;

inline BallCloth ball_cloth() {
    constexpr taut::Index n = 64;
    const taut::ClothOptions options{n, n};
    BallCloth cloth = taut::with_law<taut::TensionOnly>(taut::hanging_cloth<float>(options));
    for (const taut::Index corner : {n * (n - 1), n * n - 1}) cloth.pin(corner);
    cloth.set_rayleigh({1, 2e-5});
    return cloth;
}

/// Taut's proved step on bodies, step by step.
class TautSteps {
public:
    TautSteps(const BallCloth& cloth, const Round& ball, const Place& at, const Touch& touch,
              float h)
        : contacts_(cloth), stepper_(cloth), state_(cloth.initial_state()), h_(h) {
        taut::BodyOptions options;
        options.friction = double(touch.friction);
        options.thickness = double(touch.thickness);
        contacts_.add(taut::Sphere<float, 3>(ball.a, ball.radius), options, at);
    }
    void advance(const Places&, const Places& to) {
        contacts_.move_to(0, to[0]);
        if (!step_through(stepper_, state_, h_, 1, contacts_)) std::exit(1);
    }
    const taut::State<float, 3>& state() const { return state_; }

private:
    taut::Contacts<BallCloth> contacts_;
    taut::EnergyStableEuler<BallCloth> stepper_;
    taut::State<float, 3> state_;
    float h_;
};

/// @param h     of a step, s   @param make  make(ball, place, touch, h): what moves the cloth
template <class Make>
void ball_row(const std::string& name, const BallCloth& cloth, float h, Make&& make) {
    constexpr int aims = 200;
    constexpr float speed = 20;  // m/s
    const Round ball{Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(), 0.05f};
    const Eigen::Vector3f middle = cloth.initial_state().x.rowwise().mean();
    std::mt19937 random(1);
    std::uniform_real_distribution<float> aside(-0.15f, 0.15f);
    int passed = 0, pierced = 0;
    float deepest = 0;
    for (int aim = 0; aim < aims; ++aim) {
        Places from(1), to(1);
        from[0].position =
            middle + Eigen::Vector3f(aside(random), aside(random), -ball.radius - 0.01f);
        auto peer = make(ball, from[0], Touch{}, h);
        taut::Points<float, 3> before = cloth.initial_state().x;
        std::vector<bool> through(std::size_t(cloth.size()));
        for (float way = 0; way < 0.3f; way += speed * h) {
            to = from;
            to[0].position.z() += speed * h;
            peer.advance(from, to);
            const taut::Points<float, 3> x = peer.state().x.template cast<float>();
            for (taut::Index i = 0; i < cloth.size(); ++i) {
                const Eigen::Vector3f then = x.col(i) - to[0].position;
                const Eigen::Vector3f now = before.col(i) - from[0].position;
                if (nearest(now, then) < ball.radius / 2) through[std::size_t(i)] = true;
                deepest = std::max(deepest, ball.radius - then.norm());
            }
            before = x;
            from = to;
        }
        const auto count = std::count(through.begin(), through.end(), true);
        passed += int(count);
        pierced += count > 0;
    }
    std::printf("| %s | %.1f | %d | %d | %.2f |\n", name.c_str(), 1e3 * double(speed * h), passed,
                pierced, 1e3 * double(deepest));
    std::fflush(stdout);
}

inline void ball_table(const std::vector<taut::Index>& xpbd_steps,
                       const std::vector<BulletSettings>& bullet) {
    std::printf(
        "\n## A ball of 5 cm at 20 m/s through a held cloth of 1 m, 64 × 64, 200 aims\n\n"
        "Passed: particles whose way came within half of the radius of the ball's centre.\n\n"
        "| | the ball's way a step, mm | particles that passed | aims with one | deepest at a "
        "step's end, mm |\n|---|---|---|---|---|\n");
    const BallCloth cloth = ball_cloth();
    const Net net = net_of(cloth);
    ball_row("Taut, EnergyStableEuler and Contacts", cloth, taut::energy_limit(cloth).certified,
             [&](const Round& ball, const Place& at, const Touch& touch, float h) {
                 return TautSteps(cloth, ball, at, touch, h);
             });
    for (const taut::Index steps : xpbd_steps) {
        ball_row("XPBD, small steps: " + std::to_string(steps) + " a frame", cloth,
                 frame / float(steps),
                 [&](const Round& ball, const Place&, const Touch& touch, float h) {
                     return XpbdOnBodies(cloth, 1, {ball}, touch, h);
                 });
    }
    for (BulletSettings settings : bullet) {
        const std::string name = "Bullet soft body: " + settings.name();
        const float h = frame / float(settings.steps);
        settings.steps = 1;
        ball_row(name, cloth, h,
                 [&](const Round& ball, const Place& at, const Touch& touch, float seconds) {
                     return BulletOnBodies(net, settings, {ball}, {at}, touch, seconds);
                 });
    }
}

}  // namespace bench
