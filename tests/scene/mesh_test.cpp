// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <set>
#include <taut/scene/mesh.hpp>
#include <utility>
#include <vector>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::mesh_test {

using taut::MeshOptions;
using taut::springs_from_mesh;

namespace {

using Faces = std::vector<std::vector<Index>>;
using Pairs = std::set<std::pair<Index, Index>>;
using Vertices = taut::Points<double, 3>;

/// Vertices in general position: no two springs are equally long by accident.
Vertices scattered(Index n) {
    Vertices x(3, n);
    for (Index i = 0; i < n; ++i) {
        const auto t = static_cast<double>(i);
        x.col(i) << t, 0.1 * t * t, 0.01 * t * t * t;
    }
    return x;
}

struct Joined {
    Pairs stretch, bend;
    Index springs = 0;
};

/// The particle pairs that are joined, by stiffness.
template <class Scalar>
Joined joined(const taut::MeshSprings<Scalar>& mesh) {
    Joined pairs;
    const auto& set = mesh.system.springs();
    for (std::size_t s = 0; s < set.a.size(); ++s) {
        const bool stretch = static_cast<Index>(s) < mesh.stretch_springs;
        CHECK(set.parameters[s].stiffness == (stretch ? 1000 : 100));
        (stretch ? pairs.stretch : pairs.bend)
            .emplace(std::min(set.a[s], set.b[s]), std::max(set.a[s], set.b[s]));
        ++pairs.springs;
    }
    CHECK(pairs.springs == mesh.stretch_springs + mesh.bend_springs);
    CHECK(static_cast<std::size_t>(pairs.springs) == pairs.stretch.size() + pairs.bend.size());
    return pairs;
}

Joined joined(Index vertices, const Faces& faces) {
    return joined(springs_from_mesh<double>(scattered(vertices), faces));
}

/// A grid of rows × columns cells, each cut into two triangles.
Faces triangle_grid(Index rows, Index columns) {
    Faces faces;
    for (Index r = 0; r < rows; ++r) {
        for (Index c = 0; c < columns; ++c) {
            const Index v = r * (columns + 1) + c;
            faces.push_back({v, v + 1, v + columns + 2});
            faces.push_back({v, v + columns + 2, v + columns + 1});
        }
    }
    return faces;
}

}  // namespace

TEST_CASE("mesh: a triangle has its edges, a quad its diagonals too", "[scene]") {
    const auto triangle = joined(3, {{0, 1, 2}});
    CHECK(triangle.stretch == Pairs{{0, 1}, {1, 2}, {0, 2}});
    CHECK(triangle.bend.empty());
    const auto quad = joined(4, {{0, 1, 2, 3}});
    CHECK(quad.stretch == Pairs{{0, 1}, {1, 2}, {2, 3}, {0, 3}, {0, 2}, {1, 3}});
    CHECK(quad.bend.empty());
}

TEST_CASE("mesh: a pentagon is a fan of triangles, with their hinges", "[scene]") {
    const auto pentagon = joined(5, {{0, 1, 2, 3, 4}});
    CHECK(pentagon.stretch == Pairs{{0, 1}, {1, 2}, {2, 3}, {3, 4}, {0, 4}, {0, 2}, {0, 3}});
    CHECK(pentagon.bend == Pairs{{1, 3}, {2, 4}});
}

TEST_CASE("mesh: two triangles with a common edge are hinged, whichever way round they are given",
          "[scene]") {
    for (const Faces& faces :
         {Faces{{0, 1, 2}, {1, 3, 2}}, Faces{{0, 1, 2}, {2, 3, 1}}, Faces{{0, 1, 2}, {1, 2, 3}}}) {
        const auto pair = joined(4, faces);
        CHECK(pair.stretch.size() == 5);
        CHECK(pair.bend == Pairs{{0, 3}});
    }
}

TEST_CASE("mesh: quads that share an edge are not hinged, and share its spring", "[scene]") {
    const auto pair = joined(6, {{0, 1, 2, 3}, {1, 4, 5, 2}});
    CHECK(pair.stretch.size() == 7 + 4);
    CHECK(pair.bend.empty());
    const auto mixed = joined(5, {{0, 1, 2, 3}, {1, 4, 2}});
    CHECK(mixed.stretch.size() == 6 + 2);
    CHECK(mixed.bend.empty());
}

