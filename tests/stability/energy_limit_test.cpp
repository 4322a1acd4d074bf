// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/stability/any_pose.hpp>
#include <taut/stability/energy_limit.hpp>
#include <taut/tight/tight.hpp>

#include "../support/catch.hpp"
#include "../support/energy_networks.hpp"
#include "../support/message.hpp"
#include "../support/tolerance.hpp"

// The largest h with M ⪰ h²L_k + ½hD [T42].

namespace taut_test::energy_limit_test {

using taut::Cause;
using taut::energy_limit;
using taut::SpringSystem;

namespace {

/// M^-½(M − h²L_k − ½hD)M^-½ of one coordinate, D with all damping as the theorem bounds it.
template <class System>
RealMatrix condition(const System& system, Real h) {
    std::vector<Index> row;
    RealVector mass(system.size());
    Index count = 0;
    for (Index i = 0; i < system.size(); ++i) {
        row.push_back(system.is_pinned(i) ? -1 : count);
        if (row.back() >= 0) mass[count++] = static_cast<Real>(system.mass(i));
    }
    const auto alpha = static_cast<Real>(system.rayleigh().stiffness_proportional);
    const auto d0 = static_cast<Real>(system.rayleigh().mass_proportional);
    RealMatrix S = RealMatrix::Zero(count, count);
    S.diagonal() = (1 - h * d0 / 2) * mass.head(count);
    system.for_each_set([&](const auto& set) {
        using Law = typename std::decay_t<decltype(set)>::Law;
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            const Real k = Law::stiffness_bound(set.parameters[s].template cast<Real>(),
                                                static_cast<Real>(set.rest_length[s]));
            const Real size =
                h * h * k + h / 2 * (static_cast<Real>(set.damping_of(s)) + alpha * k);
            const Index a = row[set.a[s]], b = row[set.b[s]];
            if (a >= 0) S(a, a) -= size;
            if (b >= 0) S(b, b) -= size;
            if (a >= 0 && b >= 0) S(a, b) += size;
            if (a >= 0 && b >= 0) S(b, a) += size;
        }
    });
    const RealVector root = mass.head(count).cwiseSqrt().cwiseInverse();
    return root.asDiagonal() * S * root.asDiagonal();
}

/// A network with damping of some kinds; kind 0: none.
template <class System>
System damped_network(Random& random, int kind) {
    auto system = random_network<System>(random, kind % 2 == 0 ? 3 : 10, kind % 4 >= 2);
    const double h = static_cast<double>(taut::any_pose_limit(system).certified);
    if (kind % 3 == 1 && h < 1e30) system.set_rayleigh({log_uniform(random, 1e-2, 10) / h, 0});
    if (kind % 3 == 2 && h < 1e30) system.set_rayleigh({0, log_uniform(random, 1e-2, 10) * h});
    return system;
}

}  // namespace

TEMPLATE_TEST_CASE("energy_limit: the condition holds at certified, and fails above refuted",
                   "[stability]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>),
                   (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    using System = Mixed<Scalar, TestType::Dim>;
    Random random(4300 + TestType::Dim);
    for (int repeat = 0; repeat < 60; ++repeat) {
        const auto system = damped_network<System>(random, repeat);
        for (const double tightness : {0.0, 1e-3}) {
            const auto limit = energy_limit(system, tightness);
            INFO("network " << repeat << ", tightness " << tightness);
            CHECK(limit.revision == system.revision());
            if (limit.unbounded()) {
                const RealMatrix S = condition(system, 1);
                CHECK(S.isIdentity(1e-15L));
                continue;
            }
            REQUIRE(limit.certified > 0);
            CHECK(limit.refuted >= limit.certified);
            const auto certified = static_cast<Real>(limit.certified);
            const auto refuted = static_cast<Real>(limit.refuted);
            CHECK(eigenvalues(condition(system, certified))[0] >= 0);
            CHECK(eigenvalues(condition(system, refuted))[0] <= 0);
            if (tightness > 0) CHECK(refuted <= certified * (1 + Real(tightness) + 1e-5L));
        }
    }
}

TEMPLATE_TEST_CASE("energy_limit: undamped it is half of the any-pose limit, damped no less",
                   "[stability]", (Case<double, 1>), (Case<double, 3>), (Case<float, 3>)) {
    using System = Strings<typename TestType::Scalar, TestType::Dim>;
    Random random(4310);
    for (int repeat = 0; repeat < 40; ++repeat) {
        for (const int kind : {0, 1 + repeat}) {
            const auto system = damped_network<System>(random, kind);
            for (const double tightness : {0.0, 1e-6}) {
                const auto limit = energy_limit(system, tightness);
                const auto linear = taut::any_pose_limit(system, tightness);
                if (limit.unbounded()) continue;
                if (kind == 0) {
                    CHECK(limit.certified == linear.certified / 2);
                    CHECK(limit.refuted == linear.refuted / 2);
                    CHECK(limit.cause == Cause::stiffness);
                } else if (tightness > 0) {
                    const auto half = static_cast<double>(linear.certified) / 2;
                    CHECK(static_cast<double>(limit.certified) >= half * (1 - 1e-5));
                }
            }
        }
    }
}

TEST_CASE("energy_limit: closed forms, and scenes without a limit", "[stability][bad_input]") {
    SpringSystem<double, 2> system;
    CHECK(energy_limit(system).unbounded());
    CHECK(energy_limit(system, 1e-3).cause == Cause::nothing_to_limit);
    system.add_particle({0, 0}, 2);
    system.add_particle({1, 0}, 2);
    CHECK(energy_limit(system).unbounded());
    // Drag alone: m ≥ ½h d0 m.
    system.set_rayleigh({5, 0});
    for (const double tightness : {0.0, 1e-6}) {
        CHECK_THAT(energy_limit(system, tightness).certified, WithinRel(0.4, 1e-6));
        CHECK_THAT(energy_limit(system, tightness).refuted, WithinRel(0.4, 1e-6));
        CHECK(energy_limit(system, tightness).cause == Cause::damping);
    }
    // Two masses and a spring: m ≥ 2kh².
    system.set_rayleigh({});
    system.add_spring(0, 1, 100);
    CHECK_THAT(energy_limit(system).certified, WithinRel(0.1, 1e-9));
    // And a damper: m ≥ 2kh² + hc.
    system.add_spring(0, 1, 0, 10);
    CHECK_THAT(energy_limit(system, 1e-6).certified,
               WithinRel((std::sqrt(100.0 + 1600) - 10) / 400, 2e-6));
    // Damping that rules names itself.
    system.set_rayleigh({0, 10});
    CHECK(energy_limit(system).cause == Cause::damping);
    CHECK_THAT(energy_limit(system, 1e-6).certified, WithinRel(2.0 / 1010, 1e-2));
    // All pinned: nothing moves.
    system.pin(0);
    system.pin(1);
    CHECK(energy_limit(system).unbounded());
    CHECK(energy_limit(system, 1e-3).unbounded());
    system.unpin(0);
    CHECK_FALSE(energy_limit(system).unbounded());
    // Beyond double nothing is proved.
    system.set_rayleigh({0, 1e307});
    CHECK(energy_limit(system).cause == Cause::overflow);
    CHECK(energy_limit(system).certified == 0);
    CHECK_THROWS_AS(energy_limit(system, -1.0), std::invalid_argument);
    CHECK_THROWS_AS(energy_limit(system, std::nan("")), std::invalid_argument);
}

}  // namespace taut_test::energy_limit_test
