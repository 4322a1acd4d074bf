// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The cloth that cloth.mjs gives to Jolt Physics, and Taut's frames of it, for WebAssembly.

#include <emscripten/emscripten.h>

#include <cmath>
#include <memory>
#include <taut/guard/guard.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/integrator/velocity_verlet.hpp>
#include <taut/scene/cloth.hpp>
#include <vector>

namespace {

constexpr float frame = 1.0f / 60;  // s

template <class Scalar>
using ClothOf = taut::SpringSystem<Scalar, 3>;
using Cloth = ClothOf<float>;

struct Scene {
    explicit Scene(taut::Index side)
        : cloth(taut::hanging_cloth<float>({side, side})),
          converged(taut::hanging_cloth<double>({side, side})) {}

    Cloth cloth;
    ClothOf<double> converged;
    taut::Guarded<taut::VelocityVerlet<Cloth>> guard{cloth};
    taut::SymplecticEuler<Cloth> bare{cloth};
    Cloth::State state = cloth.initial_state();
    taut::VelocityVerlet<ClothOf<double>> fine{converged};
    ClothOf<double>::State reference = converged.initial_state();
    int substeps = static_cast<int>(
        std::ceil(frame / (0.95f * taut::any_pose_limit(cloth).certified)));  // of bare frames
};

std::unique_ptr<Scene> scene;

}  // namespace

extern "C" {

EMSCRIPTEN_KEEPALIVE void open_cloth(int side) { scene = std::make_unique<Scene>(side); }
EMSCRIPTEN_KEEPALIVE int particles() { return static_cast<int>(scene->cloth.size()); }
EMSCRIPTEN_KEEPALIVE int springs() { return static_cast<int>(scene->cloth.spring_count()); }
EMSCRIPTEN_KEEPALIVE const int* first_ends() { return scene->cloth.springs().a.data(); }
EMSCRIPTEN_KEEPALIVE const int* second_ends() { return scene->cloth.springs().b.data(); }
EMSCRIPTEN_KEEPALIVE float rest_length(int s) {
    return scene->cloth.springs().rest_length[static_cast<std::size_t>(s)];
}
EMSCRIPTEN_KEEPALIVE float stiffness(int s) {
    return scene->cloth.springs().parameters[static_cast<std::size_t>(s)].stiffness;
}
EMSCRIPTEN_KEEPALIVE float inverse_mass(int i) { return scene->cloth.inverse_mass()[i]; }
EMSCRIPTEN_KEEPALIVE const float* positions() { return scene->state.x.data(); }

EMSCRIPTEN_KEEPALIVE void start() {
    scene->state = scene->cloth.initial_state();
    scene->reference = scene->converged.initial_state();
}
/// A frame of 1/60 s. @returns its steps, 0 if it failed
EMSCRIPTEN_KEEPALIVE int guarded_frame() {
    const auto report = scene->guard.advance(scene->state, frame);
    return report ? static_cast<int>(report.substeps) : 0;
}
EMSCRIPTEN_KEEPALIVE int bare_frame() {
    const float h = frame / static_cast<float>(scene->substeps);
    return scene->bare.step(scene->state, h, scene->substeps) ? scene->substeps : 0;
}
/// In double, in steps a tenth as long; its positions go where all others are.
EMSCRIPTEN_KEEPALIVE int reference_frame() {
    const int steps = 10 * scene->substeps;
    if (!scene->fine.step(scene->reference, 1.0 / 60 / steps, steps)) return 0;
    scene->state.x = scene->reference.x.cast<float>();
    return steps;
}
}
