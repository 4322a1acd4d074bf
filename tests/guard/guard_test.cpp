// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <taut/core/status.hpp>

#include "../support/catch.hpp"
#include "../support/stepper_battery.hpp"
#include "guard_scenes.hpp"

// What Guarded promises, and what it does about trials that break it. Work: guarded_work_test.cpp.

namespace taut_test::guard_test {

using taut::Status;
using taut::Taken;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A net whose springs, masses, pins, dampers and laws are drawn; two nets where `apart`.
Scene random_net(Random& random, const Kind& kind, bool damped, bool pinned, bool apart) {
    Scene net(kind);
    const auto laws = laws_of(kind);
    const Index n = 12;
    for (Index i = 0; i < n; ++i) {
        const auto x = random_vector(random, kind.dim, -1, 1);
        net.add_particle(x, std::exp(random.uniform(-3, 3)));
    }
    // Half of the springs are of one law.
    const LawOf law = laws[static_cast<std::size_t>(random.below(Index(laws.size())))];
    for (Index i = 0; i < n; ++i) {
        for (Index j = i + 1; j < std::min(n, i + 4); ++j) {
            if (apart && i < n / 2 && j >= n / 2) continue;
            const auto other = laws[static_cast<std::size_t>(random.below(Index(laws.size())))];
            auto spring = draw_spring(random, random.below(2) == 0 ? law : other);
            spring.a = i;
            spring.b = j;
            spring.stiffness = std::exp(random.uniform(3, 8));
            spring.rest_length = random.uniform(0, 1);
            if (damped) spring.damping = random.uniform(0, 0.5);
            net.add_spring(spring);
        }
    }
    if (damped) net.set_rayleigh(random.uniform(0, 1), random.uniform(0, 1e-4));
    if (!pinned) return net;
    net.pin(0);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(kind.dim);
    g[kind.dim - 1] = -9.81;
    net.set_gravity(g);
    return net;
}

/// E − ΣW − d of the whole scene must never exceed what any frame before left by more than 0.1 K of
/// that frame, which one number follows: the least of E + 0.1 K so far.
struct Promise {
    double granted = infinity;

    /// @param kinetic  at least K, J
    bool holds(const taut::GuardedReport<double>& report, double kinetic) {
        granted += report.work;
        const double scale = std::abs(report.energy) + kinetic + std::abs(granted);
        const double slack = 1e-9 * (std::isfinite(scale) ? scale : 0);
        bool kept = !(report.energy > granted + report.balance + slack);
        if (report.again + report.frozen == 0) kept &= report.balance <= report.slack + slack;
        granted = std::min(granted, report.energy + 0.1 * kinetic);
        return kept;
    }
};

/// At least what the guard takes for it, which squares in the scene's scalar, J.
double kinetic_of(const Scene& scene, const AnyState& state) {
    double sum = 0;
    for (Index i = 0; i < scene.size(); ++i) {
        if (!scene.is_pinned(i)) sum += scene.mass(i) * state.v.col(i).squaredNorm() / 2;
    }
    return sum * (1 + 4 * scene.kind().epsilon());
}

/// What a user's stepper may do to a state.
void spoil(Random& random, const Kind& kind, AnyState& state) {
    const double most = kind.single ? double(std::numeric_limits<float>::max())
                                    : std::numeric_limits<double>::max();
    const Index i = random.below(state.x.cols());
    switch (random.below(7)) {
        case 0: state.v.setConstant(nan); break;
        case 1: state.v = -2 * state.v; break;
        case 2: state.x.col(i).array() += 1; break;
        case 3: state.v.col(i).setConstant(infinity); break;
        case 4: state.x.col(i).setConstant(most / 2); break;
        case 5: state.v *= random.uniform(0.9, 1.2); break;
        default: break;
    }
}

void attack(const Kind& kind, std::uint32_t first_seed) {
    int trimmed = 0, again = 0;
    for (std::uint32_t scene = 0; scene < 40; ++scene) {
        Random random(first_seed + scene);
        const bool damped = random.below(2) == 0, pinned = random.below(2) == 0;
        const Scene net = random_net(random, kind, damped, pinned, random.below(2) == 0);
        auto state = net.initial_state();
        const double speed = std::exp(random.uniform(-2, 4));
        state.x += random_points(random, kind.dim, net.size(), -0.5, 0.5);
        state.v = random_points(random, kind.dim, net.size(), -speed, speed);
        if (pinned) state.v.col(0).setZero();
        const auto verlet = net.stepper(taut::Method::velocity_verlet);
        const double limit = net.any_pose_limit().certified;
        const auto guard = guarded(net, [&](AnyState& s, double h) {
            const double n = std::ceil(h / (0.95 * limit));
            (void)verlet->step(s, net.rounded(h / n), static_cast<Index>(n));
            if (scene % 2 == 1 && random.below(2) == 0) spoil(random, kind, s);
            return true;
        });
        Promise promise;
        for (int i = 0; i < 40; ++i) {
            if (pinned && scene % 3 == 0) state.v(0, 0) = random.uniform(-3, 3);
            const auto report = guard->advance(state, frame);
            INFO(kind << ", seed " << first_seed + scene << ", frame " << i << ", E "
                      << report.energy << ", granted " << promise.granted + report.work << ", d "
                      << report.balance << ", slack " << report.slack << ", taken again "
                      << report.again);
            REQUIRE(report);
            REQUIRE((state.x.allFinite() && state.v.allFinite()));
            REQUIRE(report.spring == -1);
            REQUIRE(promise.holds(report, kinetic_of(net, state)));
            trimmed += report.trimmed > 0;
            again += report.again > 0;
        }
    }
    CHECK(trimmed > 0);
    CHECK(again > 0);
}

}  // namespace

