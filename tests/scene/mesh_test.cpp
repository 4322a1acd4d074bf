// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>
#include <iterator>
#include <numeric>
#include <set>
#include <taut/scene/mesh.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/scene_of.hpp"

namespace taut_test::mesh_test {

using taut::MeshOptions;

namespace {

using Faces = std::vector<std::vector<Index>>;
using Pairs = std::set<std::pair<Index, Index>>;
using Vertices = Eigen::MatrixXd;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

struct Mesh {
    Scene scene;
    std::vector<AnySpring> springs;
    std::size_t stretch_springs, bend_springs;
    Index unused_vertices;
    std::vector<Index> particle_of_vertex;
};
template <class Scalar>
Mesh mesh_of_scalar(const Vertices& vertices, const Faces& faces, const MeshOptions& options) {
    const taut::Points<Scalar, 3> x = vertices.cast<Scalar>();
    const auto mesh = taut::springs_from_mesh<Scalar>(x, faces, options);
    const Scene scene = scene_of(mesh.system);
    return {scene,
            scene.springs(),
            static_cast<std::size_t>(mesh.stretch_springs),
            static_cast<std::size_t>(mesh.bend_springs),
            mesh.unused_vertices,
            mesh.particle_of_vertex};
}
Mesh mesh_of(const Vertices& vertices, const Faces& faces, const MeshOptions& options = {},
             bool single = false) {
    return single ? mesh_of_scalar<float>(vertices, faces, options)
                  : mesh_of_scalar<double>(vertices, faces, options);
}
Eigen::VectorXd masses_of(const Scene& scene) {
    Eigen::VectorXd mass(scene.size());
    for (Index i = 0; i < scene.size(); ++i) mass[i] = scene.mass(i);
    return mass;
}

/// Vertices in general position: no two springs are equally long by accident.
Vertices scattered(Index n) {
    const Eigen::RowVectorXd t = Eigen::RowVectorXd::LinSpaced(n, 0, static_cast<double>(n - 1));
    Vertices x(3, n);
    x << t, 0.1 * t.array().square().matrix(), 0.01 * t.array().cube().matrix();
    return x;
}

struct Joined {
    Pairs stretch, bend;
};
/// The particle pairs that are joined, by stiffness.
Joined joined(const Mesh& mesh) {
    Joined pairs;
    for (std::size_t s = 0; s < mesh.springs.size(); ++s) {
        const auto& spring = mesh.springs[s];
        const bool stretch = s < mesh.stretch_springs;
        CHECK(spring.stiffness == (stretch ? 1000 : 100));
        (stretch ? pairs.stretch : pairs.bend).insert(std::minmax(spring.a, spring.b));
    }
    CHECK(mesh.springs.size() == mesh.stretch_springs + mesh.bend_springs);
    CHECK(mesh.springs.size() == pairs.stretch.size() + pairs.bend.size());
    return pairs;
}
Joined joined(Index vertices, const Faces& faces) {
    return joined(mesh_of(scattered(vertices), faces));
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

/// Triangles over scattered vertices, all in the positive octant.
struct Patch {
    Vertices vertices;
    Faces faces;
};
Patch random_patch(Random& random) {
    const Index n = 4 + random.below(30);
    Patch patch{random_points(random, 3, n, 0, 1), {{0, 1, 2}}};
    for (Index f = 0; f < 2 * n; ++f) {
        const Index a = random.below(n), b = (a + 1 + random.below(n - 1)) % n;
        const Index c = random.below(n);
        if (c != a && c != b) patch.faces.push_back({a, b, c});
    }
    return patch;
}
/// visit(patch, single), of patches that are the same for float and double.
template <class Visit>
void for_each_patch(Visit&& visit) {
    for (const bool single : {false, true}) {
        Random random(7);
        for (int trial = 0; trial < 20; ++trial) {
            CAPTURE(single, trial);
            visit(random_patch(random), single);
        }
    }
}

std::string refused(const Vertices& vertices, const Faces& faces, const MeshOptions& options,
                    std::initializer_list<const char*> words) {
    return missing(message_of([&] { mesh_of(vertices, faces, options); }), words);
}

}  // namespace

TEST_CASE("mesh: the springs of a few faces", "[scene]") {
    struct Expected {
        Index vertices;
        Faces faces;
        std::size_t stretch;
        Pairs bend;
    };
    const Expected meshes[] = {
        {3, {{0, 1, 2}}, 3, {}},     // a triangle has its edges
        {4, {{0, 1, 2, 3}}, 6, {}},  // a quad its diagonals, too
        // A pentagon is a fan of triangles, with their hinges.
        {5, {{0, 1, 2, 3, 4}}, 7, {{1, 3}, {2, 4}}},
        // Two triangles with a common edge are hinged, whichever way round they are given.
        {4, {{0, 1, 2}, {1, 3, 2}}, 5, {{0, 3}}},
        {4, {{0, 1, 2}, {2, 3, 1}}, 5, {{0, 3}}},
        {4, {{0, 1, 2}, {1, 2, 3}}, 5, {{0, 3}}},
        // Quads that share an edge are not hinged, and share its spring; quad and triangle neither.
        {6, {{0, 1, 2, 3}, {1, 4, 5, 2}}, 11, {}},
        {5, {{0, 1, 2, 3}, {1, 4, 2}}, 8, {}},
        {5, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}, 7, {}},  // an edge of three triangles is no hinge
        // The far corners of the hinge 1-2, 0 and 3, are an edge of face 2: joined already.
        {5, {{0, 1, 2}, {1, 3, 2}, {0, 3, 4}}, 8, {}},
        // Two hinges with the same far corners: one spring.
        {6, {{0, 2, 3}, {1, 2, 3}, {0, 4, 5}, {1, 4, 5}}, 10, {{0, 1}}},
        {3, {{0, 1, 2}, {2, 0, 1}}, 3, {}},  // a face given twice adds nothing
        {4, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}, 6, {}},  // tetrahedron: all are joined
        // Octahedron: E = V + F − 2 = 12; 12 hinges have only 3 different pairs of far corners.
        {6,
         {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}},
         12,
         {{0, 1}, {2, 3}, {4, 5}}}};
    for (const auto& expected : meshes) {
        const auto mesh = joined(expected.vertices, expected.faces);
        INFO("faces " << &expected - meshes);
        CHECK(mesh.stretch.size() == expected.stretch);
        CHECK(mesh.bend == expected.bend);
    }
    CHECK(joined(4, {{0, 1, 2, 3}}).stretch ==
          Pairs{{0, 1}, {1, 2}, {2, 3}, {0, 3}, {0, 2}, {1, 3}});
    CHECK(joined(5, {{0, 1, 2, 3, 4}}).stretch ==
          Pairs{{0, 1}, {1, 2}, {2, 3}, {3, 4}, {0, 4}, {0, 2}, {0, 3}});
}

