// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <set>
#include <taut/proof/bracket.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/methods.hpp"
#include "../support/proof_scenes.hpp"
#include "../support/tolerance.hpp"

// What Stability tells beside its brackets.

namespace taut_test::stability_test {

using taut::Cause;
using taut::Method;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Indefinite dampers; K positive definite, or indefinite as well.
Matrices active(bool buckled) {
    Eigen::Matrix2d D, K;
    D << 1, 2, 2, 1;
    K << 2, -1, -1, 2;
    if (buckled) K.diagonal().array() -= 2;
    return {Eigen::Vector2d(1, 1), D, K};
}

}  // namespace

TEST_CASE("stability: a float scene at rest does not buckle by its rounding", "[proof]") {
    const auto cloth = cloth_scene({6, 6}, true);
    const Analysis analysis(cloth, cloth.initial_state());
    CHECK(analysis.max_step(Method::symplectic_euler).cause == Cause::stiffness);
    CHECK(analysis.max_step(Method::explicit_euler).cause == Cause::undamped);
    CHECK(analysis.max_step(Method::implicit_euler).cause == Cause::unconditional);
    CHECK(analysis.max_step(Method::implicit_euler).growth_rate == 0);
}

TEST_CASE("stability: numbers that overflow are an open bracket and no NaN, or named",
          "[proof][bad_input]") {
    Random random(744);
    for (int repeat = 0; repeat < 200; ++repeat) {
        INFO("repeat " << repeat << " of seed 744");
        const Index n = 2 + random.below(6);
        Matrices m{Eigen::VectorXd(n), {}, Eigen::MatrixXd(n, n)};
        for (Index i = 0; i < n; ++i) m.mass[i] = log_uniform(random, 1e-3, 1e8);
        for (Index j = 0; j < n; ++j) {
            for (Index i = j; i < n; ++i) {
                m.stiffness(i, j) = m.stiffness(j, i) =
                    random.uniform(-1, 1) * log_uniform(random, 1e130, 1e150);
            }
        }
        const auto spectrum = Analysis(m).stiffness_spectrum();
        CHECK(spectrum.k_min.lower <= spectrum.k_min.upper);
        CHECK(spectrum.k_max.lower <= spectrum.k_max.upper);
    }
    Eigen::Matrix2d K = Eigen::Matrix2d::Constant(-1.5e308);
    K(1, 1) = 1.5e308;
    CHECK_THROWS_WITH(Analysis(Matrices{Eigen::Vector2d(1, 1), {}, K}),
                      ContainsSubstring("stiffness in row 0"));
}