TEST_CASE("mesh: an edge of three triangles is no hinge", "[scene]") {
    const auto fin = joined(5, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}});
    CHECK(fin.stretch.size() == 7);
    CHECK(fin.bend.empty());
}

TEST_CASE("mesh: far corners that are joined already get no bending spring", "[scene]") {
    // Triangles 0 and 1 have the hinge 1-2, whose far corners 0 and 3 are an edge of face 2.
    const auto mesh = joined(5, {{0, 1, 2}, {1, 3, 2}, {0, 3, 4}});
    CHECK(mesh.stretch.count({0, 3}) == 1);
    CHECK(mesh.bend.empty());
    // Two hinges with the same far corners, 0 and 1: one spring.
    const auto twice = joined(6, {{0, 2, 3}, {1, 2, 3}, {0, 4, 5}, {1, 4, 5}});
    CHECK(twice.bend == Pairs{{0, 1}});
}

TEST_CASE("mesh: a face given twice adds nothing", "[scene]") {
    const auto twice = joined(3, {{0, 1, 2}, {2, 0, 1}});
    CHECK(twice.stretch.size() == 3);
    CHECK(twice.bend.empty());
}

TEMPLATE_TEST_CASE("mesh: faces of two corners are springs, and nothing else changes", "[scene]",
                   float, double) {
    for (std::uint32_t seed = 0; seed < 50; ++seed) {
        INFO("seed " << seed);
        Random random(seed);
        const Index n = 6 + random.below(30);
        const auto vertices = random.template points<TestType, 3>(n, -1, 1);
        Faces lines;
        Pairs pairs;
        for (Index i = 0; i < n; ++i) {  // every vertex, and some pairs twice
            const Index a = random.below(n - 1);
            lines.push_back({i <= a ? a + 1 : a, i});
            pairs.emplace(std::min(lines.back()[0], i), std::max(lines.back()[0], i));
        }
        const auto net = springs_from_mesh<TestType>(vertices, lines);
        CHECK(joined(net).stretch == pairs);
        CHECK(net.bend_springs == 0);

        const auto columns = n / 2 - 1;
        Faces faces = triangle_grid(1, columns);
        const auto grid = joined(springs_from_mesh<TestType>(vertices, faces));
        // Before, between and behind the faces.
        for (const auto& line : lines)
            faces.insert(faces.begin() + random.below(faces.size()), line);
        const auto both = joined(springs_from_mesh<TestType>(vertices, faces));
        Pairs stretch = grid.stretch;
        stretch.insert(pairs.begin(), pairs.end());
        CHECK(both.stretch == stretch);
        Pairs bend;  // but where a line is already
        std::set_difference(grid.bend.begin(), grid.bend.end(), pairs.begin(), pairs.end(),
                            std::inserter(bend, bend.end()));
        CHECK(both.bend == bend);
    }
}

TEST_CASE("mesh: spring counts of closed and open surfaces follow Euler's formula", "[scene]") {
    // Tetrahedron: E = 6, every pair is joined already.
    const auto tetrahedron = joined(4, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}});
    CHECK(tetrahedron.stretch.size() == 6);
    CHECK(tetrahedron.bend.empty());

    // Octahedron: E = V + F − 2 = 12; its 12 hinges have only 3 different pairs of far corners.
    const auto octahedron = joined(
        6,
        {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}});
    CHECK(octahedron.stretch.size() == 12);
    CHECK(octahedron.bend == Pairs{{0, 1}, {2, 3}, {4, 5}});

    // A disc has E = V + F − 1, of which 3F − E are inner: one hinge each.
    const Index rows = 4;
    const Index columns = 7;
    const Index vertices = (rows + 1) * (columns + 1);
    const Index triangles = 2 * rows * columns;
    const Index edges = vertices + triangles - 1;
    const auto grid = joined(vertices, triangle_grid(rows, columns));
    CHECK(static_cast<Index>(grid.stretch.size()) == edges);
    CHECK(static_cast<Index>(grid.bend.size()) == 3 * triangles - edges);
}