TEST_CASE("mesh: faces of two corners are springs, and nothing else changes", "[scene]") {
    for (const bool single : {false, true}) {
        for (std::uint32_t seed = 0; seed < 50; ++seed) {
            CAPTURE(single, seed);
            Random random(seed);
            const Index n = 6 + random.below(30);
            const auto vertices = random_points(random, 3, n, -1, 1);
            Faces lines;
            Pairs pairs;
            for (Index i = 0; i < n; ++i) {  // every vertex, and some pairs twice
                const Index a = random.below(n - 1);
                lines.push_back({i <= a ? a + 1 : a, i});
                pairs.insert(std::minmax(lines.back()[0], i));
            }
            const Joined net = joined(mesh_of(vertices, lines, {}, single));
            CHECK(net.stretch == pairs);
            CHECK(net.bend.empty());

            Faces faces = triangle_grid(1, n / 2 - 1);
            const Joined grid = joined(mesh_of(vertices, faces, {}, single));
            // Before, between and behind the faces.
            for (const auto& line : lines)
                faces.insert(faces.begin() + random.below(static_cast<Index>(faces.size())), line);
            const Joined both = joined(mesh_of(vertices, faces, {}, single));
            Pairs stretch = grid.stretch;
            stretch.insert(pairs.begin(), pairs.end());
            CHECK(both.stretch == stretch);
            Pairs bend;  // but where a line is already
            std::set_difference(grid.bend.begin(), grid.bend.end(), pairs.begin(), pairs.end(),
                                std::inserter(bend, bend.end()));
            CHECK(both.bend == bend);
        }
    }
}

TEST_CASE("mesh: a disc has the springs of Euler's formula, equal masses and is at rest",
          "[scene]") {
    // E = V + F − 1, of which 3F − E are inner: one hinge each.
    const Faces faces = triangle_grid(4, 7);
    const std::size_t edges = 40 + faces.size() - 1;
    for (const bool single : {false, true}) {
        const Mesh mesh = mesh_of(scattered(40), faces, {}, single);
        const auto pairs = joined(mesh);
        CHECK(pairs.stretch.size() == edges);
        CHECK(pairs.bend.size() == 3 * faces.size() - edges);
        const Eigen::VectorXd mass = masses_of(mesh.scene);
        CHECK(mass.minCoeff() == mass.maxCoeff());
        CHECK_THAT(mass.sum(), WithinRel(0.3, mesh.scene.kind().accumulated()));
        CHECK(mesh.scene.force(mesh.scene.initial_state()).isZero(0));
        for (Index i = 0; i < 40; ++i) CHECK_FALSE(mesh.scene.is_pinned(i));
    }
    MeshOptions limp;
    limp.bend = 0;
    const Mesh mesh = mesh_of(scattered(40), faces, limp);
    CHECK(mesh.bend_springs == 0);
    CHECK(mesh.springs.size() == edges);
}

