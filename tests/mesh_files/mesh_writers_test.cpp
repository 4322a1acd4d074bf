// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <taut/mesh_files/obj.hpp>
#include <taut/mesh_files/ply.hpp>
#include <vector>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random.hpp"
#include "../support/temporary_file.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::mesh_writers_test {

namespace {

using Faces = taut::MeshFaces;
using Edges = taut::MeshEdges;
using Points = taut::Points<double, 3>;

/// What a file says, corners counted from 0.
struct Mesh {
    std::vector<std::vector<double>> vertices;
    Faces faces;
    Edges edges;
    bool understood = true;
};

struct Obj {
    using Sequence = taut::ObjSequence;
    static constexpr const char* extension = ".obj";
    template <class X>
    static taut::FileReport write(const std::string& path, const X& x, const Faces& faces,
                                  const Edges& edges = {}) {
        return taut::write_obj(path, x, faces, edges);
    }
    static Mesh read(const TemporaryFile& file) {
        Mesh mesh;
        std::istringstream lines(file.bytes());
        for (std::string line; std::getline(lines, line);) {
            std::istringstream words(line);
            std::string kind;
            words >> kind;
            std::vector<double> numbers;
            for (double number = 0; words >> number;) numbers.push_back(number);
            const bool plain =
                words.eof() && (kind == "f" || numbers.size() == (kind == "v" ? 3 : 2));
            mesh.understood = mesh.understood && plain;
            if (kind == "v") {
                mesh.vertices.push_back(numbers);
                continue;
            }
            std::vector<Index> corners;
            for (const double number : numbers) corners.push_back(static_cast<Index>(number) - 1);
            if (kind == "f") {
                mesh.faces.push_back(corners);
            } else if (kind == "l" && plain) {
                mesh.edges.push_back({corners[0], corners[1]});
            } else {
                mesh.understood = false;
            }
        }
        return mesh;
    }
};

/// Each value of an element: one number, or a list of them.
using Row = std::vector<std::vector<double>>;

/// A binary little-endian PLY file, read by what its own header declares.
class PlyReader {
public:
    explicit PlyReader(const std::string& bytes) : in_(bytes) {}

    Mesh read() {
        Mesh mesh;
        mesh.understood = read_header() && read_rows() &&
                          in_.peek() == std::istringstream::traits_type::eof() &&
                          names_["vertex"] == " x y z" && names_["face"] == " vertex_indices" &&
                          (rows_.count("edge") == 0 || names_["edge"] == " vertex1 vertex2");
        if (!mesh.understood) return mesh;
        for (const Row& row : rows_["vertex"]) {
            mesh.vertices.push_back({row[0][0], row[1][0], row[2][0]});
        }
        for (const Row& row : rows_["face"]) mesh.faces.emplace_back(row[0].begin(), row[0].end());
        for (const Row& row : rows_["edge"]) {
            mesh.edges.push_back({static_cast<Index>(row[0][0]), static_cast<Index>(row[1][0])});
        }
        return mesh;
    }

private:
    struct Property {
        std::string count;  // type of a list's length, or empty
        std::string type;
    };

