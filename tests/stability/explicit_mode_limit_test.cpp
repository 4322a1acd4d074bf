// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/stability/stability.hpp>
#include <taut/tight/tight.hpp>

#include "../support/catch.hpp"
#include "../support/laws.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::explicit_mode_limit_test {

using taut::Method;
using Real = long double;

namespace {

/// [T9] in long double.
Real exact_limit(Real k, Real d) {
    if (k == 0 && d == 0) return std::numeric_limits<Real>::infinity();
    return d * d < 4 * k ? d / k : 4 / (d + std::sqrt(d * d - 4 * k));
}

taut::RayleighDamping random_rayleigh(Random& random) {
    return {random.below(3) == 0 ? 0 : log_uniform(random, 1e-3, 1e3),
            random.below(3) == 0 ? 0 : log_uniform(random, 1e-4, 1e1)};
}

/// The k of critical damping, (d0 + αk)² = 4k, the smaller one or the larger one; nan without one.
double critical(const taut::RayleighDamping& rayleigh, bool larger) {
    const auto [d0, alpha] = rayleigh;
    const double root = std::sqrt(1 - alpha * d0);
    return std::pow(larger ? (1 + root) / alpha : d0 / (1 + root), 2);
}

}  // namespace

TEST_CASE("explicit_mode_limit: encloses the limit, at critical damping as well", "[stability]") {
    Random random(1301);
    for (int repeat = 0; repeat < 20'000; ++repeat) {
        const double d = log_uniform(random, 1e-6, 1e6);
        const double k =
            d * d / 4 *
            (1 + std::floor(random.uniform(-4, 5)) * std::exp2(-std::floor(random.uniform(0, 56))));
        if (!(k > 0)) continue;
        const auto limit = taut::stability_detail::explicit_mode_limit(k, d);
        const Real truth = exact_limit(k, d);
        REQUIRE(limit.lower <= truth);
        REQUIRE(limit.upper >= truth);
        REQUIRE(limit.upper <= limit.lower * (1 + 1e-6));
    }
}

TEST_CASE("largest_explicit_limit: no k of the interval has a larger one, and one comes near",
          "[stability]") {
    Random random(1302);
    for (int repeat = 0; repeat < 2'000; ++repeat) {
        const auto rayleigh = random_rayleigh(random);
        double low = log_uniform(random, 1e-6, 1e6);
        const double peak = critical(rayleigh, random.below(2) == 0);
        if (random.below(2) == 0 && std::isfinite(peak) && peak > 0)
            low = peak * random.uniform(0.1, 1);
        double high = low * (1 + log_uniform(random, 1e-12, 1e3));
        if (random.below(4) == 0 && rayleigh.stiffness_proportional == 0) low = -low;
        if (random.below(8) == 0) low = 0;
        const double largest = taut::stability_detail::largest_explicit_limit(rayleigh, low, high);
        Real nearest = 0;
        const auto see = [&](Real k) {
            if (!(k >= low && k <= high)) return;
            nearest = std::max(nearest, exact_limit(k, rayleigh.mass_proportional +
                                                           rayleigh.stiffness_proportional * k));
        };
        // Evenly, crowded towards the lower end, and where damping is critical.
        for (int i = 0; i <= 400; ++i) {
            const Real t = i % 2 == 0 ? i / 400.0L : std::pow(10.0L, -i / 40.0L);
            see(low + (static_cast<Real>(high) - low) * t);
        }
        see(critical(rayleigh, false));
        see(critical(rayleigh, true));
        CAPTURE(rayleigh.mass_proportional, rayleigh.stiffness_proportional, low, high);
        REQUIRE(nearest <= largest);
        REQUIRE((std::isinf(largest) || nearest >= 0.8L * largest));
    }
}

