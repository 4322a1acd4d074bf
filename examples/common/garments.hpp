// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <taut/mesh_files/mesh_files.hpp>
#include <taut/network/spring_system.hpp>
#include <vector>

#include "figure.hpp"

/// A cape on a figure's chest and a skirt on its pelvis.
namespace example {

/// How fine both are: particles of a row, and rows; the first row of each is held.
struct Garments {
    taut::Index columns, rows;  // the cape's
    taut::Index around, down;   // the skirt's

    taut::Index cape() const { return columns * rows; }
    taut::Index size() const { return cape() + around * down; }
};

/// What their springs are made of.
struct Fabric {
    double mass;              // kg, of a particle
    double threads, bending;  // N/m, of a spring
};

/// Where the particles begin, 3 × n, m.
inline taut::Points<float, 3> lay_out(const Garments& of, const Figure& figure) {
    taut::Points<float, 3> x(3, of.size());
    for (taut::Index i = 0; i < of.cape(); ++i) {
        const float c = (float(i % of.columns) / float(of.columns - 1) - 0.5f) * pi;
        const float d = 1.15f / float(of.rows - 1) * float(i / of.columns);
        const float back = 0.12f + 0.16f * d, wide = 0.25f + 0.14f * d;
        x.col(i) =
            figure.places[chest]({-0.09f - back * std::cos(c), wide * std::sin(c), 0.37f - d});
    }
    for (taut::Index i = 0; i < of.size() - of.cape(); ++i) {
        const float c = float(i % of.around) / (float(of.around) / 2) * pi;
        const float d = 0.42f / float(of.down - 1) * float(i / of.around);
        const float deep = 0.135f + 0.05f * d, wide = 0.21f + 0.14f * d;
        x.col(of.cape() + i) =
            figure.places[pelvis]({deep * std::cos(c), wide * std::sin(c), 0.05f - d});
    }
    return x;
}

namespace garments_detail {

template <class Thread, class System>
void add_sheet(System& cloth, taut::MeshFaces& faces, const taut::Points<float, 3>& x,
               taut::Index columns, taut::Index rows, bool closed, const Fabric& fabric) {
    using taut::Index;
    using Scalar = typename System::Scalar;
    const Index first = cloth.size();
    for (Index i = first; i < first + columns * rows; ++i) {
        cloth.add_particle(x.col(i).template cast<Scalar>(), Scalar(fabric.mass));
        if (i < first + columns) cloth.pin(i);
    }
    for (Index i = 0; i < columns * rows; ++i) {
        const auto next = [&](Index right, Index down) {
            const Index column = i % columns + right, row = i / columns + down;
            const bool there = row < rows && (closed || (column >= 0 && column < columns));
            return there ? first + row * columns + (column + columns) % columns : -1;
        };
        const auto join = [&](Index a, Index b, auto law, double stiffness) {
            if (a < 0 || b < 0) return;
            cloth.template add_spring<decltype(law)>(a, b, {Scalar(stiffness)});
        };
        const Index here = first + i, right = next(1, 0), down = next(0, 1), across = next(1, 1);
        join(here, right, Thread(), fabric.threads);
        join(here, down, Thread(), fabric.threads);
        if (across >= 0) {
            join(here, across, Thread(), fabric.threads);
            join(right, down, Thread(), fabric.threads);
            faces.push_back({here, right, across, down});
        }
        join(here, next(2, 0), taut::Hookean(), fabric.bending);
        join(here, next(0, 2), taut::Hookean(), fabric.bending);
    }
}

}  // namespace garments_detail

/// Adds both to a system without particles.
/// @param x  as laid out, m   @tparam Thread  the law of its threads
template <class Thread, class System>
void add_garments(System& cloth, taut::MeshFaces& faces, const Garments& of,
                  const taut::Points<float, 3>& x, const Fabric& fabric) {
    using garments_detail::add_sheet;
    add_sheet<Thread>(cloth, faces, x, of.columns, of.rows, false, fabric);
    add_sheet<Thread>(cloth, faces, x, of.around, of.down, true, fabric);
}

/// What moves with a bone.
struct BonePin {
    taut::Index particle;
    int bone;
    Vector at;  // in the bone's frame, m
};

/// The pinned particles, each with the bone that its garment is on.
/// @param x  where they are on this figure, m
template <class System>
std::vector<BonePin> bone_pins(const System& cloth, const Garments& of,
                               const taut::Points<float, 3>& x, const Figure& figure) {
    std::vector<BonePin> pins;
    for (taut::Index i = 0; i < cloth.size(); ++i) {
        const int bone = i < of.cape() ? chest : pelvis;
        if (cloth.is_pinned(i)) pins.push_back({i, bone, figure.places[bone].inside(x.col(i))});
    }
    return pins;
}

/// Gives pins the velocities by which they are on the figure after `frame`, s.
template <class State>
void send(const std::vector<BonePin>& pins, const Figure& figure, float frame, State& state) {
    for (const BonePin& pin : pins) {
        const Vector to = figure.places[pin.bone](pin.at);
        state.v.col(pin.particle) = (to - state.x.col(pin.particle)) / frame;
    }
}

/// How far a point is below the skin, m; < 0: above it.
inline float depth_of(const Figure& figure, const Vector& x) {
    float deepest = -1;
    for (int k = 0; k < 14; ++k)
        deepest =
            std::max(deepest, -Figure::capsule(k).surface(figure.places[k].inside(x)).distance);
    return deepest;
}
/// The same of the deepest particle that is not pinned, m.
template <class System>
float depth(const Figure& figure, const System& cloth, const taut::Points<float, 3>& x) {
    float deepest = -1;
    for (taut::Index i = 0; i < cloth.size(); ++i) {
        if (!cloth.is_pinned(i)) deepest = std::max(deepest, depth_of(figure, x.col(i)));
    }
    return deepest;
}

}  // namespace example
