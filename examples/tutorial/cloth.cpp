// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A cloth stepped by Taut's recipe. docs/tutorial.md reads along.

#include <cstdio>
#include <taut/taut.hpp>

int main() {
    auto cloth = taut::hanging_cloth<float>({32, 32});  // 1 m × 1 m, 0.3 kg, two corners pinned
    auto state = cloth.initial_state();

    const auto limit = taut::any_pose_limit(cloth);
    const float frame = 1.0f / 60;
    const auto h = static_cast<float>(taut::recipe.safety) * limit.certified;
    const auto substeps = static_cast<int>(frame / h) + 1;
    std::printf("%.2e s at any pose: %d substeps a frame\n", double(limit.certified), substeps);

    taut::SymplecticEuler stepper(cloth, {1, taut::recipe.damping});
    for (int i = 1; i <= 60; ++i) {
        if (!stepper.step(state, frame / float(substeps), substeps)) return 1;
        const double lowest = state.x.row(2).minCoeff();
        if (i % 20 == 0) std::printf("frame %d: lowest point at %.2f m\n", i, lowest);
    }
}
