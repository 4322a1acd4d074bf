// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A cloth stepped at its proved step. docs/tutorial.md reads along.

#include <cstdio>
#include <taut/taut.hpp>

int main() {
    auto cloth = taut::hanging_cloth<float>({32, 32});  // 1 m × 1 m, 0.3 kg, two corners pinned
    auto state = cloth.initial_state();

    const auto limit = taut::any_pose_limit(cloth);
    const float frame = 1.0f / 60;
    const auto substeps = static_cast<int>(frame / (0.95f * limit.certified)) + 1;
    std::printf("%.2e s is proved: %d substeps a frame\n", double(limit.certified), substeps);

    taut::SymplecticEuler stepper(cloth);
    for (int i = 1; i <= 60; ++i) {
        if (!stepper.step(state, frame / float(substeps), substeps)) return 1;
        const double lowest = state.x.row(2).minCoeff();
        if (i % 20 == 0) std::printf("frame %d: lowest point at %.2f m\n", i, lowest);
    }
}