    template <class Number, class Bits>
    double number() {
        Bits bits = 0;
        for (std::size_t i = 0; i < sizeof bits; ++i) {
            bits = static_cast<Bits>(bits | static_cast<Bits>(in_.get()) << (8 * i));
        }
        Number read;
        std::memcpy(&read, &bits, sizeof read);
        return static_cast<double>(read);
    }
    double number(const std::string& type) {
        if (type == "uchar") return number<std::uint8_t, std::uint8_t>();
        if (type == "int") return number<std::int32_t, std::uint32_t>();
        if (type != "float") in_.setstate(std::ios::failbit);
        return number<float, std::uint32_t>();
    }
    bool read_header() {
        std::string line, word, name;
        if (!std::getline(in_, line) || line != "ply") return false;
        if (!std::getline(in_, line) || line != "format binary_little_endian 1.0") return false;
        while (std::getline(in_, line) && line != "end_header") {
            std::istringstream words(line);
            words >> word >> name;
            if (word == "element") {
                elements_.push_back(name);
                std::size_t count = 0;
                words >> count;
                rows_[name].resize(count);
            } else if (word == "property" && !elements_.empty()) {
                Property property{{}, name};
                if (name == "list") words >> property.count >> property.type;
                words >> name;
                types_[elements_.back()].push_back(property);
                names_[elements_.back()] += " " + name;
            } else {
                return false;
            }
            if (!words || !(words >> std::ws).eof()) return false;
        }
        return true;
    }
    bool read_rows() {
        for (const auto& element : elements_) {
            for (Row& row : rows_[element]) {
                for (const auto& property : types_[element]) {
                    const double count = property.count.empty() ? 1 : number(property.count);
                    row.emplace_back();
                    for (int i = 0; i < count; ++i) row.back().push_back(number(property.type));
                }
            }
        }
        return bool(in_);
    }

    std::istringstream in_;
    std::vector<std::string> elements_;
    std::map<std::string, std::vector<Property>> types_;
    std::map<std::string, std::string> names_;
    std::map<std::string, std::vector<Row>> rows_;
};

struct Ply {
    using Sequence = taut::PlySequence;
    static constexpr const char* extension = ".ply";
    template <class X>
    static taut::FileReport write(const std::string& path, const X& x, const Faces& faces,
                                  const Edges& edges = {}) {
        return taut::write_ply(path, x, faces, edges);
    }
    static Mesh read(const TemporaryFile& file) { return PlyReader(file.bytes()).read(); }
};

/// Random's numbers have float precision: they come back to the bit.
template <class Format, class Scalar, int Dim>
void check_round_trip() {
    CAPTURE(sizeof(Scalar), Dim);
    const TemporaryFile file(std::string("round_trip") + Format::extension);
    Random random(1);
    const auto x = random.points<Scalar, Dim>(300, -100, 100);
    Faces faces{{0, 1, 2}, {5, 4, 3, 8}, {}};
    for (Index corner = 0; corner < 255; ++corner) faces.back().push_back(299 - corner);
    const Edges edges{{299, 0}, {3, 256}, {4, 4}};
    REQUIRE(Format::write(file.path, x, faces, edges));
    const Mesh mesh = Format::read(file);
    REQUIRE(mesh.understood);
    CHECK(mesh.faces == faces);
    CHECK(mesh.edges == edges);
    REQUIRE(mesh.vertices.size() == 300);
    for (Index i = 0; i < 300; ++i) {
        Eigen::Vector3f expected = Eigen::Vector3f::Zero();
        expected.head<Dim>() = x.col(i).template cast<float>();
        const auto& read = mesh.vertices[static_cast<std::size_t>(i)];
        REQUIRE(Eigen::Vector3d(read.data()).cast<float>() == expected);
    }
}

}  // namespace

TEMPLATE_TEST_CASE("mesh_writers: vertices, faces and edges are read back as written", "[io]", Obj,
                   Ply) {
    check_round_trip<TestType, float, 1>();
    check_round_trip<TestType, float, 3>();
    check_round_trip<TestType, double, 2>();
    check_round_trip<TestType, double, 3>();
}

TEMPLATE_TEST_CASE("mesh_writers: a file is replaced as a whole, and may be a cloud or empty",
                   "[io]", Obj, Ply) {
    const TemporaryFile file(std::string("cloud") + TestType::extension);
    Random random(2);
    REQUIRE(TestType::write(file.path, random.points<double, 3>(20, -1, 1), {{0, 1}}, {{0, 1}}));
    for (const Index n : {4, 0}) {
        REQUIRE(TestType::write(file.path, random.points<double, 3>(n, -1, 1), {}));
        const Mesh mesh = TestType::read(file);
        CHECK(mesh.understood);
        CHECK(mesh.vertices.size() == static_cast<std::size_t>(n));
        CHECK((mesh.faces.empty() && mesh.edges.empty()));
        CHECK(file.bytes().find("edge") == std::string::npos);
    }
}

