// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "guard_scenes.hpp"

#include "guard_on.hpp"

namespace taut_test {

std::unique_ptr<AnyGuard> guarded(const Scene& scene, const taut::GuardedOptions<double>& options) {
    std::unique_ptr<AnyGuard> made;
    visit_system<Plain<double, 1>, Plain<float, 2>, AnyLaw<double, 3>, Strings<float, 3>>(
        scene, [&](const auto& system) {
            using System = std::decay_t<decltype(system)>;
            using Scalar = typename System::Scalar;
            made = std::make_unique<GuardOn<taut::VelocityVerlet<System>, System>>(
                system, taut::GuardedOptions<Scalar>{static_cast<Scalar>(options.max_step),
                                                     options.max_substeps});
        });
    return made;
}

Frames AnyGuard::advance_all(AnyState& state, int frames, const Respond& each) {
    Frames sum;
    for (int i = 0; i < frames; ++i) {
        const auto report = advance(state, frame);
        sum.work += report.work;
        sum.trimmed += report.trimmed > 0;
        sum.again += report.again > 0;
        sum.frozen += report.frozen > 0;
        sum.all_ok = sum.all_ok && report;
        if (each) each(state);
    }
    return sum;
}

Scene pair(const Eigen::Vector3d& other, double stiffness, double damping) {
    Scene scene(any3);
    scene.add_particle(Eigen::Vector3d::Zero(), 1);
    scene.add_particle(other, 1);
    scene.add_spring({0, 1, stiffness, 1, damping});
    return scene;
}

AnyState at_rest(Scene scene) {
    scene.set_rayleigh(20, 0);
    auto state = scene.initial_state();
    const double h = scene.energy_limit().certified;
    const auto stepper = scene.stepper(taut::Method::energy_stable_euler);
    if (!stepper->step(state, h, static_cast<Index>(20 / h))) throw std::runtime_error("at_rest");
    state.v.setZero();
    state.time = 0;
    return state;
}

}  // namespace taut_test
