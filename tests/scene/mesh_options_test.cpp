// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <taut/scene/mesh.hpp>
#include <utility>
#include <vector>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random.hpp"
#include "../support/tolerance.hpp"

// Masses by area and stiffness by length.

namespace taut_test::mesh_options_test {

using taut::MeshOptions;
using taut::springs_from_mesh;

namespace {

using Faces = std::vector<std::vector<Index>>;
using Vertices = taut::Points<double, 3>;

/// Triangles over scattered vertices, all in the positive octant.
struct Patch {
    Vertices vertices;
    Faces faces;
};
Patch random_patch(Random& random) {
    const Index n = 4 + random.below(30);
    Patch patch{random.points<double, 3>(n, 0, 1), {}};
    for (Index f = 0; f < 2 * n; ++f) {
        const Index a = random.below(n), b = (a + 1 + random.below(n - 1)) % n;
        const Index c = random.below(n);
        if (c != a && c != b) patch.faces.push_back({a, b, c});
    }
    patch.faces.push_back({0, 1, 2});
    return patch;
}

}  // namespace

TEMPLATE_TEST_CASE("mesh: masses by area keep the mass, its centre and each triangle's", "[scene]",
                   float, double) {
    Random random(7);
    for (int trial = 0; trial < 20; ++trial) {
        const Patch patch = random_patch(random);
        const taut::Points<TestType, 3> vertices = patch.vertices.cast<TestType>();
        MeshOptions options{1000, 100, 0.7};
        options.mass_by_area = true;
        const auto mesh = springs_from_mesh<TestType>(vertices, patch.faces, options);
        // An even sheet's mass and centre of mass: those of its triangles.
        Eigen::Vector3d moment = Eigen::Vector3d::Zero();
        double area = 0;
        for (const auto& face : patch.faces) {
            const Eigen::Vector3d a = patch.vertices.col(face[0]), b = patch.vertices.col(face[1]),
                                  c = patch.vertices.col(face[2]);
            const double one = (b - a).cross(c - a).norm() / 2;
            area += one;
            moment += one * (a + b + c) / 3;
        }
        double mass = 0;
        Eigen::Vector3d lumped = Eigen::Vector3d::Zero();
        const auto x = mesh.system.initial_state().x;
        for (Index i = 0; i < mesh.system.size(); ++i) {
            mass += static_cast<double>(mesh.system.mass(i));
            lumped += static_cast<double>(mesh.system.mass(i)) * x.col(i).template cast<double>();
        }
        const double tolerance = Tolerance<TestType>::accumulated;
        CHECK_THAT(mass, Catch::Matchers::WithinRel(0.7, tolerance));
        CHECK((lumped / mass - moment / area).norm() < tolerance);
    }
    // A rope's masses are by length; stray lines of a cloth have no area to go by.
    Vertices rope(3, 3);
    rope << 0, 1, 4, 0, 0, 0, 0, 0, 0;
    MeshOptions options{1000, 100, 0.4};
    options.mass_by_area = true;
    const auto mesh = springs_from_mesh<TestType>(taut::Points<TestType, 3>(rope.cast<TestType>()),
                                                  {{0, 1}, {1, 2}}, options);
    for (const auto& [i, mass] : {std::pair{0, 0.05}, {1, 0.2}, {2, 0.15}}) {
        CHECK_THAT(static_cast<double>(mesh.system.mass(i)),
                   Catch::Matchers::WithinRel(mass, Tolerance<TestType>::rounding));
    }
}

TEMPLATE_TEST_CASE("mesh: masses by area do not ask at which corner a face begins", "[scene]",
                   float, double) {
    Random random(19);
    MeshOptions options{1000, 100, 0.7};
    options.mass_by_area = true;
    for (const Index corners : {3, 4, 5, 9}) {
        // A grid of squares and a regular polygon beside it, mapped to parallelograms and its like.
        Vertices vertices(3, 9 + corners);
        for (Index i = 0; i < 9; ++i)
            vertices.col(i) << static_cast<double>(i % 3), static_cast<double>(i / 3), 0;
        for (Index i = 0; i < corners; ++i) {
            const double angle =
                6.283185307179586 * static_cast<double>(i) / static_cast<double>(corners);
            vertices.col(9 + i) << 5 + std::cos(angle), std::sin(angle), 0;
        }
        const Eigen::Matrix3d affine = random.points<double, 3>(3, -1, 1);
        const auto masses = [&](Index first) {
            Faces faces;
            for (const Index i : {0, 1, 3, 4}) {
                faces.push_back({i, i + 1, i + 4, i + 3});
                std::rotate(faces.back().begin(), faces.back().begin() + first % 4,
                            faces.back().end());
            }
            faces.emplace_back();
            for (Index i = 0; i < corners; ++i) faces.back().push_back(9 + (i + first) % corners);
            const taut::Points<TestType, 3> x = (affine * vertices).cast<TestType>();
            const auto system = springs_from_mesh<TestType>(x, faces, options).system;
            Eigen::VectorXd mass(system.size());
            for (Index v = 0; v < system.size(); ++v) mass[v] = static_cast<double>(system.mass(v));
            return mass;
        };
        // springs_from_mesh numbers particles as vertices where all are used.
        const Eigen::VectorXd mass = masses(0);
        const double tolerance = Tolerance<TestType>::accumulated;
        for (Index first = 1; first < corners; ++first)
            CHECK((masses(first) - mass).norm() < tolerance * mass.norm());
        const double quarter = mass[0];
        for (const auto& [v, quarters] : {std::pair{2, 1}, {6, 1}, {8, 1}, {1, 2}, {3, 2}, {4, 4}})
            CHECK_THAT(mass[v], Catch::Matchers::WithinRel(quarters * quarter, tolerance));
        CHECK((mass.tail(corners).array() - mass[9]).abs().maxCoeff() < tolerance * mass[9]);
    }
}

TEMPLATE_TEST_CASE("mesh: stiffness by length: k L is one number, whatever the mesh", "[scene]",
                   float, double) {
    Random random(11);
    for (int trial = 0; trial < 20; ++trial) {
        const Patch patch = random_patch(random);
        MeshOptions options{600, 60, 0.7};
        options.stiffness_by_length = true;
        const taut::Points<TestType, 3> vertices = patch.vertices.cast<TestType>();
        const auto mesh = springs_from_mesh<TestType>(vertices, patch.faces, options);
        const auto& springs = mesh.system.springs();
        double mean = 0;
        const auto stretch = static_cast<std::size_t>(mesh.stretch_springs);
        for (std::size_t s = 0; s < stretch; ++s)
            mean += static_cast<double>(springs.rest_length[s]) / static_cast<double>(stretch);
        for (std::size_t s = 0; s < springs.a.size(); ++s) {
            const double kL = static_cast<double>(springs.parameters[s].stiffness) *
                              static_cast<double>(springs.rest_length[s]);
            const double wanted = (s < stretch ? 600 : 60) * mean;
            CHECK_THAT(kL, Catch::Matchers::WithinRel(wanted, Tolerance<TestType>::accumulated));
        }
    }
}

TEMPLATE_TEST_CASE("mesh: its damping is the one asked for and changes nothing else", "[scene]",
                   float, double) {
    Random random(13);
    for (int trial = 0; trial < 20; ++trial) {
        const Patch patch = random_patch(random);
        const taut::Points<TestType, 3> vertices = patch.vertices.cast<TestType>();
        MeshOptions options;
        auto declared = springs_from_mesh<TestType>(vertices, patch.faces, options).system;
        options.rayleigh = {random.uniform(0, 5), random.uniform(0, 1e-2)};
        const auto damped = springs_from_mesh<TestType>(vertices, patch.faces, options).system;
        CHECK(damped.rayleigh().mass_proportional == options.rayleigh.mass_proportional);
        CHECK(damped.rayleigh().stiffness_proportional == options.rayleigh.stiffness_proportional);
        declared.set_rayleigh(options.rayleigh);
        auto state = damped.initial_state();
        state.v = random.points<TestType, 3>(damped.size(), -1, 1);
        taut::Points<TestType, 3> f, g;
        damped.force(state, f);
        declared.force(state, g);
        CHECK(f == g);
    }
}

TEST_CASE("mesh: a rope stretches alike however it is cut, with masses and stiffness by length",
          "[scene]") {
    // 1 m under a pull of 1 N: Σ F/k over the springs.
    const auto stretched = [](const std::vector<double>& cuts, double edge) {
        Vertices x = Vertices::Zero(3, static_cast<Index>(cuts.size()));
        Faces lines;
        for (std::size_t i = 0; i < cuts.size(); ++i) {
            x(0, static_cast<Index>(i)) = cuts[i];
            if (i > 0) lines.push_back({static_cast<Index>(i) - 1, static_cast<Index>(i)});
        }
        MeshOptions options{100 / edge, 0, 1};
        options.stiffness_by_length = true;
        const auto mesh = springs_from_mesh<double>(x, lines, options);
        double length = 0;
        for (const auto& spring : mesh.system.springs().parameters) length += 1 / spring.stiffness;
        return length;
    };
    const double even = stretched({0, 0.25, 0.5, 0.75, 1}, 0.25);
    CHECK_THAT(even, Catch::Matchers::WithinRel(0.01, 1e-12));
    CHECK_THAT(stretched({0, 0.1, 0.5, 0.97, 1}, 0.25), Catch::Matchers::WithinRel(even, 1e-12));
}

TEST_CASE("mesh: bad input: what masses and stiffness cannot be had by", "[scene][bad_input]") {
    MeshOptions by_area, by_length;
    by_area.mass_by_area = by_length.stiffness_by_length = true;
    const auto refused = [](const Vertices& x, const Faces& faces, const MeshOptions& options,
                            std::initializer_list<const char*> words) {
        return missing(message_of([&] { springs_from_mesh<double>(x, faces, options); }), words);
    };
    Vertices flat(3, 5);
    flat << 0, 1, 0, 1, 2, 0, 0, 1, 1, 2, 0, 0, 0, 0, 0;
    const Faces with_line{{0, 1, 2}, {2, 1, 3}, {3, 4}};
    CHECK(refused(flat, with_line, by_area, {"mass_by_area", "vertex 4", "area"}) == "");
    CHECK(message_of([&] { springs_from_mesh<double>(flat, with_line, by_length); }) == "");
    Vertices twin = flat;
    twin.col(4) = twin.col(3);
    CHECK(refused(twin, with_line, by_length,
                  {"stiffness_by_length", "vertices 3 and 4", "coincide"}) == "");
    CHECK(refused(Vertices::Zero(3, 3), {{0, 1, 2}}, by_area, {"mass_by_area", "vertex 0"}) == "");
    CHECK(refused(1e200 * flat, {{0, 1, 2}}, by_area, {"mass_by_area", "finite area"}) == "");
}

}  // namespace taut_test::mesh_options_test
