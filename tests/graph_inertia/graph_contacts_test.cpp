// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/graph_inertia/graph_contacts.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/stability/any_pose.hpp>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::graph_contacts_test {

namespace {

/// A network so near to a plane that some of its particles lie below it, and its stepper.
template <class Scalar, int Dim>
struct Landing {
    using System = taut::SpringSystem<Scalar, Dim>;
    System system;
    typename System::State state;
    taut::HalfSpace<Scalar, Dim> ground{System::Vector::Zero(), System::Vector::Unit(Dim - 1)};
    Scalar height;
    Scalar h;

    Landing(std::uint32_t seed, double times_limit) {
        Random random(seed);
        RandomOptions options;
        options.pinned = 0;
        system = random_system<Scalar, Dim>(random, options);
        state = random_state(random, system);
        height = state.x.row(Dim - 1).mean();
        const auto up = System::Vector::Unit(Dim - 1);
        ground = taut::HalfSpace<Scalar, Dim>(height * up, up);
        h = static_cast<Scalar>(times_limit) * taut::any_pose_limit(system).certified;
    }
    double energy(const taut::GraphInertia<System>& stepper) const {
        return static_cast<double>(system.kinetic_energy(state)) + stepper.added_kinetic(state);
    }
};

}  // namespace

TEMPLATE_TEST_CASE("graph contacts: nothing moves on into the ground, and no energy comes of it",
                   "[integrator]", (Case<float, 1>), (Case<float, 3>), (Case<double, 1>),
                   (Case<double, 2>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    for (std::uint32_t seed = 1; seed <= 40; ++seed) {
        for (const double friction : {0.0, 0.3, 10.0}) {
            INFO("seed " << seed << ", friction " << friction);
            Landing<Scalar, TestType::Dim> scene(seed, 6);
            taut::GraphInertia stepper(scene.system);
            REQUIRE(stepper.prepare(scene.h));
            REQUIRE(stepper.touched() > 0);
            const auto before = scene.state;
            const double energy = scene.energy(stepper);
            const auto report =
                taut::resolve_contacts(stepper, scene.ground, scene.state, {friction, 0});
            REQUIRE(report.contacts > 0);
            const double rounding = Tolerance<Scalar>::accumulated;
            CHECK(scene.energy(stepper) <= energy * (1 + rounding));
            const auto fast = static_cast<double>(before.v.cwiseAbs().maxCoeff());
            for (taut::Index i = 0; i < scene.system.size(); ++i) {
                const auto& x = scene.state.x.col(i);
                CHECK(scene.ground.surface(x).distance >= -Tolerance<Scalar>::rounding);
                const bool touches = before.x(TestType::Dim - 1, i) <= scene.height;
                if (!touches || friction > 0) continue;
                CHECK(static_cast<double>(scene.state.v(TestType::Dim - 1, i)) >= -0.02 * fast);
            }
            // The added inertia has no momentum of its own.
            const auto push = scene.state.v - before.v;
            Eigen::Matrix<Scalar, TestType::Dim, 1> momentum;
            momentum.setZero();
            double scale = 0;
            for (taut::Index i = 0; i < scene.system.size(); ++i) {
                momentum += scene.system.mass(i) * push.col(i);
                scale += static_cast<double>(scene.system.mass(i)) * fast;
            }
            CHECK(static_cast<double>((momentum - report.impulse).norm()) <=
                  100 * Tolerance<Scalar>::accumulated * scale);
        }
    }
}

TEST_CASE("graph contacts: where no spring is implicit they are those of the plain function",
          "[integrator]") {
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        Landing<double, 3> scene(seed, 0.5);
        taut::GraphInertia stepper(scene.system);
        REQUIRE(stepper.prepare(scene.h));
        REQUIRE(stepper.touched() == 0);
        auto other = scene.state;
        const taut::ContactOptions options{0.4, 0.01};
        const auto report = taut::resolve_contacts(stepper, scene.ground, scene.state, options);
        const auto plain = taut::resolve_contacts(scene.system, scene.ground, other, options);
        CHECK(scene.state.v == other.v);
        CHECK(scene.state.x == other.x);
        CHECK(report.contacts == plain.contacts);
        CHECK(report.impulse == plain.impulse);
    }
}

TEST_CASE("graph contacts: masses may differ by decades, and thousands may touch", "[integrator]") {
    Random random(3);
    taut::SpringSystem<double, 3> grains;
    for (int i = 0; i < 60; ++i) {
        grains.add_particle(random.vector<double, 3>(-1, 1), std::exp(random.uniform(-7, 7)));
    }
    for (int i = 0; i < 10; ++i) grains.add_spring(2 * i, 2 * i + 1, 1e5);
    taut::GraphInertia stepper(grains);
    REQUIRE(stepper.prepare(0.01));
    REQUIRE(stepper.touched() > 0);
    auto state = grains.initial_state();
    state.x.row(2).setConstant(-0.1);
    for (taut::Index i = 0; i < grains.size(); ++i) {
        state.v.col(i) = random.vector<double, 3>(-1, 1);
    }
    const taut::HalfSpace<double, 3> ground({0, 0, 0}, {0, 0, 1});
    (void)taut::resolve_contacts(stepper, ground, state);
    CHECK(state.v.row(2).minCoeff() >= -2e-6);
}

