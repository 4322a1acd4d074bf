// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/graph_inertia/graph_contacts.hpp>
#include <taut/integrator/guarded.hpp>
#include <taut/scene/cloth.hpp>

#include "../support/catch.hpp"
#include "../support/random.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::guarded_inertia_test {

namespace {

/// A cloth with a row of stiff springs, and a start in motion.
template <class Scalar>
struct Hemmed {
    using System = taut::SpringSystem<Scalar, 3>;
    using Guard = taut::Guarded<taut::GraphInertia<System>>;
    System cloth = taut::hanging_cloth<Scalar>({8, 8});
    typename System::State state = cloth.initial_state();
    typename Guard::Options options;

    explicit Hemmed(std::uint32_t seed) {
        const Scalar limit = taut::any_pose_limit(cloth).certified;
        for (taut::Index s = 0; s < 7; ++s) {
            cloth.set_stiffness(s, 300 * cloth.springs()[s].parameters.stiffness);
        }
        Random random(seed);
        for (taut::Index i = 0; i < cloth.size(); ++i) {
            if (!cloth.is_pinned(i)) state.v.col(i) = random.vector<Scalar, 3>(-0.3, 0.3);
        }
        options.max_step = Scalar(0.8) * limit;
    }
    double energy(const Guard& guard) const {
        double elastic = 0;
        cloth.visit_springs([&](const auto& spring) {
            elastic += static_cast<double>(
                spring.energy((state.x.col(spring.b) - state.x.col(spring.a)).norm()));
        });
        return elastic + static_cast<double>(cloth.kinetic_energy(state)) +
               guard.stepper().added_kinetic(state);
    }
};

}  // namespace

TEMPLATE_TEST_CASE("guarded inertia: sound scenes are never given up, and one factor serves",
                   "[integrator]", float, double) {
    for (std::uint32_t seed = 1; seed <= 3; ++seed) {
        Hemmed<TestType> scene(seed);
        typename Hemmed<TestType>::Guard guard(scene.cloth, scene.options);
        for (int frame = 0; frame < 60; ++frame) {
            INFO("seed " << seed << ", frame " << frame);
            const auto report = guard.advance(scene.state, TestType(1) / 60);
            REQUIRE(report);
            REQUIRE(report.retries == 0);
        }
        CHECK(guard.stepper().touched() > 0);
        CHECK(guard.stepper().touched() < scene.cloth.size());
        CHECK(guard.stepper().factorizations() == 1);
    }
}

TEST_CASE("guarded inertia: pins that start and stop, edits and contacts pass as well",
          "[integrator]") {
    Hemmed<double> scene(4);
    Hemmed<double>::Guard guard(scene.cloth, scene.options);
    const taut::Sphere<double, 3> ball{{0.5, -0.4, -0.1}, 0.2};
    for (int frame = 0; frame < 90; ++frame) {
        INFO("frame " << frame);
        for (taut::Index i = 0; i < scene.cloth.size(); ++i) {
            if (scene.cloth.is_pinned(i)) scene.state.v.col(i) << 0, 0, frame / 15 % 2 ? 0.5 : 0;
        }
        if (frame == 40) scene.cloth.remove_spring(3);
        if (frame == 60) scene.cloth.set_stiffness(0, 2e5);
        const auto report = guard.advance(scene.state, 1.0 / 60, [&](auto& state) {
            (void)taut::resolve_contacts(guard.stepper(), ball, state, {0.2, 0});
        });
        REQUIRE(report);
    }
    CHECK(guard.stepper().factorizations() == 3);
}

TEST_CASE("guarded inertia: the work of moving pins counts through dissipation, too",
          "[integrator]") {
    for (const double dissipation : {0.0, 0.03, 0.3, 1.0}) {
        INFO("dissipation " << dissipation);
        taut::SpringSystem<double, 3> rope;
        for (int i = 0; i < 6; ++i) rope.add_particle({0.1 * i, 0, 0}, 0.01);
        for (int i = 0; i < 5; ++i) rope.add_spring(i, i + 1, 1e4);
        rope.pin(0);
        taut::GraphInertiaOptions how;
        how.dissipation = dissipation;
        taut::Guarded<taut::GraphInertia<taut::SpringSystem<double, 3>>> guard(rope, {}, how);
        auto state = rope.initial_state();
        for (int frame = 0; frame < 60; ++frame) {
            INFO("frame " << frame);
            // At rest, then at a constant velocity, then one that changes in every frame.
            const double v = frame < 5 ? 0 : frame < 30 ? 1 : std::sin(0.3 * frame);
            state.v.col(0) << 0, 0, v;
            const auto report = guard.advance(state, 0.01);
            REQUIRE(report);
            CHECK(report.retries == 0);
        }
    }
}

TEST_CASE("guarded inertia: a factor that somebody else remakes moves the books", "[integrator]") {
    Hemmed<double> scene(7);
    taut::GraphInertia stepper(scene.cloth);
    taut::Guarded guard(scene.cloth, stepper);
    for (int frame = 0; frame < 20; ++frame) {
        INFO("frame " << frame);
        if (frame == 0) REQUIRE(stepper.prepare(1.0 / 600));
        if (frame == 10) REQUIRE(stepper.prepare(1.0 / 60));
        if (frame == 15) {
            auto preview = scene.state;
            REQUIRE(stepper.step(preview, 0.05));
        }
        REQUIRE(guard.advance(scene.state, 1.0 / 600));
    }
}

TEST_CASE("guarded inertia: what accepted frames may reach is bounded by what was there",
          "[integrator]") {
    // E = T̃ + V ≤ C·E_then + …, C = (1 + √θ)/(1 − √θ), for a scene that is thrown too fast.
    for (const double speed : {1.0, 10.0, 100.0}) {
        Hemmed<double> scene(5);
        scene.cloth.set_gravity({0, 0, 0});
        scene.state.v *= speed;
        Hemmed<double>::Guard guard(scene.cloth, scene.options);
        REQUIRE(guard.stepper().renew(scene.options.max_step));
        const double root = std::sqrt(guard.stepper().options().margin);
        double granted = scene.energy(guard) * (1 + root) / (1 - root);
        for (int frame = 0; frame < 40; ++frame) {
            INFO("speed " << speed << ", frame " << frame);
            if (!guard.advance(scene.state, 1.0 / 60)) break;
            const double energy = scene.energy(guard);
            REQUIRE(energy <= granted * 1.2);
            granted = std::min(granted, energy * (1 + root) / (1 - root));
        }
    }
}

TEST_CASE("guarded inertia: a step too large for the masses is refused",
          "[integrator][bad_input]") {
    Hemmed<double> scene(6);
    scene.options.max_step = 1e6;
    Hemmed<double>::Guard guard(scene.cloth, scene.options);
    const auto before = scene.state;
    CHECK(guard.advance(scene.state, 1e6).status == taut::Status::masses_lost);
    CHECK(scene.state.x == before.x);
    CHECK(scene.state.v == before.v);
}

}  // namespace taut_test::guarded_inertia_test
