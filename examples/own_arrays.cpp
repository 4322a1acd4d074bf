// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// An engine's own arrays, judged in one call: is its step safe, how many substeps, which springs?

#include <cstdio>
#include <taut/arrays/arrays.hpp>
#include <vector>

struct Body {
    float x, y, z, inverse_mass;
};

int main() {
    // What the engine has: a rope of 20 bodies, the first one held, one link stiffer.
    std::vector<Body> bodies;
    std::vector<int> links;
    std::vector<float> stiffness;
    for (int i = 0; i < 20; ++i) bodies.push_back({0.1f * float(i), 0, 0, i == 0 ? 0.f : 50.f});
    for (int i = 0; i < 19; ++i) {
        links.insert(links.end(), {i, i + 1});
        stiffness.push_back(i == 12 ? 4000.f : 800.f);
    }

    taut::SpringArrays<float> rope;
    rope.particles = int(bodies.size());
    rope.springs = int(stiffness.size());
    rope.inverse_mass = {&bodies[0].inverse_mass, sizeof(Body)};
    rope.ends = links;
    rope.stiffness = stiffness;
    rope.damping = 0.05f;           // N·s/m, of every spring
    rope.velocity_factor = 0.999f;  // x += 0.999·(x − x_before) + h²a
    const auto check = taut::check_step(rope, taut::Method::position_verlet, 1.0 / 240, {1.0 / 60});
    std::printf("1/240 s is %ssafe at any pose: %.4g s is proved; take %d substeps a frame\n",
                check.safe ? "" : "not ", double(check.limit.certified), int(check.substeps));
    for (const auto& [index, a, b, share] : check.to_blame) {
        std::printf("  spring %d, from %d to %d: %.0f %%\n", int(index), int(a), int(b),
                    100 * share);
    }
}
