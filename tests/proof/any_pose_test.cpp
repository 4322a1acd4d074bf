// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <taut/network/spring_system.hpp>
#include <taut/proof/bracket.hpp>
#include <taut/proof/sharp_limit.hpp>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"
#include "../support/proof_scenes.hpp"

// The limits that hold at any pose: 4M − 2hL_c − h²L_k ≻ 0 [T23] and M ⪰ h²L_k + ½hD [T42].

namespace taut_test::any_pose_test {

using taut::Cause;
using taut::Method;
using taut::StepLimit;

namespace {

constexpr Real noise = 256 * real_epsilon;

/// No real multiplier at or below −1 and no complex one outside the circle.
bool step_induces_nothing(const Exact& e, double h) {
    for (const auto& mu : Multipliers(e)(Method::symplectic_euler, h)) {
        const bool real = std::abs(mu.imag()) < 1e-6L;
        // Where K is indefinite, real ones above 1 are the physics.
        if (real ? mu.real() < -1 - 1e-9L : std::abs(mu) > 1 + 1e-9L) return false;
    }
    return true;
}

/// Crumpled, stretched, inverted, flattened, knotted or collapsed.
Eigen::MatrixXd any_pose(Random& random, const Scene& scene, int pose) {
    Eigen::MatrixXd x = random_points(random, scene.dim(), scene.size(), -1, 1);
    const auto home = scene.initial_state().x;
    switch (pose % 7) {
        case 0: return x;
        case 1: return 0.01 * x;
        case 2: return 20 * home;
        case 3: return -home + 0.05 * x;
        case 4: x.row(0).setConstant(0.5); return x;
        case 5: return 0.3 * home + 1e-3 * x;
        default: return x.setConstant(0.25);
    }
}

/// The condition with `laplacians` holds at certified and fails at refuted, in units of `unit`
/// steps.
void check_condition(const StepLimit<double>& limit, const Exact& laplacians, double unit) {
    INFO(limit.certified << ", " << limit.refuted);
    CHECK(limit.refuted >= limit.certified);
    CHECK(limit.growth_rate == 0);
    if (limit.unbounded()) {
        CHECK(limit.cause == Cause::nothing_to_limit);
        CHECK(laplacians.K.cwiseAbs().sum() + laplacians.D.cwiseAbs().sum() == 0);
        return;
    }
    CHECK(limit.certified > 0);
    CHECK(definite_margin(laplacians, unit * limit.certified) >= -noise);
    CHECK(definite_margin(laplacians, unit * limit.refuted) <= noise);
}

/// The sharpened limit is proved, too, no shorter, and of the same scene.
void check_sharp(const StepLimit<double>& sharp, const StepLimit<double>& plain,
                 const StepLimit<double>& tight, const Exact& laplacians, double unit) {
    CHECK(sharp.certified >= plain.certified);
    CHECK(sharp.unbounded() == plain.unbounded());
    CHECK(sharp.revision == plain.revision);
    if (sharp.unbounded()) return;
    CHECK(sharp.certified <= tight.refuted);
    CHECK(definite_margin(laplacians, unit * sharp.certified) >= -noise);
}

void check_both(const Scene& scene) {
    const Exact laplacians = exact_laplacians(scene);
    // M − h²L_k − ½hD is a quarter of 4M − 2H(½D) − H²L_k with H = 2h.
    Exact halved = laplacians;
    halved.D /= 2;
    const bool damped = laplacians.D.cwiseAbs().sum() > 0;
    StepLimit<double> wide, wide_energy;
    for (const double tightness : {0.0, 1e-3, 1e-6}) {
        INFO("tightness " << tightness);
        const auto limit = scene.any_pose_limit(tightness);
        const auto energy = scene.energy_limit(tightness);
        check_condition(limit, laplacians, 1);
        check_condition(energy, halved, 2);
        CHECK(limit.revision == scene.revision());
        CHECK(energy.revision == scene.revision());
        if (!damped && !limit.unbounded()) {
            CHECK(energy.certified == limit.certified / 2);
            CHECK(energy.refuted == limit.refuted / 2);
            CHECK(energy.cause == Cause::stiffness);
        }
        if (tightness == 0) {
            wide = limit;
            wide_energy = energy;
            continue;
        }
        const double apart = (1 + tightness) * (1 + 10 * scene.kind().epsilon());
        CHECK(limit.certified >= wide.certified);
        CHECK(limit.refuted <= wide.refuted);
        CHECK(energy.certified >= wide_energy.certified);
        CHECK(energy.refuted <= wide_energy.refuted);
        if (limit.unbounded()) continue;
        CHECK(limit.refuted <= limit.certified * apart);
        CHECK(energy.refuted <= energy.certified * apart);
        CHECK(energy.certified >= limit.certified / 2 * (1 - 1e-5 - tightness));
        check_sharp(scene.sharp_any_pose_limit(), wide, limit, laplacians, 1);
        check_sharp(scene.sharp_energy_limit(), wide_energy, energy, halved, 2);
    }
}

void check_poses(Random& random, const Scene& scene, int poses) {
    const double h = scene.any_pose_limit(1e-6).certified;
    if (std::isinf(h)) return;
    for (int pose = 0; pose < poses; ++pose) {
        INFO("pose " << pose << ", step " << h);
        const Exact e = exact_matrices(scene, any_pose(random, scene, pose));
        for (const double part : {1.0, 0.6, 0.01}) CHECK(definite_margin(e, part * h) >= -noise);
        if (pose < 7) CHECK(step_induces_nothing(e, h));
    }
}

}  // namespace

TEST_CASE("any_pose: the energy limit of one damped spring is the root of 2kh^2 + ch = m",
          "[proof]") {
    for (const double c : {0.0, 0.1, 3.0, 200.0}) {
        taut::SpringSystem<double, 2> pair;
        pair.add_particle({0, 0}, 0.5);
        pair.add_particle({1, 0}, 0.5);
        pair.add_spring(0, 1, 40, c);
        const double root = 1 / (c + std::sqrt(c * c + 4 * 2 * 40 * 0.5));  // m = 0.5, k = 40
        CHECK_THAT(taut::energy_limit(pair).certified, WithinRel(root, 1e-9));
        CHECK(taut::energy_limit(pair).certified <= root);
        CHECK_THAT(taut::energy_bracket(pair).refuted, WithinRel(root, 1e-9));
    }
}

TEST_CASE("any_pose: the conditions hold at certified and fail at refuted, of every kind",
          "[proof]") {
    for (const Kind& kind : all_kinds()) {
        Random random(401);
        for (int repeat = 0; repeat < 12; ++repeat) {
            INFO(kind << ", system " << repeat << " of seed 401");
            RandomOptions options;
            options.particles = 5;
            options.springs = 4;
            options.pinned = repeat % 3;
            options.dampers = repeat % 2 == 0;
            options.rayleigh = repeat % 4 < 2;
            auto scene = random_scene(random, kind, options);
            if (repeat > 6) {  // damping that rules
                const double h = scene.any_pose_limit().certified;
                scene.set_rayleigh(repeat % 2 == 0 ? log_uniform(random, 1e-2, 10) / h : 0,
                                   repeat % 2 == 1 ? log_uniform(random, 1e-2, 10) * h : 0);
            }
            check_both(scene);
            if (repeat < 4) check_poses(random, scene, 7);
        }
    }
}

TEST_CASE("any_pose: the certified step holds at thousands of poses, over many decades",
          "[proof][slow]") {
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        Random random(400);
        for (int repeat = 0; repeat < 30; ++repeat) {
            INFO(kind << ", system " << repeat << " of seed 400");
            WildOptions options;
            options.decades = repeat % 2 == 0 ? 0.5 : 2.5;
            const auto scene = wild_scene(random, kind, options);
            check_both(scene);
            check_poses(random, scene, 28);
        }
    }
}