TEMPLATE_TEST_CASE("mesh_writers: files are numbered, and a frame is tried again after a failure",
                   "[io]", Obj, Ply) {
    const std::string extension = TestType::extension;
    typename TestType::Sequence frames(temporary_prefix() + "sequence_", {{0, 1, 2}}, {{2, 0}});
    Random random(3);
    const auto x = random.points<float, 3>(3, -1, 1);
    const auto y = random.points<float, 3>(3, -1, 1);
    taut::Points<float, 3> broken = x;
    broken(1, 2) = std::numeric_limits<float>::infinity();
    const TemporaryFile first("sequence_00000" + extension);
    const TemporaryFile second("sequence_00001" + extension);
    const TemporaryFile third("sequence_00002" + extension);
    REQUIRE(frames.write(x));
    CHECK(frames.path(0) == first.path);
    const auto report = frames.write(broken);
    CHECK(report.status == taut::FileStatus::not_finite);
    CHECK(report.where == 2);
    CHECK(second.bytes().empty());
    REQUIRE(frames.write(x));
    REQUIRE(frames.write(y));
    CHECK(frames.frames() == 3);
    CHECK(frames.path(123456) == temporary_prefix() + "sequence_123456" + extension);
    CHECK(second.bytes() == first.bytes());
    CHECK_FALSE(third.bytes() == first.bytes());
    // A run that was ended goes on.
    typename TestType::Sequence more(temporary_prefix() + "sequence_", {{0, 1, 2}}, {{2, 0}}, 2);
    CHECK(more.frames() == 2);
    REQUIRE(more.write(x));
    CHECK(third.bytes() == first.bytes());
}

TEMPLATE_TEST_CASE("mesh_writers: bad input: what cannot be written is named", "[io][bad_input]",
                   Obj, Ply) {
    const std::string extension = TestType::extension;
    const std::string nowhere = "no_such_directory/mesh" + extension;
    const std::string none = "not_written" + extension;
    Points x = Points::Zero(3, 300);
    const auto report = TestType::write(nowhere, x, {});
    CHECK(report.status == taut::FileStatus::not_opened);
    CHECK_THAT(report.message(), ContainsSubstring(nowhere + ": cannot"));
    CHECK_FALSE(TestType::write("", x, {}));
    const auto refused = [&](const Faces& faces, const Edges& edges, const char* words) {
        const auto message = message_of([&] { (void)TestType::write(none, x, faces, edges); });
        CHECK(missing(message, {("write_" + extension.substr(1)).c_str(), words}).empty());
    };
    refused({{0, 1, 2}, {3, 300, 4}}, {}, "face 1 has the corner 300; there are 300 positions");
    refused({}, {{0, 1}, {-1, 0}}, "edge 1 has the end -1; there are 300 positions");
    x(2, 7) = std::numeric_limits<double>::quiet_NaN();
    CHECK(TestType::write(none, x, {}).where == 7);
    CHECK_FALSE(std::ifstream(none));
#ifdef __linux__
    // A full disk is told from a missing folder.
    x(2, 7) = 0;
    if (!std::ifstream("/dev/full")) return;
    CHECK(TestType::write("/dev/full", x, {}).status == taut::FileStatus::not_written);
#endif
}

TEST_CASE("mesh_writers: bad input: what PLY has no room for", "[io][bad_input]") {
    Points x = Points::Zero(3, 300);
    CHECK_THAT(message_of([&] {
                   (void)taut::write_ply("not_written.ply", x, {std::vector<Index>(256, 7)});
               }),
               ContainsSubstring("face 0 has 256 corners; at most 255"));
    x(2, 7) = 1e39;  // a double, but no float
    const auto large = taut::write_ply("not_written.ply", x, {});
    CHECK(large.status == taut::FileStatus::not_finite);
    CHECK(large.where == 7);
    CHECK_FALSE(std::ifstream("not_written.ply"));
}

}  // namespace taut_test::mesh_writers_test
