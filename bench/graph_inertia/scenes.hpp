// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <taut/taut.hpp>
#include <utility>
#include <vector>

#include "../../examples/common/mesh_file.hpp"
#include "../survival/scenes.hpp"

namespace bench::graph_inertia {

using taut::Index;
using Net = taut::SpringSystem<double, 3>;
using survival::Random;

constexpr double frame = 1.0 / 60;  // s

/// A scene and the error that is asked of it.
struct Scene {
    std::string name;
    Net net;
    double bound;     // rms, of the largest displacement
    int frames = 30;  // of 1/60 s
};

/// Makes the springs whose ends `chosen(a, b)` picks stiffer by `factor`.
template <class Chosen>
void stiffen(Net& net, double factor, Chosen&& chosen) {
    Index index = 0;
    std::vector<std::pair<Index, double>> stiff;
    net.visit_springs([&](const auto& spring) {
        if (chosen(spring.a, spring.b)) stiff.push_back({index, factor * spring.stiffness_bound()});
        ++index;
    });
    for (const auto& [s, k] : stiff) net.set_stiffness(s, k);
}

/// hanging_cloth with the springs between particles stiffer whose rows and columns both lie in a
/// part of it.
template <class Part>
Net stiff_part(Index size, double factor, Part&& part) {
    Net net = taut::hanging_cloth<double>({size, size});
    const auto in = [&](Index i) { return part(i / size, i % size); };
    stiffen(net, factor, [&](Index a, Index b) { return in(a) && in(b); });
    return net;
}

/// The last row.
inline Net hem(Index size, double factor) {
    return stiff_part(size, factor, [=](Index r, Index) { return r == size - 1; });
}

/// A square in the middle, a quarter of the cloth's side.
inline Net patch(Index size, double factor) {
    const Index low = size / 2 - size / 8, high = size / 2 + size / 8;
    return stiff_part(size, factor, [=](Index r, Index c) {
        return r >= low && r < high && c >= low && c < high;
    });
}

/// The column in the middle.
inline Net seam(Index size, double factor) {
    return stiff_part(size, factor, [=](Index, Index c) { return c == size / 2; });
}

/// A net without diagonals and bending, with a rope along its lower border and two sides.
inline Net roped_net(Index size, double factor) {
    taut::ClothOptions options{size, size};
    options.diagonals = false;
    options.bend = 0;
    Net net = taut::hanging_cloth<double>(options);
    const auto along = [&](Index a, Index b, Index r, Index c) {
        return (a / size == r && b / size == r) || (a % size == c && b % size == c);
    };
    stiffen(net, factor, [&](Index a, Index b) {
        return along(a, b, size - 1, 0) || along(a, b, size - 1, size - 1);
    });
    return net;
}

/// A tube of triangles of all sizes: rings lie closer towards the top, columns towards one side, as
/// at a collar and a seam; each vertex is pushed about by a third of the spacing there, and
/// diagonals go either way.
inline example::MeshFile rough_tube(Index columns, Index rows, Random& random) {
    constexpr double turn = 6.283185307179586;
    example::MeshFile mesh;
    mesh.vertices.resize(3, columns * rows);
    for (Index r = 0; r < rows; ++r) {
        for (Index c = 0; c < columns; ++c) {
            const double push = r == 0 ? 0 : random.uniform(-1, 1) / 3;
            const double down = (static_cast<double>(r) + push) / static_cast<double>(rows - 1);
            const double at = turn * (static_cast<double>(c) + random.uniform(-1, 1) / 3) /
                              static_cast<double>(columns);
            const double angle = at - 0.75 * std::sin(at);
            const double radius = 0.2 + 0.1 * down;  // m
            mesh.vertices.col(r * columns + c) =
                Eigen::Vector3d(radius * std::cos(angle), -0.6 * down * std::sqrt(std::abs(down)),
                                radius * std::sin(angle));
        }
    }
    for (Index r = 0; r + 1 < rows; ++r) {
        for (Index c = 0; c < columns; ++c) {
            const Index a = r * columns + c, b = r * columns + (c + 1) % columns;
            const Index d = a + columns, e = b + columns;
            const bool even = random.uniform(0, 1) < 0.5;
            mesh.faces.push_back({a, b, even ? e : d});
            mesh.faces.push_back({even ? a : b, e, d});
        }
    }
    return mesh;
}

/// Springs over a mesh with masses by area, `density` kg/m², and k = `stretch`·(mean L)/L; those
/// across an edge are ten times softer. The highest particles (y is up) are held.
inline Net garment(const example::MeshFile& file, double stretch, double density = 0.2) {
    const Eigen::VectorXd area = taut::scene_detail::areas_of_vertices(file.vertices, file.faces);
    taut::MeshOptions options{stretch, stretch / 10, density * area.sum()};
    options.mass_by_area = options.stiffness_by_length = true;
    const auto mesh = taut::springs_from_mesh<double>(file.vertices, file.faces, options);
    return survival::garment(mesh).net;
}

}  // namespace bench::graph_inertia
