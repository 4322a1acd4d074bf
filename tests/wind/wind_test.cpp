// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/network/spring_system.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/wind/wind.hpp>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <vector>

#include "../support/catch.hpp"
#include "../support/plain_steps.hpp"
#include "../support/random_system.hpp"

namespace taut_test::wind_test {

namespace {

using Vector = Eigen::Vector3d;
using System = taut::SpringSystem<double, 3>;

/// One triangle in a wind.
struct Plate {
    System system;
    taut::Wind<double> wind;
    System::State state;

    Plate(Random& random, double drag, double lift) {
        for (int i = 0; i < 3; ++i) system.add_particle(random.vector<double, 3>(-1, 1), 1.0);
        state = random_state(random, system);
        wind.velocity = random.vector<double, 3>(-5, 5);
        wind.triangles = {{0, 1, 2}};
        wind.density = 1.3;
        wind.drag = drag;
        wind.lift = lift;
    }
    Vector relative() const { return wind.velocity - state.v.rowwise().mean(); }
    Vector area() const {
        const Vector p = state.x.col(1) - state.x.col(0);
        const Vector q = state.x.col(2) - state.x.col(0);
        return p.cross(q) / 2;
    }
    System::Force forces() {
        taut::set_wind(system, wind);
        System::Force f;
        system.external_force(state, f);
        return f;
    }
    Vector force() { return forces().rowwise().sum(); }
};

}  // namespace

TEST_CASE("wind: the force is the formula's, a third on each corner", "[network]") {
    Random random(61);
    for (int scene = 0; scene < 200; ++scene) {
        Plate plate(random, random.uniform(0, 2), random.uniform(0, 2));
        const auto f = plate.forces();
        const Vector u = plate.relative();
        const Vector direction = u.normalized();
        Vector n = plate.area().normalized();
        if (n.dot(u) < 0) n = -n;
        const double c = n.dot(direction);
        const Vector expected =
            0.5 * plate.wind.density * u.squaredNorm() * plate.area().norm() * c *
            (plate.wind.drag * direction + plate.wind.lift * (n - c * direction));
        CHECK((f.rowwise().sum() - expected).norm() <= 1e-12 * (1 + expected.norm()));
        for (int i = 0; i < 3; ++i) CHECK((f.col(i) - expected / 3).norm() <= 1e-12);
    }
}

TEST_CASE("wind: drag goes with the flow, and lift takes no power from it", "[network]") {
    Random random(62);
    for (int scene = 0; scene < 200; ++scene) {
        Plate drag(random, 1, 0);
        CHECK(drag.force().dot(drag.relative()) >= 0);
        Plate lift(random, 0, 1);
        const Vector f = lift.force();
        CHECK(std::abs(f.dot(lift.relative())) <= 1e-12 * f.norm() * lift.relative().norm());
    }
}

TEST_CASE("wind: neither the way round nor the frame of reference matters", "[network]") {
    Random random(63);
    for (int scene = 0; scene < 100; ++scene) {
        Plate plate(random, 1.2, 0.7);
        const Vector f = plate.force();
        const double tolerance = 1e-12 * (1 + f.norm());
        plate.wind.triangles = {{2, 1, 0}};
        CHECK((plate.force() - f).norm() <= tolerance);
        const Vector motion = random.vector<double, 3>(-5, 5);
        plate.state.v.colwise() += motion;
        plate.wind.velocity += motion;
        CHECK((plate.force() - f).norm() <= tolerance);
        const Eigen::Matrix3d turn =
            Eigen::AngleAxisd(1.1, random.vector<double, 3>(0.1, 1).normalized())
                .toRotationMatrix();
        plate.state.x = (turn * plate.state.x).eval();
        plate.state.v = (turn * plate.state.v).eval();
        plate.wind.velocity = (turn * plate.wind.velocity).eval();
        CHECK((plate.force() - turn * f).norm() <= tolerance);
    }
}

TEST_CASE("wind: without area, flow or density there is no force, and no NaN", "[network]") {
    Random random(64);
    Plate flat(random, 1, 1);
    flat.state.x.col(2) = flat.state.x.col(0);
    CHECK(flat.force() == Vector::Zero());
    Plate calm(random, 1, 1);
    calm.state.v.setZero();
    calm.wind.velocity.setZero();
    CHECK(calm.force() == Vector::Zero());
    CHECK(calm.system.has_external_force());
    Plate vacuum(random, 1, 1);
    vacuum.wind.density = 0;
    CHECK(vacuum.force() == Vector::Zero());
    CHECK_FALSE(vacuum.system.has_external_force());
    taut::set_wind(calm.system, taut::Wind<double>());
    CHECK_FALSE(calm.system.has_external_force());
}

TEST_CASE("wind: bad values are refused by name", "[network]") {
    using Catch::Contains;
    Random random(65);
    Plate plate(random, 1, 1);
    const auto refused = [&](const char* name, const auto& spoil) {
        auto wind = plate.wind;
        spoil(wind);
        CHECK_THROWS_WITH(taut::set_wind(plate.system, wind),
                          Contains("set_wind") && Contains(name));
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    refused("velocity", [&](auto& w) { w.velocity[1] = nan; });
    refused("density", [&](auto& w) { w.density = -1; });
    refused("drag", [&](auto& w) { w.drag = nan; });
    refused("lift", [&](auto& w) { w.lift = std::numeric_limits<double>::infinity(); });
    refused("corner", [&](auto& w) { w.triangles.push_back({0, 1, 3}); });
    refused("corner", [&](auto& w) { w.triangles.push_back({-1, 1, 2}); });
    refused("density * drag", [&](auto& w) { w.density = w.drag = 1e200; });
    CHECK_THROWS_WITH(taut::set_wind_velocity(plate.system, {nan, 0, 0}),
                      Contains("set_wind_velocity"));
}

TEST_CASE("external forces add up, and each change is one of the force alone", "[network]") {
    Random random(66);
    Plate plate(random, 1, 1);
    auto& system = plate.system;
    const auto changes = [&](const auto& set) {
        const auto revision = system.revision();
        const auto force_revision = system.force_revision();
        set();
        CHECK(system.revision() == revision);
        CHECK(system.force_revision() != force_revision);
    };
    CHECK_FALSE(system.has_external_force());
    changes([&] { taut::set_wind(system, plate.wind); });
    const Vector by_wind = plate.force();
    changes([&] { system.set_constant_force(1, {1, 2, 3}); });
    changes([&] { system.set_external_force([](const auto& s, auto& f) { f -= 3 * s.x; }); });
    Vector expected = by_wind + Vector(1, 2, 3);
    for (int i = 0; i < 3; ++i) {
        expected -= 3 * plate.state.x.col(i);
    }
    CHECK((plate.force() - expected).norm() <= 1e-12 * (1 + expected.norm()));
    System::Force all, without;
    system.force(plate.state, all);
    System(plate.system).force(plate.state, without);
    CHECK(all == without);  // a copy has them too
    const System copy = system;
    taut::set_wind_velocity(system, {7, 8, 9});
    copy.force(plate.state, without);
    CHECK(all == without);  // and keeps its own
    System::Force turned;
    system.force(plate.state, turned);
    CHECK(turned != all);
}

TEST_CASE("wind: a step sweeps the triangles as force() adds them", "[wind]") {
    for (const Index side : {3, 6, 24}) {
        Random random(68);
        CAPTURE(side);
        auto cloth = taut::hanging_cloth<double>({side, side});
        taut::Wind<double> wind;
        wind.velocity = random.vector<double, 3>(-5, 5);
        wind.density = 1.3;
        wind.drag = 1.2;
        wind.lift = 0.7;
        for (const auto& triangle : taut::cloth_triangles({side, side}))
            wind.triangles.push_back(triangle);
        taut::set_wind(cloth, wind);
        auto state = random_state(random, cloth);
        auto expected = state;
        plain_steps<taut::Method::symplectic_euler>(cloth, expected, 1e-3, 2);
        taut::SymplecticEuler stepper(cloth);
        REQUIRE(stepper.step(state, 1e-3, 2));
        CHECK((state.v - expected.v).cwiseAbs().maxCoeff() <=
              1e-11 * expected.v.cwiseAbs().maxCoeff());
    }
}

}  // namespace taut_test::wind_test
