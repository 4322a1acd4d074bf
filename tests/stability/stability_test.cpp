// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <stdexcept>
#include <set>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/stability/stability.hpp>
#include <taut/tight/tight.hpp>

#include "../support/catch.hpp"
#include "../support/methods.hpp"
#include "../support/stability_scenes.hpp"

namespace taut_test::stability_test {

using taut::Cause;
using taut::Method;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// certified ≤ truth ≤ refuted, the truth by dense multipliers; empty when it holds.
template <class Scalar>
std::string bracket_error(const taut::StepLimit<Scalar>& limit, const Multipliers& multipliers,
                          Method method) {
    const auto certified = static_cast<double>(limit.certified);
    const auto refuted = static_cast<double>(limit.refuted);
    const auto text = [&](const char* what, double h, Real radius) {
        return std::string(what) + " at h·ω = " + std::to_string(h * multipliers.omega()) +
               ", |mu| - 1 = " + std::to_string(static_cast<double>((radius - 1) * 1e12L)) + "e-12";
    };
    if (!(certified >= 0) || !(refuted >= certified)) return "not a bracket";
    if (method == Method::explicit_euler) {
        const double truth = multipliers.explicit_limit();
        if (certified > truth * (1 + 1e-9))
            return "certified is above the truth, " + std::to_string(truth);
        if (refuted < truth * (1 - 1e-6))
            return "refuted is below the truth, " + std::to_string(truth);
        return {};
    }
    std::vector<double> safe;
    for (const double part : {1 - 1e-9, 0.9, 0.3, 1e-2}) {
        if (certified > 0 && std::isfinite(certified)) safe.push_back(part * certified);
    }
    for (const double z : {1e-2, 1.0, 10.0, 100.0}) {
        if (std::isinf(certified)) safe.push_back(z / multipliers.omega());
    }
    for (const double h : safe) {
        const Real radius = multipliers.induced_radius(method, h);
        if (!(radius <= 1 + Multipliers::tolerance))
            return text("certified is unstable", h, radius);
    }
    if (std::isfinite(refuted)) {
        const double h = refuted * (1 + 1e-6);
        const Real radius = multipliers.induced_radius(method, h);
        if (!(radius > 1 + Multipliers::tolerance)) return text("refuted is stable", h, radius);
    }
    return {};
}

}  // namespace

TEMPLATE_TEST_CASE("stability: certified <= truth <= refuted, every method, scene and damping",
                   "[stability][slow]", double, float) {
    for (const auto& c : stability_cases<TestType>(true)) {
        const Multipliers multipliers = c.multipliers();
        for (const Method method : limited_methods) {
            const auto limit = c.stability.max_step(method);
            INFO(c.text << ", " << name(method) << ": " << limit.certified << ", "
                        << limit.refuted);
            CHECK(bracket_error(limit, multipliers, method) == "");
            CHECK(limit.revision == c.revision);
            CHECK(std::string(describe(limit.cause)).size() > 10);
            if (method == Method::implicit_euler) CHECK(std::isinf(limit.certified));
        }
    }
}

TEST_CASE("stability: the growth of the physics is given apart from the step's limit",
          "[stability]") {
    for (const auto& c : stability_cases<double>(true)) {
        const Multipliers multipliers = c.multipliers();
        for (const Method method : limited_methods) {
            INFO(c.text << ", " << name(method));
            const auto limit = c.stability.max_step(method);
            CHECK_THAT(limit.growth_rate,
                       Catch::Matchers::WithinRel(multipliers.growth_rate(), 1e-3) ||
                           Catch::Matchers::WithinAbs(multipliers.growth_rate(), 1e-12));
            // Why nothing is certified matters more than that the scene buckles as well.
            CHECK((limit.cause == Cause::buckling) ==
                  (multipliers.buckled() && limit.certified > 0));
        }
    }
}

TEST_CASE("stability: a float scene at rest does not buckle by its rounding", "[stability]") {
    const auto cloth = taut::hanging_cloth<float>({6, 6});
    const taut::Stability<float> stability(cloth, cloth.initial_state());
    CHECK(stability.max_step(Method::symplectic_euler).cause == Cause::stiffness);
    CHECK(stability.max_step(Method::explicit_euler).cause == Cause::undamped);
    CHECK(stability.max_step(Method::implicit_euler).cause == Cause::unconditional);
    CHECK(stability.max_step(Method::implicit_euler).growth_rate == 0);
}

