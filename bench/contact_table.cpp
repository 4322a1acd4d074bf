// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What contact costs: steps of EnergyStableEuler of a cloth that lies on a row of 14 capsules,
// beside the same steps without bodies, in turns; in float, processor time. Prints Markdown.

#include <cstdio>
#include <exception>
#include <string>
#include <taut/contact/contacts.hpp>
#include <taut/network/tension_only.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/scene/with_law.hpp>
#include <taut/taut.hpp>

#include "measure.hpp"

namespace {

using taut::Index;
using Cloth = taut::SpringSystem<float, 3, taut::TensionOnly>;
constexpr int capsules = 14;
constexpr float frame = 1.0f / 60;  // s

/// @param below   of the capsules' tops, m   @param spread  between their axes, m
void row(const char* label, float below, float spread) {
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
        const float z = -radius - 0.005f - below;
        contacts.add(taut::Capsule<float, 3>({x, -0.1f, z}, {x, 1.1f, z}, radius), body);
    }
    const float limit = taut::energy_limit(cloth).certified;
    const Index count = Index(frame / limit) + 1;
    const float h = frame / float(count);
    taut::EnergyStableEuler<Cloth> stepper(cloth), alone(cloth);
    auto state = cloth.initial_state();
    if (below > 0.5f) state.v.row(0).setConstant(1);  // falls, and meets nothing meanwhile
    bool ok = true;
    Index touching = 0;
    const auto with = [&] { ok = bool(step_through(stepper, state, h, count, contacts)) && ok; };
    for (int f = 0; f < 30 && below < 0.5f; ++f) with();  // until it lies
    auto free = state;
    bench::Turns both;
    both.run(
        21, [&] { ok = bool(alone.step(free, h, count)) && ok; },
        [&] {
            with();
            touching += contacts.touching();
        });
    std::printf("| %s | %.1f %% | %s%s |\n", label,
                100 * double(touching) / 22 / double(cloth.size()), both.cells().c_str(),
                ok ? "" : " A STEP FAILED");
    std::fflush(stdout);
}

}  // namespace

int main() try {
    std::printf(
        "## A frame of EnergyStableEuler with 14 capsules beside one without, ms\n\n"
        "Cloth of 64 × 64, tension-only, float; processor time, least of 21 turns (median).\n\n"
        "| the capsules | touching | without | with | ratio |\n"
        "|---|---|---|---|---|\n");
    row("0.8 m below", 0.8f, 0.072f);
    row("14 cm apart", 0, 0.14f);
    row("side by side", 0, 0.0705f);
} catch (const std::exception& error) {
    std::fprintf(stderr, "contact_table: %s\n", error.what());
    return 1;
}
