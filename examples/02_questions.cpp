// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// One answer for each question that a time step raises; docs/questions.md reads along.

#include <cstdio>
#include <taut/mass_scaling/mass_scaling.hpp>
#include <taut/taut.hpp>
#include <taut/tight/tight.hpp>
#include <taut/proof/bracket.hpp>

using taut::Method;

int main() {
    taut::SpringSystem<double, 3> cloth = taut::hanging_cloth<double>({24, 24});
    cloth.add_spring(300, 301, 2e4);  // one stiff seam
    const auto state = cloth.initial_state();
    taut::Stability<double> stability(cloth, state);

    std::printf("How large may my step be?\n");
    const auto limit = taut::bracket(stability, Method::symplectic_euler);
    std::printf("  about %.5e s is proved stable, about %.5e s is not; set by %s\n",
                limit.certified, limit.refuted, name(limit.cause));

    std::printf("And to six digits?\n");
    const auto narrow = taut::max_step(stability, Method::symplectic_euler, 1e-6);
    std::printf("  about %.9e s is proved, about %.9e s is not\n", narrow.certified,
                narrow.refuted);

    std::printf("Is my step safe?\n");
    std::printf("  1e-4 s: %s\n", taut::certify(stability, Method::symplectic_euler, 1e-4).proved
                                      ? "proved"
                                      : "not proved");

    std::printf("How many substeps does a frame of 1/60 s need?\n");
    const auto substeps = taut::any_pose_limit(cloth).substeps(1.0 / 60);
    std::printf("  %d\n", substeps ? static_cast<int>(*substeps) : -1);

    std::printf("And while the cloth moves?\n");
    const auto moving = taut::any_pose_limit(cloth, 1e-6);
    std::printf("  about %.3e s, at any pose\n", moving.certified);

    std::printf("And so that it never gains energy?\n");
    const auto stable = taut::energy_limit(cloth, 1e-6);
    std::printf("  about %.3e s, by EnergyStableEuler\n", stable.certified);

    std::printf("What limits the step?\n");
    for (const auto& spring : taut::limiting_springs(stability, 1)) {
        std::printf("  spring %d between particles %d and %d: %.0f %% of the limiting mode\n",
                    static_cast<int>(spring.index), static_cast<int>(spring.a),
                    static_cast<int>(spring.b), 100 * spring.share);
    }

    std::printf("What would make 4e-4 s safe?\n");
    const double h = 4e-4;
    std::printf("  all stiffness times about %.3f, or all masses times about %.3f,\n",
                stability.max_stiffness_scale(Method::symplectic_euler, h),
                stability.min_mass_scale(Method::symplectic_euler, h));
    const auto added = taut::added_mass(cloth, state, h);
    std::printf("  or about %.2e kg on a few particles; the lowest frequency changes by %.2g %%\n",
                added.total, 100 * added.frequency_change[0]);

    std::printf("Which damping does explicit Euler need at 5e-5 s?\n");
    const auto window = stability.rayleigh_window(Method::explicit_euler, 5e-5);
    std::printf("  alpha in about (%.2e, %.2e) s\n", window.lower, window.upper);

    std::printf("How much is that of critical damping?\n");
    std::printf("  a ratio of %.5f at 10 rad/s\n", taut::damping_ratio({0, window.lower}, 10));

    std::printf("May I keep the step when the scene changes?\n");
    cloth.unpin(0);
    std::printf("  %s\n", limit.step_for(cloth, 0.95) ? "yes" : "no: ask again");
    stability = taut::Stability<double>(cloth, state);
    const auto renewed = stability.max_step(Method::symplectic_euler).step_for(cloth, 0.95);
    std::printf("  now about %.3e s\n", renewed.value_or(0));
}
