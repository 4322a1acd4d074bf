// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What contact costs: steps of EnergyStableEuler of a cloth that lies on a row of 14 capsules,
// beside the same steps without bodies, in turns; in float, processor time. And what a fast ball
// leaves before it. The same of cloth on cloth. Prints Markdown.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <random>
#include <string>
#include <taut/contact/self_contact.hpp>
#include <taut/network/tension_only.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/scene/with_law.hpp>
#include <taut/taut.hpp>

#include "measure.hpp"
#include "nearest.hpp"

namespace {

using taut::Index;
using Cloth = taut::SpringSystem<float, 3, taut::TensionOnly>;
constexpr int capsules = 14;
constexpr float frame = 1.0f / 60;  // s

struct Compared {
    std::string cells;
    double touching;  // pairs, after a frame
};
/// Frames of `count` steps of h, s, without contact and with it.
/// @param lies  whether it has half a second to come to rest first
template <class Contact>
Compared compare(const Cloth& cloth, taut::State<float, 3>& state, float h, Index count,
                 Contact& contact, bool lies) {
    taut::EnergyStableEuler<Cloth> stepper(cloth), alone(cloth);
    bool ok = true;
    Index touching = 0;
    const auto with = [&] { ok = bool(step_through(stepper, state, h, count, contact)) && ok; };
    for (int f = 0; f < 30 && lies; ++f) with();
    auto free = state;
    bench::Turns both;
    both.run(
        21, [&] { ok = bool(alone.step(free, h, count)) && ok; },
        [&] {
            with();
            touching += contact.touching();
        });
    return {both.cells() + (ok ? "" : " A STEP FAILED"), double(touching) / 22};
}

/// @param below   of the capsules' tops, m   @param spread  between their axes, m
/// @param upper   capsules in the middle; the others are 1 m below
void row(const char* label, float below, float spread, int upper) {
    taut::ClothOptions options{64, 64};
    options.pin_corners = false;
    options.rayleigh = {5, 2e-5};
    const Cloth cloth = taut::with_law<taut::TensionOnly>(taut::hanging_cloth<float>(options));
    taut::Contacts contacts(cloth);
    taut::BodyOptions body;
    body.friction = 0.5;
    body.thickness = 0.005;
    const float radius = 0.035f;  // m
    for (int i = 0; i < capsules; ++i) {
        const float x = 0.5f + spread * (float(i) - 0.5f * float(capsules - 1));
        const bool is_upper = std::abs(2 * i - capsules + 1) <= upper;
        const float z = -radius - 0.005f - below - (is_upper ? 0.0f : 1.0f);
        contacts.add(taut::Capsule<float, 3>({x, -0.1f, z}, {x, 1.1f, z}, radius), body);
    }
    const float limit = taut::energy_limit(cloth).certified;
    const Index count = Index(frame / limit) + 1;
    const float h = frame / float(count);
    auto state = cloth.initial_state();
    if (below > 0.5f) state.v.row(0).setConstant(1);  // falls, and meets nothing meanwhile
    const Compared found = compare(cloth, state, h, count, contacts, below < 0.5f);
    std::printf("| %s | %.1f %% | %s |\n", label, 100 * found.touching / double(cloth.size()),
                found.cells.c_str());
    std::fflush(stdout);
}

/// Steps with cloth on cloth: a cloth that swings, or one folded, its upper half lying on the lower
/// one, which is pinned.
void layers(const char* label, bool folded) {
    constexpr Index side = 64;
    taut::ClothOptions options{side, side};
    options.rayleigh = {folded ? 5.0 : 1.0, 2e-5};
    Cloth cloth = taut::with_law<taut::TensionOnly>(taut::hanging_cloth<float>(options));
    if (folded) cloth.set_gravity({0, 0, -9.81f});
    auto state = cloth.initial_state();
    for (Index i = 0; folded && i < cloth.size(); ++i) {
        if (i % side < side / 2) {
            cloth.pin(i);
        } else {
            state.x(0, i) = 1 - state.x(0, i);
            state.x(2, i) = 1.0f / (side - 1);
            cloth.unpin(i);
        }
    }
    taut::SelfContact contact(cloth);
    const Index count = Index(frame / (0.9f * taut::energy_limit(cloth).certified)) + 1;
    const float h = frame / float(count);
    const Compared found = compare(cloth, state, h, count, contact, folded);
    std::printf("| %s | %d | %.0f | %s |\n", label, int(count), found.touching,
                found.cells.c_str());
    std::fflush(stdout);
}

/// A ball of 5 cm at 20 m/s through a cloth of n × n that is held at its four corners, step by
/// step.
void balls(Index n) {
    constexpr float radius = 0.05f, speed = 20;  // m, m/s
    constexpr int aims = 1000;
    taut::ClothOptions options{n, n};
    Cloth cloth = taut::with_law<taut::TensionOnly>(taut::hanging_cloth<float>(options));
    for (const Index corner : {n * (n - 1), n * n - 1}) cloth.pin(corner);
    cloth.set_rayleigh({1, 2e-5});
    const float h = taut::energy_limit(cloth).certified;
    const auto start = cloth.initial_state();
    std::mt19937 random(1);
    std::uniform_real_distribution<float> aside(-0.15f, 0.15f);
    Index passed = 0;
    float deepest = 0, cut = 0;
    for (int aim = 0; aim < aims; ++aim) {
        Eigen::Vector3f at =
            start.x.rowwise().mean() + Eigen::Vector3f(aside(random), aside(random), 0);
        at.z() -= 0.06f;
        taut::Contacts contacts(cloth);
        taut::Pose<float, 3> pose{at, Eigen::Matrix3f::Identity()};
        const Index ball = contacts.add(taut::Sphere<float, 3>({0, 0, 0}, radius), {}, pose);
        taut::EnergyStableEuler<Cloth> stepper(cloth);
        auto state = start;
        for (float way = 0; way < 0.3f; way += speed * h) {
            const auto before = state.x;
            const Eigen::Vector3f was = pose.position;
            pose.position.z() += speed * h;
            contacts.move_to(ball, pose);
            if (!step_through(stepper, state, h, 1, contacts)) std::exit(1);
            deepest = std::max(deepest, contacts.deepest());
            for (Index i = 0; i < cloth.size(); ++i) {
                const float in =
                    radius - bench::nearest(before.col(i) - was, state.x.col(i) - pose.position);
                cut = std::max(cut, in);
                passed += in > radius / 2;
            }
        }
    }
    std::printf("| %d × %d | %d | %.2f | %d | %.3f | %.3f |\n", int(n), int(n), aims,
                1e3 * double(speed * h), int(passed), 1e3 * double(deepest), 1e3 * double(cut));
    std::fflush(stdout);
}

}  // namespace