TEST_CASE("mesh: vertices that no face uses are left out and counted", "[scene]") {
    const Mesh mesh = mesh_of(scattered(8), {{1, 3, 6}});
    CHECK(mesh.unused_vertices == 5);
    CHECK(mesh.particle_of_vertex == std::vector<Index>{-1, 0, -1, 1, -1, -1, 2, -1});
    CHECK(mesh.scene.initial_state().x.col(2) == scattered(8).col(6));
    CHECK(joined(mesh).stretch == Pairs{{0, 1}, {1, 2}, {0, 2}});
    CHECK_THAT(mesh.scene.mass(0), WithinRel(0.1, 1e-14));
}

TEST_CASE("mesh: masses by area keep the mass and its centre", "[scene]") {
    MeshOptions options{1000, 100, 0.7};
    options.mass_by_area = true;
    for_each_patch([&](const Patch& patch, bool single) {
        const Scene scene = mesh_of(patch.vertices, patch.faces, options, single).scene;
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
        const Eigen::VectorXd mass = masses_of(scene);
        CHECK_THAT(mass.sum(), WithinRel(0.7, scene.kind().accumulated()));
        CHECK((scene.initial_state().x * mass / mass.sum() - moment / area).norm() <
              scene.kind().accumulated());
    });
    // A rope has masses and stiffness by length.
    options.stiffness_by_length = true;
    Vertices rope = Vertices::Zero(3, 3);
    rope.row(0) << 0, 1, 4;
    for (const bool single : {false, true}) {
        const Mesh mesh = mesh_of(rope, {{0, 1}, {1, 2}}, options, single);
        const Eigen::Vector3d expected = 0.7 * Eigen::Vector3d(1, 4, 3) / 8;
        CHECK((masses_of(mesh.scene) - expected).norm() < mesh.scene.kind().rounding());
        for (const auto& spring : mesh.springs)
            CHECK_THAT(spring.stiffness * spring.rest_length, WithinRel(2000, 1e-6));
    }
}

TEST_CASE("mesh: masses by area do not ask at which corner a face begins", "[scene]") {
    MeshOptions options{1000, 100, 0.7};
    options.mass_by_area = true;
    for (const bool single : {false, true}) {
        Random random(19);
        for (const Index corners : {3, 4, 5, 9}) {
            CAPTURE(single, corners);
            // A grid of squares and a regular polygon beside it, mapped to parallelograms and its
            // like.
            Vertices vertices = Vertices::Zero(3, 9 + corners);
            for (Index i = 0; i < 9; ++i)
                vertices.col(i) << static_cast<double>(i % 3), static_cast<double>(i / 3), 0;
            const double n = static_cast<double>(corners), sector = 6.283185307179586 / n;
            for (Index i = 0; i < corners; ++i) {
                const double angle = static_cast<double>(i) * sector;
                vertices.col(9 + i) << 5 + std::cos(angle), std::sin(angle), 0;
            }
            const Vertices x = random_points(random, 3, 3, -1, 1) * vertices;
            const auto masses = [&](Index first) {
                Faces faces;
                for (const Index i : {0, 1, 3, 4}) faces.push_back({i, i + 1, i + 4, i + 3});
                faces.emplace_back(corners);
                std::iota(faces.back().begin(), faces.back().end(), 9);
                for (auto& face : faces) {
                    const auto by = first % static_cast<Index>(face.size());
                    std::rotate(face.begin(), face.begin() + by, face.end());
                }
                // Particles are numbered as vertices where all are used.
                return masses_of(mesh_of(x, faces, options, single).scene);
            };
            const Eigen::VectorXd mass = masses(0);
            const double tolerance = Kind{single}.accumulated();
            for (Index first = 1; first < corners; ++first)
                CHECK((masses(first) - mass).norm() < tolerance * mass.norm());
            for (const auto& [v, quarters] :
                 {std::pair{2, 1}, {6, 1}, {8, 1}, {1, 2}, {3, 2}, {4, 4}})
                CHECK_THAT(mass[v], WithinRel(quarters * mass[0], tolerance));
            CHECK((mass.tail(corners).array() - mass[9]).abs().maxCoeff() < tolerance * mass[9]);
            // Areas n/2 sin(2π/n) and 4, times the map's.
            CHECK_THAT(mass.tail(corners).sum() / mass.head(9).sum(),
                       WithinRel(n * std::sin(sector) / 8, tolerance));
        }
    }
}

