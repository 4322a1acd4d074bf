// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <taut/contact/contacts.hpp>
#include <taut/guard/guard.hpp>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::fast_contacts_test {

namespace {

/// A square metre, or a metre, across the last axis, n particles a side, held at its corners.
template <class Scalar, int Dim>
auto sheet(Index n, double stiffness, double mass) {
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    taut::SpringSystem<Scalar, Dim, taut::Hookean> system;
    const Index rows = Dim == 3 ? n : 1;
    const auto join = [&](Index a, Index b) {
        system.add_spring(a, b, {static_cast<Scalar>(stiffness)});
    };
    for (Index i = 0; i < n * rows; ++i) {
        const Index column = i % n, row = i / n;
        Vector x = Vector::Zero();
        x[0] = static_cast<Scalar>(double(column) / double(n - 1) - 0.5);
        if constexpr (Dim == 3) x[1] = static_cast<Scalar>(double(row) / double(n - 1) - 0.5);
        system.add_particle(x, static_cast<Scalar>(mass / double(n * rows)));
        if (column % (n - 1) == 0 && (rows == 1 || row % (n - 1) == 0)) system.pin(i);
    }
    for (Index i = 0; i < n * rows; ++i) {
        const bool right = i % n + 1 < n, down = i / n + 1 < rows;
        if (right) join(i, i + 1);
        if (down) join(i, i + n);
        if (right && down) {
            join(i, i + n + 1);
            join(i + 1, i + n);
        }
    }
    return system;
}

/// How near the way from a to b comes to the origin.
template <class Vector>
double nearest(const Vector& a, const Vector& b) {
    const Vector way = b - a;
    const auto length2 = way.squaredNorm();
    const auto share = length2 > 0 ? std::clamp(-a.dot(way) / length2, 0.0, 1.0) : 0.0;
    return (a + share * way).norm();
}

}  // namespace

TEMPLATE_TEST_CASE("fast contacts: no particle goes through a ball on its way", "[contact]",
                   (Case<float, 3>), (Case<double, 2>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using Vector = Eigen::Matrix<double, Dim, 1>;
    constexpr double radius = 0.05, speed = 20;
    Random random(20);
    double deepest = 0, cut = 0, longest = 0;
    Index met = 0;
    for (int aim = 0; aim < 1000; ++aim) {
        const Index n = 5 + random.below(12);  // a ball is wider than two particles, or narrower
        const auto system = sheet<Scalar, Dim>(n, log_uniform(random, 0.3, 1000), 0.25);
        const double limit = static_cast<double>(taut::energy_limit(system).certified);
        const auto h = static_cast<Scalar>(limit);
        Vector from = random.vector<double, Dim>(-0.15, 0.15);
        from[Dim - 1] = -0.3;
        Vector direction = random.vector<double, Dim>(-0.3, 0.3);
        direction[Dim - 1] = 1;
        direction.normalize();
        taut::Pose<Scalar, Dim> pose;
        pose.position = from.template cast<Scalar>();
        taut::Contacts contacts(system);
        const auto ball = contacts.add(
            taut::Sphere<Scalar, Dim>(decltype(pose.position)::Zero(), Scalar(radius)), {}, pose);
        taut::EnergyStableEuler stepper(system);
        auto state = system.initial_state();
        longest = std::max(longest, speed * limit);
        for (double time = limit; time < 0.03; time += limit) {
            const auto before = state.x;
            const Vector was = pose.position.template cast<double>();
            pose.position = (from + speed * time * direction).template cast<Scalar>();
            contacts.move_to(ball, pose);
            REQUIRE(taut::step_through(stepper, state, h, 1, contacts));
            met += contacts.work() > 0;
            deepest = std::max(deepest, static_cast<double>(contacts.deepest()));
            for (Index i = 0; i < system.size(); ++i) {
                if (system.is_pinned(i)) continue;
                const Vector a = before.col(i).template cast<double>() - was;
                const Vector b =
                    state.x.col(i).template cast<double>() - pose.position.template cast<double>();
                cut = std::max(cut, radius - nearest(a, b));
            }
        }
    }
    CHECK(longest > 10 * radius);
    CHECK(met > 500);
    CHECK(deepest < 1e-3);
    CHECK(cut <= radius / 32 + deepest);  // what a way of half a radius may cut off
}

TEMPLATE_TEST_CASE("fast contacts: a guarded cloth lets no ball through a particle", "[contact]",
                   (Case<float, 3>), (Case<double, 2>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using Vector = Eigen::Matrix<double, Dim, 1>;
    constexpr double radius = 0.05, speed = 20, frame = 0.0005;
    Random random(21);
    double deepest = 0, cut = 0;  // beside how deep a particle of that speed comes alone
    Index met = 0;
    for (int aim = 0; aim < 50; ++aim) {
        const Index n = aim % 2 == 0 ? 9 : 25;
        auto system = sheet<Scalar, Dim>(n, log_uniform(random, 10, 1000), 0.25);
        system.set_rayleigh({1, 2e-5});
        const double alone = speed * static_cast<double>(taut::energy_limit(system).certified) / 10;
        Vector from = random.vector<double, Dim>(-0.1, 0.1);
        from[Dim - 1] = -0.1;
        taut::Pose<Scalar, Dim> pose;
        pose.position = from.template cast<Scalar>();
        taut::Contacts contacts(system);
        const auto ball = contacts.add(
            taut::Sphere<Scalar, Dim>(decltype(pose.position)::Zero(), Scalar(radius)), {}, pose);
        taut::Guarded guard(system);
        auto state = system.initial_state();
        for (int k = 1; k < 40; ++k) {
            const auto before = state.x;
            const Vector was = pose.position.template cast<double>();
            Vector now = from;
            now[Dim - 1] += speed * k * frame;
            pose.position = now.template cast<Scalar>();
            contacts.move_to(ball, pose);
            REQUIRE(guard.advance(state, Scalar(frame), contacts));
            met += contacts.work() > 0;
            deepest = std::max(deepest, static_cast<double>(contacts.deepest()) / alone);
            for (Index i = 0; i < system.size(); ++i) {
                if (system.is_pinned(i)) continue;
                const Vector a = before.col(i).template cast<double>() - was;
                const Vector b = state.x.col(i).template cast<double>() - now;
                cut = std::max(cut, radius - nearest(a, b) - alone);
            }
        }
    }
    CHECK(met > 200);
    CHECK(deepest < 1);
    CHECK(cut < 1e-3);  // a frame's way round the ball is longer than the straight one
}

}  // namespace taut_test::fast_contacts_test
