// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>
#include <taut/scene/mesh.hpp>
#include <utility>
#include <vector>

#include "../../examples/common/mesh_file.hpp"
#include "../support/catch.hpp"
#include "../support/random.hpp"
#include "../support/temporary_file.hpp"

namespace taut_test::mesh_file_test {

namespace {

using Faces = std::vector<std::vector<Index>>;

/// A text and the mesh that it means.
struct Written {
    std::string text;
    std::vector<Eigen::Vector3d> vertices;
    Faces faces;
    std::vector<long long> mesh_lines;  // those of v, f and l, from 1
    int skipped = 0;                    // statements that no reader of meshes knows
    long long first_skipped = 0;        // the line of the first
};

/// Writes meshes in all the ways that the format allows.
class Writer {
public:
    explicit Writer(std::uint32_t seed) : random_(seed) {
        static constexpr const char* ends[] = {"\n", "\r\n", "\r"};
        end_ = ends[seed % 3];
        if (seed % 7 == 0) out_.text = "\xEF\xBB\xBF";
        unknown_ = seed % 4 == 0;
    }

    Written mesh(Index vertices, Index faces, Index most_corners) {
        for (Index i = 0; i < vertices / 2; ++i) add_vertex();
        for (Index f = 0; f < faces; ++f) {
            const auto known = static_cast<Index>(out_.vertices.size());
            if (known < vertices && random_.below(3) == 0) add_vertex();
            if (random_.below(4) == 0) add_other();
            if (unknown_ && random_.below(4) == 0) add_unknown();
            const Index most = std::min(most_corners, vertices);
            const Index corners = 2 + random_.below(random_.below(5) == 0 ? most - 1 : 4);
            const bool line = corners == 2 || random_.below(4) == 0;
            line ? add_line(corners, vertices) : add_face(corners, vertices);
        }
        while (static_cast<Index>(out_.vertices.size()) < vertices) add_vertex();
        if (random_.below(2) == 0) out_.text.erase(out_.text.size() - end_.size());
        return std::move(out_);
    }

private:
    std::string blanks() {
        static constexpr const char* some[] = {" ", "  ", "\t", " \t "};
        return some[random_.below(4)];
    }
    void end_line() {
        out_.text += end_;
        ++line_;
    }
    /// A statement of these words, broken where it may be.
    void add_statement(const std::vector<std::string>& words) {
        if (words[0] == "v" || words[0] == "f" || words[0] == "l") out_.mesh_lines.push_back(line_);
        if (random_.below(6) == 0) out_.text += blanks();
        for (std::size_t w = 0; w < words.size(); ++w) {
            if (w > 0) out_.text += blanks();
            if (w > 0 && random_.below(12) == 0) {
                out_.text += "\\";
                end_line();
                if (random_.below(2) == 0) out_.text += blanks();
            }
            out_.text += words[w];
        }
        if (random_.below(6) == 0) out_.text += blanks();
        if (random_.below(10) == 0) out_.text += " # 1 2 3 \\";
        end_line();
    }
    void add_vertex() {
        const auto x = random_.vector<double, 3>(-10, 10);
        std::vector<std::string> words{"v"};
        for (int d = 0; d < 3; ++d) {
            static constexpr const char* formats[] = {"%.17g", "%+.17e", "%.17E"};
            char text[40];
            std::snprintf(text, sizeof text, formats[random_.below(3)], x[d]);
            words.push_back(text);
        }
        const Index more = random_.below(8);  // a weight, or a colour
        if (more == 0) words.push_back("1");
        if (more == 1) words.insert(words.end(), {"0.5", "1", "0"});
        out_.vertices.push_back(x);
        add_statement(words);
    }
    void add_other() {
        static const std::vector<std::string> others[] = {
            {"# a comment"}, {"# C:\\meshes\\"}, {"g", "a", "b"},       {"o", "it's"},
            {"s", "off"},    {"usemtl", "0x10"}, {"mtllib", "a.mtl"},   {"vt", "0.5", "0.5"},
            {"p", "1"},      {"vn", "0 0 1"},    {"vp", "0.1", "0.25"}, {""}};
        add_statement(others[random_.below(12)]);
    }
    void add_unknown() {
        static const std::vector<std::string> unknown[] = {
            {"vv", "0", "0", "0"},    {"t", "0"},   {"ny", "1", "2", "nan"}, {"end"},
            {"cstype", "bspline"},    {"deg", "3"}, {"call", "other.obj"},   {"F", "1", "2"},
            {"curv", "0", "1", "-9"}, {"parm", "u"}};
        if (out_.skipped++ == 0) out_.first_skipped = line_;
        add_statement(unknown[random_.below(10)]);
    }
    /// `count` different vertices.
    std::vector<Index> choose(Index count, Index vertices) {
        std::vector<Index> all(static_cast<std::size_t>(vertices));
        std::iota(all.begin(), all.end(), Index(0));
        for (Index i = 0; i < count; ++i) std::swap(all[i], all[i + random_.below(vertices - i)]);
        all.resize(static_cast<std::size_t>(count));
        return all;
    }
    std::string number(Index vertex) {
        const auto known = static_cast<Index>(out_.vertices.size());
        const bool relative = vertex < known && random_.below(2) == 0;
        return std::to_string(relative ? vertex - known : vertex + 1);
    }
    void add_face(Index count, Index vertices) {
        out_.faces.push_back(choose(count, vertices));
        static constexpr const char* tails[] = {"", "/7", "//-3", "/7/3"};
        const std::string tail = tails[random_.below(4)];
        std::vector<std::string> words{"f"};
        for (const Index vertex : out_.faces.back()) words.push_back(number(vertex) + tail);
        add_statement(words);
    }
    void add_line(Index count, Index vertices) {
        auto corners = choose(count, vertices);
        if (random_.below(3) == 0 && count > 2) corners.push_back(corners[0]);
        const std::string tail = random_.below(2) == 0 ? "" : "/5";
        std::vector<std::string> words{"l"};
        for (std::size_t i = 0; i < corners.size(); ++i) {
            words.push_back(number(corners[i]) + tail);
            if (i > 0) out_.faces.push_back({corners[i - 1], corners[i]});
        }
        add_statement(words);
    }