TEST_CASE("guard: it refuses no frame and keeps its promise under attack", "[guard][slow]") {
    std::uint32_t seed = 4300;
    for (const Kind& kind : {Kind{true, 1, Laws::hookean}, Kind{false, 2, Laws::strings}, any3,
                             Kind{true, 3, Laws::strings}, Kind{false, 1, Laws::hookean},
                             Kind{true, 2, Laws::hookean}, Kind{false, 3, Laws::strings}})
        attack(kind, seed += 100);
}

TEST_CASE("guard: an undamped cloth keeps its energy for a minute", "[guard][slow]") {
    for (const LawOf law : {LawOf::hookean, LawOf::tension_only}) {
        const Scene cloth = cloth_scene(any3, {10, 10}, law);
        const auto guard = guarded(cloth);
        auto state = cloth.initial_state();
        double fastest = 0, energy = 0, start = cloth.potential_energy(state);
        for (Index i = 0; i < cloth.size(); ++i) {  // no part has the pins
            if (cloth.is_pinned(i)) start += cloth.mass(i) * cloth.gravity().dot(state.x.col(i));
        }
        for (int i = 0; i < 3600; ++i) {
            const auto report = guard->advance(state, frame);
            REQUIRE(report);
            CHECK(report.again == 0);
            fastest = std::max(fastest, kinetic_of(cloth, state));
            energy = report.energy;
        }
        CHECK(energy - start <= 0.1 * fastest);
        CHECK(energy - start >= -0.04 * fastest);
    }
}

TEST_CASE("guard: the spin of a free net is kept", "[guard]") {
    Scene net = cloth_scene(any3, {8, 8}, LawOf::tension_only);
    for (Index i = 0; i < net.size(); ++i) net.unpin(i);
    net.set_gravity(Eigen::Vector3d::Zero());
    auto state = net.initial_state();
    const Eigen::Vector3d centre = state.x.rowwise().mean();
    const auto cross = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
        return Eigen::Vector3d(a.cross(b));
    };
    for (Index i = 0; i < net.size(); ++i)
        state.v.col(i) = cross({0.3, 0.5, 4}, state.x.col(i) - centre);
    const auto spin = [&] {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (Index i = 0; i < net.size(); ++i)
            sum += net.mass(i) * cross(state.x.col(i), state.v.col(i));
        return sum;
    };
    const Eigen::Vector3d before = spin();
    CHECK(guarded(net)->advance_all(state, 600).trimmed > 0);
    CHECK((spin() - before).norm() <= 1e-3 * before.norm());
}

