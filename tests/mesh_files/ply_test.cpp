// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <taut/mesh_files/ply.hpp>
#include <vector>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random.hpp"
#include "../support/temporary_file.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::ply_test {

namespace {

/// Each value of an element: one number, or a list of them.
using Row = std::vector<std::vector<double>>;

/// A binary little-endian PLY file, read by what its own header declares.
struct Document {
    bool understood = false;
    std::map<std::string, std::vector<std::string>> properties;  // by element, their names
    std::map<std::string, std::vector<Row>> rows;                // by element
};

template <class Number, class Bits>
bool read_as(std::istream& in, double& value) {
    Bits bits = 0;
    for (std::size_t i = 0; i < sizeof bits; ++i) {
        bits = static_cast<Bits>(bits | static_cast<Bits>(in.get()) << (8 * i));
    }
    Number number;
    std::memcpy(&number, &bits, sizeof number);
    value = static_cast<double>(number);
    return bool(in);
}

bool read_number(std::istream& in, const std::string& type, double& value) {
    if (type == "uchar") return read_as<std::uint8_t, std::uint8_t>(in, value);
    if (type == "int") return read_as<std::int32_t, std::uint32_t>(in, value);
    if (type == "float") return read_as<float, std::uint32_t>(in, value);
    return false;
}

struct Property {
    std::string count;  // type of a list's length, or empty
    std::string type;
};

bool read_row(std::istream& in, const std::vector<Property>& properties, Row& row) {
    for (const auto& property : properties) {
        double count = 1;
        if (!property.count.empty() && !read_number(in, property.count, count)) return false;
        row.emplace_back(static_cast<std::size_t>(count));
        for (double& value : row.back()) {
            if (!read_number(in, property.type, value)) return false;
        }
    }
    return true;
}

Document read(const TemporaryFile& file) {
    Document document;
    std::istringstream in(file.bytes());
    std::string line, word, name;
    std::getline(in, line);
    if (line != "ply") return document;
    std::getline(in, line);
    if (line != "format binary_little_endian 1.0") return document;
    std::vector<std::string> elements;
    std::vector<std::size_t> counts;
    std::vector<std::vector<Property>> types;
    while (std::getline(in, line) && line != "end_header") {
        std::istringstream words(line);
        words >> word >> name;
        if (word == "element") {
            elements.push_back(name);
            words >> counts.emplace_back();
            types.emplace_back();
        } else if (word == "property" && !types.empty()) {
            Property property{{}, name};
            if (name == "list") words >> property.count >> property.type;
            words >> name;
            types.back().push_back(property);
            document.properties[elements.back()].push_back(name);
        } else {
            return document;
        }
        if (!words || !(words >> std::ws).eof()) return document;
    }
    for (std::size_t e = 0; e < elements.size(); ++e) {
        auto& rows = document.rows[elements[e]];
        rows.resize(counts[e]);
        for (Row& row : rows) {
            if (!read_row(in, types[e], row)) return document;
        }
    }
    document.understood = in.peek() == std::istringstream::traits_type::eof();
    return document;
}

}  // namespace

TEMPLATE_TEST_CASE("ply: vertices, faces and edges are read back as written", "[io]",
                   (Case<float, 1>), (Case<float, 3>), (Case<double, 2>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    const TemporaryFile file("ply_round_trip_" + std::to_string(sizeof(Scalar)) +
                             std::to_string(Dim) + ".ply");
    Random random(1);
    const auto x = random.points<Scalar, Dim>(300, -100, 100);
    taut::MeshFaces faces{{0, 1, 2}, {5, 4, 3, 8}, {}};
    for (Index corner = 0; corner < 255; ++corner) faces.back().push_back(299 - corner);
    const taut::MeshEdges edges{{299, 0}, {3, 256}, {4, 4}};
    REQUIRE(taut::write_ply(file.path, x, faces, edges));
    auto found = read(file);
    REQUIRE(found.understood);
    CHECK(found.properties["vertex"] == std::vector<std::string>{"x", "y", "z"});
    CHECK(found.properties["face"] == std::vector<std::string>{"vertex_indices"});
    CHECK(found.properties["edge"] == std::vector<std::string>{"vertex1", "vertex2"});
    REQUIRE(found.rows["vertex"].size() == 300);
    REQUIRE(found.rows["face"].size() == 3);
    REQUIRE(found.rows["edge"].size() == 3);
    for (Index i = 0; i < 300; ++i) {
        for (int d = 0; d < 3; ++d) {
            // Random's numbers have float precision: they come back to the bit.
            const double expected = d < Dim ? static_cast<double>(x(d < Dim ? d : 0, i)) : 0;
            CHECK(found.rows["vertex"][static_cast<std::size_t>(i)][static_cast<std::size_t>(d)] ==
                  std::vector<double>{expected});
        }
    }
    for (std::size_t f = 0; f < faces.size(); ++f) {
        CHECK(found.rows["face"][f][0] == std::vector<double>(faces[f].begin(), faces[f].end()));
    }
    for (std::size_t e = 0; e < edges.size(); ++e) {
        CHECK(found.rows["edge"][e][0][0] == static_cast<double>(edges[e][0]));
        CHECK(found.rows["edge"][e][1][0] == static_cast<double>(edges[e][1]));
    }
}

TEST_CASE("ply: without edges there is no element of that name, and a file may be empty", "[io]") {
    const TemporaryFile file("ply_cloud.ply");
    for (const Index n : {0, 4}) {
        REQUIRE(taut::write_ply(file.path, Random(2).points<double, 3>(n, -1, 1), {}));
        auto found = read(file);
        CHECK(found.understood);
        CHECK(found.rows["vertex"].size() == static_cast<std::size_t>(n));
        CHECK(found.rows["face"].empty());
        CHECK(found.properties.count("edge") == 0);
    }
}

TEST_CASE("ply: bad input: what cannot be written is named", "[io][bad_input]") {
    taut::Points<double, 3> x = taut::Points<double, 3>::Zero(3, 300);
    const auto report = taut::write_ply("no_such_directory/mesh.ply", x, {});
    CHECK(report.status == taut::FileStatus::not_opened);
    CHECK_THAT(report.message(), ContainsSubstring("no_such_directory/mesh.ply: cannot"));
    const auto refused = [&](const taut::MeshFaces& faces, const taut::MeshEdges& edges) {
        return message_of([&] { (void)taut::write_ply("not_written.ply", x, faces, edges); });
    };
    CHECK_THAT(refused({{0, 1, 2}, {3, 300, 4}}, {}),
               ContainsSubstring("write_ply: face 1 has the corner 300; there are 300 positions"));
    CHECK_THAT(refused({}, {{-1, 0}}), ContainsSubstring("edge 0 has the end -1"));
    CHECK_THAT(refused({taut::MeshFaces::value_type(256, 7)}, {}),
               ContainsSubstring("face 0 has 256 corners; at most 255"));
    x(2, 7) = 1e39;  // a double, but no float
    const auto large = taut::write_ply("not_written.ply", x, {});
    CHECK(large.status == taut::FileStatus::not_finite);
    CHECK(large.where == 7);
    CHECK_FALSE(std::ifstream("not_written.ply"));
}

#ifdef __linux__
TEST_CASE("ply: bad input: a full disk is told from a missing folder", "[io][bad_input]") {
    const taut::Points<double, 3> x = taut::Points<double, 3>::Zero(3, 2);
    if (!std::ifstream("/dev/full")) return;
    CHECK(taut::write_ply("/dev/full", x, {}).status == taut::FileStatus::not_written);
}
#endif

}  // namespace taut_test::ply_test