TEST_CASE("stability: causes", "[proof]") {
    taut::ChainOptions options;
    options.ends = taut::ChainEnds::fixed_free;
    auto chain = chain_scene(false, 2, options);
    const auto rest = chain.initial_state();
    const auto expect = [&](const Scene& scene, const AnyState& state, Method method, Cause cause) {
        const auto limit = scene.limit(method, state);
        CHECK(limit.cause == cause);
        return limit;
    };

    SECTION("without damping explicit Euler has no step, and a vector says so") {
        const auto limit = expect(chain, rest, Method::explicit_euler, Cause::undamped);
        CHECK(limit.certified == 0);
        CHECK(limit.refuted == 0);
        CHECK_FALSE(limit.step_for(chain, 1).has_value());
    }
    SECTION("stiffness or damping") {
        expect(chain, rest, Method::symplectic_euler, Cause::stiffness);
        expect(chain, rest, Method::implicit_euler, Cause::unconditional);
        chain.set_rayleigh(50, 0);
        expect(chain, rest, Method::symplectic_euler, Cause::damping);
        expect(chain, rest, Method::explicit_euler, Cause::damping);
        chain.set_rayleigh(0.5, 0);
        expect(chain, rest, Method::symplectic_euler, Cause::stiffness);
        expect(chain, rest, Method::explicit_euler, Cause::damping);
        // At d = ω the explicit limit d/k comes to 1/ω; at d = 2ω, as large as any damping allows.
        options.masses = 1;
        auto one = chain_scene(false, 1, options);
        one.set_rayleigh(0, 2);
        expect(one, one.initial_state(), Method::explicit_euler, Cause::stiffness);
    }
    SECTION("dampers along a stretched chain leave its transverse modes undamped") {
        const auto damped = with_dampers(chain, 0.1);
        const Analysis analysis(damped, deformed(damped, 1.5, 0, 1));
        for (const double tightness : {0.0, 0.1}) {
            const auto limit = analysis.max_step(Method::explicit_euler, tightness);
            CHECK(limit.cause == Cause::undamped_modes);
            CHECK(limit.certified == 0);
            if (tightness > 0) CHECK(limit.refuted < 1e-8);  // dense eigenvalues cannot tell more
        }
    }
    SECTION("compression") {
        const auto pressed = deformed(chain, 0.5, 0, 1);
        for (const Method method :
             {Method::symplectic_euler, Method::velocity_verlet, Method::implicit_euler}) {
            const auto limit = expect(chain, pressed, method, Cause::buckling);
            CHECK(limit.certified > 0);
            CHECK(limit.growth_rate > 0);
        }
        // Without damping explicit Euler fails for that reason first; the growth is told all the
        // same.
        CHECK(expect(chain, pressed, Method::explicit_euler, Cause::undamped).growth_rate > 0);
    }
    SECTION("nothing to limit") {
        for (const Method method : limited_methods) {
            Scene alone({false, 3, Laws::hookean});
            alone.add_particle(Eigen::Vector3d(0, 0, 0), 1);
            if (method != Method::implicit_euler)
                CHECK(expect(alone, alone.initial_state(), method, Cause::nothing_to_limit)
                          .unbounded());
            alone.pin(0);
            const auto limit =
                expect(alone, alone.initial_state(), method, Cause::nothing_to_limit);
            CHECK(limit.unbounded());
            CHECK(std::isinf(limit.refuted));
        }
    }
    SECTION("a damping matrix that is not positive semi-definite") {
        for (const bool buckled : {false, true}) {  // which does not hide it
            const Analysis analysis(active(buckled));
            for (const Method method : limited_methods) {
                const auto limit = analysis.max_step(method);
                CHECK(limit.cause == Cause::damping_unproved);
                CHECK(limit.certified == 0);
                CHECK(std::isinf(limit.refuted));
                CHECK_FALSE(analysis.proves(method, 1e-3));
            }
            CHECK(analysis.max_stiffness_scale(Method::symplectic_euler, 1e-3) == 0);
            CHECK(analysis.min_mass_scale(Method::symplectic_euler, 1e-3) == infinity);
        }
    }
}

TEST_CASE("stability: each cause has its own sentence and its own name", "[proof]") {
    std::set<std::string> sentences, names;
    for (int i = 0; i <= static_cast<int>(Cause::overflow); ++i) {
        const auto cause = static_cast<Cause>(i);
        CHECK(std::string(describe(cause)).size() > 10);
        sentences.insert(describe(cause));
        names.insert(name(cause));
    }
    CHECK(sentences.size() == 10);
    CHECK(names.size() == 10);
    CHECK(names.count("unknown") == 0);
}

