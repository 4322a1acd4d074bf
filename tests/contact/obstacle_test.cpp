// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <limits>
#include <taut/contact/detail/body.hpp>
#include <taut/contact/obstacle.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::obstacle_test {

namespace {

/// Checks what every convex shape is promised: lengths of normals, a way out as long as it is deep,
/// and the same answers for a register of points.
template <class Scalar, int Dim, class Shape>
void check_shape(Random& random, const Shape& shape) {
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Register = taut::step_detail::VectorRegister<Scalar>;
    constexpr double tolerance = 10 * Tolerance<Scalar>::rounding;
    taut::detail::Few<Register, Dim> y, normals;
    taut::detail::Few<Scalar, Register::width> lanes;
    std::vector<Vector> points;
    for (int k = 0; k < Register::width; ++k)
        points.push_back(random.template vector<Scalar, Dim>(-1, 1));
    for (int d = 0; d < Dim; ++d) {
        for (int k = 0; k < Register::width; ++k) lanes[k] = points[static_cast<std::size_t>(k)][d];
        y[d] = Register::load(lanes.data());
    }
    shape.template query<Register>(y, normals).store(lanes.data());
    for (int k = 0; k < Register::width; ++k) {
        const Vector& x = points[static_cast<std::size_t>(k)];
        const taut::Surface<Scalar, Dim> found = shape.surface(x);
        CHECK_THAT(static_cast<double>(found.normal.norm()), WithinAbs(1, tolerance));
        CHECK_THAT(static_cast<double>(lanes[k] - found.distance), WithinAbs(0, tolerance));
        const Vector out = x - found.distance * found.normal;
        CHECK_THAT(static_cast<double>(shape.surface(out).distance), WithinAbs(0, tolerance));
        // Convex: all of it lies behind the plane there.
        const Vector other = random.template vector<Scalar, Dim>(-1, 1);
        const taut::Surface<Scalar, Dim> there = shape.surface(other);
        const Vector on = other - there.distance * there.normal;
        CHECK(static_cast<double>(found.normal.dot(on - out)) <= tolerance);
        CHECK(on.norm() <= shape.extent() * Scalar(1.001));
    }
}

}  // namespace

TEMPLATE_TEST_CASE("obstacle: the way out is as long as a point is deep, one point or many",
                   "[contact]", (Case<float, 3>), (Case<double, 1>), (Case<double, 2>),
                   (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(3);
    for (int scene = 0; scene < 50; ++scene) {
        const auto a = random.vector<Scalar, Dim>(-0.4, 0.4), b = random.vector<Scalar, Dim>(-1, 1);
        const auto radius = static_cast<Scalar>(random.uniform(0.1, 0.6));
        check_shape<Scalar, Dim>(random, taut::HalfSpace<Scalar, Dim>(a, b));
        check_shape<Scalar, Dim>(random, taut::Sphere<Scalar, Dim>(a, radius));
        check_shape<Scalar, Dim>(random,
                                 taut::Box<Scalar, Dim>(random.vector<Scalar, Dim>(0.1, 0.6)));
        if constexpr (Dim > 1)
            check_shape<Scalar, Dim>(random, taut::Capsule<Scalar, Dim>(a, b, radius));
    }
}

TEMPLATE_TEST_CASE("obstacle: from the middle of a sphere the way out is the last axis",
                   "[contact]", float, double) {
    const auto found = taut::Sphere<TestType, 2>({1, 2}, TestType(0.5)).surface({1, 2});
    CHECK(found.distance == TestType(-0.5));
    CHECK((found.normal == Eigen::Matrix<TestType, 2, 1>(0, 1)));
}

TEST_CASE("obstacle: shapes out of range are refused by name", "[contact][bad_input]") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    using Plane = taut::HalfSpace<double, 3>;
    using Ball = taut::Sphere<double, 3>;
    using Capsule = taut::Capsule<double, 3>;
    const auto says = [](std::initializer_list<const char*> words, auto build) {
        CHECK(missing(message_of([&] { build(); }), words) == "");
    };
    says({"HalfSpace", "normal"}, [] { Plane({0, 0, 0}, {0, 0, 0}); });
    says({"HalfSpace", "normal"}, [&] { Plane({0, 0, 0}, {0, nan, 1}); });
    says({"HalfSpace", "point"}, [&] { Plane({nan, 0, 0}, {0, 0, 1}); });
    CHECK_NOTHROW(Plane({0, 0, 0}, {0, 0, 1e-200}));
    says({"Sphere", "radius is 0"}, [] { Ball({0, 0, 0}, 0); });
    says({"Sphere", "centre"}, [&] { Ball({0, 0, nan}, 1); });
    says({"Capsule", "end"}, [&] { Capsule({0, 0, 0}, {0, nan, 0}, 1); });
    says({"Capsule", "radius"}, [&] { Capsule({0, 0, 0}, {0, 1, 0}, nan); });
    says({"Box", "edge"}, [] { taut::Box<double, 3>({1, 0, 1}); });
}

}  // namespace taut_test::obstacle_test