TEST_CASE("stability: certify proves up to certified and nothing that is refuted", "[stability]") {
    for (const auto& c : stability_cases<double>(true)) {
        for (const Method method : limited_methods) {
            INFO(c.text << ", " << name(method));
            const auto limit = c.stability.max_step(method);
            if (limit.certified > 0) {
                const double h = limit.unbounded() ? 1e3 : limit.certified;
                const auto certificate = taut::certify(c.stability, method, h);
                CHECK(certificate.proved);
                CHECK(certificate.step == h);
                CHECK(certificate.method == method);
                CHECK(taut::certify(c.stability, method, 0.1 * h).proved);
            }
            if (std::isfinite(limit.refuted)) {
                CHECK_FALSE(
                    taut::certify(c.stability, method, 1.001 * limit.refuted + 1e-300).proved);
            }
            for (const double h : {0.0, -1.0, std::nan("")})
                CHECK_THROWS_AS(taut::certify(c.stability, method, h), std::invalid_argument);
        }
    }
}

TEST_CASE("stability: spectral_radius is that of the transition matrix", "[stability][slow]") {
    for (const auto& c : stability_cases<double>(true)) {
        const Multipliers multipliers = c.multipliers();
        if (multipliers.buckled() || c.exact.size() == 0)
            continue;  // in a buckled pose K⁺ stands for K
        for (const Method method : limited_methods) {
            for (const double z : {0.05, 0.7, 3.0}) {
                const double h = z / multipliers.omega();
                INFO(c.text << ", " << name(method) << ", z = " << z);
                const auto truth = static_cast<double>(multipliers.radius(method, h));
                const double radius = taut::spectral_radius(c.stability, method, h);
                // √eps where two multipliers meet. The velocity of a zero mode may count as 1 or
                // not.
                if (truth > 1 + 1e-6 || multipliers.zero_modes() == 0) {
                    CHECK_THAT(radius, Catch::Matchers::WithinRel(truth, 1e-6));
                } else {
                    CHECK(radius <= 1 + 1e-6);
                }
            }
        }
    }
}

TEST_CASE("stability: a spectrum that overflows is an open bracket and no NaN", "[stability]") {
    Random random(744);
    for (int repeat = 0; repeat < 200; ++repeat) {
        const Index n = 2 + random.below(6);
        Eigen::VectorXd mass(n);
        for (Index i = 0; i < n; ++i) mass[i] = log_uniform(random, 1e-3, 1e8);
        Eigen::MatrixXd K(n, n);
        for (Index j = 0; j < n; ++j) {
            for (Index i = j; i < n; ++i) {
                K(i, j) = K(j, i) = random.uniform(-1, 1) * log_uniform(random, 1e130, 1e150);
            }
        }
        const taut::Stability<double> stability(taut::LinearSystem<double>(mass, {}, sparse(K)));
        const auto spectrum = stability.stiffness_spectrum();
        CHECK(spectrum.k_min.lower <= spectrum.k_min.upper);
        CHECK(spectrum.k_max.lower <= spectrum.k_max.upper);
    }
}