TEST_CASE("mesh: stiffness by length: k L is one number, whatever the mesh", "[scene]") {
    MeshOptions options{600, 60, 0.7};
    options.stiffness_by_length = true;
    for_each_patch([&](const Patch& patch, bool single) {
        const Mesh mesh = mesh_of(patch.vertices, patch.faces, options, single);
        double mean = 0;
        for (std::size_t s = 0; s < mesh.stretch_springs; ++s)
            mean += mesh.springs[s].rest_length / static_cast<double>(mesh.stretch_springs);
        for (std::size_t s = 0; s < mesh.springs.size(); ++s) {
            CHECK_THAT(mesh.springs[s].stiffness * mesh.springs[s].rest_length,
                       WithinRel((s < mesh.stretch_springs ? 600 : 60) * mean,
                                 mesh.scene.kind().accumulated()));
        }
    });
}

TEST_CASE("mesh: its damping is the one asked for and changes nothing else", "[scene]") {
    Random random(13);
    for_each_patch([&](const Patch& patch, bool single) {
        MeshOptions options;
        Scene declared = mesh_of(patch.vertices, patch.faces, options, single).scene;
        const double d0 = random.uniform(0, 5), alpha = random.uniform(0, 1e-2);
        options.rayleigh = {d0, alpha};
        const Scene damped = mesh_of(patch.vertices, patch.faces, options, single).scene;
        CHECK(damped.mass_proportional() == d0);
        CHECK(damped.stiffness_proportional() == alpha);
        declared.set_rayleigh(d0, alpha);
        auto state = damped.initial_state();
        state.v = random_points(random, 3, damped.size(), -1, 1);
        CHECK(damped.force(state) == declared.force(state));
    });
}

TEST_CASE("mesh: bad input: faces", "[scene][bad_input]") {
    const auto wrong = [](const Faces& faces, std::initializer_list<const char*> words) {
        CHECK(refused(scattered(4), faces, {}, words) == "");
    };
    wrong({}, {"springs_from_mesh", "no faces"});
    wrong({{0, 1, 2}, {0}}, {"face 1", "1 corners", "at least 2"});
    wrong({{}}, {"face 0", "0 corners", "at least 2"});
    wrong({{0, 1}, {2, 2}}, {"face 1", "vertex 2 twice"});
    wrong({{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}, {"face 2", "vertex 4", "4 vertices"});
    wrong({{0, -1, 2}}, {"face 0", "vertex -1", "4 vertices"});
    wrong({{0, 1, 2, 1}}, {"face 0", "vertex 1 twice"});
}

TEST_CASE("mesh: bad input: options and vertices", "[scene][bad_input]") {
    const auto wrong = [](const MeshOptions& options, std::initializer_list<const char*> words) {
        CHECK(refused(scattered(3), {{0, 1, 2}}, options, words) == "");
    };
    for (const double bad : {-1.0, not_a_number, std::numeric_limits<double>::infinity()}) {
        wrong({bad, 100, 0.3}, {"springs_from_mesh", "stretch is ", ">= 0"});
        wrong({1000, bad, 0.3}, {"springs_from_mesh", "bend is ", ">= 0"});
        wrong({1000, 100, bad}, {"mass", " is ", "> 0"});
        MeshOptions damped;
        damped.rayleigh = {bad, 0};
        wrong(damped, {"mass_proportional is ", ">= 0"});
        damped.rayleigh = {0, bad};
        wrong(damped, {"stiffness_proportional is ", ">= 0"});
    }
    wrong({1000, 100, 0}, {"mass", " is 0", "> 0"});
    Vertices broken = scattered(4);
    broken(1, 3) = not_a_number;
    CHECK(refused(broken, {{0, 1, 2}}, {}, {}) == "");
    // The message must name the vertex of the mesh, not the particle that it would have become.
    CHECK(refused(broken, {{0, 1, 3}}, {}, {"vertex 3", "finite"}) == "");
    // What masses and stiffness cannot be had by.
    MeshOptions by_area, by_length;
    by_area.mass_by_area = by_length.stiffness_by_length = true;
    Vertices flat = Vertices::Zero(3, 5);
    flat.topRows(2) << 0, 1, 0, 1, 2, 0, 0, 1, 1, 2;
    const Faces with_line{{0, 1, 2}, {2, 1, 3}, {3, 4}};
    CHECK(refused(flat, with_line, by_area, {"mass_by_area", "vertex 4", "area"}) == "");
    CHECK(mesh_of(flat, with_line, by_length).springs.size() > 0);
    CHECK(refused(1e200 * flat, {{0, 1, 2}}, by_area, {"mass_by_area", "finite area"}) == "");
    CHECK(refused(Vertices::Zero(3, 3), {{0, 1, 2}}, by_area, {"mass_by_area", "vertex 0"}) == "");
    flat.col(4) = flat.col(3);
    CHECK(refused(flat, with_line, by_length,
                  {"stiffness_by_length", "vertices 3 and 4", "coincide"}) == "");
}

}  // namespace taut_test::mesh_test