TEST_CASE("guard: parts of a scene are judged apart", "[guard]") {
    Scene net({false, 2, Laws::strings});
    for (int i = 0; i < 4; ++i) net.add_particle(Eigen::Vector2d(i < 2 ? 0 : 5, i % 2), 1);
    net.add_spring({0, 1, 100, 1, 0, LawOf::tension_only});
    net.add_spring({2, 3, 100, 1, 0, LawOf::tension_only});
    auto state = net.initial_state();
    state.v(0, 0) = state.v(0, 2) = 1;
    const auto verlet = net.stepper(taut::Method::velocity_verlet);
    const auto guard = guarded(net, [&](AnyState& s, double h) {
        (void)verlet->step(s, h / 8, 8);
        s.v.col(3).array() += 50;
        return true;
    });
    auto plain = state;
    const auto report = guard->advance(state, frame);
    CHECK(report);
    CHECK(report.parts == 2);
    CHECK(report.again == 1);
    CHECK(report.taken == Taken::again);
    CHECK(report.where == 2);
    REQUIRE(net.stepper(taut::Method::velocity_verlet)->step(plain, frame / 8, 8));
    CHECK(state.x.leftCols(2) == plain.x.leftCols(2));
    CHECK(state.v.leftCols(2) == plain.v.leftCols(2));
    CHECK((state.v.col(3) - plain.v.col(3)).norm() < 0.1);
}

TEST_CASE("guard: a trial that is never finite leaves every frame to the proved step", "[guard]") {
    const Scene cloth = cloth_scene(any3, {6, 6});
    const auto guard = guarded(cloth, [](AnyState& s, double) {
        s.v.setConstant(nan);
        return true;
    });
    auto state = cloth.initial_state();
    auto alone = state;
    const Frames frames = guard->advance_all(state, 30);
    CHECK(frames.all_ok);
    CHECK(frames.again == 30);
    const double n = std::ceil(frame / cloth.sharp_energy_limit().certified);
    const auto stepper = cloth.stepper(taut::Method::energy_stable_euler);
    REQUIRE(stepper->step(alone, frame / n, static_cast<Index>(30 * n)));
    CHECK(gap(state.x, alone.x) <= 1e-9);
}

TEST_CASE("guard: what is not finite is refused by name, and the state stays", "[guard]") {
    Scene cloth = cloth_scene(any3, {6, 6});
    const auto guard = guarded(cloth);
    auto state = cloth.initial_state();
    CHECK(guard->advance(state, 0).status == Status::invalid_step);
    CHECK(guard->advance(state, nan).status == Status::invalid_step);
    REQUIRE(guard->advance(state, 1e-12));
    auto broken = state;
    broken.v(1, 7) = infinity;
    const auto refused = guard->advance(broken, frame);
    CHECK(refused.status == Status::invalid_state);
    CHECK(refused.where == 7);
    broken = state;
    broken.x(1, 7) = 1e200;  // its square is not
    CHECK(guard->advance(broken, frame).status == Status::invalid_state);
    cloth.set_external_force([](const auto&, auto& f) { f(0, 9) = nan; });
    const auto before = state;
    const auto report = guard->advance(state, frame);
    CHECK_FALSE(report);
    CHECK(report.force == std::string("set_external_force"));
    CHECK(report.advanced == 0);
    CHECK(state == before);
    cloth.set_external_force({});
    CHECK(guard->advance(state, frame));
}

TEST_CASE("guard: a late frame is shortened to its most steps", "[guard]") {
    const Scene cloth = cloth_scene(any3, {6, 6});
    taut::GuardedOptions<double> options;
    options.max_substeps = 10;
    auto state = cloth.initial_state();
    const auto report = guarded(cloth, options)->advance(state, 10);
    CHECK(report);
    CHECK(report.substeps == 10);
    CHECK_THAT(report.advanced, WithinRel(9.5 * cloth.sharp_any_pose_limit().certified, 1e-9));
    CHECK(state.time == report.advanced);
    for (std::uint32_t seed = 4410; seed < 4470; ++seed) {  // of a float's rounding, too
        INFO("seed " << seed);
        Random random(seed);
        Scene net({true, 3, Laws::strings});
        for (int i = 0; i < 2; ++i)
            net.add_particle(Eigen::Vector3d(i, 0, 0), random.uniform(0.1, 10));
        net.add_spring({0, 1, random.uniform(1, 1e4), 1, 0, LawOf::tension_only});
        auto start = net.initial_state();
        options.max_substeps = 1 + random.below(20);
        CHECK(guarded(net, options)->advance(start, 100).substeps <= options.max_substeps);
    }
}