TEST_CASE("stability: causes", "[stability]") {
    std::set<Cause> reached;
    const auto expect = [&](const auto& limit, Cause cause) {
        reached.insert(limit.cause);
        CHECK(limit.cause == cause);
    };
    taut::ChainOptions options;
    options.ends = taut::ChainEnds::fixed_free;
    auto chain = taut::chain<double, 2>(options);
    const auto limit_of = [](const auto& system, const auto& state, Method method) {
        return taut::Stability<double>(system, state).max_step(method);
    };
    const auto rest = chain.initial_state();

    SECTION("without damping explicit Euler has no step, and a vector says so") {
        const auto limit = limit_of(chain, rest, Method::explicit_euler);
        expect(limit, Cause::undamped);
        CHECK(limit.certified == 0);
        CHECK(limit.refuted == 0);
        CHECK_FALSE(limit.step_for(chain, 1).has_value());
    }
    SECTION("stiffness or damping") {
        expect(limit_of(chain, rest, Method::symplectic_euler), Cause::stiffness);
        expect(limit_of(chain, rest, Method::implicit_euler), Cause::unconditional);
        chain.set_rayleigh({50, 0});
        expect(limit_of(chain, rest, Method::symplectic_euler), Cause::damping);
        expect(limit_of(chain, rest, Method::explicit_euler), Cause::damping);
        chain.set_rayleigh({0.5, 0});
        expect(limit_of(chain, rest, Method::symplectic_euler), Cause::stiffness);
        expect(limit_of(chain, rest, Method::explicit_euler), Cause::damping);
        // At d = ω the explicit limit d/k comes to 1/ω; at d = 2ω, as large as any damping allows.
        auto one = taut::SpringSystem<double, 1>();
        one.add_particle(Eigen::Matrix<double, 1, 1>(0.0), 1);
        one.add_particle(Eigen::Matrix<double, 1, 1>(1.0), 1);
        one.pin(0);
        one.add_spring(0, 1, 1.0);
        one.set_rayleigh({0, 2});
        expect(limit_of(one, one.initial_state(), Method::explicit_euler), Cause::stiffness);
    }
    SECTION("dampers along a stretched chain leave its transverse modes undamped") {
        const auto damped = with_dampers(chain, 0.1);
        auto pulled = rest;
        pulled.x *= 1.5;
        const taut::Stability<double> stability(damped, pulled);
        for (const double tightness : {0.0, 0.1}) {
            const auto limit = taut::max_step(stability, Method::explicit_euler, tightness);
            expect(limit, Cause::undamped_modes);
            CHECK(limit.certified == 0);
            if (tightness > 0) CHECK(limit.refuted < 1e-8);  // dense eigenvalues cannot tell more
        }
    }
    SECTION("compression") {
        auto pressed = rest;
        pressed.x *= 0.5;
        for (const Method method :
             {Method::symplectic_euler, Method::velocity_verlet, Method::implicit_euler}) {
            const auto limit = limit_of(chain, pressed, method);
            expect(limit, Cause::buckling);
            CHECK(limit.certified > 0);
            CHECK(limit.growth_rate > 0);
        }
        // Without damping explicit Euler fails for that reason first; the growth is told all the
        // same.
        const auto limit = limit_of(chain, pressed, Method::explicit_euler);
        expect(limit, Cause::undamped);
        CHECK(limit.growth_rate > 0);
    }
    SECTION("nothing to limit") {
        for (const Method method : limited_methods) {
            taut::SpringSystem<double, 3> alone;
            alone.add_particle({0, 0, 0}, 1);
            if (method != Method::implicit_euler) {
                const auto limit = limit_of(alone, alone.initial_state(), method);
                expect(limit, Cause::nothing_to_limit);
                CHECK(limit.unbounded());
            }
            alone.pin(0);
            const auto limit = limit_of(alone, alone.initial_state(), method);
            expect(limit, Cause::nothing_to_limit);
            CHECK(limit.unbounded());
            CHECK(std::isinf(limit.refuted));
        }
    }
    SECTION("a damping matrix that is not positive semi-definite") {
        const Eigen::Vector2d mass(1, 1);
        Eigen::Matrix2d D, K;
        D << 1, 2, 2, 1;
        K << 2, -1, -1, 2;
        for (const double sign : {1.0, -1.0}) {  // a K that is indefinite as well does not hide it
            const Eigen::Matrix2d stiffness =
                K + (sign < 0 ? -2.0 : 0.0) * Eigen::Matrix2d::Identity();
            const taut::Stability<double> stability(
                taut::LinearSystem<double>(mass, sparse(D), sparse(stiffness)));
            for (const Method method : limited_methods) {
                const auto limit = stability.max_step(method);
                expect(limit, Cause::damping_unproved);
                CHECK(limit.certified == 0);
                CHECK(std::isinf(limit.refuted));
            }
        }
    }
}

TEST_CASE("stability: each cause has its own sentence", "[stability]") {
    std::set<std::string> sentences;
    for (const Cause cause : {Cause::stiffness, Cause::damping, Cause::undamped,
                              Cause::undamped_modes, Cause::unconditional, Cause::nothing_to_limit,
                              Cause::buckling, Cause::damping_unproved, Cause::rounding}) {
        CHECK(std::string(describe(cause)).size() > 10);
        sentences.insert(describe(cause));
    }
    CHECK(sentences.size() == 9);
}