TEST_CASE("stability: the spectrum's brackets hold, and zero modes are counted", "[proof]") {
    for (const auto& c : stability_cases(false, false)) {
        INFO(c.text);
        const Exact& e = c.exact;
        const auto& stability = c.analysis.in_double();
        const auto spectrum = taut::stiffness_spectrum(stability);
        CHECK(stability.size() == e.size());
        if (e.size() == 0) {
            CHECK(spectrum.k_max.upper == 0);
            CHECK(taut::limiting_mode(stability).shape.size() == 0);
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
        CHECK(taut::count_zero_modes(stability) ==
              (k.array() <= 1e-10L * static_cast<Real>(spectrum.k_max.upper)).count());

        const auto mode = taut::limiting_mode(stability);
        REQUIRE(mode.shape.size() == e.size());
        const RealVector u = mode.shape.cast<Real>();
        const auto quotient = static_cast<double>(u.dot(e.K_plus * u));
        CHECK_THAT(static_cast<double>(u.dot(e.mass.cwiseProduct(u))), WithinRel(1.0, 1e-12));
        CHECK_THAT(mode.k, WithinRel(quotient, 1e-10));
        CHECK_THAT(mode.k, WithinRel(static_cast<double>(largest), 1e-5));
    }
}

TEST_CASE("stability: the softest mode of indefinite matrices is found below a free translation",
          "[proof]") {
    Random random(77);
    for (const Index n : {3, 8, 40, 300}) {
        // K1 = 0, as of springs that nothing holds, and one direction that pushes outwards.
        RealMatrix G = random_points(random, static_cast<int>(n), n, -1, 1).cast<Real>();
        G.col(0).setOnes();
        const Eigen::MatrixXd Q = orthogonal(G).cast<double>();
        Eigen::VectorXd lambda = random_vector(random, static_cast<int>(n), 0.5, 1);
        lambda[0] = 0;
        lambda[n - 1] = -random.uniform(0.1, 0.4);
        const Eigen::MatrixXd K = Q * lambda.asDiagonal() * Q.transpose();
        const Analysis analysis(
            Matrices{Eigen::VectorXd::Ones(n), {}, (K + K.transpose()).eval() / 2});
        const auto k_min = analysis.stiffness_spectrum().k_min;
        INFO(n << " degrees of freedom, least eigenvalue " << lambda[n - 1]);
        CHECK(k_min.lower <= lambda[n - 1] + 1e-12);
        CHECK(k_min.upper >= lambda[n - 1] - 1e-12);
        CHECK(k_min.upper <= 0.99 * lambda[n - 1]);
    }
}

TEST_CASE("stability: rayleigh_window is proved: any alpha inside keeps the scene stable",
          "[proof]") {
    int windows = 0;
    for (const auto& c : stability_cases(false, false)) {
        if (c.exact.size() == 0) continue;
        const double omega = Multipliers(c.exact).omega();
        for (const Method method : limited_methods) {
            if (method == Method::velocity_verlet) continue;  // by the multipliers of the next
            for (const auto& [z, d0] :
                 {std::pair(0.05, 0.0), {0.4, 0.0}, {0.9, 0.0}, {0.4, 0.7 * omega}}) {
                INFO(c.text << ", " << name(method) << ", z = " << z << ", d0 = " << d0);
                const double h = z / omega;
                const auto window = c.analysis.in_double().rayleigh_window(method, h, d0);
                if (window.empty != taut::EmptyWindow::none) continue;
                ++windows;
                const double top =
                    std::isinf(window.upper) ? window.lower + 10 / omega : window.upper;
                for (const double part : {1e-6, 1 - 1e-6}) {
                    const double alpha = window.lower + part * (top - window.lower);
                    CHECK(window.contains(alpha));
                    Exact damped = c.exact;
                    damped.D.setZero();
                    damped.add_rayleigh(d0, alpha);
                    CHECK(Multipliers(damped).induced_radius(method, h) <=
                          1 + Multipliers::tolerance);
                }
            }
        }
    }
    CHECK(windows > 60);
}

TEST_CASE("stability: wrong input is refused", "[proof][bad_input]") {
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

TEST_CASE("stability: a change reaches the analysis by a new one alone, and the limit then is new",
          "[proof]") {
    auto cloth = taut::hanging_cloth<double>({16, 14});
    auto state = cloth.initial_state();
    taut::Stability<double> stability(cloth, state);
    const auto method = Method::symplectic_euler;
    const auto certificate = taut::certify(stability, method, 1e-4);
    CHECK(certificate.proved);
    CHECK(certificate.step == 1e-4);
    CHECK(certificate.method == method);
    const auto check = [&](const char* change, auto&& make) {
        INFO(change);
        const auto before = stability.max_step(method);
        make();
        CHECK(stability.max_step(method).certified == before.certified);
        stability = taut::Stability<double>(cloth, state);
        const auto limit = stability.max_step(method);
        const auto anew = taut::bracket(taut::Stability<double>(cloth, state), method);
        CHECK(limit.step_for(cloth, 1.0).has_value());
        CHECK(before.step_for(cloth, 0.9).has_value() == (before.revision == cloth.revision()));
        CHECK(std::isinf(limit.refuted));
        CHECK(limit.certified < anew.refuted);
        CHECK(anew.refuted / limit.certified < 1.06);
        CHECK(stability.size() == 3 * (cloth.size() - cloth.pinned_count()));
    };
    check("a spring added", [&] { cloth.add_spring(30, 45, 1e6); });
    // The mode of the last one is still there, and leads no more.
    check("a stiffer one elsewhere", [&] { cloth.add_spring(150, 165, 1e7); });
    check("a lighter particle", [&] { cloth.set_mass(100, 1e-5); });
    check("a pin added", [&] { cloth.pin(7); });
    check("another pose", [&] { state.x *= 1.02; });
}

TEST_CASE(
    "stability: a scene is analysed if double holds the squares of its numbers, or refused "
    "by name",
    "[proof][bad_input]") {
    for (const int dim : {1, 2, 3}) {
        Random random(29);
        int refused = 0;
        for (int i = 0; i < 200; ++i) {
            // One of four numbers near the ends of the range, on either side.
            const double size =
                std::exp2(random.uniform(495, 505) * (random.below(2) == 0 ? 1 : -1));
            const Index which = random.below(4);
            const auto number = [&](Index place) { return place == which ? size : 1.0; };
            Scene scene({false, dim, Laws::hookean});
            scene.add_particle(Eigen::VectorXd::Zero(dim), 1);
            scene.add_particle(number(0) * Eigen::VectorXd::Unit(dim, 0), number(1));
            scene.add_spring({0, 1, number(2), number(3)});
            scene.pin(0);
            const bool length = which == 0 || which == 3;
            const bool holds = size <= 0x1p500 && (length || size >= 0x1p-500);
            const char* const names[] = {"position of particle 1", "mass of particle 1",
                                         "stiffness of spring 0", "rest length of spring 0"};
            INFO(names[which] << " is " << size << " in " << dim << " dimensions");
            const auto message = message_of([&] {
                const auto limit = scene.limit(Method::symplectic_euler, scene.initial_state());
                const Real k = number(2) / static_cast<Real>(number(1));
                CHECK(limit.certified > 0);
                CHECK(static_cast<Real>(limit.certified) <= 2 / std::sqrt(k));
            });
            CHECK((message == "") == holds);
            if (!holds) CHECK(missing(message, {names[which]}) == "");
            refused += !holds;
        }
        CHECK(refused > 25);
        CHECK(refused < 100);
    }
}

TEST_CASE("stability: damping is analysed if the system's scalars hold it, or refused by name",
          "[proof][bad_input]") {
    for (const bool single : {false, true}) {
        const double most = single ? static_cast<double>(std::numeric_limits<float>::max())
                                   : std::numeric_limits<double>::max();
        Random random(30);
        int refused = 0;
        for (int i = 0; i < 100; ++i) {
            const double size = std::exp2(random.uniform(-400, 400));
            const Index which = random.below(2);
            const double k = static_cast<float>(log_uniform(random, 1e-3, 1e3));
            INFO("damping " << which << " is " << size);
            const auto message = message_of([&] {
                Scene scene({single, 2, Laws::hookean});
                scene.add_particle(Eigen::Vector2d(0, 0), 1);
                scene.add_particle(Eigen::Vector2d(1, 0), 1);
                scene.add_spring({0, 1, k, 1});
                scene.pin(0);
                scene.set_rayleigh(which == 0 ? size : 0, which == 1 ? size : 0);
                const auto largest =
                    Analysis(scene, scene.initial_state()).stiffness_spectrum().k_max;
                CHECK(largest.upper >= k);
                CHECK(largest.lower <= largest.upper);
            });
            CHECK((message == "") == (size <= most));
            if (size > most) {
                const char* const names[] = {"mass_proportional", "stiffness_proportional"};
                CHECK(missing(message, {names[which], "end at"}) == "");
            }
            refused += size > most;
        }
        CHECK((refused > 25) == single);
    }
}

}  // namespace taut_test::stability_test
