// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "../support/catch.hpp"
#include "../support/proof_scenes.hpp"

// Explicit Euler: one mode's limit, and where damping alone decides.

namespace taut_test::explicit_limit_test {

using taut::Method;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

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

/// One free particle on one spring.
Scene oscillator(const Kind& kind, double mass, const AnySpring& spring,
                 const Eigen::VectorXd& at) {
    Scene scene(kind);
    scene.add_particle(at, mass);
    scene.add_particle(Eigen::VectorXd::Constant(kind.dim, 2), 1);
    scene.pin(1);
    scene.add_spring(spring);
    return scene;
}

void check_around(const Analysis& analysis, Real truth, double sharp) {
    for (const double tightness : {0.0, sharp}) {
        const auto limit = analysis.max_step(Method::explicit_euler, tightness);
        INFO(limit.certified << ", " << limit.refuted << ", tightness " << tightness);
        REQUIRE(static_cast<Real>(limit.certified) <= truth);
        REQUIRE(static_cast<Real>(limit.refuted) >= truth);
    }
}

}  // namespace

TEST_CASE("explicit_limit: a mode's limit is enclosed, at critical damping and by rounded numbers",
          "[proof]") {
    Random random(1301);
    for (int repeat = 0; repeat < 20'000; ++repeat) {
        const double d = log_uniform(random, 1e-6, 1e6);
        const double k =
            d * d / 4 *
            (1 + std::floor(random.uniform(-4, 5)) * std::exp2(-std::floor(random.uniform(0, 56))));
        if (!(k > 0)) continue;
        CAPTURE(k, d);
        const auto limit = taut::proof_detail::explicit_mode_limit(k, d);
        REQUIRE(limit.upper <= limit.lower * (1 + 1e-6));
        // Of any numbers that round to these by 3 ulp.
        const Real ulps = 3 * static_cast<Real>(std::numeric_limits<double>::epsilon());
        for (const int of_k : {-1, 0, 1}) {
            for (const int of_d : {-1, 0, 1}) {
                const Real truth = exact_limit(k * (1 + of_k * ulps), d * (1 + of_d * ulps));
                REQUIRE(limit.lower <= truth);
                REQUIRE(limit.upper >= truth);
            }
        }
    }
}

TEST_CASE("explicit_limit: no k of an interval has a larger one than is told, and one comes near",
          "[proof]") {
    Random random(1302);
    for (int repeat = 0; repeat < 1'500; ++repeat) {
        const auto rayleigh = random_rayleigh(random);
        const auto [d0, alpha] = rayleigh;
        double low = log_uniform(random, 1e-6, 1e6);
        const double peak = critical(rayleigh, random.below(2) == 0);
        if (random.below(2) == 0 && std::isfinite(peak) && peak > 0)
            low = peak * random.uniform(0.1, 1);
        const double high = low * (1 + log_uniform(random, 1e-12, 1e3));
        if (random.below(4) == 0 && alpha == 0) low = -low;
        if (random.below(8) == 0) low = 0;
        const double largest = taut::proof_detail::largest_explicit_limit(rayleigh, low, high);
        Real nearest = 0;
        const auto see = [&](Real k) {
            if (k >= low && k <= high) nearest = std::max(nearest, exact_limit(k, d0 + alpha * k));
        };
        // Evenly, crowded towards the lower end, and where damping is critical.
        for (int i = 0; i <= 200; ++i) {
            const Real t = i % 2 == 0 ? i / 200.0L : std::pow(10.0L, -i / 20.0L);
            see(low + (static_cast<Real>(high) - low) * t);
        }
        see(critical(rayleigh, false));
        see(critical(rayleigh, true));
        CAPTURE(d0, alpha, low, high);
        REQUIRE(nearest <= largest);
        REQUIRE((std::isinf(largest) || nearest >= 0.8L * largest));
    }
}

// One unknown with K ≤ 0 and D ≤ 0: multipliers 1 + hλ, λ real, one of them below −1 where
// 4 − 2hd + h²k < 0, or above 1 for every h by negative damping.
TEST_CASE("explicit_limit: a negative K or D is not nothing to limit", "[proof]") {
    Random random(1305);
    for (int repeat = 0; repeat < 300; ++repeat) {
        Matrices m{Eigen::VectorXd::Ones(1), {}, {}, repeat % 2 == 0};
        const auto one = [&](bool zero) {
            const double size = static_cast<float>(log_uniform(random, 1e-15, 1e15));
            return Eigen::MatrixXd::Constant(1, 1, zero ? 0 : -size);
        };
        const Index which = random.below(3);
        m.stiffness = one(which == 0);
        m.damping = one(which == 1);
        const Analysis analysis(m);
        for (const double tightness : {0.0, 1e-3}) {
            const auto limit = analysis.max_step(Method::explicit_euler, tightness);
            CAPTURE(m.single, m.stiffness(0), m.damping(0), tightness);
            REQUIRE_FALSE(limit.unbounded());
            const Real h = limit.certified;
            REQUIRE(4 - 2 * h * m.damping(0) + h * h * m.stiffness(0) >= 0);
            REQUIRE((which == 1 || limit.certified == 0));
        }
        REQUIRE_FALSE(analysis.proves(Method::explicit_euler, 1e200));
    }
}