TEST_CASE("stability: the spectrum's brackets hold, and zero modes are counted", "[stability]") {
    for (const auto& c : stability_cases<double>(false)) {
        INFO(c.text);
        const Exact& e = c.exact;
        const auto spectrum = c.stability.stiffness_spectrum();
        CHECK(c.stability.size() == e.size());
        if (e.size() == 0) {
            CHECK(spectrum.k_max.upper == 0);
            CHECK(c.stability.limiting_mode().shape.size() == 0);
            continue;
        }
        const RealVector k = eigenvalues(e.scaled(0, 1, 0, true));
        const Real largest = k[k.size() - 1];
        const Real noise = 1e-17L * largest;
        CHECK(spectrum.k_max.upper >= largest - noise);
        CHECK(spectrum.k_max.lower <= largest + noise);
        CHECK(spectrum.k_max.lower >= 0.98L * largest);
        CHECK(spectrum.k_min.lower == 0);
        CHECK(spectrum.k_min.upper >= k[0] - noise);
        CHECK(taut::count_zero_modes(c.stability) ==
              (k.array() <= 1e-10L * static_cast<Real>(spectrum.k_max.upper)).count());

        const auto mode = c.stability.limiting_mode();
        REQUIRE(mode.shape.size() == e.size());
        const RealVector u = mode.shape.cast<Real>();
        const auto quotient = static_cast<double>(u.dot(e.K_plus * u));
        CHECK_THAT(static_cast<double>(u.dot(e.mass.cwiseProduct(u))),
                   Catch::Matchers::WithinRel(1.0, 1e-12));
        CHECK_THAT(mode.k, Catch::Matchers::WithinRel(quotient, 1e-10));
        CHECK_THAT(mode.k, Catch::Matchers::WithinRel(static_cast<double>(largest), 1e-5));
    }
}

TEST_CASE("stability: rayleigh_window is proved: any alpha inside keeps the scene stable",
          "[stability][slow]") {
    int windows = 0;
    for (const auto& c : stability_cases<double>(false)) {
        if (c.exact.size() == 0) continue;
        const double omega = c.multipliers().omega();
        for (const Method method : limited_methods) {
            for (const double z : {0.05, 0.4, 0.9}) {
                for (const double d0 : {0.0, 0.7 * omega}) {
                    INFO(c.text << ", " << name(method) << ", z = " << z << ", d0 = " << d0);
                    const double h = z / omega;
                    const auto window = c.stability.rayleigh_window(method, h, d0);
                    if (window.empty != taut::EmptyWindow::none) continue;
                    ++windows;
                    const double top =
                        std::isinf(window.upper) ? window.lower + 10 / omega : window.upper;
                    for (const double part : {1e-6, 0.5, 1 - 1e-6}) {
                        const double alpha = window.lower + part * (top - window.lower);
                        CHECK(window.contains(alpha));
                        Exact damped = c.exact;
                        damped.D = static_cast<Real>(alpha) * c.exact.K_plus;
                        damped.D.diagonal() += static_cast<Real>(d0) * c.exact.mass;
                        CHECK(Multipliers(damped).induced_radius(method, h) <=
                              1 + Multipliers::tolerance);
                    }
                }
            }
        }
    }
    CHECK(windows > 100);
}

TEST_CASE("stability: wrong input is refused", "[stability]") {
    const auto cloth = taut::hanging_cloth<double>({3, 3});
    auto state = cloth.initial_state();
    const taut::Stability<double> stability(cloth, state);
    for (const double h : {0.0, -1.0, infinity, std::nan("")}) {
        CHECK_THROWS_AS(taut::spectral_radius(stability, Method::explicit_euler, h),
                        std::invalid_argument);
        CHECK_THROWS_AS(stability.rayleigh_window(Method::explicit_euler, h),
                        std::invalid_argument);
    }
    CHECK_THROWS_AS(stability.rayleigh_window(Method::explicit_euler, 1e-3, -1),
                    std::invalid_argument);
    state.x(1, 2) = std::nan("");
    CHECK_THROWS_AS(taut::Stability<double>(cloth, state), std::invalid_argument);
    CHECK_THROWS_AS(
        taut::Stability<double>(cloth, taut::hanging_cloth<double>({2, 2}).initial_state()),
        std::invalid_argument);
}

TEST_CASE("stability: later changes of the system do not reach the analysis", "[stability]") {
    auto cloth = taut::hanging_cloth<double>({4, 4});
    const taut::Stability<double> stability(cloth, cloth.initial_state());
    const auto before = stability.max_step(Method::symplectic_euler);
    cloth.add_spring(0, 5, 1e6);
    const auto after = stability.max_step(Method::symplectic_euler);
    CHECK(before.certified == after.certified);
    CHECK_FALSE(before.step_for(cloth, 0.9).has_value());
}

}  // namespace taut_test::stability_test