TEST_CASE("any_pose: never above the limit of a pose", "[proof]") {
    const auto cloth = cloth_scene({4, 4});
    const auto any = cloth.any_pose_limit(1e-6);
    for (const double stretch : {0.5, 1.0, 1.5, 40.0}) {
        const Exact e = exact_matrices(cloth, deformed(cloth, stretch, 0.01, 1).x);
        CHECK(any.certified <= definite_limit(e, 1, false));
        // Stretched without end, every spring's tangent is k times the identity.
        if (stretch > 10) CHECK(any.refuted >= 0.9 * definite_limit(e, 1, false));
    }
    // In one dimension it is the limit of the one pose there is.
    taut::ChainOptions row;
    row.masses = 9;
    const auto chain = chain_scene(false, 1, row);
    const Exact e = exact_matrices(chain, chain.initial_state().x);
    CHECK_THAT(chain.any_pose_limit(1e-6).certified, WithinRel(definite_limit(e, 1, false), 2e-6));
}

TEST_CASE("any_pose: the sharpened limits of cloths and nets are near the condition's end",
          "[proof]") {
    taut::ClothOptions cloth;
    cloth.rows = cloth.columns = 16;
    const auto near = [](const auto& scene, double least) {
        const double end = scene.any_pose_limit(1e-6).refuted;
        CHECK(scene.sharp_any_pose_limit().certified >= least * end);
        CHECK(scene.sharp_any_pose_limit().certified <= end);
        CHECK(scene.sharp_energy_limit().certified >= least * scene.energy_limit(1e-6).refuted);
    };
    for (const double bend : {0.0, 100.0, 1000.0}) {
        for (const bool diagonals : {false, true}) {
            INFO("bend " << bend << ", diagonals " << diagonals);
            cloth.bend = bend;
            cloth.diagonals = diagonals;
            auto scene = cloth_scene(cloth);
            near(scene, 0.96);
            const double h = scene.any_pose_limit().certified;
            scene.set_rayleigh(0.1 / h, 0.1 * h);
            near(scene, 0.95);
            scene.add_spring({3, 20, 500, 1, 0.01 / h});
            near(scene, 0.93);
        }
    }
    // Where it would take too long, all springs with all, it is the splitting bound.
    Random random(11);
    Scene all({false, 3, Laws::hookean});
    for (int i = 0; i < 120; ++i) {
        all.add_particle(random_points(random, 3, 1, -1, 1), random.uniform(0.5, 2));
        for (int j = 0; j < i; ++j) all.add_spring({i, j, random.uniform(1, 2)});
    }
    CHECK(all.sharp_any_pose_limit().certified == all.any_pose_limit().certified);
    // Nor do the neighbours of one hub keep it for minutes.
    cloth.rows = cloth.columns = 60;
    auto spider = cloth_scene(cloth);
    spider.add_particle(random_points(random, 3, 1, -1, 1), 1e-3);
    for (int i = 0; i < 380; ++i) spider.add_spring({3600, 9 * i, 1});
    CHECK(spider.sharp_any_pose_limit().certified == spider.any_pose_limit().certified);
}