    Random random_;
    std::string end_;
    bool unknown_;
    Written out_;
    long long line_ = 1;
};

struct MeshText : TemporaryFile {
    explicit MeshText(const std::string& text) : TemporaryFile("mesh_file.obj") {
        std::ofstream(path, std::ios::binary) << text;
    }
};

/// The reader's complaint about a text; empty if there is none.
std::string complaint(const std::string& text) {
    const MeshText file(text);
    try {
        (void)example::read_obj(file.path);
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return {};
}

/// The same mesh, read and meant.
void check_read(const Written& written) {
    const MeshText file(written.text);
    std::ostringstream warnings;
    const auto mesh = example::read_obj(file.path, warnings);
    REQUIRE(mesh.vertices.cols() == static_cast<Index>(written.vertices.size()));
    bool same = true;
    for (Index i = 0; i < mesh.vertices.cols(); ++i)
        same = same && mesh.vertices.col(i) == written.vertices[static_cast<std::size_t>(i)];
    CHECK(same);
    CHECK((mesh.faces == written.faces));
    if (written.skipped == 0) {
        CHECK(mesh.skipped == "");
        CHECK(warnings.str() == "");
    } else {
        CHECK_THAT(mesh.skipped,
                   ContainsSubstring("skipped " + std::to_string(written.skipped) + " statement") &&
                       ContainsSubstring("in line " + std::to_string(written.first_skipped)));
        CHECK(warnings.str() == file.path + ": " + mesh.skipped + "\n");
    }
}

std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> words(1);
    for (const char c : text) {
        if (c == ' ') words.emplace_back();
        if (c != ' ') words.back() += c;
    }
    return words;
}

const std::string corners_of_square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

}  // namespace

TEST_CASE("mesh_file: what was written is read, however it was written", "[programs]") {
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        INFO("seed " << seed);
        check_read(Writer(seed).mesh(8 + seed % 5, 20, 8));
    }
}

