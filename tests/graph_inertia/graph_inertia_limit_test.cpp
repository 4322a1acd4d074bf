// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <taut/graph_inertia/graph_inertia.hpp>
#include <taut/stability/any_pose.hpp>
#include <taut/graph_inertia/graph_inertia_limit.hpp>
#include <taut/graph_inertia/inertia_price.hpp>

#include "../support/catch.hpp"
#include "../support/decompositions.hpp"
#include "../support/graph_matrices.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

// [T33] at fixed shares: which steps are safe, and what the added inertia does to frequencies.

namespace taut_test::graph_inertia_limit_test {

using taut::graph_inertia_limit;
using taut::graph_shares;
using taut::Hookean;
using taut::SpringSystem;
using taut::Status;

namespace {

/// The largest |μ|, of those to the left, where steps explode, and of those near 1: zero modes have
/// the multiplier 1 twice, which rounding takes apart by its root.
struct Radius {
    Real left = 0;
    Real right = 0;

    bool bounded() const { return left <= 1 + 1e-8L && right <= 1 + 1e-4L; }
};

/// Of steps of h with M̃ made for h, on a scene with K = L_k ⊗ I and D = d0 M + L_c ⊗ I: one
/// coordinate stands for all.
template <class System>
Radius radius(const System& system, const taut::GraphShares& shares, double h) {
    const auto g = graph_matrices(system, shares.shares, shares.margin, h);
    const auto block = [&](const Eigen::MatrixXd& A) {
        const Eigen::MatrixXd free = free_block(system, A);
        return RealMatrix(free.cast<Real>());
    };
    const RealMatrix heavy = block(g.heavy());
    const RealMatrix K = block(g.K);
    const RealMatrix D = block(g.C + system.rayleigh().mass_proportional * g.M);
    const Index n = K.rows();
    const RealMatrix I = RealMatrix::Identity(n, n);
    const Real t = static_cast<Real>(h);
    RealMatrix step(2 * n, 2 * n);
    const RealMatrix kick = -t * solve(heavy, K);
    const RealMatrix keep = I - t * solve(heavy, D);
    step << I + t * kick, t * keep, kick, keep;
    // Velocities times h: both halves in metres.
    step.bottomLeftCorner(n, n) *= t;
    step.topRightCorner(n, n) /= t;
    Radius found;
    for (const auto& mu : general_eigenvalues(step)) {
        Real& largest = mu.real() < 0.5L ? found.left : found.right;
        largest = std::max(largest, std::abs(mu));
    }
    return found;
}

/// Sometimes d0, α or graph damping.
template <class System>
void damp(Random& random, System& system, int kind, double h) {
    if (kind == 1) system.set_rayleigh({random.uniform(0, 0.2) / h, 0});
    if (kind == 2) system.set_rayleigh({0, h * log_uniform(random, 0.01, 10)});
    if (kind == 3) system.set_graph_damping(h * log_uniform(random, 0.01, 10));
}

}  // namespace

TEMPLATE_TEST_CASE("graph_inertia_limit: bounded below certified, growing above refuted",
                   "[stability]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>),
                   (Case<float, 1>), (Case<float, 3>)) {
    using System = SpringSystem<typename TestType::Scalar, TestType::Dim>;
    Random random(3340 + TestType::Dim);
    int refuted = 0;
    for (int repeat = 0; repeat < 60; ++repeat) {
        auto system = linear_network<System>(random, 3);
        const auto explicit_limit = taut::any_pose_limit(system);
        if (explicit_limit.unbounded()) continue;
        const double scale = static_cast<double>(explicit_limit.certified);
        const double h = scale * log_uniform(random, 0.3, 100);
        damp(random, system, repeat % 4, h);
        const double theta = repeat % 3 == 0 ? 1 : repeat % 3 == 1 ? 0.83 : random.uniform(0.3, 1);
        const auto shares = graph_shares(system, h, theta);
        REQUIRE(shares.status == Status::ok);
        const auto limit = graph_inertia_limit(system, shares);
        INFO("network " << repeat << ", h " << h << ", margin " << theta << ", certified "
                        << limit.certified << ", refuted " << limit.refuted);
        CHECK(static_cast<double>(limit.certified) >= h * (1 - 1e-6));
        CHECK(limit.refuted >= limit.certified);
        CHECK(limit.revision == system.revision());
        const double certified = static_cast<double>(limit.certified);
        for (const double part : {0.99, 0.5, 0.01}) {
            if (!std::isfinite(certified)) continue;
            CHECK(radius(system, shares, part * certified).bounded());
        }
        CHECK(radius(system, shares, h).bounded());
        if (std::isfinite(limit.refuted)) {
            ++refuted;
            CHECK(radius(system, shares, 1.01 * static_cast<double>(limit.refuted)).left >
                  1 + 1e-7L);
        }
        // All implicit: every step, but for drag.
        auto all = shares;
        all.make_all_implicit();
        const double d0 = system.rayleigh().mass_proportional;
        const auto every = graph_inertia_limit(system, all);
        if (d0 > 0) {
            CHECK_THAT(static_cast<double>(every.certified), WithinRel(2 * theta / d0, 1e-5));
            CHECK(radius(system, all, 0.99 * 2 * theta / d0).bounded());
        } else {
            CHECK(every.unbounded());
            for (const double far : {1.0, 30.0, 1e3}) {
                CHECK(radius(system, all, far * scale).bounded());
            }
        }
    }
    CHECK(refuted > 20);
}

TEMPLATE_TEST_CASE("graph_inertia_limit: without shares it is the any-pose limit", "[stability]",
                   (Case<double, 1>), (Case<double, 3>), (Case<float, 2>)) {
    using System = SpringSystem<typename TestType::Scalar, TestType::Dim>;
    Random random(3350);
    for (int repeat = 0; repeat < 30; ++repeat) {
        const auto system = linear_network<System>(random, 3);
        const auto expected = taut::any_pose_limit(system);
        if (expected.unbounded()) continue;
        const double certified = static_cast<double>(expected.certified);
        const auto shares = graph_shares(system, 0.9 * certified, 1);
        REQUIRE(shares.implicit_springs() == 0);
        const auto limit = graph_inertia_limit(system, shares);
        CHECK_THAT(static_cast<double>(limit.certified), WithinRel(certified, 1e-3));
        CHECK_THAT(static_cast<double>(limit.refuted),
                   WithinRel(static_cast<double>(expected.refuted), 1e-3));
        // A margin of certified steps, not of refuted ones: their inertia is the mass alone.
        const auto careful =
            graph_inertia_limit(system, graph_shares(system, 0.4 * certified, 0.25));
        CHECK_THAT(static_cast<double>(careful.certified), WithinRel(certified / 2, 1e-3));
        CHECK_THAT(static_cast<double>(careful.refuted),
                   WithinRel(static_cast<double>(expected.refuted), 1e-3));
    }
}

TEMPLATE_TEST_CASE(
    "inertia_price: the changes of the lowest frequencies are those of a dense "
    "eigenvalue solver",
    "[stability]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>), (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(3360 + Dim);
    int judged = 0;
    for (int repeat = 0; repeat < 24; ++repeat) {
        RandomOptions options;
        options.particles = 6 + random.below(10);
        options.springs = repeat % 2 == 0 ? 4 * options.particles : 2 * options.particles;
        options.pinned = repeat % 3 == 0 ? 0 : 3;
        const bool flat = repeat % 6 == 5;  // with mechanisms
        const auto system = flat ? hemmed_cloth<Scalar, Dim>(5, 5, 100)
                                 : random_like<SpringSystem<Scalar, Dim>>(random, options);
        const auto state = flat ? system.initial_state() : random_state(random, system);
        const double h = static_cast<double>(taut::any_pose_limit(system).certified) *
                         log_uniform(random, 1, 20);
        auto shares = graph_shares(system, h, 0.83);
        if (repeat % 4 == 0) shares.make_all_implicit();
        const auto price = taut::inertia_price(system, state, shares, 10);
        const auto g = graph_matrices(system, shares.shares, 0.83, h);
        const Eigen::MatrixXd M = free_block(system, g.M);
        const Eigen::MatrixXd heavy = free_block(system, g.heavy());
        CHECK_THAT(price.added, WithinRel((heavy - M).trace() / M.trace(), 1e-5));
        const auto dofs = free_dofs(system);
        const Eigen::MatrixXd K = dense_matrices(system, state).K_plus(dofs, dofs);
        const auto before = generalized_modes(K, for_each_axis<Dim>(M)).values;
        const auto after = generalized_modes(K, for_each_axis<Dim>(heavy)).values;
        const double zero = 1e-9 * before[before.size() - 1];
        Index j = 0;
        while (j < before.size() && before[j] < zero) ++j;
        INFO("net " << repeat << ", " << j << " zero modes");
        REQUIRE(price.modes.size() == static_cast<std::size_t>(std::min<Index>(10, K.rows() - j)));
        for (const auto& mode : price.modes) {
            const double change = std::sqrt(after[j] / before[j]) - 1;
            CHECK_THAT(mode.frequency, WithinRel(std::sqrt(before[j]), 1e-4));
            if (change < -1e-4) {
                CHECK_THAT(mode.change(), WithinRel(change, 0.1));
                ++judged;
            }
            CHECK(mode.change() <= 1e-9);
            ++j;
        }
    }
    CHECK(judged > 100);
}

TEST_CASE("inertia_price: the swing of a step is as slow as predicted", "[stability]") {
    // Two masses on a zero-length spring: ω² = 2k/m, and the step's own phase on top.
    SpringSystem<double, 2> system;
    system.add_particle({0, 0}, 1);
    system.add_particle({1, 0}, 1);
    system.add_spring(taut::Spring<double, Hookean>{0, 1, {50}, 0});
    const double h = 0.5;  // the explicit limit is 0.2
    taut::GraphInertiaOptions undamped;
    undamped.dissipation = 0;
    taut::GraphInertia stepper(system, undamped);
    REQUIRE(stepper.prepare(h));
    const auto price = taut::inertia_price(system, system.initial_state(), stepper.shares(), 10);
    REQUIRE(price.modes.size() == 2);  // both ways
    CHECK_THAT(price.modes[0].frequency, WithinRel(10.0, 1e-9));
    const double slowed = price.modes[0].slowed_frequency;
    CHECK(slowed < 2 / h);
    // cos φ of a step is 1 − h²ω̃²/2: a three-term recurrence.
    auto state = system.initial_state();
    double before = state.x(0, 1) - state.x(0, 0);
    REQUIRE(stepper.step(state, h));
    double now = state.x(0, 1) - state.x(0, 0);
    for (int i = 0; i < 50; ++i) {
        REQUIRE(stepper.step(state, h));
        const double next = state.x(0, 1) - state.x(0, 0);
        CHECK_THAT(next, WithinAbs((2 - h * h * slowed * slowed) * now - before, 1e-10));
        before = now;
        now = next;
    }
}

TEST_CASE("graph_inertia_limit: wrong input and scenes with little in them",
          "[stability][bad_input]") {
    SpringSystem<double, 3> system;
    const auto empty = graph_shares(system, 1, 0.83);
    CHECK(graph_inertia_limit(system, empty).unbounded());
    CHECK(taut::inertia_price(system, system.initial_state(), empty, 10).added == 0);
    system.add_particle({0, 0, 0}, 1);
    CHECK(missing(message_of([&] { (void)graph_inertia_limit(system, empty); }),
                  {"graph_inertia_limit", "revision"}) == "");
    system.add_particle({0, 1, 0}, 1);
    system.add_spring(0, 1, 100);
    const auto shares = graph_shares(system, 1, 0.83);
    CHECK(taut::inertia_price(system, system.initial_state(), shares, 0).modes.empty());
    CHECK(taut::inertia_price(system, system.initial_state(), shares, 99).modes.size() == 1);
    system.set_rayleigh({10, 0});
    const auto refused = graph_shares(system, 1, 0.83);
    CHECK(graph_inertia_limit(system, refused).certified == 0);
    system.pin(0);
    system.pin(1);
    const auto pinned = graph_shares(system, 1, 0.83);
    CHECK(graph_inertia_limit(system, pinned).unbounded());
    CHECK(taut::inertia_price(system, system.initial_state(), pinned, 10).modes.empty());
}

TEST_CASE("inertia_price: shares of another revision are refused", "[stability][bad_input]") {
    SpringSystem<double, 1> pair;
    pair.add_particle(Eigen::Matrix<double, 1, 1>(0.0), 1);
    pair.add_particle(Eigen::Matrix<double, 1, 1>(1.0), 1);
    pair.add_spring(0, 1, 100);
    const auto state = pair.initial_state();
    const auto price = [&](const taut::GraphShares& shares) {
        return message_of([&] { (void)taut::inertia_price(pair, state, shares, 1); });
    };
    CHECK(missing(price({}), {"inertia_price", "revision"}) == "");
    const auto shares = taut::graph_shares(pair, 1, 1);
    pair.set_stiffness(0, 200);
    CHECK(missing(price(shares), {"inertia_price", "revision"}) == "");
}

}  // namespace taut_test::graph_inertia_limit_test
