// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A figure of 14 capsules in a cape and a skirt stands for a second, walks, runs at 5 m/s and
// turns. Writes cape.obj, of all that is to be seen, and its motion, cape.pc2; z is up.
// Usage: cape [SECONDS]

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <taut/contact/contact.hpp>
#include <taut/guard/guard.hpp>
#include <taut/mesh_files/mesh_files.hpp>
#include <taut/network/tension_only.hpp>
#include <taut/taut.hpp>
#include <vector>

#include "common/garments.hpp"

namespace {

using Cloth = taut::SpringSystem<float, 3, taut::TensionOnly, taut::Hookean>;
using example::Figure;

constexpr float frame = 1.0f / 60;  // s
constexpr example::Garments garments{48, 64, 64, 20};
constexpr example::Fabric fabric{8.7e-5, 1000, 2};  // 0.25 kg/m²

}  // namespace

int main(int argc, char** argv) {
    const int frames = int(60 * (argc > 1 ? std::atof(argv[1]) : 4));
    Figure figure;
    const taut::Points<float, 3> x = example::lay_out(garments, figure);
    Cloth cloth;
    taut::MeshFaces faces;
    example::add_garments<taut::TensionOnly>(cloth, faces, garments, x, fabric);
    cloth.set_gravity({0, 0, -9.81f});
    cloth.set_rayleigh({1, 2e-5});  // the air, 1/s, and what the threads damp, s
    const auto pins = example::bone_pins(cloth, garments, x, figure);

    taut::BodyOptions options;
    options.friction = 0.3;
    options.thickness = 0.005;  // m, so that no face of 2 cm cuts a capsule
    taut::Contacts contacts(cloth);
    for (int i = 0; i < 14; ++i) contacts.add(Figure::capsule(i), options, figure.places[i]);
    example::add_faces(cloth.size(), faces);
    taut::Points<float, 3> seen(3, cloth.size() + example::figure_points);
    auto state = cloth.initial_state();
    taut::Guarded guard(cloth);
    int again = 0;  // frames
    taut::Pc2Writer motion("cape.pc2", seen.cols());
    std::vector<double> milliseconds;
    double deepest = -1;  // below the skin, m
    double work = 0;      // J
    const auto energy = double(cloth.energy(state));
    for (int f = 0; f <= frames; ++f) {
        // Where the skirt begins inside a thigh it is pushed out slowly.
        if (f > 6) deepest = std::max(deepest, double(example::depth(figure, cloth, state.x)));
        seen.leftCols(cloth.size()) = state.x;
        example::draw(figure, seen, cloth.size());
        if (f == 0 && !taut::write_obj("cape.obj", seen, faces)) return 1;
        if (!motion.write(seen)) return 1;
        if (f == frames) break;

        figure.advance(frame);
        const std::clock_t start = std::clock();
        for (int k = 0; k < 14; ++k) contacts.move_to(k, figure.places[k]);
        example::send(pins, figure, frame, state);
        const auto report = guard.advance(state, frame, contacts);
        if (!report) return std::puts(taut::describe(report.status)), 1;
        again += report.again > 0;
        milliseconds.push_back(1e3 * double(std::clock() - start) / CLOCKS_PER_SEC);
        work += contacts.work();
    }
    const double first = milliseconds.front();  // with the limits
    milliseconds.erase(milliseconds.begin());
    std::sort(milliseconds.begin(), milliseconds.end());
    std::printf("%d particles, %d springs, %d frames, %d of them taken again\n", int(cloth.size()),
                int(cloth.spring_count()), frames, again);
    std::printf("a frame: %.2f ms median, %.2f ms at most but for the first, %.2f ms\n",
                milliseconds[milliseconds.size() / 2], milliseconds.back(), first);
    std::printf("deepest at a frame's end: %.3f mm below the skin, %.3f mm into what is kept\n",
                1e3 * std::max(0.0, deepest), 1e3 * std::max(0.0, deepest + options.thickness));
    std::printf("what is near was looked up %d times\n", int(contacts.lookups()));
    std::printf("the cloth has %.2f J of %.2f J, the bodies did %.2f J of work\n",
                double(cloth.energy(state)), energy, work);
    return deepest < 1e-3 ? 0 : 1;
}
