// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <stdexcept>
#include <taut/core/status.hpp>

#include "../support/catch.hpp"
#include "guard_scenes.hpp"

// What the guard books of moving pins and of forces given as code, and what it does about them.

namespace taut_test::guarded_work_test {

namespace {

/// One particle of 1 kg.
Scene particle(double x) {
    Scene scene(any3);
    scene.add_particle(Eigen::Vector3d(x, 0, 0), 1);
    return scene;
}

}  // namespace

TEST_CASE("guarded_work: it is the same between the steps of a sweep as step by step", "[guard]") {
    for (const Kind& kind : {Kind{false, 1, Laws::hookean}, Kind{true, 2, Laws::hookean}, any3,
                             Kind{true, 3, Laws::strings}}) {
        for (std::uint32_t seed = 4400; seed < 4412; ++seed) {
            Random random(seed);
            const bool hangs = kind.dim == 3 && seed % 3 == 0;
            RandomOptions options;
            options.particles = seed % 3 == 1 ? 30 : 700;
            options.springs = options.particles / 2;
            options.pinned = 4;
            Scene scene = hangs ? cloth_scene(kind, {18, 18}, laws_of(kind)[0])
                                : random_scene(random, kind, options);
            if (seed % 2 == 1) {
                scene.set_external_force([](const auto& state, auto& f) {
                    f.row(0).array() += std::cos(3 * state.time);
                    f -= 0.5 * state.x;
                });
            }
            if (seed % 4 >= 2) scene.set_constant_force(3, random_vector(random, kind.dim, -1, 1));
            auto state = scene.initial_state();
            state.time = 1;
            for (Index i = 0; i < scene.size(); ++i) {
                if (scene.is_pinned(i)) state.v.col(i).setConstant(scene.rounded(0.1));
            }
            auto other = state;
            const auto at_once = guarded(scene), singly = guarded(scene);
            for (int i = 0; i < 4; ++i) {
                const double span = hangs ? frame : 0.25;
                const auto a = at_once->advance(state, span);
                const auto b = singly->advance(other, span, [](AnyState&) {});
                INFO(kind << ", seed " << seed << ", frame " << i << ", " << a.substeps
                          << " steps");
                REQUIRE(a);
                REQUIRE(b);
                CHECK(a.substeps > 1);
                const double size = std::abs(a.work) + std::abs(a.energy) + a.slack;
                CHECK(std::abs(a.work - b.work) <= (kind.single ? 2e-4 : 1e-9) * size);
                CHECK((kind.single || a.taken == b.taken));
            }
        }
    }
}

TEST_CASE("guarded_work: forces of time are booked at their time", "[guard]") {
    for (const bool again : {false, true}) {
        Scene net = particle(0);
        net.set_external_force(
            [](const auto& s, auto& f) { f(0, 0) += 10 * std::cos(3 * s.time); });
        auto state = net.initial_state();
        state.time = 1;
        const auto guard = again ? guarded(net,
                                           [](AnyState& s, double) {
                                               s.v.setConstant(NAN);
                                               return true;
                                           })
                                 : guarded(net);
        const Frames frames = guard->advance_all(state, 120);
        CHECK(frames.frozen == 0);
        const double exact = 10 * (std::sin(9.0) - std::sin(3.0)) / 3;
        CHECK_THAT(state.v(0, 0), WithinRel(exact, again ? 0.2 : 1e-3));
        CHECK_THAT(frames.work, WithinRel(net.kinetic_energy(state), again ? 0.2 : 0.05));
    }
}

TEST_CASE("guarded_work: a trial that changes the time does not move a force of time", "[guard]") {
    Scene net = particle(0);
    net.set_mass(0, 2);
    net.set_external_force([](const auto& s, auto& f) { f(0, 0) += std::sin(s.time); });
    auto state = net.initial_state();
    const auto guard = guarded(net, [](AnyState& s, double h) {
        s.v(0, 0) += h * std::sin(s.time + h / 2) / 2;
        s.x += h * s.v;
        s.time = 1e6;
        return true;
    });
    for (int i = 0; i < 60; ++i) REQUIRE(guard->advance(state, frame).taken != taut::Taken::frozen);
    CHECK_THAT(state.v(0, 0), WithinRel((1 - std::cos(1.0)) / 2, 1e-2));
}

TEST_CASE("guarded_work: mild forces given as code neither stop a part nor take its motion",
          "[guard]") {
    for (const double omega : {1.0, 3.0, 10.0, 20.0}) {
        for (const bool two : {false, true}) {
            INFO("omega " << omega << ", a pair: " << two);
            Scene net = particle(0.1);
            if (two) {
                net.add_particle(Eigen::Vector3d(0.1, 0.1, 0), 1);
                net.add_spring({0, 1, 10, 0.1});
            }
            net.set_external_force([=](const auto& s, auto& f) { f -= omega * omega * s.x; });
            auto state = net.initial_state();
            const auto guard = guarded(net);
            double late = 0;
            const auto look = [&](AnyState& s) { late = std::max(late, std::abs(s.x(0, 0))); };
            const Frames early = guard->advance_all(state, 600);
            const Frames rest = guard->advance_all(state, 600, look);
            CHECK((early.all_ok && rest.all_ok));
            CHECK(early.again + rest.again <= 2);
            CHECK_THAT(late, WithinRel(0.1, 0.02));
        }
    }
    for (const double drag : {1.0, 10.0, 25.0}) {
        INFO("drag " << drag);
        Scene net = particle(0);
        net.set_gravity(Eigen::Vector3d(0, 0, -10));
        net.set_external_force([=](const auto& s, auto& f) { f -= drag * s.v; });
        auto state = net.initial_state();
        CHECK(guarded(net)->advance_all(state, 300).all_ok);
        CHECK_THAT(-state.v(2, 0), WithinRel(10 / drag * (1 - std::exp(-5 * drag)), 0.01));
    }
    for (const bool by_chance : {false, true}) {
        INFO("a cloth, force by chance: " << by_chance << ", seed 3");
        Random random(3);
        Scene cloth = cloth_scene(any3, {6, 6});
        if (!by_chance) {
            cloth.unpin(0);
            cloth.unpin(5);
        }
        cloth.set_external_force([&](const auto& s, auto& f) {
            by_chance ? f.array() += 1e-3 * random.uniform(-1, 1) : f.array() -= 1e-3 * s.v.array();
        });
        auto state = cloth.initial_state();
        const Frames frames = guarded(cloth)->advance_all(state, 600);
        CHECK((frames.all_ok && frames.frozen == 0));
    }
}

TEST_CASE("guarded_work: a force too stiff for one step a frame is followed in shorter ones",
          "[guard]") {
    for (const double omega : {100.0, 125.0, 300.0}) {  // one step of 1/60 s grows from 120 on
        INFO("omega " << omega);
        Scene net = particle(0.1);
        net.set_external_force([=](const auto& s, auto& f) { f -= omega * omega * s.x; });
        auto state = net.initial_state();
        const auto energy = [&] {
            return net.kinetic_energy(state) + 0.5 * omega * omega * state.x.squaredNorm();
        };
        const double first = energy();
        double most = 0;
        const auto look = [&](AnyState&) { most = std::max(most, energy()); };
        CHECK(guarded(net)->advance_all(state, 600, look).frozen == 0);
        CHECK(most <= 4 * first);
    }
}

TEST_CASE("guarded_work: stiff forces given as code never explode, and are named", "[guard]") {
    for (const int kind : {0, 1, 2, 3}) {
        INFO("kind " << kind);
        Scene cloth = cloth_scene(any3, {6, 6});
        const double h = 0.95 * cloth.any_pose_limit().certified;
        const double mass = cloth.mass(0), most = kind == 3 ? 3e5 : 3;
        cloth.set_external_force([=](const auto& s, auto& f) {
            if (kind == 1) f -= most * mass / (h * h) * s.x;
            if (kind == 2) f.row(2) -= 30 * mass / (h * h) * s.x.row(2).cwiseMin(0.0);
            if (kind == 0 || kind == 3) f -= most * mass / h * s.v;
        });
        const auto guard = guarded(cloth);
        auto state = cloth.initial_state();
        const auto spread = [&] { return (state.x.colwise() - state.x.col(0)).norm(); };
        const double start = spread();
        bool named = false;
        for (int i = 0; i < 60; ++i) {
            const auto report = guard->advance(state, frame);
            if (!report) {
                CHECK(report.status == taut::Status::frozen);
                CHECK(report.force == std::string("set_external_force"));
            }
            named = named || report.force != nullptr || report.again > 0;
            REQUIRE((state.x.allFinite() && state.v.allFinite()));
            // The springs of kind 1 are followed in shorter steps, and hold so much energy.
            REQUIRE(state.v.norm() < (kind == 1 ? 10 * start / h : 1e3));
            REQUIRE(spread() < 10 * start);
        }
        CHECK(named);
    }
}

TEST_CASE("guarded_work: a refused frame leaves nothing behind", "[guard]") {
    const Scene net = pair({1, 0, 0}, 100);
    double kick = 0;
    enum class Bad { none, not_finite, throws, resizes };
    Bad bad = Bad::none;
    int calls = 0;
    const auto respond = [&](AnyState& s) {
        if (bad == Bad::none || ++calls < 2) return;
        if (bad == Bad::not_finite) s.v(0, 0) = NAN;
        if (bad == Bad::throws) throw std::runtime_error("respond");
        if (bad == Bad::resizes) s.x.conservativeResize(3, 1);
    };
    for (const Bad kind : {Bad::not_finite, Bad::throws, Bad::resizes}) {
        const auto guard = guarded(net, [&](AnyState& s, double h) {
            s.v(0, 1) += kick;
            s.x += h * s.v;
            return true;
        });
        auto state = net.initial_state();
        REQUIRE(guard->advance(state, frame, respond));
        const auto before = state;
        kick = 100;
        bad = kind;
        calls = 0;
        if (kind == Bad::throws) {
            CHECK_THROWS_AS((void)guard->advance(state, frame, respond), std::runtime_error);
        } else {
            const auto refused = guard->advance(state, frame, respond);
            CHECK_FALSE(refused);
            CHECK(refused.force == std::string("respond"));
        }
        CHECK(state == before);
        bad = Bad::none;
        const auto next = guard->advance(state, frame, respond);
        CHECK(next.taken == taut::Taken::again);
        CHECK(next.energy <= 1e-9);
        kick = 0;
    }
}

TEST_CASE("guarded_work: a response cannot move a pin, and is named where it is not finite",
          "[guard]") {
    Scene net = pair({1, 0, 0}, 1e5, 1);
    net.pin(0);
    auto state = net.initial_state();
    const auto guard = guarded(net);
    for (int i = 0; i < 60; ++i) {
        const auto report = guard->advance(
            state, frame, [](AnyState& s) { s.v(0, 0) = 3 * std::sin(20 * s.time); });
        REQUIRE(report);
        REQUIRE(report.energy <= 1e-9);
        REQUIRE(state.x.col(0).norm() == 0);
        REQUIRE(state.v.col(0).norm() == 0);
    }
    const auto report = guard->advance(state, frame, [](AnyState& s) { s.v(0, 1) = NAN; });
    CHECK(report.status == taut::Status::diverged);
    CHECK(report.force == std::string("respond"));
    CHECK(report.where == 1);
}

TEST_CASE("guarded_work: a response beside a stiff force given as code does not let it explode",
          "[guard]") {
    for (const double stiffness : {1e3, 1e5, 1e6}) {
        for (const bool touches : {false, true}) {
            INFO("a floor of " << stiffness << " N/m, responses " << touches);
            Scene cloth = cloth_scene(any3, {6, 6});
            cloth.unpin(0);
            cloth.unpin(5);
            cloth.set_external_force([=](const auto& s, auto& f) {
                f.row(2) -= stiffness * (s.x.row(2).array() + 0.3).min(0.0).matrix();
            });
            auto state = cloth.initial_state();
            const auto guard = guarded(cloth);
            for (int i = 0; i < 120; ++i) {
                (void)guard->advance(state, frame, [&](AnyState& s) {
                    if (touches) s.v(0, 0) += 1e-13;
                });
                REQUIRE(state.v.colwise().norm().maxCoeff() < 20);
                REQUIRE(state.x.row(2).maxCoeff() < 1);
            }
        }
    }
}

TEST_CASE("guarded_work: of a pin that lifts a weight", "[guard]") {
    Scene net = pair({0, 0, -1}, 1e4, 20);
    net.pin(0);
    net.set_gravity(Eigen::Vector3d(0, 0, -10));
    auto state = net.initial_state();
    state.v(2, 0) = 0.5;
    const Frames frames = guarded(net)->advance_all(state, 600);
    CHECK(frames.all_ok);
    // m g z, and ½mv²; the damper takes a little.
    CHECK_THAT(frames.work, WithinRel(50 + 0.125, 0.02));
}

TEST_CASE("guarded_work: of lifting a cloth, however fast, and it rests in the lift", "[guard]") {
    const Scene cloth = cloth_scene(any3, {8, 8}, LawOf::tension_only);
    const auto rest = at_rest(cloth);
    const double mass = 62 * cloth.mass(0);  // of the free ones
    for (const double u : {-3.0, -1.0, 0.3, 1.0, 3.0, 10.0}) {
        INFO("lifted at " << u << " m/s");
        auto state = rest;
        state.v.row(2).setConstant(u);
        const Frames frames = guarded(cloth)->advance_all(state, 120);
        CHECK(frames.all_ok);
        CHECK(frames.again == 0);
        CHECK_THAT(frames.work, WithinRel(mass * 9.81 * u * 2, 0.01));
    }
}

TEST_CASE("guarded_work: a pendulum keeps its swing", "[guard]") {
    for (const double k : {100.0, 1e4, 1e5}) {
        INFO(k << " N/m");
        Scene net = pair({1, 0, 0}, k);
        net.pin(0);
        net.set_gravity(Eigen::Vector3d(0, 0, -9.81));
        auto state = net.initial_state();
        const auto guard = guarded(net);
        double late = 0;
        const auto look = [&](AnyState& s) { late = std::max(late, net.kinetic_energy(s)); };
        CHECK(guard->advance_all(state, 1500).all_ok);
        CHECK(guard->advance_all(state, 300, look).all_ok);
        CHECK(late >= 9.2);
        CHECK(late <= 10);
    }
}

TEST_CASE(
    "guarded_work: in float a cloth that is carried along at rest is not taken again for ever",
    "[guard][slow]") {
    Scene cloth = cloth_scene({true, 3, Laws::strings}, {10, 10}, LawOf::tension_only);
    for (Index i = 0; i < 10; ++i) cloth.pin(i);
    auto state = cloth.initial_state();
    state.v.row(0).setConstant(1);
    const Frames frames = guarded(cloth)->advance_all(state, 600);
    CHECK(frames.all_ok);
    CHECK(frames.again <= 12);
}

TEST_CASE("guarded_work: in float a cloth at rest does not heat up, near the origin or far from it",
          "[guard][slow]") {
    const Scene cloth = cloth_scene({true, 3, Laws::strings}, {12, 12}, LawOf::tension_only);
    const auto rest = at_rest(cloth);
    for (const double away : {0.0, 10.0, 100.0}) {
        INFO(away << " m from the origin");
        auto state = rest;
        state.x.array() += away;
        state.x = state.x.cast<float>().cast<double>();
        const auto guard = guarded(cloth);
        int again = 0;
        double rounding = 0;
        for (int i = 0; i < 1800; ++i) {
            const auto report = guard->advance(state, frame);
            REQUIRE(report);
            again += report.again > 0;
            rounding = std::max(rounding, report.slack);
        }
        CHECK(cloth.kinetic_energy(state) <= 2 * rounding);
        CHECK(again <= 18);
    }
}

}  // namespace taut_test::guarded_work_test
