// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A guard round a stepper takes back what no analysis foresaw. docs/systems/guard.md reads along.

#include <cstdio>
#include <taut/taut.hpp>

int main() {
    auto cloth = taut::hanging_cloth<double>({12, 12});
    const Eigen::Vector3d hook = cloth.initial_state().x.col(77);
    cloth.set_external_force([hook](const auto& state, auto& f) {
        f.col(77) += 4e5 * (hook - state.x.col(77));  // stiff, and unseen by the analysis
    });
    auto state = cloth.initial_state();

    using Stepper = taut::SymplecticEuler<decltype(cloth)>;
    taut::Guarded<Stepper> guard(cloth);
    for (int frame = 0; frame < 60; ++frame) {
        const auto report = guard.advance(state, 1.0 / 60);
        if (report.retries > 0 && frame < 3) {
            std::printf("frame %d: %d substeps after %d retries\n", frame,
                        static_cast<int>(report.substeps), report.retries);
        }
        if (!report) {
            std::printf("given up: particle %d, spring %d\n", static_cast<int>(report.where),
                        static_cast<int>(report.spring));
            return 1;
        }
    }
    std::printf("after 1 s the hooked particle is %.1e m off its hook\n",
                (state.x.col(77) - hook).norm());
}
