// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <limits>
#include <set>
#include <taut/scene/mesh.hpp>
#include <taut/mesh_files/weld.hpp>
#include <utility>
#include <vector>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random.hpp"

namespace taut_test::weld_test {

using taut::weld_vertices;

namespace {

using Faces = std::vector<std::vector<Index>>;

/// As weld_vertices says it, by looking at every pair.
template <class Scalar>
std::vector<Index> welded(const taut::Points<Scalar, 3>& x, double distance) {
    std::vector<Index> vertex;
    for (Index v = 0; v < x.cols(); ++v) {
        Index first = v;
        for (Index other = 0; other < v && first == v; ++other) {
            const bool stayed = vertex[static_cast<std::size_t>(other)] == other;
            const Eigen::Vector3d apart = (x.col(other) - x.col(v)).template cast<double>();
            if (stayed && apart.norm() <= distance) first = other;
        }
        vertex.push_back(first);
    }
    return vertex;
}

/// Quads of a grid in the plane.
Faces quads(Index rows, Index columns) {
    Faces faces;
    for (Index r = 0; r + 1 < rows; ++r)
        for (Index c = 0; c + 1 < columns; ++c) {
            const Index i = r * columns + c;
            faces.push_back({i, i + 1, i + columns + 1, i + columns});
        }
    return faces;
}

}  // namespace

TEMPLATE_TEST_CASE("weld: each vertex goes to the first within the distance that stayed", "[scene]",
                   float, double) {
    Random random(3);
    for (int trial = 0; trial < 60; ++trial) {
        const Index n = 1 + random.below(80);
        const double scale = std::pow(10, random.uniform(-6, 6));
        taut::Points<TestType, 3> x =
            (scale * random.points<double, 3>(n, -1, 1)).template cast<TestType>();
        for (Index v = 1; v < n; ++v)  // seams: the same, or a whole number of steps beside
            if (random.uniform(0, 1) < 0.5) x.col(v) = x.col(random.below(v));
        if (trial % 3 == 1)
            x = (x.array() / TestType(scale) * 4).round().matrix() * TestType(scale);
        const double distance = trial % 2 == 0 ? 0 : scale * random.uniform(0, 1.2);
        const auto mesh = weld_vertices(x, {}, distance);
        CHECK(mesh.vertex == welded(x, distance));
        Index moved = 0;
        for (Index v = 0; v < n; ++v) moved += mesh.vertex[static_cast<std::size_t>(v)] != v;
        CHECK(mesh.welded == moved);
    }
}

TEMPLATE_TEST_CASE("weld: a mesh cut along all its edges is whole again", "[scene]", float,
                   double) {
    Random random(5);
    for (int trial = 0; trial < 10; ++trial) {
        const Index rows = 2 + random.below(6), columns = 2 + random.below(6);
        const auto whole = random.points<TestType, 3>(rows * columns, -1, 1);
        const Faces faces = quads(rows, columns);
        taut::Points<TestType, 3> cut(3, 4 * static_cast<Index>(faces.size()));
        Faces apart;
        for (const auto& face : faces) {
            apart.emplace_back();
            for (const Index corner : face) {
                const auto v = static_cast<Index>(4 * (apart.size() - 1) + apart.back().size());
                cut.col(v) = whole.col(corner);
                apart.back().push_back(v);
            }
        }
        const auto mesh = weld_vertices(cut, apart);
        const auto expected = taut::springs_from_mesh<TestType>(whole, faces);
        const auto found = taut::springs_from_mesh<TestType>(cut, mesh.faces);
        CHECK(found.system.size() == expected.system.size());
        CHECK(found.system.spring_count() == expected.system.spring_count());
        CHECK(found.unused_vertices == mesh.welded);
        double length = 0;
        for (const auto L : expected.system.springs().rest_length) length += double(L);
        for (const auto L : found.system.springs().rest_length) length -= double(L);
        CHECK(std::abs(length) < 1e-3);
    }
}

TEST_CASE("weld: what becomes of faces whose corners meet", "[scene]") {
    taut::Points<double, 3> x(3, 6);
    x << 0, 0, 1, 1, 0, 2,  // vertices 0 and 1, and 2 and 3, at one place
        0, 0, 0, 0, 1, 2,   //
        0, 0, 0, 0, 0, 0;
    const auto of = [&](const Faces& faces) { return weld_vertices(x, faces).faces; };
    CHECK(of({{0, 2, 4}}) == Faces{{0, 2, 4}});
    CHECK(of({{0, 1, 4}}) == Faces{{0, 4}});
    CHECK(of({{4, 0, 1}, {1, 4, 0}}) == Faces{{4, 0}, {0, 4}});
    CHECK(of({{0, 1}}).empty());
    CHECK(of({{1, 3, 4}}) == Faces{{0, 2, 4}});
    CHECK(of({{0, 4, 1, 5}}) == Faces{{0, 4}, {4, 0}, {0, 5}, {5, 0}});
}

TEST_CASE("weld: bad input", "[scene][bad_input]") {
    const double not_a_number = std::numeric_limits<double>::quiet_NaN();
    taut::Points<double, 3> x = taut::Points<double, 3>::Zero(3, 3);
    const auto refused = [&](const Faces& faces, double distance,
                             std::initializer_list<const char*> words) {
        return missing(message_of([&] { weld_vertices(x, faces, distance); }), words);
    };
    for (const double bad : {-1.0, not_a_number, std::numeric_limits<double>::infinity()})
        CHECK(refused({}, bad, {"weld_vertices", "distance"}) == "");
    CHECK(refused({{0, 1}, {2, 3}}, 0, {"face 1", "vertex 3", "3 vertices"}) == "");
    CHECK(refused({{-1, 1}}, 0, {"face 0", "vertex -1"}) == "");
    x(2, 1) = not_a_number;
    CHECK(refused({}, 0, {"vertex 1", "finite"}) == "");
    CHECK(weld_vertices(taut::Points<double, 3>(3, 0), {}).vertex.empty());
}

}  // namespace taut_test::weld_test
