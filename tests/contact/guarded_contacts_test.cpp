// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <taut/contact/skin.hpp>
#include <taut/guard/guard.hpp>
#include <taut/scene/cloth.hpp>

#include "../support/catch.hpp"
#include "../support/tolerance.hpp"
#include "bodies.hpp"

namespace taut_test::guarded_contacts_test {

namespace {

template <class System, class State>
double energy_of(const System& system, const taut::Contacts<System>& contacts, const State& state) {
    return static_cast<double>(system.kinetic_energy(state)) +
           static_cast<double>(system.potential_energy(state)) + contacts.energy();
}

}  // namespace

TEMPLATE_TEST_CASE("guarded contacts: a guard books what moving bodies do", "[contact]",
                   (Case<float, 3>), (Case<double, 1>), (Case<double, 2>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    constexpr double unit = static_cast<double>(std::numeric_limits<Scalar>::epsilon());
    Random random(43);
    Index touched = 0, again = 0;
    for (int scene = 0; scene < 60; ++scene) {
        RandomOptions options;
        options.particles = 2 + random.below(8);
        options.springs = 2 * options.particles;
        options.pinned = 0;
        options.gravity = scene % 2 == 0;
        const auto system = random_system<Scalar, Dim>(random, options);
        taut::Contacts contacts(system);
        std::vector<taut::Pose<Scalar, Dim>> poses(static_cast<std::size_t>(1 + random.below(3)));
        for (auto& pose : poses) {
            pose = turn<Scalar, Dim>(random, 3);
            pose.position = random.vector<Scalar, Dim>(-0.7, 0.7);
            add_some_body(random, contacts, pose);
        }
        auto state = random_state(random, system);
        taut::Guarded guard(system);
        double most = 0, work = 0, rounding = 0;
        for (int frame = 0; frame < 30; ++frame) {
            for (std::size_t b = 0; b < poses.size(); ++b) {
                poses[b].rotation = turn<Scalar, Dim>(random, 0.02).rotation * poses[b].rotation;
                poses[b].position += random.vector<Scalar, Dim>(-0.01, 0.01);
                contacts.move_to(static_cast<Index>(b), poses[b]);
            }
            const auto report = guard.advance(state, Scalar(1.0 / 60), contacts);
            REQUIRE(report);
            touched += contacts.touching();
            again += report.again;
            const double energy = energy_of(system, contacts, state);
            const double size = std::abs(energy) + std::abs(contacts.work()) + 1;
            CHECK(std::abs(report.energy - energy) <= 100 * unit * size + report.slack);
            CHECK(std::abs(report.work - contacts.work()) <= 100 * unit * size);
            if (frame == 0) {
                most = energy + 0.1 * static_cast<double>(system.kinetic_energy(state)) +
                       std::max(0.0, -report.balance);
                continue;
            }
            work += report.work;
            rounding += 2 * report.slack;
            CHECK(energy <= most + work + rounding);
        }
    }
    CHECK(touched > 500);
    if constexpr (Dim == 2) CHECK(again > 0);  // seldom in all
}

TEMPLATE_TEST_CASE("guarded contacts: what is edited between frames is no gain", "[contact]", float,
                   double) {
    auto cloth = taut::hanging_cloth<TestType>({8, 8});
    auto state = cloth.initial_state();
    taut::Contacts contacts(cloth);
    taut::Skin<std::decay_t<decltype(cloth)>> skin(contacts, state.x);
    taut::Guarded guard(cloth);
    using Vector = Eigen::Matrix<TestType, 3, 1>;
    for (int frame = 0; frame < 40; ++frame) {
        const bool with = frame >= 5;  // bodies are seen from then on
        if (frame == 10) {
            contacts.add(taut::Sphere<TestType, 3>(Vector::Zero(), TestType(0.2)), {},
                         {state.x.col(40)});
        }
        if (frame == 20) contacts.set_stiffness(4 * contacts.stiffness());
        if (frame == 30) {
            for (Index i = 40; i < 64; ++i) skin.limit(i, {TestType(0.001)});
        }
        double held = 0;
        for (const double each : contacts.open(state)) held += with ? each : 0.0;
        const double before = static_cast<double>(cloth.energy(state)) + held;
        const auto kinetic = static_cast<double>(cloth.kinetic_energy(state));
        const auto report = with ? guard.advance(state, TestType(1.0 / 60), contacts)
                                 : guard.advance(state, TestType(1.0 / 60));
        REQUIRE(report);
        CAPTURE(frame, held);
        CHECK(report.frozen == 0);
        CHECK(report.balance <= report.slack);
        CHECK(report.energy <= before + report.work + 0.1 * kinetic + 2 * report.slack + 1e-6);
    }
}

}  // namespace taut_test::guarded_contacts_test
