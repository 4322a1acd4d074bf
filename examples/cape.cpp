// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A figure of 14 capsules in a cape and a skirt stands for a second, walks, runs at 5 m/s and
// turns. Writes cape.obj, of all that is to be seen, and its motion, cape.pc2; z is up.
// Usage: cape [SECONDS]

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <taut/contact/contact.hpp>
#include <taut/guard/guard.hpp>
#include <taut/mesh_files/mesh_files.hpp>
#include <taut/network/tension_only.hpp>
#include <taut/taut.hpp>
#include <vector>

#include "common/figure.hpp"

namespace {

using taut::Index;
using Cloth = taut::SpringSystem<float, 3, taut::TensionOnly, taut::Hookean>;
using example::Figure, example::pi, example::chest, example::pelvis;
using Vector = Eigen::Vector3f;
using Points = taut::Points<float, 3>;

constexpr float frame = 1.0f / 60;  // s
constexpr float mass = 8.7e-5f;     // kg, of a particle: 0.25 kg/m²

/// What moves with a bone.
struct Pin {
    Index particle;
    int bone;
    Vector at;  // in the bone's frame, m
};

/// How far the deepest particle is below the skin, m.
float depth(const Figure& figure, const Cloth& cloth, const Points& x) {
    float deepest = -1;
    for (Index i = 0; i < cloth.size(); ++i) {
        for (int k = 0; k < 14 && !cloth.is_pinned(i); ++k)
            deepest = std::max(
                deepest, -Figure::capsule(k).surface(figure.places[k].inside(x.col(i))).distance);
    }
    return deepest;
}

/// Adds a grid of particles at the next columns of x, row by row, its first row pinned.
void add_sheet(Cloth& cloth, taut::MeshFaces& faces, const Points& x, Index columns, Index rows,
               bool closed) {
    const Index first = cloth.size();
    for (Index i = first; i < first + columns * rows; ++i) {
        cloth.add_particle(x.col(i), mass);
        if (i < first + columns) cloth.pin(i);
    }
    for (Index i = 0; i < columns * rows; ++i) {
        const auto next = [&](Index right, Index down) {
            const Index column = i % columns + right, row = i / columns + down;
            const bool there = row < rows && (closed || (column >= 0 && column < columns));
            return there ? first + row * columns + (column + columns) % columns : -1;
        };
        const auto join = [&](Index a, Index b, auto law, float stiffness) {
            if (a >= 0 && b >= 0) cloth.add_spring<decltype(law)>(a, b, {stiffness});  // N/m
        };
        const Index here = first + i, right = next(1, 0), down = next(0, 1), across = next(1, 1);
        join(here, right, taut::TensionOnly(), 1000);
        join(here, down, taut::TensionOnly(), 1000);
        if (across >= 0) {
            join(here, across, taut::TensionOnly(), 1000);
            join(right, down, taut::TensionOnly(), 1000);
            faces.push_back({here, right, across, down});
        }
        join(here, next(2, 0), taut::Hookean(), 2);  // bending
        join(here, next(0, 2), taut::Hookean(), 2);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const int frames = int(60 * (argc > 1 ? std::atof(argv[1]) : 4));
    Figure figure;
    constexpr Index cape = 48 * 64, size = cape + 64 * 20;
    Points seen(3, size + example::figure_points);
    for (Index i = 0; i < cape; ++i) {
        const float c = (float(i % 48) / 47 - 0.5f) * pi, d = 1.15f / 63 * float(i / 48);
        const float back = 0.12f + 0.16f * d, wide = 0.25f + 0.14f * d;
        seen.col(i) =
            figure.places[chest]({-0.09f - back * std::cos(c), wide * std::sin(c), 0.37f - d});
    }
    for (Index i = 0; i < size - cape; ++i) {
        const float c = float(i % 64) / 32 * pi, d = 0.42f / 19 * float(i / 64);
        const float deep = 0.135f + 0.05f * d, wide = 0.21f + 0.14f * d;
        seen.col(cape + i) =
            figure.places[pelvis]({deep * std::cos(c), wide * std::sin(c), 0.05f - d});
    }
    Cloth cloth;
    taut::MeshFaces faces;
    add_sheet(cloth, faces, seen, 48, 64, false);
    add_sheet(cloth, faces, seen, 64, 20, true);
    cloth.set_gravity({0, 0, -9.81f});
    cloth.set_rayleigh({1, 2e-5});  // the air, 1/s, and what the threads damp, s
    std::vector<Pin> pins;
    for (Index i = 0; i < size; ++i) {
        const int bone = i < cape ? chest : pelvis;
        if (cloth.is_pinned(i)) pins.push_back({i, bone, figure.places[bone].inside(seen.col(i))});
    }

    taut::BodyOptions options;
    options.friction = 0.3;
    options.thickness = 0.005;  // m, so that no face of 2 cm cuts a capsule
    taut::Contacts contacts(cloth);
    for (int i = 0; i < 14; ++i) contacts.add(Figure::capsule(i), options, figure.places[i]);
    example::add_faces(size, faces);
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
        if (f > 6) deepest = std::max(deepest, double(depth(figure, cloth, state.x)));
        seen.leftCols(size) = state.x;
        example::draw(figure, seen, size);
        if (f == 0 && !taut::write_obj("cape.obj", seen, faces)) return 1;
        if (!motion.write(seen)) return 1;
        if (f == frames) break;

        figure.advance(frame);
        const std::clock_t start = std::clock();
        for (int k = 0; k < 14; ++k) contacts.move_to(k, figure.places[k]);
        for (const Pin& pin : pins) {
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
