// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <array>
#include <fstream>
#include <sstream>
#include <string>
#include <taut/mesh_files/obj.hpp>
#include <taut/scene/cloth.hpp>
#include <vector>

#include "../support/catch.hpp"
#include "../support/random.hpp"
#include "../support/message.hpp"
#include "../support/temporary_file.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::obj_test {

namespace {

using Faces = taut::MeshFaces;

struct Mesh {
    std::vector<Eigen::Vector3d> vertices;
    Faces faces;
    taut::MeshEdges edges;
    bool understood = true;
};

/// The `v`, `f` and `l` lines of an OBJ file, corners counted from 0.
Mesh read(const std::string& path) {
    Mesh mesh;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string kind;
        words >> kind;
        if (kind == "v") {
            Eigen::Vector3d x;
            words >> x[0] >> x[1] >> x[2];
            mesh.vertices.push_back(x);
            mesh.understood = mesh.understood && words && (words >> std::ws).eof();
        } else if (kind == "f") {
            mesh.faces.emplace_back();
            for (Index corner = 0; words >> corner;) mesh.faces.back().push_back(corner - 1);
            mesh.understood = mesh.understood && words.eof();
        } else if (kind == "l") {
            std::array<Index, 2> ends{};
            words >> ends[0] >> ends[1];
            mesh.edges.push_back({ends[0] - 1, ends[1] - 1});
            mesh.understood = mesh.understood && words && (words >> std::ws).eof();
        } else {
            mesh.understood = false;
        }
    }
    return mesh;
}

}  // namespace

TEMPLATE_TEST_CASE("obj: vertices, faces and edges are read back as written", "[io]",
                   (Case<float, 1>), (Case<float, 3>), (Case<double, 2>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    const TemporaryFile file("obj_round_trip_" + std::to_string(sizeof(Scalar)) + "_" +
                             std::to_string(Dim) + ".obj");
    Random random(1);
    const auto x = random.points<Scalar, Dim>(9, -100, 100);
    const Faces faces{{0, 1, 2}, {5, 4, 3, 8}, {0, 2, 4, 6, 7}};
    const taut::MeshEdges edges{{8, 0}, {3, 4}};
    REQUIRE(taut::write_obj(file.path, x, faces, edges));
    const auto mesh = read(file.path);
    CHECK(mesh.understood);
    CHECK(mesh.faces == faces);
    CHECK(mesh.edges == edges);
    REQUIRE(mesh.vertices.size() == 9);
    for (Index i = 0; i < 9; ++i) {
        for (int d = 0; d < 3; ++d) {
            const double expected = d < Dim ? static_cast<double>(x(d < Dim ? d : 0, i)) : 0;
            // Numbers of float precision: they come back to the bit.
            CHECK(static_cast<float>(mesh.vertices[static_cast<std::size_t>(i)][d]) ==
                  static_cast<float>(expected));
        }
    }
}

TEST_CASE("obj: a state without faces is a cloud of points", "[io]") {
    const TemporaryFile file("obj_cloud.obj");
    const auto cloth = taut::hanging_cloth<double>({3, 3});
    REQUIRE(taut::write_obj(file.path, cloth.initial_state().x, {}));
    const auto mesh = read(file.path);
    CHECK(mesh.understood);
    CHECK(mesh.vertices.size() == 9);
    CHECK(mesh.faces.empty());
}

TEST_CASE("obj: a file is replaced as a whole", "[io]") {
    const TemporaryFile file("obj_replaced.obj");
    Random random(2);
    REQUIRE(taut::write_obj(file.path, random.points<double, 3>(20, -1, 1), {{0, 1, 2}}));
    REQUIRE(taut::write_obj(file.path, random.points<double, 3>(4, -1, 1), {}));
    CHECK(read(file.path).vertices.size() == 4);
}

TEST_CASE("obj: bad input: a path that cannot be written is named", "[io][bad_input]") {
    const taut::Points<double, 3> x = taut::Points<double, 3>::Zero(3, 2);
    const auto report = taut::write_obj("no_such_directory/mesh.obj", x, {});
    CHECK(report.status == taut::FileStatus::not_opened);
    CHECK_THAT(report.message(), ContainsSubstring("no_such_directory/mesh.obj: cannot"));
    CHECK_FALSE(taut::write_obj("", x, {}));
    CHECK_THAT(message_of([&] {
                   (void)taut::write_obj("not_written.obj", x, {{0, 1, 2}});
               }),
               ContainsSubstring("face 0 has the corner 2; there are 2 positions"));
    CHECK_THAT(message_of([&] {
                   (void)taut::write_obj("not_written.obj", x, {}, {{0, 1}, {-1, 0}});
               }),
               ContainsSubstring("edge 1 has the end -1; there are 2 positions"));
    CHECK_FALSE(std::ifstream("not_written.obj"));
}

#ifdef __linux__
TEST_CASE("obj: bad input: a full disk is told from a missing folder", "[io][bad_input]") {
    const taut::Points<double, 3> x = taut::Points<double, 3>::Zero(3, 2);
    if (!std::ifstream("/dev/full")) return;
    CHECK(taut::write_obj("/dev/full", x, {}).status == taut::FileStatus::not_written);
}
#endif

}  // namespace taut_test::obj_test