// D − hK ⪰ 0 at the limit says nothing of smaller steps where K is indefinite: D = −δM and K = −κM
// along (1, −1) meet it from δ/κ on alone, and below that the damping feeds energy in.
TEST_CASE("explicit_limit: a negative D counts beside a buckled K at every smaller step",
          "[proof]") {
    Random random(1311);
    int claimed = 0, refused = 0;
    for (int repeat = 0; repeat < 400; ++repeat) {
        const bool single = repeat % 2 == 0;
        const double m = log_uniform(random, 1e-2, 1e2);
        const double k = log_uniform(random, 1, 100);
        const double d = std::sqrt(k) * random.uniform(0.2, 1);
        const double delta = d * log_uniform(random, single ? 2e-7 : 1e-11, 1e-5);
        const double kappa = delta * k / d * log_uniform(random, 0.1, 100);
        // Each matrix has u along (1, 1) and w along (1, −1).
        const auto matrix = [&](double u, double w) {
            Eigen::MatrixXd A = Eigen::MatrixXd::Constant(2, 2, m * (u - w) / 2);
            A.diagonal().setConstant(m * (u + w) / 2);
            return A;
        };
        const Matrices matrices{Eigen::VectorXd::Constant(2, m), matrix(d, -delta),
                                matrix(k, -kappa), single};
        const Exact e = exact_matrices(matrices);
        const auto check = [&](double h, double admitted) {
            for (const double share : {1e-9, 0.01, 0.1, 0.5, 1.0}) {
                for (const int sign : {1, -1}) {
                    const RealMatrix S = e.D - share * h * e.K;
                    const Real rate = (S(0, 0) + sign * S(0, 1)) / e.mass[0];
                    CAPTURE(single, h, admitted, share, sign, delta, kappa);
                    CHECK(rate >= -admitted * (1 + 1e-12));
                }
            }
        };
        const Analysis analysis(matrices);
        for (const double tightness : {0.0, 1e-3}) {
            const auto limit = analysis.max_step(Method::explicit_euler, tightness);
            const bool strictly = limit.certified > 0;
            const double h = strictly ? limit.certified : limit.certified_up_to;
            if (h > 0) check(h, strictly ? 0 : limit.admitted_growth);
            if (tightness > 0) ++(h > 0 ? claimed : refused);
        }
        const double tried = d / k * random.uniform(0.01, 0.99);
        if (analysis.proves(Method::explicit_euler, tried)) check(tried, 0);
    }
    CHECK(claimed > 30);
    CHECK(refused > 50);
}

// A slack string's stiffness is 0 but for rounding errors, which are those of a taut one.
TEST_CASE("explicit_limit: what rounding leaves of a slack string refutes nothing", "[proof]") {
    for (const Kind& kind : all_kinds()) {
        if (kind.laws != Laws::strings && kind.laws != Laws::any) continue;
        Random random(1303);
        for (int repeat = 0; repeat < 100; ++repeat) {
            INFO(kind << ", repeat " << repeat << " of seed 1303");
            const auto at = random_vector(random, kind.dim, -1, 1);
            AnySpring string{0, 1, log_uniform(random, 1e-6, 1e16), 9};
            string.law = LawOf::tension_only;
            auto scene = oscillator(kind, log_uniform(random, 1e-3, 1e3), string, at);
            const double d0 = random.below(4) == 0 ? 0 : log_uniform(random, 1e-6, 1e6);
            scene.set_rayleigh(d0, random.below(2) == 0 ? log_uniform(random, 1e-6, 1) : 0);
            const double truth = d0 > 0 ? 2 / d0 : infinity;
            check_around(Analysis(scene, scene.initial_state()), truth, 1e-3);
        }
    }
}

