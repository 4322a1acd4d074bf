// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <taut/core/status.hpp>

#include "../support/catch.hpp"
#include "guard_scenes.hpp"

// What a frame reports to the joule: scenes so small, and trials so simple, that it can be said.

namespace taut_test::guarded_books_test {

using taut::Taken;

namespace {

/// A trial that leaves all places and changes velocities.
Trial change(const std::function<void(AnyState&)>& how) {
    return [=](AnyState& s, double) {
        how(s);
        return true;
    };
}

/// Pairs with springs of 100 N/m, 10 m from one another, which turn at `speed` of either end.
Scene pairs(int count) {
    Scene scene(any3);
    for (int i = 0; i < 2 * count; ++i)
        scene.add_particle(Eigen::Vector3d(10 * (i / 2) + i % 2, 0, 0), 1);
    for (int i = 0; i < count; ++i) scene.add_spring({2 * i, 2 * i + 1, 100, 1});
    return scene;
}
void turn(AnyState& s, Index pair, double speed) {
    s.v(1, 2 * pair) = -speed;
    s.v(1, 2 * pair + 1) = speed;
}

/// A particle without springs, and a force given as code.
Scene driven(const std::function<void(const AnyState&, Eigen::MatrixXd&)>& force) {
    Scene scene(any3);
    scene.add_particle(Eigen::Vector3d(0, 0, 0), 1);
    scene.set_external_force(force);
    return scene;
}

}  // namespace

TEST_CASE("guarded_books: what a part lost it may gain back, up to a tenth of its motion",
          "[guard]") {
    const Scene scene = pairs(1);
    double factor = 1;
    const auto guard = guarded(scene, change([&](AnyState& s) { s.v *= factor; }));
    auto state = scene.initial_state();
    turn(state, 0, 10);  // K is 100 J
    auto report = guard->advance(state, frame);
    CHECK(report.taken == Taken::tried);
    CHECK(report.balance == 0);
    factor = 0.5;
    report = guard->advance(state, frame);
    CHECK_THAT(report.energy, WithinRel(25, 1e-9));
    CHECK_THAT(report.balance, WithinRel(-2.5, 1e-9));
    factor = std::sqrt(1.06);
    report = guard->advance(state, frame);
    CHECK(report.taken == Taken::tried);
    CHECK_THAT(report.balance, WithinRel(-1, 1e-9));
    // Not after an edit that took the motion.
    state.v *= 0.1 / factor;
    factor = std::sqrt(1.3);
    report = guard->advance(state, frame);
    CHECK(report.energy <= 0.25 * 1.1 + 1e-9);
    // An edit that leaves it, and no gain, leaves the balance.
    factor = 1;
    state = scene.initial_state();
    turn(state, 0, 10);
    factor = 0.5;
    REQUIRE(guard->advance(state, frame));
    state.x.array() += 1;
    factor = std::sqrt(1.06);
    CHECK(guard->advance(state, frame).taken == Taken::tried);
}

TEST_CASE("guarded_books: flight is no motion that a part may gain from", "[guard]") {
    const Scene scene = pairs(1);
    auto state = scene.initial_state();
    state.v.row(0).setConstant(10);
    const auto guard = guarded(scene, change([](AnyState& s) { s.v *= 0.5; }));
    const auto report = guard->advance(state, frame);
    CHECK_THAT(report.energy, WithinRel(25, 1e-9));
    CHECK(std::abs(report.balance) <= 1e-9);
}

TEST_CASE("guarded_books: a part taken again keeps what it may gain, and earns nothing",
          "[guard]") {
    const Scene scene = pairs(1);
    bool fails = false;
    const auto guard = guarded(scene, [&](AnyState& s, double) {
        s.v *= 0.5;
        return !fails;
    });
    auto state = scene.initial_state();
    turn(state, 0, 10);
    REQUIRE_THAT(guard->advance(state, frame).balance, WithinRel(-2.5, 1e-9));
    fails = true;
    const auto report = guard->advance(state, frame);
    CHECK(report.taken == Taken::again);
    CHECK_THAT(report.balance, WithinRel(-2.5, 0.2));
}

TEST_CASE("guarded_books: parts that hang on one pin are two, and pieces share by their mass",
          "[guard]") {
    Scene hung(any3);
    for (int i = 0; i < 3; ++i) hung.add_particle(Eigen::Vector3d(i - 1, 0, 0), 1);
    hung.add_spring({0, 1, 100, 1});
    hung.add_spring({1, 2, 100, 1});
    hung.pin(1);
    auto state = hung.initial_state();
    CHECK(guarded(hung)->advance(state, frame).parts == 2);

    Scene scene = pairs(2);
    scene.add_spring({1, 2, 100, 9});
    double factor = 0.5;
    const auto guard = guarded(scene, change([&](AnyState& s) { s.v *= factor; }));
    state = scene.initial_state();
    turn(state, 0, 20);
    CHECK_THAT(guard->advance(state, frame).balance, WithinRel(-10, 1e-9));
    scene.remove_spring(LawOf::hookean, 2);
    factor = 1;
    const auto report = guard->advance(state, frame);
    CHECK(report.parts == 2);
    CHECK_THAT(report.balance, WithinRel(-5, 1e-9));  // and the other half has no motion
    scene.add_spring({1, 2, 100, 9});
    CHECK_THAT(guard->advance(state, frame).balance, WithinRel(-5, 1e-9));
}

TEST_CASE("guarded_books: a trim takes off what was gained, and turns no motion round", "[guard]") {
    for (const bool three : {false, true}) {
        INFO("three particles: " << three);
        Scene scene(any3);
        for (int i = 0; i < (three ? 3 : 2); ++i) {
            scene.add_particle(Eigen::Vector3d(i, 0, 0), 1);
            if (i > 0) scene.add_spring({i - 1, i, 100, 1});
        }
        auto state = scene.initial_state();
        if (three) {  // stretched, bent along the line, and turned, which no trim sees
            const double stretch = std::sqrt(0.75), bend = std::sqrt(0.25 / 3);
            state.v.row(0) << stretch + bend, -2 * bend, bend - stretch;
            state.v.row(1) << -std::sqrt(3.5), 0, std::sqrt(3.5);
        } else {
            state.v.row(0) << -1, 1;
        }
        const auto before = state;
        const double first = scene.energy(state);
        const auto guard = guarded(scene, change([](AnyState& s) { s.v *= std::sqrt(1.2); }));
        const auto report = guard->advance(state, frame);
        CHECK(report.taken == Taken::trimmed);
        CHECK(report.trimmed == 1);
        CHECK_THAT(report.energy, WithinRel(first, 1e-5));
        CHECK_THAT(scene.energy(state), WithinRel(first, 1e-5));
        CHECK_THAT(state.v.row(0).sum(), WithinAbs(0, 1e-12));
        if (!three) continue;
        const Eigen::Vector3d bent(1, -2, 1);
        const double was = before.v.row(0) * bent, is = state.v.row(0) * bent;
        CHECK(is > 0);
        CHECK(is < was);
    }
}

TEST_CASE("guarded_books: a frame that is refused leaves none of its own", "[guard]") {
    const Scene scene = pairs(2);
    double factor = 0.5, kick = 1000;
    int calls = 0;
    const auto guard = guarded(scene, change([&](AnyState& s) {
                                   s.v.leftCols(2) *= factor;
                                   s.v(0, 2) += kick;
                               }));
    auto state = scene.initial_state();
    turn(state, 0, 10);
    const auto before = state;
    const auto refused = guard->advance(state, frame, [&](AnyState& s) {
        if (++calls > 1) s.v(0, 0) = NAN;  // where the other pair is taken again
    });
    CHECK_FALSE(refused);
    CHECK(state == before);
    factor = std::sqrt(1.02);  // less than what was lost would allow
    kick = 0;
    CHECK(guard->advance(state, frame).energy <= 100 * (1 + 1e-6));
}

TEST_CASE("guarded_books: pins go on where no frame was tried", "[guard]") {
    Scene scene = pair({1, 0, 0}, 100);
    scene.pin(0);
    auto state = scene.initial_state();
    state.v(0, 0) = -1;
    const auto guard = guarded(scene, [](AnyState&, double) { return false; });
    const auto report = guard->advance(state, frame);
    CHECK(report.taken == Taken::again);
    CHECK_THAT(state.x(0, 0), WithinRel(-frame, 1e-9));
}

TEST_CASE("guarded_books: of a pin the mean of its pulls, by springs that it gets later, too",
          "[guard]") {
    Scene scene = pair({1, 0, 0}, 100);
    scene.add_particle(Eigen::Vector3d(-1, 0, 0), 1);
    scene.pin(0);
    auto state = scene.initial_state();
    state.v(0, 0) = 1;
    const auto guard = guarded(scene, change([](AnyState&) {}));
    CHECK_THAT(guard->advance(state, frame).work, WithinRel(50 * frame * frame, 1e-9));
    scene.add_spring({0, 2, 100, 1});  // which is stretched by what the pin went
    const auto report = guard->advance(state, frame);
    CHECK(report.taken == Taken::tried);
    CHECK_THAT(report.work, WithinRel(2 * 150 * frame * frame, 1e-9));
}

TEST_CASE("guarded_books: of a damper at a pin what it gives, seen step by step or all at once",
          "[guard]") {
    for (std::uint32_t seed = 4500; seed < 4540; ++seed) {
        INFO("seed " << seed);
        Random random(seed);
        const double damping = std::exp(random.uniform(-1, 3)), mass = random.uniform(1, 4);
        const double span = random.uniform(0.2, 6) * mass / damping;
        Scene scene(any3);
        scene.add_particle(Eigen::Vector3d(0, 0, 0), 1);
        scene.add_particle(Eigen::Vector3d(1, 0, 0), mass);
        scene.add_spring({0, 1, 1e-6, 1, damping});
        scene.pin(0);
        AnyState once = scene.initial_state();
        once.v.row(0) << random.uniform(-3, 3), random.uniform(-3, 3);
        AnyState stepwise = once;
        const auto all_at_once = guarded(scene), by_step = guarded(scene);
        double energy = mass * once.v(0, 1) * once.v(0, 1) / 2;
        for (int i = 0; i < 4; ++i) {  // from its own start, and going on
            // Verlet's kinetic energy is work along the way, and the change of ⅛h² f²/m. Its
            // forces are those at v½.
            const double before = std::pow(once.v(0, 1) - once.v(0, 0), 2);
            const auto report = all_at_once->advance(once, span);
            REQUIRE(report.taken == Taken::tried);
            CHECK_THAT(by_step->advance(stepwise, span, [](AnyState&) {}).work,
                       WithinRel(report.work, 1e-9));
            CHECK(stepwise == once);
            const double half = i > 0 ? 1 - report.h * damping / (2 * mass) : 1;
            const double swing = std::pow(report.h * damping / half, 2) / (8 * mass) * before;
            CHECK(std::abs(report.work - (report.energy - energy)) <= 1.1 * swing + 1e-9);
            energy = report.energy;
        }
    }
}

TEST_CASE("guarded_books: a damper at a pin works where rounding leaves nothing of the ways",
          "[guard]") {
    for (std::uint32_t seed = 4600; seed < 4620; ++seed) {
        INFO("seed " << seed);
        Random random(seed);
        const double damping = std::exp(random.uniform(36, 38)), mass = random.uniform(1, 4);
        Scene scene(any3);
        scene.add_particle(Eigen::Vector3d(6, 0, 0), 1);
        scene.add_particle(Eigen::Vector3d(5, 0, 0), mass);
        scene.add_spring({0, 1, 1, 1, damping});
        scene.pin(0);
        for (const bool again : {false, true}) {
            AnyState state = scene.initial_state();
            state.v(0, 0) = random.uniform(2, 7);
            const auto guard =
                again ? guarded(scene, [](AnyState&, double) { return false; }) : guarded(scene);
            const auto report = guard->advance(state, random.uniform(0.05, 0.2) * mass / damping);
            CHECK(state.x == scene.initial_state().x);
            REQUIRE(report.taken == (again ? Taken::again : Taken::tried));
            CHECK(report.energy > 0);
            CHECK(report.work >= report.energy * (1 - 1e-6));
            CHECK(report.work < 50 * report.energy);
        }
    }
}

TEST_CASE("guarded_books: forces given as code count once, and hold back so much", "[guard]") {
    Scene scene = driven([](const auto&, auto& f) { f(0, 0) += 10; });
    auto state = scene.initial_state();
    state.v(0, 0) = 2;
    const auto report = guarded(scene)->advance(state, frame);
    const double v = 2 + 10 * frame, way = (2 + 5 * frame) * frame;
    CHECK_THAT(report.work, WithinRel(10 * way, 1e-9));
    CHECK_THAT(report.slack, WithinRel(5 * v * frame + 25 * frame * frame, 1e-6));
    CHECK_FALSE(report.blind);

    scene.set_constant_force(0, Eigen::Vector3d(0, 1, 0));
    state = scene.initial_state();
    CHECK_THAT(guarded(scene)->advance(state, frame).work,
               WithinRel((10 * 10 + 1) * frame * frame / 2, 1e-9));
}

TEST_CASE(
    "guarded_books: from h^2 k/m = 1/4 on a spring given as code is followed in shorter steps",
    "[guard]") {
    for (const double omega : {25.0, 35.0}) {
        INFO("omega " << omega);
        const Scene scene = driven([=](const auto& s, auto& f) { f -= omega * omega * s.x; });
        auto state = scene.initial_state();
        state.v(0, 0) = 1;
        const auto report = guarded(scene)->advance(state, frame);
        CHECK(report.taken == (omega < 30 ? Taken::tried : Taken::again));
        CHECK((report.force == nullptr) == (omega < 30));
    }
}

TEST_CASE("guarded_books: what no step follows is stopped, and the books say so", "[guard]") {
    // A drag that overshoots in a sixteenth of a frame, too: finite, and growing.
    const Scene scene = driven([](const auto& s, auto& f) { f -= 3 * 16 / frame * s.v; });
    auto state = scene.initial_state();
    state.v(0, 0) = 3;
    const auto report = guarded(scene)->advance(state, frame);
    CHECK(report.status == taut::Status::frozen);
    CHECK(report.frozen == 1);
    CHECK(report.force == std::string("set_external_force"));
    CHECK(state.v.col(0).norm() == 0);
    CHECK(std::abs(report.work) <= 1e-9);  // the force's own is not the part's
    CHECK(report.energy == 0);
}

TEST_CASE("guarded_books: a motion whose energy is no number is refused, not stopped", "[guard]") {
    for (const Kind& kind : {any3, Kind{true, 3, Laws::strings}}) {
        Scene scene(kind);
        scene.add_particle(Eigen::Vector3d(0, 0, 0), 1);
        // From rest to a speed whose square overflows.
        scene.set_gravity(Eigen::Vector3d(0, kind.single ? 1e18 : 1e153, 0));
        const AnyState before = scene.initial_state();
        AnyState state = before;
        const auto report = guarded(scene)->advance(state, 100);
        CHECK(report.status == taut::Status::diverged);
        CHECK(report.frozen == 0);
        CHECK(state == before);
    }
}

TEST_CASE("guarded_books: a soft scene far from any limit has little rounding", "[guard]") {
    const Scene scene = pair({1, 0, 0}, 1e-6);
    auto state = scene.initial_state();
    state.v(0, 1) = 1;
    CHECK(guarded(scene)->advance(state, frame).slack < 1e-12);
}

}  // namespace taut_test::guarded_books_test
