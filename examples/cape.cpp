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
#include <taut/taut.hpp>
#include <vector>

#include "common/garment.hpp"

namespace {

using example::Figure, example::Garment;
using taut::Index;
using Vector = Eigen::Vector3f;
using Points = taut::Points<float, 3>;

constexpr float frame = 1.0f / 60;  // s

}  // namespace

int main(int argc, char** argv) {
    const int frames = int(60 * (argc > 1 ? std::atof(argv[1]) : 4));
    Figure figure;
    Garment garment(figure);
    const Garment::Cloth& cloth = garment.cloth;
    constexpr Index size = Garment::size;
    Points seen(3, size + example::figure_points);

    taut::BodyOptions options;
    options.friction = 0.3;
    options.thickness = 0.005;  // m, so that no face of 2 cm cuts a capsule
    taut::Contacts contacts(cloth);
    for (int i = 0; i < 14; ++i) contacts.add(Figure::capsule(i), options, figure.places[i]);
    example::add_faces(size, garment.faces);
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
        seen.leftCols(size) = state.x;
        example::draw(figure, seen, size);
        if (f == 0 && !taut::write_obj("cape.obj", seen, garment.faces)) return 1;
        if (!motion.write(seen)) return 1;
        if (f == frames) break;

        figure.advance(frame);
        const std::clock_t start = std::clock();
        for (int k = 0; k < 14; ++k) contacts.move_to(k, figure.places[k]);
        for (const Garment::Pin& pin : garment.pins) {
            const Vector to = figure.places[pin.bone](pin.at);
            state.v.col(pin.particle) = (to - state.x.col(pin.particle)) / frame;
        }
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
