// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <taut/contact/contact.hpp>
#include <taut/guard/guard.hpp>
#include <taut/network/tension_only.hpp>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"
#include "bodies.hpp"

namespace taut_test::resting_contacts_test {

namespace {

/// A network of particles that lie on a slope, which goes down along the first axis; and the slope.
template <class Scalar, int Dim>
struct OnSlope {
    taut::SpringSystem<Scalar, Dim> system;
    Eigen::Matrix<Scalar, Dim, 1> down = Eigen::Matrix<Scalar, Dim, 1>::Unit(0);
    Eigen::Matrix<Scalar, Dim, 1> up = Eigen::Matrix<Scalar, Dim, 1>::Unit(Dim - 1);

    OnSlope(Random& random, double angle) {
        for (Index i = 0; i < 8; ++i) {
            Eigen::Matrix<Scalar, Dim, 1> x = random.vector<Scalar, Dim>(-1, 1);
            x[Dim - 1] = 0;
            system.add_particle(x, static_cast<Scalar>(random.uniform(0.5, 2)));
        }
        for (Index i = 0; i < 8; ++i) {
            for (Index k = i + 1; k < 8; ++k)
                system.add_spring(i, k, {static_cast<Scalar>(log_uniform(random, 10, 1000))});
        }
        system.set_gravity(static_cast<Scalar>(9.81) *
                           (static_cast<Scalar>(std::sin(angle)) * down -
                            static_cast<Scalar>(std::cos(angle)) * up));
    }
};

}  // namespace

TEMPLATE_TEST_CASE("resting contacts: what slides accelerates by g sin, what should hold holds",
                   "[contact]", (Case<float, 2>), (Case<float, 3>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    constexpr double frame = 1.0 / 60;
    Random random(9);
    double worst = 0, crept = 0;
    for (int scene = 0; scene < 12; ++scene) {
        const double angle = random.uniform(0.1, 1.2);
        const OnSlope<Scalar, Dim> slope(random, angle);
        for (const bool holds : {false, true}) {
            taut::BodyOptions options;
            if (holds) options.friction = random.uniform(1.1, 2) * std::tan(angle);
            taut::Contacts contacts(slope.system);
            contacts.add(taut::HalfSpace<Scalar, Dim>(0 * slope.up, slope.up), options);
            taut::Guarded guard(slope.system);
            auto state = slope.system.initial_state();
            const int frames = holds ? 600 : 60;
            auto settled = state;  // after a second
            Index again = 0;
            for (int f = 0; f < frames; ++f) {
                const auto report = guard.advance(state, Scalar(frame), contacts);
                REQUIRE(report);
                again += report.again;
                if (f == 60) settled = state;
            }
            CHECK(again == 0);
            if (holds) {
                const auto moved = (state.x - settled.x).eval();
                crept = std::max(crept, static_cast<double>(moved.colwise().norm().maxCoeff()));
                continue;
            }
            const double acceleration =
                static_cast<double>(state.v.row(0).mean()) / (frames * frame);
            worst = std::max(worst, std::abs(acceleration / (9.81 * std::sin(angle)) - 1));
        }
    }
    CHECK(worst < 1e-3);
    CHECK(crept < 1e-6);
}

TEMPLATE_TEST_CASE("resting contacts: a cloth lies still on a ball, and is carried by it",
                   "[contact]", float, double) {
    using Scalar = TestType;
    using Vector = Eigen::Matrix<Scalar, 3, 1>;
    constexpr double frame = 1.0 / 60;
    constexpr Index n = 17;
    taut::SpringSystem<Scalar, 3, taut::TensionOnly, taut::Hookean> cloth;
    for (Index i = 0; i < n * n; ++i) {
        const Vector x(static_cast<Scalar>(i % n) / (n - 1) - Scalar(0.47),
                       static_cast<Scalar>(i / n) / (n - 1) - Scalar(0.52), Scalar(0.302));
        cloth.add_particle(x, static_cast<Scalar>(0.25 / (n * n)));
    }
    for (Index i = 0; i < n * n; ++i) {
        const bool right = i % n + 1 < n, down = i / n + 1 < n;
        const auto pull = [&](Index a, Index b) {
            cloth.template add_spring<taut::TensionOnly>(a, b, {Scalar(500)});
        };
        if (right) pull(i, i + 1);
        if (down) pull(i, i + n);
        if (right && down) {
            pull(i, i + n + 1);
            pull(i + 1, i + n);
        }
        if (i % n + 2 < n) cloth.template add_spring<taut::Hookean>(i, i + 2, {Scalar(1)});
        if (i / n + 2 < n) cloth.template add_spring<taut::Hookean>(i, i + 2 * n, {Scalar(1)});
    }
    cloth.set_gravity({0, 0, Scalar(-9.81)});
    cloth.set_rayleigh({1, 1e-4});
    taut::BodyOptions options;
    options.friction = 0.5;
    taut::Contacts contacts(cloth);
    const auto ball = contacts.add(taut::Sphere<Scalar, 3>(Vector::Zero(), Scalar(0.3)), options);
    taut::Guarded guard(cloth);
    auto state = cloth.initial_state();
    Index again = 0;
    double height = 0, work = 0;
    const auto run = [&](double seconds, double speed) {
        const int frames = static_cast<int>(std::lround(seconds / frame));
        for (int f = 0; f < frames; ++f) {
            taut::Pose<Scalar, 3> pose;
            height += speed * frame;
            pose.position[2] = static_cast<Scalar>(height);
            contacts.move_to(ball, pose);
            const auto report = guard.advance(state, Scalar(frame), contacts);
            REQUIRE(report);
            again += report.again;
            work += report.work;
        }
        return static_cast<double>(cloth.energy(state)) + contacts.energy();
    };
    run(10, 0);
    CHECK(work == 0);  // of a ball that stands
    const auto fallen = state;
    const double lying = run(4, 0);
    CHECK((state.x - fallen.x).colwise().norm().maxCoeff() < Scalar(1e-3));
    CHECK(work == 0);
    const double carried = run(5, 0.2);
    CHECK(again == 0);
    // What the ball gave is in the cloth, but for the drag of 1/s.
    CHECK_THAT(work, WithinRel(carried - lying + 0.25 * 0.2 * 0.2 * 5, 0.01));
    CHECK_THAT(carried - lying, WithinRel(0.25 * (9.81 * 1 + 0.2 * 0.2 / 2), 0.01));
}

}  // namespace taut_test::resting_contacts_test
