// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <taut/solids/solids.hpp>

#include "../contact/bodies.hpp"
#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/tolerance.hpp"
#include "meshes.hpp"

namespace taut_test::solids_test {

namespace {

using taut::ConvexHull;
using taut::Points;
using taut::SolidMesh;
using taut::Triangle;
using Vector3 = Eigen::Vector3d;

/// How far x is from a segment, m.
double from_segment(const Vector3& x, const Vector3& a, const Vector3& b) {
    const double along = (x - a).dot(b - a) / (b - a).squaredNorm();
    return (x - a - std::min(1.0, std::max(0.0, along)) * (b - a)).norm();
}
/// How far x is from a triangle: from its plane above it, else from its sides.
double from_triangle(const Vector3& x, const Vector3& a, const Vector3& b, const Vector3& c) {
    const Vector3 normal = (b - a).cross(c - a).normalized();
    const auto left = [&](const Vector3& from, const Vector3& to) {
        return normal.dot((to - from).cross(x - from)) >= 0;
    };
    if (left(a, b) && left(b, c) && left(c, a)) return std::abs(normal.dot(x - a));
    return std::min({from_segment(x, a, b), from_segment(x, b, c), from_segment(x, c, a)});
}
/// How often a mesh goes around x: its solid angle over 4π (Van Oosterom and Strackee, 1983).
double winding(const Vector3& x, const ClosedMesh& mesh) {
    double sum = 0;
    for (const auto& [i, j, k] : mesh.triangles) {
        const Vector3 a = mesh.points.col(i) - x, b = mesh.points.col(j) - x;
        const Vector3 c = mesh.points.col(k) - x;
        const double la = a.norm(), lb = b.norm(), lc = c.norm();
        sum += 2 * std::atan2(a.dot(b.cross(c)),
                              la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    return sum / (16 * std::atan(1.0));
}

/// All points are behind each face, and no plane with all points behind it is passed less deep.
template <class Scalar>
void check_hull(Random& random, const Points<Scalar, 3>& points) {
    using Vector = Eigen::Matrix<Scalar, 3, 1>;
    using Register = taut::step_detail::VectorRegister<Scalar>;
    const ConvexHull<Scalar> hull(points);
    // Of the grid of points, too.
    const double tolerance = (40 * Tolerance<Scalar>::rounding + 4e-8) * points.norm();
    for (int k = 0; k < 40; ++k) {
        const Vector x = random.vector<Scalar, 3>(-1.5, 1.5);
        const taut::Surface<Scalar, 3> found = hull.surface(x);
        const auto beyond = [&](const Vector& normal) {
            const Scalar support = (normal.transpose() * points).maxCoeff();
            return static_cast<double>(normal.dot(x) - support);
        };
        CHECK_THAT(static_cast<double>(found.normal.norm()), WithinAbs(1, tolerance));
        CHECK_THAT(beyond(found.normal), WithinAbs(double(found.distance), tolerance));
        for (int other = 0; other < 10 && found.distance < 0; ++other) {
            const Vector normal = random.vector<Scalar, 3>(-1, 1).normalized();
            CHECK(beyond(normal) <= static_cast<double>(found.distance) + tolerance);
        }
        taut::detail::Few<Register, 3> y, normal;
        for (int d = 0; d < 3; ++d) y[d] = Register(x[d]);
        taut::detail::Few<Scalar, Register::width> lanes;
        hull.template query<Register>(y, normal).store(lanes.data());
        CHECK_THAT(double(lanes[0]), WithinAbs(double(found.distance), tolerance));
    }
    for (Index i = 0; i < points.cols(); ++i)
        CHECK(static_cast<double>(hull.surface(points.col(i)).distance) <= tolerance);
}

}  // namespace

TEMPLATE_TEST_CASE("solids: a hull is what lies behind all planes that have the points behind them",
                   "[solids]", float, double) {
    Random random(61);
    for (int scene = 0; scene < 30; ++scene) {
        const Index n = 4 + random.below(60);
        check_hull<TestType>(random, random.points<TestType, 3>(n, -1, 1));
        check_hull<TestType>(random,
                             random.points<TestType, 3>(n, -1, 1).colwise().normalized().eval());
        // A turned grid: corners, and much that lies in planes and on lines.
        Points<TestType, 3> grid(3, 4 * 4 * 4);
        for (Index i = 0; i < grid.cols(); ++i)
            grid.col(i) << TestType(i % 4), TestType(i / 4 % 4), TestType(i / 16);
        const auto by = turn<TestType, 3>(random, 3);
        check_hull<TestType>(random, (by.rotation * grid / 4).eval());
        // A turned prism of many sides, each point twice.
        Points<TestType, 3> prism(3, 4 * n);
        for (Index i = 0; i < 4 * n; ++i) {
            const auto angle = static_cast<TestType>(6.2831853 * double(i / 4) / double(n));
            prism.col(i) << std::cos(angle), std::sin(angle), TestType(i % 2);
        }
        check_hull<TestType>(random, (by.rotation * prism).eval());
    }
}

TEMPLATE_TEST_CASE("solids: the hull of a box's corners and of points in it is the box", "[solids]",
                   float, double) {
    using Vector = Eigen::Matrix<TestType, 3, 1>;
    Random random(62);
    for (int scene = 0; scene < 30; ++scene) {
        const Vector half = random.vector<TestType, 3>(0.1, 0.6);
        Points<TestType, 3> points(3, 30);
        for (Index i = 0; i < points.cols(); ++i) {
            points.col(i) = half.cwiseProduct(random.vector<TestType, 3>(-1, 1));
            for (int d = 0; d < 3 && i >= 20 && i < 28; ++d)
                points(d, i) = (i >> d) % 2 ? half[d] : -half[d];
        }
        const ConvexHull<TestType> hull(points);
        const taut::Box<TestType, 3> box(half);
        CHECK_THAT(double(hull.extent()), WithinRel(double(box.extent()), 1e-5));
        for (int k = 0; k < 40; ++k) {
            const Vector x = random.vector<TestType, 3>(-1, 1);
            const auto found = hull.surface(x), same = box.surface(x);
            const double tolerance = 20 * Tolerance<TestType>::rounding + 1e-7;
            CHECK(found.distance <= same.distance + TestType(tolerance));
            if (((x.cwiseAbs() - half).array() > 0).count() > 1) continue;  // beside an edge
            CHECK_THAT(double(found.distance - same.distance), WithinAbs(0, tolerance));
            CHECK((found.normal - same.normal).norm() < TestType(tolerance));
        }
    }
}

TEMPLATE_TEST_CASE("solids: the distance from a mesh is that of its nearest triangle", "[solids]",
                   float, double) {
    Random random(63);
    Index inside = 0;
    for (int scene = 0; scene < 12; ++scene) {
        const ClosedMesh mesh = scene % 2 ? bumpy_ring(random, 12, 7) : bumpy_ball(random, 2);
        const SolidMesh<TestType> solid(mesh.points.cast<TestType>(), mesh.triangles);
        for (int k = 0; k < 60; ++k) {
            const auto x = random.vector<TestType, 3>(-1, 1);
            const Vector3 at = x.template cast<double>();
            double nearest = std::numeric_limits<double>::infinity();
            for (const auto& [a, b, c] : mesh.triangles)
                nearest = std::min(nearest, from_triangle(at, mesh.points.col(a),
                                                          mesh.points.col(b), mesh.points.col(c)));
            const auto found = solid.surface(x);
            const bool within = winding(at, mesh) > 0.5;
            inside += within;
            const double tolerance = 20 * Tolerance<TestType>::rounding;
            CHECK_THAT(double(found.distance), WithinAbs(within ? -nearest : nearest, tolerance));
            const auto out = (x - found.distance * found.normal).eval();
            CHECK_THAT(double(solid.surface(out).distance), WithinAbs(0, tolerance));
        }
    }
    CHECK(inside > 50);
}

TEMPLATE_TEST_CASE("solids: beside the surface of a mesh normals are unit and its side is right",
                   "[solids]", float, double) {
    Random random(64);
    for (int scene = 0; scene < 10; ++scene) {
        const ClosedMesh mesh = bumpy_ball(random, 2);
        const SolidMesh<TestType> solid(mesh.points.cast<TestType>(), mesh.triangles);
        for (const auto& [a, b, c] : mesh.triangles) {
            // Beside the face, a side, a corner; or on it, but for rounding.
            const double share = random.below(3) ? random.uniform(0, 1) : 0;
            const double rest = random.below(3) ? random.uniform(0, 1 - share) : 0;
            const Vector3 on = mesh.points.col(a) +
                               share * (mesh.points.col(b) - mesh.points.col(a)) +
                               rest * (mesh.points.col(c) - mesh.points.col(a));
            const Vector3 way =
                std::pow(10, -3 - random.below(6)) * random.vector<double, 3>(-1, 1);
            const auto x = (on + way).template cast<TestType>().eval();
            const auto found = solid.surface(x);
            CHECK_THAT(double(found.normal.norm()), WithinAbs(1, 1e-5));
            CHECK(std::abs(double(found.distance)) <= way.norm() + 1e-6);
            if (std::abs(double(found.distance)) < 1e-5) continue;
            CHECK((found.distance < 0) == (winding(x.template cast<double>(), mesh) > 0.5));
        }
    }
}

TEMPLATE_TEST_CASE("solids: ground is solid from its heights down to its floor", "[solids]", float,
                   double) {
    Random random(65);
    for (int scene = 0; scene < 20; ++scene) {
        const Index rows = 2 + random.below(6), columns = 2 + random.below(6);
        taut::MatrixX<TestType> heights(rows, columns);
        for (Index i = 0; i < heights.size(); ++i)
            heights(i) = static_cast<TestType>(random.uniform(0, 0.4));
        const auto spacing = static_cast<TestType>(random.uniform(0.1, 1));
        const auto ground = taut::height_field<TestType>(heights, spacing, TestType(-0.5));
        for (Index i = 0; i < rows; ++i) {
            for (Index j = 0; j < columns; ++j) {
                const Eigen::Matrix<TestType, 3, 1> on(spacing * TestType(j), spacing * TestType(i),
                                                       heights(i, j));
                CHECK_THAT(double(ground.surface(on).distance), WithinAbs(0, 1e-6));
                const auto above = on + TestType(0.2) * on.Unit(2);
                CHECK(ground.surface(above).distance > 0);
                const auto below = on - TestType(3) * on.Unit(2);
                CHECK_THAT(double(ground.surface(below).distance),
                           WithinAbs(2.5 - double(heights(i, j)), 1e-5));
                if (i == 0 || j == 0 || i == rows - 1 || j == columns - 1) continue;
                const auto within = on - TestType(0.1) * spacing * on.Unit(2);
                CHECK(ground.surface(within).distance < 0);
            }
        }
    }
}

TEST_CASE("solids: what encloses nothing is refused by name", "[solids][bad_input]") {
    const auto says = [](std::initializer_list<const char*> words, auto build) {
        CHECK(missing(message_of([&] { build(); }), words) == "");
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Random random(67);
    const ClosedMesh ball = bumpy_ball(random, 1);
    const auto mesh = [&](auto&& edit) {
        ClosedMesh bad = ball;
        edit(bad);
        return SolidMesh<double>(bad.points, bad.triangles);
    };
    CHECK_NOTHROW(mesh([](ClosedMesh&) {}));
    says({"SolidMesh", "no triangle"}, [&] { mesh([](auto& m) { m.triangles.clear(); }); });
    says({"SolidMesh", "open at the side"}, [&] { mesh([](auto& m) { m.triangles.pop_back(); }); });
    says({"SolidMesh", "not finite"}, [&] { mesh([&](auto& m) { m.points(1, 3) = nan; }); });
    says({"SolidMesh", "has no point"}, [&] { mesh([](auto& m) { m.triangles[2][1] = 99; }); });
    says({"SolidMesh", "has no point -1"}, [&] { mesh([](auto& m) { m.triangles[2][1] = -1; }); });
    says({"SolidMesh", "the same way round"},
         [&] { mesh([](auto& m) { std::swap(m.triangles[2][0], m.triangles[2][1]); }); });
    says({"SolidMesh", "inside out"}, [&] {
        mesh([](auto& m) {
            for (auto& t : m.triangles) std::swap(t[0], t[1]);
        });
    });
    says({"SolidMesh", "no area"}, [&] {
        mesh([](auto& m) { m.points.col(m.triangles[0][0]) = m.points.col(m.triangles[0][1]); });
    });
    const auto hull = [](const Points<double, 3>& points) { ConvexHull<double> built(points); };
    says({"ConvexHull", "in a plane"}, [&] { hull(Points<double, 3>(3, 0)); });
    says({"ConvexHull", "in a plane"}, [&] { hull(Points<double, 3>::Zero(3, 9)); });
    says({"ConvexHull", "in a plane"}, [&] {
        Points<double, 3> flat = random.points<double, 3>(20, -1, 1);
        flat.row(2) = flat.row(0) + flat.row(1);
        hull(flat);
    });
    says({"ConvexHull", "not finite"}, [&] { hull(Points<double, 3>::Constant(3, 5, nan)); });
    taut::MatrixX<double> heights = taut::MatrixX<double>::Zero(3, 3);
    says({"height_field", "floor"}, [&] { taut::height_field(heights, 1.0, 0.0); });
    says({"height_field", "spacing"}, [&] { taut::height_field(heights, 0.0, -1.0); });
    heights(1, 1) = nan;
    says({"height_field", "finite"}, [&] { taut::height_field(heights, 1.0, -1.0); });
    heights.resize(1, 5);
    says({"height_field", "2 × 2"}, [&] { taut::height_field(heights, 1.0, -1.0); });
}

}  // namespace taut_test::solids_test
