// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A soft cube of 0.3 m falls on a floor, bounces and comes to rest. Writes soft_cube00000.obj,
// soft_cube00001.obj and so on, 60 a second for three seconds; z is up.
//
// Method: taut::EnergyStableEuler, at the step of taut::energy_limit, with the floor inside every
// step. A blow presses springs far out of the pose for which other limits are proved. No such step
// gains energy at any pose, and what it takes from fast vibrations, rubber loses too.

#include <algorithm>
#include <cstdio>
#include <taut/contact/contact.hpp>
#include <taut/lattice/lattice.hpp>
#include <taut/mesh_files/mesh_files.hpp>
#include <taut/taut.hpp>

int main() {
    using taut::Index;
    const Index n = 7;  // particles along an edge
    taut::LatticeOptions options;
    options.particles = {n, n, n};
    options.spacing = 0.05;                      // m
    options.stiffness = options.diagonal = 300;  // N/m
    options.mass = 0.01;                         // kg of a particle
    auto cube = taut::lattice<double>(options);
    cube.set_gravity({0, 0, -9.81});
    cube.set_rayleigh({0, 1e-3});  // s

    auto state = cube.initial_state();
    const Eigen::AngleAxisd turn(0.4, Eigen::Vector3d(1, 4, 0).normalized());
    state.x = turn.toRotationMatrix() * state.x;
    state.x.row(2).array() += 0.3 - state.x.row(2).minCoeff();  // lowest corner 0.3 m up

    taut::MeshFaces squares;  // of the six sides, each spanned by the steps u and v of an index
    const Index stride[] = {1, n, n * n};
    for (int side = 0; side < 6; ++side) {
        const Index u = stride[(side + 1) % 3], v = stride[(side + 2) % 3];
        const Index corner = side < 3 ? 0 : stride[side % 3] * (n - 1);
        for (Index i = 0; i < (n - 1) * (n - 1); ++i) {
            const Index a = corner + i / (n - 1) * u + i % (n - 1) * v;
            if (side < 3) squares.push_back({a, a + v, a + v + u, a + u});
            if (side >= 3) squares.push_back({a, a + u, a + u + v, a + v});
        }
    }
    taut::ObjSequence files("soft_cube", squares);

    taut::Contacts contacts(cube);
    taut::BodyOptions floor;
    floor.friction = 0.5;
    contacts.add(taut::HalfSpace<double, 3>({0, 0, 0}, {0, 0, 1}), floor);
    taut::EnergyStableEuler stepper(cube);
    const int steps = int(1.0 / 60 / taut::energy_limit(cube).certified) + 1;  // a frame
    const double h = 1.0 / 60 / steps;
    double lowest = 1;  // m
    for (int frame = 0; frame < 600; ++frame) {
        if (frame < 180 && !files.write(state.x)) return 1;
        if (!taut::step_through(stepper, state, h, steps, contacts)) return 1;
        lowest = std::min(lowest, state.x.row(2).minCoeff());
    }
    std::printf("energy-stable Euler: %d steps of %.3f ms a frame\n", steps, 1e3 * h);
    std::printf("lowest %.2e m above the floor, at rest %.5f m high\n", lowest,
                state.x.row(2).maxCoeff());
}