TEST_CASE("guard: scenes without springs, without free particles, torn and edited", "[guard]") {
    Scene net(any3);
    const auto guard = guarded(net);
    auto state = net.initial_state();
    CHECK(guard->advance(state, frame));
    net.add_particle(Eigen::Vector3d(0, 0, 0), 1);
    net.add_particle(Eigen::Vector3d(1, 0, 0), 1);
    net.set_gravity(Eigen::Vector3d(0, 0, -10));
    net.pin(0);
    state = net.initial_state();
    state.v(0, 0) = 1;
    auto report = guard->advance(state, 1);
    CHECK(report);
    CHECK(report.parts == 1);
    CHECK_THAT(state.x(2, 1), WithinRel(-5, 1e-4));
    CHECK_THAT(state.x(0, 0), WithinRel(1, 1e-4));
    CHECK(std::abs(report.work) < 1e-9);  // a pin lifted or moved alone does no work
    net.pin(1);
    CHECK(guard->advance(state, frame).parts == 0);
    net.unpin(0);
    net.unpin(1);
    net.add_spring({0, 1, 100, 1});
    CHECK(guard->advance(state, frame).parts == 1);
    net.remove_spring(LawOf::hookean, 0);
    net.add_spring({0, 1, 1e8, 1});
    CHECK(guard->advance_all(state, 10).all_ok);
    CHECK(guard->advance(state, frame).h <= 0.95 * net.any_pose_limit().certified);
    net.remove_spring(LawOf::hookean, 0);
    report = guard->advance(state, frame);
    CHECK(report);
    CHECK(report.parts == 2);
}

TEST_CASE("guard: a torn cloth is certified again, and falls", "[guard]") {
    Scene cloth = cloth_scene(any3, {10, 10});
    const auto guard = guarded(cloth);
    const auto start = cloth.initial_state();
    auto state = start;
    REQUIRE(guard->advance_all(state, 5).all_ok);
    const auto springs = cloth.springs();
    for (std::size_t s = springs.size(); s-- > 0;) {
        if ((springs[s].a < 20) != (springs[s].b < 20))
            cloth.remove_spring(LawOf::hookean, static_cast<Index>(s));
    }
    const auto report = guard->advance(state, frame);
    CHECK(report.parts == 2);
    CHECK(report.h <= 0.95 * cloth.any_pose_limit().certified);
    REQUIRE(guard->advance_all(state, 34).all_ok);
    // Free fall of what was let go, which holds more than half of the cloth.
    CHECK(start.x(2, 99) - state.x(2, 99) > 0.4);
    CHECK(state.x(2, 0) == start.x(2, 0));
}

TEST_CASE("guard: a damper between a pin and a particle excuses no kick", "[guard]") {
    // The trial is exact: a linear damper and a spring that hardly moves.
    Scene net = pair({1, 0, 0}, 100, 1e4);
    net.pin(0);
    auto state = net.initial_state();
    const auto guard = guarded(net, [&](AnyState& s, double h) {
        const double c = 1e4 * h, k = 100 * h * h;
        const double pull = -k / h * (s.x(0, 1) - s.x(0, 0) - 1);
        s.v(0, 1) = (s.v(0, 1) + (c + k) * s.v(0, 0) + pull) / (1 + c + k);
        s.v(1, 1) += 2;
        s.x += h * s.v;
        return true;
    });
    for (int i = 0; i < 120; ++i) {
        state.v(0, 0) = i % 2 == 0 ? 1 : -1;
        REQUIRE(guard->advance(state, frame));
        REQUIRE(state.v.col(1).norm() < 10);
    }
}

TEST_CASE("guard: what is frozen while its pin moves books the work of that pin", "[guard]") {
    Scene net = pair({1, 0, 0}, 1000);
    net.pin(0);
    net.set_external_force([](const auto& s, auto& f) { f -= 1e200 * s.v; });
    auto state = net.initial_state();
    state.v(1, 1) = 1;
    const auto guard = guarded(net);
    Promise promise;
    for (int i = 0; i < 60; ++i) {
        state.v(0, 0) = -1;
        const auto report = guard->advance(state, frame);
        REQUIRE((state.x.allFinite() && state.v.allFinite()));
        REQUIRE(promise.holds(report, kinetic_of(net, state)));
    }
}

}  // namespace taut_test::guard_test
