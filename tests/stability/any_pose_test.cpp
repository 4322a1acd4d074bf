// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/stability/any_pose.hpp>
#include <taut/tight/tight.hpp>

#include "../support/catch.hpp"
#include "../support/laws.hpp"
#include "../support/random_system.hpp"
#include "wild_system.hpp"

namespace taut_test::any_pose_test {

using taut::Method;

namespace {

constexpr Real noise = 256 * real_epsilon;

/// λ_min of 4M − 2hD − h²K, as M⁻¹ of it, over the size of its terms.
Real margin(const Exact& e, double h) {
    const Real t = static_cast<Real>(h);
    const RealMatrix S = e.scaled(4, -t * t, -2 * t, false);
    return eigenvalues(S)[0] / (4 + S.cwiseAbs().maxCoeff());
}

/// No real multiplier at or below −1 and no complex one outside the circle.
bool step_induces_nothing(const Exact& e, double h) {
    for (const auto& mu : Multipliers(e)(Method::symplectic_euler, h)) {
        const bool real = std::abs(mu.imag()) < 1e-6L;
        // Where K is indefinite, real ones above 1 are the physics.
        if (real ? mu.real() < -1 - 1e-9L : std::abs(mu) > 1 + 1e-9L) return false;
    }
    return true;
}

/// M, L_k and L_c written from [T23]: one row a particle.
template <class System>
Exact laplacians(const System& system) {
    std::vector<Index> row;
    Index n = 0;
    for (Index i = 0; i < system.size(); ++i) row.push_back(system.is_pinned(i) ? -1 : n++);
    Exact e{RealVector(n), RealMatrix::Zero(n, n), {}, RealMatrix::Zero(n, n)};
    for (Index i = 0; i < system.size(); ++i) {
        if (row[i] >= 0) e.mass[row[i]] = static_cast<Real>(system.mass(i));
    }
    system.for_each_set([&](const auto& set) {
        using Law = typename std::decay_t<decltype(set)>::Law;
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            const auto add = [&](RealMatrix& L, Real weight) {
                const Index a = row[set.a[s]];
                const Index b = row[set.b[s]];
                if (a >= 0) L(a, a) += weight;
                if (b >= 0) L(b, b) += weight;
                if (a < 0 || b < 0) return;
                L(a, b) -= weight;
                L(b, a) -= weight;
            };
            add(e.K, Law::stiffness_bound(set.parameters[s].template cast<Real>(),
                                          static_cast<Real>(set.rest_length[s])));
            add(e.D, static_cast<Real>(set.damping_of(s)));
        }
    });
    e.K_plus = e.K;
    e.D += static_cast<Real>(system.rayleigh().stiffness_proportional) * e.K;
    e.D.diagonal() += static_cast<Real>(system.rayleigh().mass_proportional) * e.mass;
    return e;
}

/// Crumpled, stretched, inverted, flattened, knotted or collapsed.
template <class System>
auto any_pose(Random& random, const System& system, int kind) {
    using Scalar = typename System::Scalar;
    auto x = random.points<Scalar, System::Dim>(system.size(), -1, 1);
    const auto home = system.initial_state().x;
    switch (kind % 7) {
        case 0: return x;
        case 1: x *= Scalar(0.01); return x;
        case 2: x = home * Scalar(20); return x;
        case 3: x = -home + Scalar(0.05) * x; return x;
        case 4: x.row(0).setConstant(Scalar(0.5)); return x;
        case 5: x = home * Scalar(0.3) + Scalar(1e-3) * x; return x;
        default: x.setConstant(Scalar(0.25)); return x;
    }
}

template <class System>
void check_any_pose(Random& random, const System& system, int poses) {
    const auto limit = taut::any_pose_limit(system);
    const auto narrowed = taut::any_pose_limit(system, 1e-6);
    INFO(limit.certified << ", " << limit.refuted << " and " << narrowed.certified << ", "
                         << narrowed.refuted);
    CHECK(limit.refuted >= limit.certified);
    CHECK(narrowed.certified >= limit.certified);
    CHECK(narrowed.refuted <= limit.refuted);
    CHECK(limit.certified > 0);
    CHECK(limit.growth_rate == 0);
    CHECK(limit.revision == system.revision());
    const Exact L = laplacians(system);
    if (!std::isfinite(limit.certified)) {
        CHECK(limit.cause == taut::Cause::nothing_to_limit);
        CHECK(L.K.cwiseAbs().maxCoeff() + L.D.cwiseAbs().maxCoeff() == 0);
        return;
    }
    const auto h = static_cast<double>(narrowed.certified);
    CHECK(margin(L, static_cast<double>(limit.certified)) >= -noise);
    CHECK(margin(L, h) >= -noise);
    CHECK(margin(L, static_cast<double>(limit.refuted)) <= noise);
    CHECK(margin(L, static_cast<double>(narrowed.refuted)) <= noise);
    for (int kind = 0; kind < poses; ++kind) {
        INFO("pose " << kind);
        const Exact e = exact_matrices(system, any_pose(random, system, kind));
        for (const double part : {1.0, 0.6, 0.01}) CHECK(margin(e, part * h) >= -noise);
        if (kind < 7) CHECK(step_induces_nothing(e, h));
    }
}

}  // namespace