TEST_CASE("mesh_file: what other programs write is read, and what is skipped is counted",
          "[programs]") {
    const std::vector<Eigen::Vector3d> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const auto reads = [&](const std::string& text, const Faces& faces,
                           const std::string& skipped = "") {
        INFO(text);
        const MeshText file(text);
        std::ostringstream warnings;
        const auto mesh = example::read_obj(file.path, warnings);
        REQUIRE(mesh.vertices.cols() >= 4);
        for (Index v = 0; v < 4; ++v) CHECK(mesh.vertices.col(v) == square[std::size_t(v)]);
        CHECK((mesh.faces == faces));
        CHECK(mesh.skipped == skipped);
    };
    // Blender: colours behind the places, a loose edge, and a NURBS path beside the cloth.
    reads(
        "# Blender 4.2.1 LTS\n# www.blender.org\nmtllib cloth.mtl\no Plane\n"
        "v 0.000000 0.000000 0.000000 0.8000 0.8000 0.8000\nv 1.000000 0.000000 0.000000 1 0 0\n"
        "v 1.000000 1.000000 0.000000 0 1 0\nv 0.000000 1.000000 0.000000 0 0 1\n"
        "vn -0.0000 -0.0000 1.0000\nvt 0.000000 0.000000\ns 0\nusemtl Material.001\n"
        "f 1/1/1 2/1/1 3/1/1 4/1/1\nl 1 3\no NurbsPath\nv -1.5 0 0\nv -1 0 0\nv 1 0 0\n"
        "v 1.5 0 0\ng NurbsPath\ncstype bspline\ndeg 3\ncurv 0.0 1.0 -1 -2 -3 -4\n"
        "parm u 0.0 0.0 0.0 0.0 1.0 1.0 1.0 1.0\nend\n",
        {{0, 1, 2, 3}, {0, 2}},
        "skipped 5 statements, the first in line 21 (1 \"cstype\", 1 \"curv\", 1 \"deg\", "
        "1 \"end\", 1 \"parm\")");
    // Maya: lines end in CR LF; groups have no name or several.
    reads(
        "# This file uses centimeters as units for non-parametric coordinates.\r\n\r\n"
        "mtllib pPlane1.mtl\r\ng default\r\nv 0.000000 0.000000 0.000000\r\n"
        "v 1.000000 0.000000 0.000000\r\nv 1.000000 1.000000 -0.000000\r\n"
        "v 0.000000 1.000000 0.000000\r\nvt 0.000000 0.000000\r\nvn 0.000000 0.000000 1.000000"
        "\r\ns off\r\ng pPlane1 set1\r\nusemtl initialShadingGroup\r\n"
        "f 1/1/1 2/1/1 3/1/1\r\nf 1/1/1 3/1/1 4/1/1\r\ng\r\n",
        {{0, 1, 2}, {0, 2, 3}});
    // Marvelous Designer and CLO: names of patterns and fabrics have blanks, and letters of any
    // alphabet.
    reads(
        "# Exported from a garment program\r\nmtllib T shirt.mtl\r\no Pattern2D_1 Front\r\n"
        "g \xEC\x95\x9E\xED\x8C\x90\r\nv  0 0 0\r\nv  1 0 0\r\nv  1 1 0\r\nv  0 1 0\r\n"
        "vt  0 0\r\nvt  1 0\r\nvn  0 0 1\r\nusemtl FABRIC 1_FRONT_4193\r\ns 1\r\n"
        "f  1/1/1 2/2/1 3/1/1 \r\nf  1/1/1 3/1/1 4/2/1 \r\n",
        {{0, 1, 2}, {0, 2, 3}});
    // ARCSim: velocities, rest places, labels and damage beside vertices, edges and faces.
    reads(
        "vt 0 0\nvl 1\nv 0 0 0\nvv 0 0 0\nv 1 0 0\nvv 0 0 0\nny 1 0 0\nv 1 1 0\nnv 0 0 1\n"
        "nl 2\nv 0 1 0\ne 1 2\nea 0.1\nel 1\nf 1/1 2/1 3/1\nt 0\ntl 4\nf 1/1 3/1 4/1\nt 0\n",
        {{0, 1, 2}, {0, 2, 3}},
        "skipped 12 statements, the first in line 2 (1 \"e\", 1 \"ea\", 1 \"el\", 1 \"nl\", "
        "1 \"nv\", ...)");
}

TEST_CASE("mesh_file: faces and lines have any number of corners", "[programs]") {
    for (std::uint32_t seed = 0; seed < 12; ++seed) {
        INFO("seed " << seed);
        check_read(Writer(seed).mesh(1000, 40, 1000));
    }
    for (const Index corners : {254, 255, 256, 257, 300, 511, 512, 65536}) {
        INFO(corners << " corners");
        std::string vertices, face = "f";
        for (Index i = 1; i <= corners; ++i) {
            vertices += "v 0 0 " + std::to_string(i) + "\n";
            face += " " + std::to_string(i);
        }
        const MeshText file(vertices + face + "\nf 1 2 3\n");
        const auto mesh = example::read_obj(file.path);
        REQUIRE(mesh.faces.size() == 2);
        CHECK(static_cast<Index>(mesh.faces[0].size()) == corners);
        CHECK(mesh.faces[1] == std::vector<Index>{0, 1, 2});
    }
}

TEST_CASE("mesh_file: a face of 300 corners with 300 quads at it keeps all its particles",
          "[programs]") {
    const Index n = 300;
    std::string text, polygon = "f";
    for (const double radius : {1.0, 1.1}) {
        for (Index i = 0; i < n; ++i) {
            const double angle = 6.283185307179586 * static_cast<double>(i) / n;
            text += "v " + std::to_string(radius * std::cos(angle)) + " 0 " +
                    std::to_string(radius * std::sin(angle)) + "\n";
        }
    }
    for (Index i = 1; i <= n; ++i) polygon += " " + std::to_string(i);
    text += polygon + "\n";
    for (Index i = 0; i < n; ++i) {
        const Index j = (i + 1) % n;
        for (const Index corner : {i, j, j + n, i + n})
            text += (corner == i ? "f " : " ") + std::to_string(corner + 1);
        text += "\n";
    }
    const MeshText file(text);
    const auto mesh = example::read_obj(file.path);
    const auto springs = taut::springs_from_mesh<double>(mesh.vertices, mesh.faces);
    CHECK(springs.system.size() == 2 * n);
    CHECK(springs.unused_vertices == 0);
    // The polygon's fan has 2n − 3 edges, and each quad brings its far side, a spoke and two
    // diagonals.
    CHECK(springs.stretch_springs == 2 * n - 3 + 4 * n);
    CHECK(springs.bend_springs == n - 3);
}

