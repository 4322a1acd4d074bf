// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "../support/catch.hpp"
#include "../support/methods.hpp"
#include "../support/proof_scenes.hpp"

// What every bracket of a pose promises: of every scene and damping, by every method, as tight as
// asked for, the truth by the referee's multipliers.

namespace taut_test::limit_test {

using taut::Cause;
using taut::Method;
using taut::StepLimit;

namespace {

constexpr Real noise = 256 * real_epsilon;

struct Truth {
    Multipliers multipliers;
    double explicit_limit;

    explicit Truth(const Exact& e) : multipliers(e), explicit_limit(multipliers.explicit_limit()) {}
};

/// certified ≤ truth ≤ refuted; empty when it holds.
std::string bracket_error(const StepLimit<double>& limit, const Truth& known, Method method) {
    const Multipliers& multipliers = known.multipliers;
    const auto text = [&](const char* what, double h, Real radius) {
        return std::string(what) + " at h·ω = " + std::to_string(h * multipliers.omega()) +
               ", |mu| - 1 = " + std::to_string(static_cast<double>((radius - 1) * 1e12L)) + "e-12";
    };
    const auto [certified, refuted] = std::pair(limit.certified, limit.refuted);
    if (!(certified >= 0) || !(refuted >= certified)) return "not a bracket";
    if (method == Method::explicit_euler) {
        const double truth = known.explicit_limit;
        if (certified > truth * (1 + 1e-9)) return "certified above " + std::to_string(truth);
        if (refuted < truth * (1 - 1e-6)) return "refuted below " + std::to_string(truth);
        return {};
    }
    std::vector<double> safe;
    for (const double part : {1 - 1e-9, 0.5, 1e-2}) {
        if (certified > 0 && std::isfinite(certified)) safe.push_back(part * certified);
    }
    for (const double z : {1.0, 100.0}) {
        if (std::isinf(certified)) safe.push_back(z / multipliers.omega());
    }
    for (const double h : safe) {
        const Real radius = multipliers.induced_radius(method, h);
        if (!(radius <= 1 + Multipliers::tolerance))
            return text("certified is unstable", h, radius);
    }
    if (std::isinf(refuted)) return {};
    const double h = refuted * (1 + 1e-6);
    const Real radius = multipliers.induced_radius(method, h);
    return radius > 1 + Multipliers::tolerance ? "" : text("refuted is stable", h, radius);
}

/// A bracket of symplectic Euler as tight as asked for, by the condition itself.
void check_narrowed(const StepLimit<double>& limit, const Exact& e, double tightness,
                    const Kind& kind) {
    INFO(limit.certified << ", " << limit.refuted << ", " << describe(limit.cause));
    REQUIRE(limit.certified > 0);
    if (std::isfinite(limit.certified)) {
        for (const double part : {1.0, 0.7, 0.01})
            CHECK(definite_margin(e, part * limit.certified) >= -noise);
    }
    if (std::isfinite(limit.refuted)) CHECK(definite_margin(e, limit.refuted) <= noise);
    // Both ends count 2 ulp of a stepper's, and are rounded.
    CHECK((limit.unbounded()
               ? std::isinf(limit.refuted)
               : limit.refuted <= limit.certified * (1 + tightness) * (1 + 10 * kind.epsilon())));
}

/// Tightened, a bracket keeps every promise and is no wider.
void check_tightened(const StabilityCase& c, const Truth& truth, Method method,
                     const StepLimit<double>& bound) {
    if (c.exact.size() == 0) return;
    const bool is_explicit = method == Method::explicit_euler;
    const auto limit = c.analysis.max_step(method, is_explicit ? 1e-4 : 1e-6);
    INFO("tightened: " << limit.certified << ", " << limit.refuted);
    CHECK(limit.certified >= bound.certified);
    CHECK(limit.refuted <= bound.refuted);
    CHECK(limit.revision == bound.revision);
    if (method == Method::symplectic_euler) check_narrowed(limit, c.exact, 1e-6, c.scene.kind());
    if (method == Method::velocity_verlet)
        CHECK(limit.certified == c.analysis.max_step(Method::symplectic_euler, 1e-6).certified);
    if (!is_explicit) return;
    CHECK(bracket_error(limit, truth, method) == "");
    if (limit.certified_up_to > 0) {
        const double h = limit.certified_up_to;
        CHECK(limit.admitted_growth > 0);
        CHECK(truth.multipliers.induced_radius(method, h) <=
              1 + static_cast<Real>(h * limit.admitted_growth) + Multipliers::tolerance);
    }
}

void check_case(const StabilityCase& c, const Truth& truth, Method method) {
    const Multipliers& multipliers = truth.multipliers;
    INFO(c.scene.kind() << ", " << c.text << ", " << name(method));
    const auto limit = c.analysis.max_step(method);
    INFO(limit.certified << ", " << limit.refuted << ", " << name(limit.cause));
    // The condition, and the step's multipliers, are those of symplectic Euler.
    if (method == Method::velocity_verlet) {
        const auto symplectic = c.analysis.max_step(Method::symplectic_euler);
        CHECK(limit.certified == symplectic.certified);
        CHECK(limit.refuted == symplectic.refuted);
    } else {
        CHECK(bracket_error(limit, truth, method) == "");
    }
    CHECK(limit.revision == c.scene.revision());
    CHECK(std::string(describe(limit.cause)).size() > 10);
    if (method == Method::implicit_euler) CHECK(std::isinf(limit.certified));
    if (!c.scene.kind().single) {  // what a float scene's rounding presses together is no physics
        CHECK_THAT(limit.growth_rate, WithinRel(multipliers.growth_rate(), 1e-3) ||
                                          WithinAbs(multipliers.growth_rate(), 1e-12));
        // Why nothing is certified matters more than that the scene buckles as well.
        CHECK((limit.cause == Cause::buckling) == (multipliers.buckled() && limit.certified > 0));
    }
    if (limit.certified > 0) {
        const double h = limit.unbounded() ? 1e3 : limit.certified;
        CHECK(c.analysis.proves(method, h));
        CHECK(c.analysis.proves(method, 0.1 * h));
    }
    if (std::isfinite(limit.refuted))
        CHECK_FALSE(c.analysis.proves(method, 1.001 * limit.refuted + 1e-300));
    check_tightened(c, truth, method, limit);
}

}  // namespace

TEST_CASE("limit: the truth is in every bracket, of every scene, damping, method and scalar",
          "[proof][slow]") {
    int narrowed = 0, tight = 0, shown = 0;
    for (const bool single : {false, true}) {
        for (const auto& c : stability_cases(single, true)) {
            const Truth truth(c.exact);
            for (const Method method : limited_methods) check_case(c, truth, method);
            const auto bound = c.analysis.max_step(Method::explicit_euler);
            const auto limit = c.analysis.max_step(Method::explicit_euler, 1e-4);
            narrowed += limit.certified > bound.certified * 1.0001;
            shown += limit.certified_up_to > 0;
            tight += limit.refuted <= limit.certified * (1 + 1e-4);
        }
    }
    CHECK(narrowed > 20);
    CHECK(tight > 80);
    CHECK(shown > 0);
}

TEST_CASE("limit: random systems over many decades, narrowed, of every dimension and scalar",
          "[proof]") {
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        Random random(300);
        for (int repeat = 0; repeat < 60; ++repeat) {
            INFO(kind << ", system " << repeat << " of seed 300");
            const auto scene = wild_scene(random, kind);
            const auto state = scene.initial_state();
            const Exact e = exact_matrices(scene, state.x);
            const auto limit = Analysis(scene, state).max_step(Method::symplectic_euler, 1e-6);
            check_narrowed(limit, e, 1e-6, kind);
        }
    }
}