TEMPLATE_TEST_CASE("mesh: equal masses sum to the given one, and springs lie at rest", "[scene]",
                   float, double) {
    const taut::Points<TestType, 3> vertices = scattered(40).cast<TestType>();
    const auto mesh = springs_from_mesh<TestType>(vertices, triangle_grid(4, 7));
    double mass = 0;
    for (Index i = 0; i < mesh.system.size(); ++i) {
        CHECK(mesh.system.mass(i) == mesh.system.mass(0));
        mass += static_cast<double>(mesh.system.mass(i));
    }
    CHECK_THAT(mass, Catch::Matchers::WithinRel(0.3, Tolerance<TestType>::accumulated));
    taut::Points<TestType, 3> f;
    mesh.system.force(mesh.system.initial_state(), f);
    CHECK(f.isZero(0));
    CHECK(mesh.system.pinned_count() == 0);
}

TEST_CASE("mesh: vertices that no face uses are left out and counted", "[scene]") {
    const auto mesh = springs_from_mesh<double>(scattered(8), {{1, 3, 6}});
    CHECK(mesh.system.size() == 3);
    CHECK(mesh.unused_vertices == 5);
    CHECK(mesh.particle_of_vertex == std::vector<Index>{-1, 0, -1, 1, -1, -1, 2, -1});
    CHECK((mesh.system.initial_state().x.col(2) == scattered(8).col(6)));
    CHECK(joined(mesh).stretch == Pairs{{0, 1}, {1, 2}, {0, 2}});
    CHECK_THAT(mesh.system.mass(0), Catch::Matchers::WithinRel(0.1, Tolerance<double>::rounding));
}

TEST_CASE("mesh: with bend 0 there are no bending springs", "[scene]") {
    MeshOptions options;
    options.bend = 0;
    const auto mesh = springs_from_mesh<double>(scattered(40), triangle_grid(4, 7), options);
    CHECK(mesh.bend_springs == 0);
    CHECK(mesh.system.spring_count() == 40 + 56 - 1);
}

TEST_CASE("mesh: bad input: faces", "[scene][bad_input]") {
    const auto refused = [](const Faces& faces, std::initializer_list<const char*> words) {
        return missing(message_of([&] { joined(4, faces); }), words);
    };
    CHECK(refused({}, {"springs_from_mesh", "no faces"}) == "");
    CHECK(refused({{0, 1, 2}, {0}}, {"face 1", "1 corners", "at least 2"}) == "");
    CHECK(refused({{}}, {"face 0", "0 corners", "at least 2"}) == "");
    CHECK(refused({{0, 1}, {2, 2}}, {"face 1", "vertex 2 twice"}) == "");
    CHECK(refused({{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}, {"face 2", "vertex 4", "4 vertices"}) == "");
    CHECK(refused({{0, -1, 2}}, {"face 0", "vertex -1", "4 vertices"}) == "");
    CHECK(refused({{0, 1, 2, 1}}, {"face 0", "vertex 1 twice"}) == "");
}

TEST_CASE("mesh: bad input: options and vertices", "[scene][bad_input]") {
    const double not_a_number = std::numeric_limits<double>::quiet_NaN();
    const auto refused = [](const MeshOptions& options, std::initializer_list<const char*> words) {
        return missing(message_of([&] {
                           springs_from_mesh<double>(scattered(3), {{0, 1, 2}}, options);
                       }),
                       words);
    };
    for (const double bad : {-1.0, not_a_number, std::numeric_limits<double>::infinity()}) {
        CHECK(refused({bad, 100, 0.3}, {"springs_from_mesh", "stretch is ", ">= 0"}) == "");
        CHECK(refused({1000, bad, 0.3}, {"springs_from_mesh", "bend is ", ">= 0"}) == "");
        CHECK(refused({1000, 100, bad}, {"mass", " is ", "> 0"}) == "");
        MeshOptions damped;
        damped.rayleigh = {bad, 0};
        CHECK(refused(damped, {"mass_proportional is ", ">= 0"}) == "");
        damped.rayleigh = {0, bad};
        CHECK(refused(damped, {"stiffness_proportional is ", ">= 0"}) == "");
    }
    CHECK(refused({1000, 100, 0}, {"mass", " is 0", "> 0"}) == "");
    Vertices broken = scattered(4);
    broken(1, 3) = not_a_number;
    CHECK(message_of([&] { springs_from_mesh<double>(broken, {{0, 1, 2}}); }) == "");
    // The message must name the vertex of the mesh, not the particle that it would have become.
    CHECK(missing(message_of([&] {
                      springs_from_mesh<double>(broken, {{0, 1, 3}});
                  }),
                  {"vertex 3", "finite"}) == "");
}

}  // namespace taut_test::mesh_test