TEST_CASE("any_pose: the sharpened limits of many springs side by side", "[proof]") {
    // Two equal particles, whose frequency is 2nk/m: all of the margin is for rounding.
    for (const int springs : {1, 40, 200, 1000}) {
        INFO(springs << " springs");
        taut::SpringSystem<double, 1> pair;
        for (const double x : {0.0, 1.0}) pair.add_particle(Eigen::Matrix<double, 1, 1>(x), 1.7);
        for (int s = 0; s < springs; ++s) pair.add_spring(0, 1, 1.36);
        const Real end = std::sqrt(2 * Real(1.7) / (springs * Real(1.36)));
        CHECK(taut::sharp_any_pose_limit(pair).certified <= end);
        CHECK(taut::sharp_energy_limit(pair).certified <= end / 2);
    }
}

TEST_CASE("any_pose: the sharpened limits of numbers at the ends of their range", "[proof]") {
    for (const double mass : {1e-150, 1e-12, 1.0, 1e150}) {
        for (const double stiffness : {1e-150, 1e-12, 1.0, 1e12, 1e150}) {
            INFO("mass " << mass << ", stiffness " << stiffness);
            taut::SpringSystem<double, 1> triangle;
            for (int i = 0; i < 3; ++i)
                triangle.add_particle(Eigen::Matrix<double, 1, 1>(double(i)), mass);
            for (int i = 0; i < 3; ++i) triangle.add_spring(i, (i + 1) % 3, stiffness);
            const auto plain = taut::any_pose_limit(triangle);
            const auto sharp = taut::sharp_any_pose_limit(triangle);
            CHECK(sharp.cause == plain.cause);
            CHECK(sharp.certified >= plain.certified);
            const double end = 2 / (std::sqrt(3.0) * std::sqrt(stiffness) / std::sqrt(mass));
            if (plain.certified > 0 && !plain.unbounded()) CHECK(sharp.certified <= end);
        }
    }
}

