// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <array>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/temporary_file.hpp"
#include "../support/tolerance.hpp"
#include "vtk_scenes.hpp"

namespace taut_test::vtk_test {

namespace {

/// What a legacy file says, read by its grammar: sections with their counts, in any order.
struct Document {
    bool understood = false;
    std::vector<Eigen::Vector3d> points;
    std::vector<std::array<Index, 2>> lines;
    std::map<std::string, std::vector<double>> cells, vertices;  // values by name
};

bool read_array(std::istream& in, const std::string& kind, std::size_t count, Document& document,
                bool of_cells) {
    std::string name, type, word;
    in >> name >> type;
    std::size_t width = 3;
    if (kind == "SCALARS") {
        in >> width >> word;
        if (word != "LOOKUP_TABLE") return false;
        in >> word;
    }
    auto& values = of_cells ? document.cells[name] : document.vertices[name];
    values.resize(count * width);
    for (double& value : values) in >> value;
    return bool(in);
}

Document read(const TemporaryFile& file) {
    std::istringstream in(file.bytes());
    Document document;
    std::string line, word, type;
    std::getline(in, line);
    const bool legacy = line.rfind("# vtk DataFile Version ", 0) == 0;
    std::getline(in, line);
    in >> word >> type >> line;
    if (!legacy || word != "ASCII" || type != "DATASET" || line != "POLYDATA") return document;
    std::size_t count = 0, numbers = 0;
    bool of_cells = false;
    while (in >> word) {
        if (word == "POINTS") {
            in >> count >> type;
            document.points.resize(count);
            for (auto& p : document.points) in >> p[0] >> p[1] >> p[2];
        } else if (word == "LINES") {
            in >> count >> numbers;
            if (numbers != 3 * count) return document;
            document.lines.resize(count);
            for (auto& ends : document.lines) {
                in >> numbers >> ends[0] >> ends[1];
                if (numbers != 2) return document;
            }
        } else if (word == "CELL_DATA" || word == "POINT_DATA") {
            in >> count;
            of_cells = word == "CELL_DATA";
            if (count != (of_cells ? document.lines.size() : document.points.size())) {
                return document;
            }
        } else if (word == "SCALARS" || word == "VECTORS") {
            if (!read_array(in, word, count, document, of_cells)) return document;
        } else {
            return document;
        }
        if (!in) return document;
    }
    document.understood = true;
    return document;
}

}  // namespace

TEST_CASE("vtk: the tensions read back, laid along the lines, are the forces", "[io]") {
    const TemporaryFile file("tangle.vtk");
    auto kinds = kinds_of(Laws::any);
    kinds.push_back({true, 2, Laws::mixed});
    for (const Kind& kind : kinds) {
        for (std::uint32_t seed = 1; seed <= 5; ++seed) {
            CAPTURE(kind, seed);
            Random random(seed);
            const Scene scene = random_scene(random, kind, {12, 14, 1, false, false, false});
            auto state = scene.initial_state();
            state.v = random_points(random, kind.dim, 12, -3, 3);
            REQUIRE(write_vtk(file.path, scene, state));
            const auto found = read(file);
            REQUIRE(found.understood);
            REQUIRE(found.points.size() == 12);
            REQUIRE(found.lines.size() == static_cast<std::size_t>(scene.spring_count()));
            const auto& tension = found.cells.at("tension");

            Eigen::Matrix3Xd force = Eigen::Matrix3Xd::Zero(3, 12);
            double scale = 0;
            for (std::size_t s = 0; s < tension.size(); ++s) {
                const auto [a, b] = found.lines[s];
                const Eigen::Vector3d along = (found.points[static_cast<std::size_t>(b)] -
                                               found.points[static_cast<std::size_t>(a)])
                                                  .stableNormalized();
                force.col(a) += tension[s] * along;
                force.col(b) -= tension[s] * along;
                scale = std::max(scale, std::abs(tension[s]));
            }
            AnyState still = state;
            still.v.setZero();
            const double written = 1e-7;  // nine digits of positions some 1e-2 apart
            CHECK(distance(force.topRows(kind.dim), scene.force(still)) <=
                  scale * (written + kind.accumulated()));

            for (Index i = 0; i < 12; ++i) {
                const auto at = static_cast<std::size_t>(i);
                CHECK(found.vertices.at("pinned")[at] == (i == 0 ? 1 : 0));
                CHECK_THAT(found.vertices.at("mass")[at], WithinRel(scene.mass(i), 1e-8));
                CHECK_THAT(found.vertices.at("velocity")[3 * at], WithinAbs(state.v(0, i), 1e-7));
            }
            CHECK(found.cells.at("law").front() == 0);
            CHECK(found.cells.at("law").back() == static_cast<double>(laws_of(kind).size() - 1));
        }
    }
}

TEST_CASE("vtk: strain is the change of length, and a spring of no length has neither", "[io]") {
    const TemporaryFile file("strain.vtk");
    Scene scene({false, 3, Laws::any});
    for (const double x : {0, 1, 0}) scene.add_particle(Eigen::Vector3d(x, 0, 0), 1);
    scene.add_spring({0, 1, 100, 0.8});
    scene.add_spring({0, 2, 100, 0.5});  // its ends meet
    scene.add_spring({0, 1, 100, 0});
    REQUIRE(write_vtk(file.path, scene, scene.initial_state()));
    const auto found = read(file);
    REQUIRE(found.understood);
    CHECK_THAT(found.cells.at("strain")[0], WithinRel(0.25, 1e-8));
    CHECK_THAT(found.cells.at("tension")[0], WithinRel(20, 1e-8));
    CHECK(found.cells.at("strain")[1] == -1);
    CHECK(found.cells.at("tension")[1] == 0);
    CHECK(found.cells.at("strain")[2] == 0);
    CHECK_THAT(found.cells.at("tension")[2], WithinRel(100, 1e-8));
}

TEST_CASE("vtk: bad input: a path, a size or a position that cannot be written",
          "[io][bad_input]") {
    Scene scene({true, 2, Laws::mixed});
    scene.add_particle(Eigen::Vector2d(0, 0), 1);
    scene.add_particle(Eigen::Vector2d(1, 0), 1);
    auto state = scene.initial_state();
    const auto report = write_vtk("no_such_directory/state.vtk", scene, state);
    CHECK(report.status == taut::FileStatus::not_opened);
    CHECK_THAT(report.message(), ContainsSubstring("no_such_directory/state.vtk: cannot"));
    state.x(0, 1) = std::numeric_limits<double>::quiet_NaN();
    CHECK(write_vtk("not_written.vtk", scene, state).where == 1);
    CHECK_FALSE(std::ifstream("not_written.vtk"));
    state.x(0, 1) = 1;
    state.v(1, 0) = std::numeric_limits<double>::infinity();
    CHECK(write_vtk("not_written.vtk", scene, state).where == 0);
    state.x.resize(2, 1);
    CHECK_THAT(message_of([&] { (void)write_vtk("not_written.vtk", scene, state); }),
               ContainsSubstring("1 positions and 2 velocities; the system has 2 particles"));
}

}  // namespace taut_test::vtk_test