int main() try {
    std::printf(
        "## A frame of EnergyStableEuler with 14 capsules beside one without, ms\n\n"
        "Cloth of 64 × 64, tension-only, float; processor time, least of 21 turns (median).\n\n"
        "| the capsules | touching | without | with | ratio |\n"
        "|---|---|---|---|---|\n");
    row("0.8 m below", 0.8f, 0.072f, capsules);
    row("two of them 14 cm apart, the others 1 m below", 0, 0.14f, 2);
    row("four of them", 0, 0.14f, 4);
    row("all 14 cm apart", 0, 0.14f, capsules);
    row("all side by side", 0, 0.0705f, capsules);
    std::printf(
        "\n## The same with cloth on cloth beside one without, ms\n\n"
        "| the cloth | steps | pairs that touch | without | with | ratio |\n"
        "|---|---|---|---|---|---|\n");
    layers("swings, nothing near", false);
    layers("one half lies on the other", true);
    std::printf(
        "\n## A ball of 5 cm radius at 20 m/s through a held cloth of 1 m\n\n"
        "| particles | aims | a step's way, mm | went through | deepest, mm | cut off on a way, mm "
        "|\n"
        "|---|---|---|---|---|---|\n");
    for (const Index n : {9, 32, 64}) balls(n);
} catch (const std::exception& error) {
    std::fprintf(stderr, "contact_table: %s\n", error.what());
    return 1;
}