TEST_CASE("any_pose: closed forms, causes, and scenes without a limit", "[proof][bad_input]") {
    for (const bool single : {false, true}) {
        const double rounding = Kind{single}.epsilon() * 8;
        Scene scene({single, 2, Laws::hookean});
        const auto check = [&](double any, double energy, Cause cause, double within) {
            for (const double tightness : {0.0, 1e-6}) {
                INFO("tightness " << tightness);
                const auto of_any = scene.any_pose_limit(tightness);
                const auto of_energy = scene.energy_limit(tightness);
                CHECK(of_any.cause == cause);
                CHECK(of_energy.cause == cause);
                if (cause == Cause::nothing_to_limit) {
                    CHECK(of_any.unbounded());
                    CHECK(of_energy.unbounded());
                    continue;
                }
                const double near = rounding + (tightness > 0 ? 2e-6 : within);
                CHECK(of_any.certified <= any);
                CHECK(of_any.refuted >= any);
                CHECK(of_energy.certified <= energy);
                CHECK(of_energy.refuted >= energy);
                CHECK(of_any.certified >= any * (1 - near));
                CHECK(of_energy.certified >= energy * (1 - near));
            }
        };
        const auto nothing = [&] { check(0, 0, Cause::nothing_to_limit, 0); };
        nothing();
        scene.add_particle(Eigen::Vector2d(0, 0), 2);
        nothing();
        scene.add_particle(Eigen::Vector2d(1, 0), 2);
        scene.add_spring({0, 1, 0});
        nothing();
        // Drag alone: 2 ≥ h d0, and 1 ≥ ½h d0.
        scene.set_rayleigh(5, 0);
        check(0.4, 0.4, Cause::damping, 1e-6);
        // Two masses and a spring: 4m ≥ 2kh², and m ≥ 2kh².
        scene.set_rayleigh(0, 0);
        scene.add_spring({0, 1, 100});
        check(0.2, 0.1, Cause::stiffness, 1e-9);
        // A damper: 4m ≥ 2kh² + 4hc, and m ≥ 2kh² + hc.
        scene.add_spring({0, 1, 0, 1, 1000});
        const auto root = [](double a, double b, double c) {  // of ah² + bh = c
            return 2 * c / (b + std::sqrt(b * b + 4 * a * c));
        };
        check(root(200, 4000, 8), root(200, 1000, 2), Cause::damping, 0.1);
        scene.set_rayleigh(0, 10);
        check(root(200, 8000, 8), root(200, 2000, 2), Cause::damping, 0.1);
        // All pinned: nothing moves.
        scene.pin(0);
        scene.pin(1);
        nothing();
        scene.unpin(0);
        CHECK_FALSE(scene.any_pose_limit().unbounded());
        CHECK_FALSE(scene.energy_limit().unbounded());
        for (const double wrong : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
            CHECK_THROWS_AS(scene.energy_limit(wrong), std::invalid_argument);
            CHECK_THROWS_AS(scene.any_pose_limit(wrong), std::invalid_argument);
        }
    }
    // Beyond double nothing is proved.
    Scene scene({false, 2, Laws::hookean});
    scene.add_particle(Eigen::Vector2d(0, 0), 2);
    scene.add_particle(Eigen::Vector2d(1, 0), 2);
    scene.add_spring({0, 1, 100});
    scene.set_rayleigh(0, 1e307);
    for (const auto& limit : {scene.any_pose_limit(), scene.energy_limit()}) {
        CHECK(limit.cause == Cause::overflow);
        CHECK(limit.certified == 0);
    }
}

TEST_CASE("any pose: every method has its answer", "[proof]") {
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        Random random(seed);
        RandomOptions options;
        options.dampers = seed % 2 == 0;
        options.rayleigh = seed % 3 == 0;
        const auto system = random_system<double, 3>(random, options);
        INFO("seed " << seed);
        const auto limit = taut::any_pose_limit(system);
        for (const Method method : {Method::symplectic_euler, Method::velocity_verlet}) {
            const auto same = taut::any_pose_limit(system, method);
            CHECK(same.certified == limit.certified);
            CHECK(same.cause == limit.cause);
        }
        const auto stable = taut::any_pose_limit(system, Method::energy_stable_euler);
        CHECK(stable.certified == taut::energy_limit(system).certified);
        const auto every = taut::any_pose_limit(system, Method::implicit_euler);
        CHECK(every.unbounded());
        CHECK(every.cause == Cause::unconditional);
        CHECK_THROWS_AS(taut::any_pose_limit(system, Method::bdf2), std::invalid_argument);
        const auto none = taut::any_pose_limit(system, Method::explicit_euler);
        CHECK(none.certified == 0);
        const bool damped = options.dampers || options.rayleigh;
        CHECK(none.cause == (damped ? Cause::one_pose_only : Cause::undamped));
        CHECK(none.revision == system.revision());
    }
    taut::SpringSystem<double, 3> loose;
    loose.add_particle({0, 0, 0}, 1);
    CHECK(taut::any_pose_limit(loose, Method::explicit_euler).cause == Cause::nothing_to_limit);
}

TEST_CASE("any pose: explicit Euler fails at some pose, whatever its step and damping", "[proof]") {
    Random random(77);
    for (int repeat = 0; repeat < 20; ++repeat) {
        const double h = log_uniform(random, 1e-6, 1);
        taut::SpringSystem<double, 3> system;
        system.add_particle({0, 0, 0}, 1);
        system.add_particle({1, 0, 0}, 1);
        system.add_spring(0, 1, log_uniform(random, 1, 1e4), random.uniform(0, 10));
        system.pin(0);
        const double d0 = random.uniform(0, 10);
        system.set_rayleigh({d0, random.uniform(0, 0.01)});
        auto state = system.initial_state();
        const double k = system.springs()[0].parameters.stiffness;
        // 4 − 2h·d0 + h²·T/(ml) = −1
        state.x(0, 1) = 1 / (1 + (5 + 2 * h * d0) / (h * h * k));
        CHECK(Multipliers(exact_matrices(system, state.x))(Method::explicit_euler, h)
                  .real()
                  .minCoeff() < -1.01L);
        CHECK(taut::any_pose_limit(system, Method::explicit_euler).certified == 0);
    }
}

}  // namespace taut_test::any_pose_test