TEST_CASE("explicit_limit: one mode near critical damping is not judged falsely", "[proof]") {
    Random random(1304);
    for (int repeat = 0; repeat < 2'000; ++repeat) {
        const double m = log_uniform(random, 0.1, 10);
        const double stiffness = log_uniform(random, 1, 1e4);
        const double d0 = random.below(2) == 0 ? 0 : log_uniform(random, 1e-3, 1);
        // (d0 + αk)² = 4k but for some ulp.
        const double k = stiffness / m;
        const double alpha =
            (2 * std::sqrt(k) - d0) / k * (1 + std::floor(random.uniform(-16, 17)) * 0x1p-53);
        auto scene = oscillator({false, 1}, m, {0, 1, stiffness, 2}, Eigen::VectorXd::Zero(1));
        scene.set_rayleigh(d0, alpha);
        const Real exact = static_cast<Real>(stiffness) / m;
        const Real truth = exact_limit(exact, d0 + static_cast<Real>(alpha) * exact);
        CAPTURE(m, stiffness, d0, alpha);
        check_around(Analysis(scene, scene.initial_state()), truth, 1e-9);
    }
}

TEST_CASE("explicit_limit: a compression of a few ulp, which counts as none, certifies no step",
          "[proof]") {
    // 4 − 2hd0 − h²κ ≥ 0 across the spring, while along it no damping is better.
    for (const int dim : {2, 3}) {
        Random random(1313);
        for (int repeat = 0; repeat < 100; ++repeat) {
            const double m = log_uniform(random, 0.1, 10), k = log_uniform(random, 1, 1e4);
            const double omega = std::sqrt(k / m),
                         short_by = static_cast<double>(20 + random.below(11)) * 0x1p-53;
            const double d0 = omega * random.uniform(1.01, 1.1);
            Scene scene({false, dim});
            scene.add_particle(Eigen::VectorXd::Unit(dim, 0) * (1 - short_by), m);
            scene.add_particle(Eigen::VectorXd::Zero(dim), 1);
            scene.pin(1);
            scene.add_spring({0, 1, k, 1});
            scene.set_rayleigh(d0, 0.999 * (2 * omega - d0) / (omega * omega));
            INFO(dim << " dimensions, repeat " << repeat << " of seed 1313");
            const Analysis analysis(scene, scene.initial_state());
            REQUIRE(analysis.pencil().stiffness_semidefinite());
            const Real kappa =
                static_cast<Real>(k) / m * short_by / (1 - static_cast<Real>(short_by));
            for (const double tightness : {0.0, 1e-6}) {
                const auto limit = analysis.max_step(Method::explicit_euler, tightness);
                const Real h = limit.certified;
                CHECK(4 - 2 * h * d0 - h * h * kappa >= 0);
                CHECK(limit.certified >= (1 - 1e-12) * 2 / d0);
            }
        }
    }
}

TEST_CASE("explicit_limit: any diagonal damping, whatever the unit of time", "[proof]") {
    Random random(1620);
    for (int repeat = 0; repeat < 150; ++repeat) {
        const Index n = 2 + random.below(4);
        const double per_second = log_uniform(random, 1e-70, 1e70);
        // Dampers from those that K asks for [T12] to such as leave no vibration.
        const double strength = log_uniform(random, 1, 1e20);
        Eigen::VectorXd mass(n), d(n), k(n);
        Real truth = infinity;
        for (Index i = 0; i < n; ++i) {
            mass[i] = log_uniform(random, 0.1, 10);
            const double k_i = random.below(4) == 0 ? 0 : log_uniform(random, 0.1, 1);
            const double d_i = strength * random.uniform(0.5, 2);
            k[i] = k_i * per_second * per_second * mass[i];
            d[i] = d_i * per_second * mass[i];
            const Real of_mass = mass[i];
            truth = std::min(truth, exact_limit(k[i] / of_mass, d[i] / of_mass));
        }
        INFO("system " << repeat << ", " << per_second << "/s, strength " << strength);
        const Analysis analysis(Matrices{mass, d.asDiagonal(), k.asDiagonal()});
        const auto limit = analysis.max_step(Method::explicit_euler);
        CHECK(static_cast<Real>(limit.certified) <= truth);
        CHECK(static_cast<Real>(limit.certified) >= truth * (1 - 3e-4L));
        CHECK(static_cast<Real>(limit.refuted) >= truth);
    }
}

TEST_CASE("explicit_limit: dampers without stiffness, at any strength", "[proof]") {
    for (int exponent = -150; exponent <= 150; exponent += 5) {
        const double d = std::pow(10.0, exponent);
        const Analysis analysis(Matrices{Eigen::Vector2d(1, 1),
                                         Eigen::Vector2d(d, 2 * d).asDiagonal(),
                                         Eigen::MatrixXd::Zero(2, 2)});
        INFO("D = diag(1, 2) * " << d);
        for (const double tightness : {0.0, 1e-6}) {
            const auto limit = analysis.max_step(Method::explicit_euler, tightness);
            CHECK(limit.certified <= 1 / d);
            CHECK(limit.certified >= (1 - 2e-4) / d);
            CHECK(limit.refuted >= (1 - 1e-15) / d);
        }
    }
}

}  // namespace taut_test::explicit_limit_test