TEST_CASE("graph contacts: after a step that was refused, and after edits, nothing is stale",
          "[integrator][bad_input]") {
    auto cloth = taut::hanging_cloth<double>({5, 5});
    const taut::HalfSpace<double, 3> ground({0, 0, 0}, {0, 0, 1});
    taut::GraphInertia stepper(cloth);
    CHECK(stepper.inertia(3) == cloth.mass(3));
    auto state = cloth.initial_state();
    state.v.row(2).setConstant(-1);
    for (int round = 0; round < 2; ++round) {
        CHECK(stepper.step(state, 1e9).status == taut::Status::masses_lost);
        CHECK(stepper.touched() == 0);
        auto fallen = state;
        (void)taut::resolve_contacts(stepper, ground, fallen);
        CHECK(stepper.added_kinetic(fallen) == 0);
        REQUIRE(stepper.step(state, 1e-3));
    }
    for (taut::Index i = 0; i < 2; ++i) {
        cloth.pin(7 + i);
        state.v.col(7 + i) << 0.1, 0.2, -1;
        auto pushed = state;
        pushed.x.row(2).setConstant(-0.1);
        (void)taut::resolve_contacts(stepper, ground, pushed);
        CHECK(pushed.v.col(7 + i) == state.v.col(7 + i));
    }
}

TEST_CASE("graph contacts: friction stops what it can, and turns nothing round", "[integrator]") {
    // One block that slides: all particles on the ground, the same velocity along it.
    for (const double friction : {0.05, 0.2, 5.0}) {
        auto cloth = taut::hanging_cloth<double>({6, 6});
        for (taut::Index i = 0; i < cloth.size(); ++i) cloth.unpin(i);
        taut::GraphInertia stepper(cloth);
        REQUIRE(stepper.prepare(8 * taut::any_pose_limit(cloth).certified));
        auto state = cloth.initial_state();
        state.v.row(0).setConstant(0.3);
        state.v.row(2).setConstant(-1);
        const taut::HalfSpace<double, 3> ground({0, 0, 0}, {0, 0, 1});
        (void)taut::resolve_contacts(stepper, ground, state, {friction, 0});
        const double left = std::max(0.0, 0.3 - friction);
        CHECK((state.v.row(0).array() - left).abs().maxCoeff() < 1e-6);
        CHECK(state.v.row(2).cwiseAbs().maxCoeff() < 3e-6);
    }
}

/// The most energy, J, above its start of a cloth that falls on a sphere, its added inertia's
/// counted.
template <class Resolve>
double most_gain(double times_limit, Resolve&& resolve) {
    auto cloth = taut::hanging_cloth<double>({8, 8});
    for (taut::Index i = 0; i < cloth.size(); ++i) cloth.unpin(i);
    taut::GraphInertiaOptions undamped;
    undamped.dissipation = 0;
    taut::GraphInertia stepper(cloth, undamped);
    const taut::Sphere<double, 3> ball{{0.5, 0.5, -0.3}, 0.2};
    auto state = cloth.initial_state();
    const double start = cloth.energy(state);
    const double h = times_limit * taut::any_pose_limit(cloth).certified;
    double most = 0;
    taut::Index met = 0;
    for (int i = 0; i * h < 0.6; ++i) {
        REQUIRE(stepper.step(state, h));
        const auto moving = [&] {
            return cloth.kinetic_energy(state) + stepper.added_kinetic(state);
        };
        const double before = moving();
        met += resolve(cloth, stepper, ball, state).contacts;
        most = std::max({most, moving() - before, cloth.energy(state) + moving() - start});
    }
    CHECK(met > 0);
    return most;
}

TEST_CASE("graph contacts: the response of one particle alone feeds the cloth, this one does not",
          "[integrator]") {
    for (const double times_limit : {3.0, 10.0}) {
        const double alone =
            most_gain(times_limit, [](auto& cloth, auto&, const auto& ball, auto& state) {
                return taut::resolve_contacts(cloth, ball, state, {0.3, 0});
            });
        const double together =
            most_gain(times_limit, [](auto&, auto& stepper, const auto& ball, auto& state) {
                return taut::resolve_contacts(stepper, ball, state, {0.3, 0});
            });
        INFO(alone << " J and " << together << " J");
        CHECK(together < alone / 4);
    }
}

}  // namespace taut_test::graph_contacts_test