TEMPLATE_TEST_CASE("any_pose: the certified step holds at thousands of poses", "[stability][slow]",
                   (std::integral_constant<int, 1>), (std::integral_constant<int, 2>),
                   (std::integral_constant<int, 3>)) {
    Random random(400);
    for (int repeat = 0; repeat < 60; ++repeat) {
        INFO("system " << repeat);
        WildOptions options;
        options.decades = repeat % 2 == 0 ? 0.5 : 2.5;
        check_any_pose(random, wild_system<double, TestType::value>(random, options), 28);
    }
}

TEST_CASE("any_pose: float, and laws other than Hooke's", "[stability][slow]") {
    Random random(401);
    for (int repeat = 0; repeat < 20; ++repeat) {
        INFO("system " << repeat);
        check_any_pose(random, wild_system<float, 3>(random), 14);
        RandomOptions options;
        options.particles = 5;
        options.springs = 4;
        options.pinned = repeat % 3;
        options.dampers = repeat % 2 == 0;
        options.rayleigh = repeat % 4 < 2;
        check_any_pose(random,
                       random_system<double, 2, taut::Hookean, TensionOnly, Glue>(random, options),
                       21);
    }
}

TEST_CASE("any_pose: never above the limit of a pose", "[stability]") {
    taut::ClothOptions options;
    options.rows = options.columns = 4;
    const auto cloth = taut::hanging_cloth<double>(options);
    const auto any = taut::any_pose_limit(cloth, 1e-6);
    for (const double stretch : {0.5, 1.0, 1.5, 40.0}) {
        const Exact e = exact_matrices(cloth, deformed(cloth, stretch, 0.01, 1).x);
        CHECK(any.certified <= definite_limit(e, 1, false));
        // Stretched without end, every spring's tangent is k times the identity.
        if (stretch > 10) CHECK(any.refuted >= 0.9 * definite_limit(e, 1, false));
    }
    // In one dimension it is the limit of the one pose there is.
    taut::ChainOptions row;
    row.masses = 9;
    const auto chain = taut::chain<double, 1>(row);
    const Exact e = exact_matrices(chain, chain.initial_state().x);
    CHECK_THAT(taut::any_pose_limit(chain, 1e-6).certified,
               WithinRel(definite_limit(e, 1, false), 2e-6));
}

TEST_CASE("any_pose: it is void after what it says voids it", "[stability]") {
    Random random(402);
    const auto original = random_system<double, 3>(random);
    const auto limit = taut::any_pose_limit(original);
    REQUIRE(limit.step_for(original, 0.9).has_value());
    CHECK(*limit.step_for(original, 0.9) == 0.9 * limit.certified);
    const auto changed = [&](auto&& change) {
        auto system = original;
        change(system);
        return !limit.step_for(system, 0.9).has_value();
    };
    CHECK(changed([](auto& s) { s.add_spring(2, 3, 10); }));
    CHECK(changed([](auto& s) { s.set_mass(2, 0.1); }));
    CHECK(changed([](auto& s) { s.unpin(0); }));
    CHECK(changed([](auto& s) { s.set_rayleigh({1, 0}); }));
    CHECK_FALSE(changed([](auto& s) { s.set_gravity({0, 0, 1}); }));
}

TEST_CASE("any_pose: causes", "[stability]") {
    taut::SpringSystem<double, 2> system;
    CHECK(taut::any_pose_limit(system).cause == taut::Cause::nothing_to_limit);
    system.add_particle({0, 0}, 1);
    CHECK(taut::any_pose_limit(system).unbounded());
    system.add_particle({1, 0}, 1);
    system.add_spring(0, 1, 0);
    CHECK(taut::any_pose_limit(system).unbounded());
    system.add_spring(0, 1, 8);
    // Two masses m on a spring k: k_max = 2k/m.
    auto limit = taut::any_pose_limit(system, 1e-6);
    CHECK(limit.cause == taut::Cause::stiffness);
    CHECK_THAT(limit.certified, WithinRel(0.5, 1e-6));
    CHECK(limit.certified <= 0.5);
    CHECK(limit.refuted >= 0.5);
    system.add_spring(0, 1, 0, 100);
    limit = taut::any_pose_limit(system, 1e-6);
    CHECK(limit.cause == taut::Cause::damping);
    // h = 4/(d + √(d² + 4k)) with d = 200, k = 16.
    CHECK_THAT(limit.certified, WithinRel(4 / (200 + std::sqrt(40064.0)), 2e-6));
    system.pin(0);
    system.pin(1);
    CHECK(taut::any_pose_limit(system).unbounded());
}

}  // namespace taut_test::any_pose_test