TEST_CASE("limit: springs of every law", "[proof]") {
    for (const Kind& kind : all_kinds()) {
        Random random(303);
        for (int repeat = 0; repeat < 4; ++repeat) {
            INFO(kind << ", system " << repeat << " of seed 303");
            RandomOptions options;
            options.particles = 4;
            options.springs = 5;
            options.dampers = repeat % 2 == 0;
            options.rayleigh = repeat < 2;
            const auto scene = random_scene(random, kind, options);
            const auto state = random_state(random, scene);
            const Exact e = exact_matrices(scene, state.x);
            const Truth truth(e);
            const Analysis analysis(scene, state);
            for (const double tightness : {0.0, 1e-3}) {
                const auto limit = analysis.max_step(Method::symplectic_euler, tightness);
                INFO(limit.certified << ", " << limit.refuted << ", tightness " << tightness);
                CHECK(bracket_error(limit, truth, Method::symplectic_euler) == "");
                CHECK(limit.revision == scene.revision());
            }
            const auto limit = scene.limit(Method::explicit_euler, state);
            CHECK(bracket_error(limit, truth, Method::explicit_euler) == "");
        }
    }
}

TEST_CASE("limit: bare matrices, definite and indefinite", "[proof]") {
    Random random(301);
    for (int repeat = 0; repeat < 150; ++repeat) {
        const Index n = 1 + random.below(12);
        Eigen::VectorXd k(n), d(n);
        Matrices m;
        m.mass.resize(n);
        for (Index i = 0; i < n; ++i) {
            k[i] = log_uniform(random, 1e-3, 1e3);
            d[i] = log_uniform(random, 1e-3, 1e3);
            m.mass[i] = log_uniform(random, 0.1, 10);
        }
        const bool indefinite = repeat % 3 == 0 && n > 1;
        if (indefinite) k[0] = -log_uniform(random, 1e-2, 1e2);
        m.damping = with_spectrum(random, d);
        if (repeat % 2 == 0) m.damping.setZero();
        m.stiffness = with_spectrum(random, k);
        INFO("system " << repeat << ", " << n << " unknowns");
        const auto limit = Analysis(m).max_step(Method::symplectic_euler, 1e-6);
        const Exact e = exact_matrices(m);
        check_narrowed(limit, e, 1e-6, {});
        CHECK((limit.growth_rate > 0) == indefinite);
        if (indefinite)
            CHECK_THAT(limit.growth_rate, WithinRel(Multipliers(e).growth_rate(), 1e-3));
    }
}

