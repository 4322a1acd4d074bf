// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <taut/mesh_files/mesh_files.hpp>
#include <taut/network/hookean.hpp>
#include <taut/network/spring_system.hpp>
#include <taut/network/tension_only.hpp>
#include <vector>

#include "figure.hpp"

namespace example {

/// A cape of 48 × 64 particles on the chest of a figure and a skirt of 64 × 20 on its pelvis.
struct Garment {
    using Cloth = taut::SpringSystem<float, 3, taut::TensionOnly, taut::Hookean>;
    using Points = taut::Points<float, 3>;

    static constexpr taut::Index cape = 48 * 64, size = cape + 64 * 20;
    static constexpr float mass = 8.7e-5f;  // kg, of a particle: 0.25 kg/m²

    /// What moves with a bone.
    struct Pin {
        taut::Index particle;
        int bone;
        Vector at;  // in the bone's frame, m
    };

    Cloth cloth;
    taut::MeshFaces faces;
    std::vector<Pin> pins;

    /// As the figure stands.
    explicit Garment(const Figure& figure) {
        Points x(3, size);
        for (taut::Index i = 0; i < cape; ++i) {
            const float c = (float(i % 48) / 47 - 0.5f) * pi, d = 1.15f / 63 * float(i / 48);
            const float back = 0.12f + 0.16f * d, wide = 0.25f + 0.14f * d;
            x.col(i) =
                figure.places[chest]({-0.09f - back * std::cos(c), wide * std::sin(c), 0.37f - d});
        }
        for (taut::Index i = 0; i < size - cape; ++i) {
            const float c = float(i % 64) / 32 * pi, d = 0.42f / 19 * float(i / 64);
            const float deep = 0.135f + 0.05f * d, wide = 0.21f + 0.14f * d;
            x.col(cape + i) =
                figure.places[pelvis]({deep * std::cos(c), wide * std::sin(c), 0.05f - d});
        }
        add_sheet(x, 48, 64, false);
        add_sheet(x, 64, 20, true);
        cloth.set_gravity({0, 0, -9.81f});
        cloth.set_rayleigh({1, 2e-5});  // the air, 1/s, and what the threads damp, s
        for (taut::Index i = 0; i < size; ++i) {
            const int bone = i < cape ? chest : pelvis;
            if (cloth.is_pinned(i)) pins.push_back({i, bone, figure.places[bone].inside(x.col(i))});
        }
    }

private:
    /// A grid of particles at the next columns of x, row by row, its first row pinned.
    void add_sheet(const Points& x, taut::Index columns, taut::Index rows, bool closed) {
        using taut::Index;
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
            const Index here = first + i, right = next(1, 0), down = next(0, 1),
                        across = next(1, 1);
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
};

/// How far a point is below the figure's skin, m.
inline float depth_of(const Figure& figure, const Vector& x) {
    float deepest = -1;
    for (int k = 0; k < 14; ++k)
        deepest =
            std::max(deepest, -Figure::capsule(k).surface(figure.places[k].inside(x)).distance);
    return deepest;
}
/// The deepest of the particles that are not pinned, m.
inline float depth(const Figure& figure, const Garment::Cloth& cloth, const Garment::Points& x) {
    float deepest = -1;
    for (taut::Index i = 0; i < cloth.size(); ++i) {
        if (!cloth.is_pinned(i)) deepest = std::max(deepest, depth_of(figure, x.col(i)));
    }
    return deepest;
}

}  // namespace example