TEST_CASE("mesh_file: bad input: a word that is no number is refused by its line",
          "[programs][bad_input]") {
    const std::string nul(1, '\0');
    auto no_numbers = split(
        "0x10 nan inf 1e999 1..2 1e --1 1,5 x 1\v3 1\f3 1d0 1\\2 0x 1x 1\x1b[ +-1 1_0 infinity "
        "1\xC2\xA0 1e1.5");
    no_numbers.insert(no_numbers.end(), {nul, "1" + nul});
    auto no_corners = split(
        "0 1.9 1x 1e0 /1 1/2/3/4 1/x 99999 -99999 0x1 nan 1\v2 1//x +-1 4294967297 1\\2 "
        "9223372036854775808 -9223372036854775808");
    no_corners.insert(no_corners.end(), {"1 x", "1" + nul + "2"});
    for (std::uint32_t seed = 0; seed < 300; ++seed) {
        Random random(seed);
        const auto& words = seed % 2 == 0 ? no_numbers : no_corners;
        const auto& word = words[random.below(static_cast<Index>(words.size()))];
        std::vector<std::string> numbers{"1", "2", "3"};
        numbers[random.below(3)] = word;
        const char* kinds[] = {"v", "f", "l"};
        std::string line = kinds[seed % 2 == 0 ? 0 : 1 + random.below(2)];
        for (const auto& number : numbers) line += " " + number;
        std::string text = corners_of_square;
        const Index before = random.below(4);
        for (Index i = 0; i < before; ++i) text += "f 1 2 3\n";
        text += line + "\nf 1 3 4\n";
        INFO("seed " << seed << ": " << line);
        const std::string at = "mesh_file.obj:" + std::to_string(5 + before) + ": ";
        CHECK_THAT(complaint(text), ContainsSubstring(at));
    }
}

TEST_CASE("mesh_file: bad input: what is no line of a mesh is refused", "[programs][bad_input]") {
    const auto refused = [](const std::string& line) {
        return complaint(corners_of_square + line + "\nf 1 2 3\n");
    };
    CHECK(refused("l 1 2") == "");
    CHECK_THAT(refused("f 1 2"), ContainsSubstring("a face needs three corners"));
    for (const std::string line :
         {"v 1", "v 1 2", "v", "f 1", "f", "l 3", "l", "f 1 1", "f 1 2 -4", "f 1 2 3 2", "l 2 2",
          "l 1 2 2 3", "v\v1\v2\v3", "f 1 2", "f 1/1 2/2", "1 2 3", "-1 2", "f\x01 1 2 3"}) {
        INFO(line);
        CHECK_THAT(refused(line), ContainsSubstring("mesh_file.obj:5: "));
    }
    // The line of the largest corner, not the last one.
    CHECK_THAT(complaint("f 1 2 3\nf 1 2 7\n" + corners_of_square),
               ContainsSubstring("mesh_file.obj:2: ") && ContainsSubstring("vertex 7"));
    // A relative corner counts the vertices so far.
    CHECK_THAT(complaint("v 0 0 0\nv 1 0 0\nf -1 -2 -3\nv 0 1 0\n"),
               ContainsSubstring("mesh_file.obj:3: ") && ContainsSubstring("-3"));
    // Where a line ends inside a number it is not said what the number is.
    CHECK_THAT(complaint(corners_of_square + "f 1 2 3\\\n4\n"),
               ContainsSubstring("mesh_file.obj:5: "));
    CHECK_THAT(complaint(corners_of_square + "f 1 2 3 \\"), ContainsSubstring("mesh_file.obj:5: "));
    CHECK_THAT(complaint(corners_of_square + "\xFF\xFE\n"), ContainsSubstring("mesh_file.obj:5: "));
    CHECK_THAT(complaint(corners_of_square), ContainsSubstring("4 vertices and 0 faces"));
    CHECK_THAT(complaint(""), ContainsSubstring("0 vertices and 0 faces"));
    CHECK_THAT(complaint(std::string(1000, '\x1b')), !ContainsSubstring("\x1b"));
    CHECK(complaint(std::string(1000, 'x')).size() < 200);
}

}  // namespace taut_test::mesh_file_test