TEST_CASE("limit: the tightness is what was asked for", "[proof][bad_input]") {
    const auto cloth = with_dampers(cloth_scene({6, 6}), 1e-3);
    const auto state = deformed(cloth, 1.05, 0.02, 4);
    const Analysis analysis(cloth, state);
    const Exact e = exact_matrices(cloth, state.x);
    for (const double asked : {0.1, 1e-2, 1e-4, 1e-7})
        check_narrowed(analysis.max_step(Method::symplectic_euler, asked), e, asked, {});
    // More than can be had: an honest bracket.
    check_narrowed(analysis.max_step(Method::symplectic_euler, 1e-15), e, 1e-6, {});
    for (const double wrong : {-1e-6, std::nan(""), std::numeric_limits<double>::infinity()})
        CHECK_THROWS_AS(analysis.max_step(Method::symplectic_euler, wrong), std::invalid_argument);
    for (const double h : {0.0, -1.0, std::nan("")})
        CHECK_THROWS_AS(analysis.proves(Method::symplectic_euler, h), std::invalid_argument);
}

// A spring whose tension falls, T' < 0, takes nothing from its damper.
TEST_CASE("limit: by the bound a step of symplectic Euler is that of K+ [T19]", "[proof]") {
    for (const Kind& kind : kinds_of(Laws::any)) {
        Random random(1320);
        for (int repeat = 0; repeat < 40; ++repeat) {
            AnySpring glue{0, 1, log_uniform(random, 1, 1e3), 1};
            glue.law = LawOf::glue;
            glue.second = random.uniform(0.1, 1);
            const double l = 1 + glue.second * random.uniform(0.8, 1.5);
            const double falls = static_cast<double>(-law_at(glue, l).slope);
            const double m = log_uniform(random, 0.1, 10);
            glue.damping = std::sqrt(m * falls) * random.uniform(2.2, 5);
            Scene scene(kind);
            scene.add_particle(Eigen::VectorXd::Zero(kind.dim), 1);
            scene.add_particle(Eigen::VectorXd::Unit(kind.dim, 0) * l, m);
            scene.add_spring(glue);
            scene.pin(0);
            INFO(kind << ", repeat " << repeat << " of seed 1320");
            const auto state = scene.initial_state();
            const double certified =
                Analysis(scene, state).max_step(Method::symplectic_euler).certified;
            const double truth = definite_limit(exact_matrices(scene, state.x), 1, true);
            CHECK(certified <= truth);
            CHECK(certified >= 0.9 * truth);
        }
    }
}

}  // namespace taut_test::limit_test