// One unknown with K ≤ 0 and D ≤ 0: multipliers 1 + hλ, λ real, one of them below −1 where
// 4 − 2hd + h²k < 0, or above 1 for every h by negative damping.
TEMPLATE_TEST_CASE("explicit Euler: a negative K or D is not nothing to limit", "[stability]",
                   float, double) {
    Random random(1305);
    for (int repeat = 0; repeat < 200; ++repeat) {
        taut::SparseMatrix<TestType> K(1, 1), D(1, 1);
        const Index which = random.below(3);
        K.insert(0, 0) = which == 0 ? 0 : -static_cast<TestType>(log_uniform(random, 1e-15, 1e15));
        D.insert(0, 0) = which == 1 ? 0 : -static_cast<TestType>(log_uniform(random, 1e-15, 1e15));
        const taut::Stability<TestType> stability(
            taut::LinearSystem<TestType>(taut::VectorX<TestType>::Ones(1), D, K));
        for (const double tightness : {0.0, 1e-3}) {
            const auto limit = taut::max_step(stability, Method::explicit_euler, tightness);
            CAPTURE(K.coeff(0, 0), D.coeff(0, 0), tightness);
            REQUIRE_FALSE(limit.unbounded());
            const auto h = static_cast<Real>(limit.certified);
            REQUIRE(4 - 2 * h * D.coeff(0, 0) + h * h * K.coeff(0, 0) >= 0);
            REQUIRE((which == 1 || limit.certified == 0));
        }
        REQUIRE_FALSE(taut::certify(stability, Method::explicit_euler, 1e200).proved);
    }
}

// A slack string's stiffness is 0 but for rounding errors, which are those of a taut one.
TEMPLATE_TEST_CASE("explicit Euler: what rounding leaves of a slack string refutes nothing",
                   "[stability]", (Case<float, 1>), (Case<float, 2>), (Case<float, 3>),
                   (Case<double, 1>), (Case<double, 2>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    Random random(1303);
    for (int repeat = 0; repeat < 200; ++repeat) {
        taut::SpringSystem<Scalar, Dim, TensionOnly> system;
        system.add_particle(random.vector<Scalar, Dim>(-1, 1),
                            static_cast<Scalar>(log_uniform(random, 1e-3, 1e3)));
        system.add_particle(Vector(Vector::Constant(2)), 1);
        system.pin(1);
        system.add_spring(taut::Spring<Scalar, TensionOnly>{
            0, 1, {static_cast<Scalar>(log_uniform(random, 1e-6, 1e16))}, Scalar(9)});
        const double d0 = log_uniform(random, 1e-6, 1e6);
        const bool stiffness_proportional = random.below(2) == 0;
        system.set_rayleigh({random.below(4) == 0 ? 0 : d0,
                             stiffness_proportional ? log_uniform(random, 1e-6, 1) : 0});
        const taut::Stability<Scalar> stability(system, system.initial_state());
        const double truth = system.rayleigh().mass_proportional > 0
                                 ? 2 / system.rayleigh().mass_proportional
                                 : std::numeric_limits<double>::infinity();
        for (const double tightness : {0.0, 1e-3}) {
            const auto limit = taut::max_step(stability, Method::explicit_euler, tightness);
            CAPTURE(truth, tightness);
            REQUIRE(static_cast<double>(limit.refuted) >= truth);
            REQUIRE(static_cast<double>(limit.certified) <= truth);
        }
    }
}

TEST_CASE("explicit Euler: one mode near critical damping is neither certified nor refuted falsely",
          "[stability]") {
    Random random(1304);
    for (int repeat = 0; repeat < 2'000; ++repeat) {
        const double m = log_uniform(random, 0.1, 10);
        const double stiffness = log_uniform(random, 1, 1e4);
        const double d0 = random.below(2) == 0 ? 0 : log_uniform(random, 1e-3, 1);
        // (d0 + αk)² = 4k but for some ulp.
        const double k = stiffness / m;
        const double alpha =
            (2 * std::sqrt(k) - d0) / k * (1 + std::floor(random.uniform(-16, 17)) * 0x1p-53);
        taut::SpringSystem<double, 1> system;
        using Vector = Eigen::Matrix<double, 1, 1>;
        system.add_particle(Vector(0), m);
        system.add_particle(Vector(1), 1);
        system.pin(1);
        system.add_spring(0, 1, stiffness);
        system.set_rayleigh({d0, alpha});
        const Real truth =
            exact_limit(static_cast<Real>(stiffness) / m,
                        d0 + static_cast<Real>(alpha) * (static_cast<Real>(stiffness) / m));
        const taut::Stability<double> stability(system, system.initial_state());
        for (const double tightness : {0.0, 1e-9}) {
            const auto limit = taut::max_step(stability, Method::explicit_euler, tightness);
            CAPTURE(m, stiffness, d0, alpha, tightness);
            REQUIRE(limit.certified <= truth);
            REQUIRE(limit.refuted >= truth);
        }
    }
}

}  // namespace taut_test::explicit_mode_limit_test
