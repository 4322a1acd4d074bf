// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <taut/stability/any_pose.hpp>
#include <taut/graph_inertia/graph_shares.hpp>

#include "../support/catch.hpp"
#include "../support/decompositions.hpp"
#include "../support/energy_networks.hpp"
#include "../support/graph_matrices.hpp"
#include "../support/message.hpp"
#include "../support/tolerance.hpp"

// The shares of [T33]: what they leave explicit is safe, and no more is implicit than that asks.

namespace taut_test::graph_shares_test {

using taut::graph_shares;
using taut::Hookean;
using taut::SpringSystem;
using taut::Status;

namespace {

/// Nets of like springs, or wild ones; dampers, Rayleigh and graph damping in turn.
template <class Scalar, int Dim>
Mixed<Scalar, Dim> scene(Random& random, int repeat) {
    using System = Mixed<Scalar, Dim>;
    RandomOptions options;
    options.particles = 3 + random.below(12);
    options.springs = 2 * options.particles;
    options.dampers = repeat % 4 == 1;
    options.rayleigh = repeat % 4 == 2;
    auto system = repeat % 2 == 0 ? random_network<System>(random, repeat % 3 == 0 ? 8 : 3)
                                  : random_like<System>(random, options);
    if (repeat % 5 == 3) system.set_graph_damping(log_uniform(random, 1e-4, 1e-2));
    return system;
}

/// The least eigenvalue of M^-½((4θ − 2h d0)M − Σ(1 − s)(2hc + h²k)L_e)M^-½, and what rounding to
/// the shares makes of it.
struct Left {
    double least = 0;
    double rounding = 0;
};
template <class System>
Left left_over(const System& system, const std::vector<double>& shares, double theta, double h) {
    const auto g = graph_matrices(system, shares, theta, h);
    const double d0 = system.rayleigh().mass_proportional;
    const Eigen::MatrixXd M = free_block(system, g.M);
    const Eigen::VectorXd scale = M.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd S = (4 * theta - 2 * h * d0) * M - free_block(system, g.unassisted);
    const Eigen::MatrixXd all =
        scale.asDiagonal() * free_block(system, 2 * h * g.C + h * h * g.K) * scale.asDiagonal();
    return {least_eigenvalue(scale.asDiagonal() * S * scale.asDiagonal()),
            16 * Tolerance<double>::epsilon * (4 + all.diagonal().maxCoeff())};
}

template <class System>
double hop(const System& system, double factor) {
    const auto limit = taut::any_pose_limit(system);
    return limit.unbounded() ? factor : factor * static_cast<double>(limit.certified);
}

}  // namespace

TEMPLATE_TEST_CASE("graph_shares: what stays explicit is safe, by a dense eigenvalue solver",
                   "[stability]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>),
                   (Case<float, 1>), (Case<float, 2>), (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    Random random(3300 + TestType::Dim);
    int between = 0;
    for (int repeat = 0; repeat < 120; ++repeat) {
        const auto system = scene<Scalar, TestType::Dim>(random, repeat);
        const double theta = repeat % 3 == 0 ? 1 : repeat % 3 == 1 ? 0.83 : random.uniform(0.1, 1);
        const double h = hop(system, log_uniform(random, 0.1, 1e3));
        const double d0 = system.rayleigh().mass_proportional;
        INFO("scene " << repeat << ", h = " << h << ", margin " << theta);
        const auto answer = graph_shares(system, h, theta);
        CHECK(answer.step == h);
        CHECK(answer.margin == theta);
        CHECK(answer.revision == system.revision());
        REQUIRE(answer.shares.size() == static_cast<std::size_t>(system.spring_count()));
        for (const double s : answer.shares) CHECK((s >= 0 && s <= 1));
        const bool any_free = system.pinned_count() < system.size();
        if (any_free && h * d0 >= 2 * theta) {
            CHECK(answer.status == Status::not_positive_definite);
            continue;
        }
        REQUIRE(answer.status == Status::ok);
        if (!any_free) continue;
        const Left left = left_over(system, answer.shares, theta, h);
        CHECK(left.least >= -left.rounding);
        // Every shorter step is safe with the same shares, and all implicit every step is.
        const Left half = left_over(system, answer.shares, theta, h / 2);
        CHECK(half.least >= -half.rounding);
        auto all = answer;
        all.make_all_implicit();
        CHECK(all.implicit_springs() == system.spring_count());
        if (d0 == 0) CHECK(left_over(system, all.shares, theta, 1000 * h).least > 0);
        for (const double s : answer.shares) between += s > 0 && s < 1;
    }
    CHECK(between > 100);
}

TEMPLATE_TEST_CASE("graph_shares: no spring is implicit where the explicit step is safe",
                   "[stability]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>),
                   (Case<float, 1>), (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    Random random(3310 + TestType::Dim);
    for (int repeat = 0; repeat < 80; ++repeat) {
        const auto system = scene<Scalar, TestType::Dim>(random, repeat);
        if (taut::any_pose_limit(system).unbounded()) continue;
        const double theta = random.uniform(0.3, 1);
        const auto laplacian = taut::SpringPencil<1>::any_pose(system);
        const bool damped = laplacian.rayleigh().mass_proportional > 0 ||
                            laplacian.rayleigh().stiffness_proportional > 0 ||
                            !laplacian.is_rayleigh();
        // θ(4M − 2hD − h²K) at h is no more than 4θM − 2(θh)D − (θh)²K.
        const double h = hop(system, 0.99 * (damped ? theta : std::sqrt(theta)));
        INFO("scene " << repeat << ", h = " << h << ", margin " << theta);
        const auto answer = graph_shares(system, h, theta);
        REQUIRE(answer.status == Status::ok);
        CHECK(answer.implicit_springs() == 0);
        // Far above it some are.
        if (laplacian.rayleigh().mass_proportional > 0) continue;
        CHECK(graph_shares(system, hop(system, 4), theta).implicit_springs() > 0);
    }
}

TEMPLATE_TEST_CASE("graph_shares: soft springs beside a stiff hem stay explicit", "[stability]",
                   (Case<double, 2>), (Case<double, 3>), (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr Index rows = 8, columns = 8;
    for (const double hem : {100.0, 1000.0, 1e5}) {
        const auto soft = hemmed_cloth<Scalar, TestType::Dim>(rows, columns, 1);
        const auto system = hemmed_cloth<Scalar, TestType::Dim>(rows, columns, hem);
        const double h =
            0.9 * std::sqrt(0.83) * static_cast<double>(taut::any_pose_limit(soft).certified);
        const auto answer = graph_shares(system, h, 0.83);
        REQUIRE(answer.status == Status::ok);
        std::size_t index = 0;
        double added = 0;
        system.for_each_spring([&](Index a, Index b) {
            const double s = answer.shares[index++];
            INFO("hem " << hem << ", spring from " << a << " to " << b);
            const bool of_hem = a >= (rows - 1) * columns;
            const bool at_hem = b >= (rows - 2) * columns;
            if (of_hem) {
                CHECK(s > 0.9);
            } else if (!at_hem) {
                CHECK(s == 0);
            } else {
                CHECK(s < 0.6);
                added += s;
            }
        });
        CHECK(added < 0.3 * columns);
    }
}

TEMPLATE_TEST_CASE("graph_shares: units make no difference", "[stability]", (Case<double, 1>),
                   (Case<double, 3>), (Case<float, 2>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using System = SpringSystem<Scalar, Dim>;
    Random random(3320);
    for (int repeat = 0; repeat < 20; ++repeat) {
        const auto system = linear_network<System>(random, 4);
        // Four times the mass and stiffness; then half the unit of time.
        System heavier, faster;
        for (Index i = 0; i < system.size(); ++i) {
            heavier.add_particle(system.initial_state().x.col(i), 4 * system.mass(i));
            faster.add_particle(system.initial_state().x.col(i), system.mass(i));
        }
        system.visit_springs([&](auto spring) {
            spring.parameters.stiffness *= 4;
            heavier.add_spring(spring);
            faster.add_spring(spring);
        });
        for (Index i = 0; i < system.size(); ++i) {
            if (!system.is_pinned(i)) continue;
            heavier.pin(i);
            faster.pin(i);
        }
        const double h = hop(system, log_uniform(random, 1, 100));
        const auto answer = graph_shares(system, h, 0.83);
        CHECK(graph_shares(heavier, h, 0.83).shares == answer.shares);
        CHECK(graph_shares(faster, h / 2, 0.83).shares == answer.shares);
    }
}

TEST_CASE("graph_shares: wrong input and scenes with little in them", "[stability][bad_input]") {
    using System = SpringSystem<double, 2>;
    System none;
    CHECK(graph_shares(none, 1, 1).status == Status::ok);
    CHECK(graph_shares(none, 1, 1).shares.empty());

    System system;
    system.add_particle({0, 0}, 1);
    CHECK(graph_shares(system, 1e9, 0.5).status == Status::ok);
    system.add_particle({1, 0}, 2);
    system.add_particle({5, 0}, 1);
    system.add_particle({6, 0}, 1);
    CHECK(graph_shares(system, 1e9, 0.5).implicit_springs() == 0);
    // Two parts that nothing joins: a stiff one and a soft one.
    system.add_spring(0, 1, 1e6);
    system.add_spring(2, 3, 1);
    const auto parts = graph_shares(system, 0.1, 0.83);
    CHECK(parts.shares[0] > 0.9);
    CHECK(parts.shares[1] == 0);
    // One spring by hand: (1 − s)h²k(1/m + 1/m) = 4θ.
    const auto pair = graph_shares(system, 2, 0.83);
    CHECK_THAT(1 - pair.shares[1], WithinRel(4 * 0.83 / (4 * 2), 0.01));

    for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        CHECK(missing(message_of([&] { (void)graph_shares(system, bad, 0.83); }),
                      {"graph_shares", "h"}) == "");
        CHECK(missing(message_of([&] { (void)graph_shares(system, 0.1, bad); }),
                      {"graph_shares", "margin"}) == "");
    }
    CHECK(missing(message_of([&] { (void)graph_shares(system, 0.1, 1.5); }),
                  {"graph_shares", "margin is 1.5", "<= 1"}) == "");

    // Drag stays explicit: h·d0 ≥ 2θ has no remedy, but without free particles nothing drags.
    system.set_rayleigh({10, 0});
    CHECK(graph_shares(system, 0.99 * 0.166, 0.83).status == Status::ok);
    for (const double h : {0.166 * (1 + 1e-12), 1.0, 1e300}) {
        CHECK(graph_shares(system, h, 0.83).status == Status::not_positive_definite);
    }
    for (Index i = 0; i < system.size(); ++i) system.pin(i);
    const auto pinned = graph_shares(system, 1, 0.83);
    CHECK(pinned.status == Status::ok);
    CHECK(pinned.implicit_springs() == 0);
}

}  // namespace taut_test::graph_shares_test
