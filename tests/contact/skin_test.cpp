// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <optional>
#include <sstream>
#include <taut/contact/skin.hpp>
#include <taut/guard/guard.hpp>
#include <taut/scene/cloth.hpp>

#include "../support/catch.hpp"
#include "../support/tolerance.hpp"
#include "bodies.hpp"
#include "curved_bodies.hpp"

namespace taut_test::skin_test {

namespace {

using taut::Contacts;
using taut::Pose;

/// Bodies that may be not convex, a skin with limits and tethers, all of which move about.
template <class System>
class Scene {
public:
    using Scalar = typename System::Scalar;
    static constexpr int Dim = System::Dim;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Points = taut::Points<Scalar, Dim>;

    Scene(Random& random, const System& system, const Points& x, int bodies)
        : random_(random), contacts(system), places_(x), normals_(x) {
        for (Index i = 0; i < x.cols(); ++i) {
            places_.col(i) += random.vector<Scalar, Dim>(-0.2, 0.2);
            normals_.col(i) = random.vector<Scalar, Dim>(0.1, 1);
        }
        for (int b = 0; b < bodies; ++b) add_body();
        skin_.emplace(contacts, places_, normals_);
        for (Index i = 0; i < system.size(); ++i) {
            if (system.is_pinned(i)) continue;
            taut::SkinLimit<Scalar> limit;
            if (random.below(2) > 0) limit.max_distance = size(0, 0.3) * Scalar(random.below(4));
            if (random.below(2) > 0) limit.backstop_distance = size(0, 0.1);
            if (random.below(2) > 0) limit.backstop_radius = power(-1.5, 2);
            skin_->limit(i, limit);
            for (Index k = random.below(3); k > 0 && system.is_pinned(0); --k)
                skin_->tether(i, 0, size(0.1, 1));
        }
    }
    /// @param way  about how far, m
    void move(double way) {
        const auto step = static_cast<Scalar>(way);
        for (std::size_t b = 0; b < poses_.size(); ++b) {
            const Pose<Scalar, Dim> by = turn<Scalar, Dim>(random_, std::min(2.0, 5 * way));
            poses_[b].rotation = by.rotation * poses_[b].rotation;
            poses_[b].position += step * random_.vector<Scalar, Dim>(-1, 1);
            contacts.move_to(static_cast<Index>(b), poses_[b]);
        }
        for (Index i = 0; i < places_.cols(); ++i) {
            places_.col(i) += step * random_.vector<Scalar, Dim>(-1, 1);
            const Vector normal =
                normals_.col(i).normalized() + 5 * step * random_.vector<Scalar, Dim>(-1, 1);
            if (normal.norm() > Scalar(0.05)) normals_.col(i) = normal;
        }
        skin_->move_to(places_, normals_);
    }

private:
    Random& random_;

public:
    Contacts<System> contacts;

private:
    Scalar size(double least, double most) {
        return static_cast<Scalar>(random_.uniform(least, most));
    }
    Scalar power(double least, double most) {
        return static_cast<Scalar>(std::pow(10, random_.uniform(least, most)));
    }
    void add_body() {
        Pose<Scalar, Dim> pose = turn<Scalar, Dim>(random_, 3);
        pose.position = random_.vector<Scalar, Dim>(-0.7, 0.7);
        poses_.push_back(pose);
        taut::BodyOptions options;
        if (random_.below(2) > 0) options.friction = random_.uniform(0, 2);
        if (random_.below(2) > 0) options.thickness = random_.uniform(0, 0.1);
        const Scalar radius = size(0.1, 0.7);
        const auto add = [&](auto shape) { contacts.add(shape, options, pose); };
        switch (random_.below(5)) {
            case 0: return add(Shell<Scalar, Dim>{radius, radius + size(0.05, 1)});
            case 1: return add(Shell<Scalar, Dim>{radius, 1000});
            case 2:
                return add(Room<Scalar, Dim>{
                    taut::Box<Scalar, Dim>(random_.template vector<Scalar, Dim>(0.1, 0.9))});
            case 3: return add(Torus<Scalar, Dim>{Scalar(0.6), Scalar(0.3) * radius});
            default: add_some_body(random_, contacts, pose);
        }
    }

    std::vector<Pose<Scalar, Dim>> poses_;
    Points places_, normals_;
    std::optional<taut::Skin<System>> skin_;
};

}  // namespace

TEMPLATE_TEST_CASE(
    "skin: no step raises the energy beyond the work of skin and bodies, convex or "
    "not, deep or not, at any stiffness",
    "[contact]", (Case<float, 2>), (Case<float, 3>), (Case<double, 1>), (Case<double, 2>),
    (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(40);
    Index touched = 0;
    double worst = -1;  // in roundings of what is added up
    for (int scene = 0; scene < 200; ++scene) {
        RandomOptions options;
        options.particles = 2 + random.below(8);
        options.springs = 2 * options.particles;
        options.pinned = scene % 3 > 0 ? 1 : 0;
        options.dampers = scene % 4 == 0;
        const auto system = random_system<Scalar, Dim>(random, options);
        const Scalar limit = taut::energy_limit(system).certified;
        const auto h = limit * static_cast<Scalar>(random.below(2) ? 1 : random.uniform(0.05, 1));
        auto state = random_state(random, system);
        Scene<std::decay_t<decltype(system)>> moving(random, system, state.x, scene % 5);
        const double most = std::is_same_v<Scalar, float> ? 3.9 : 8;
        if (scene % 2 > 0) {
            moving.contacts.set_stiffness(
                static_cast<Scalar>(std::pow(10, random.uniform(-2, most))) / (limit * limit));
        }
        state.v *= static_cast<Scalar>(std::pow(10, random.uniform(-1, 1.5)));
        for (Index i = 0; i < options.pinned; ++i) state.v.col(i).setZero();
        taut::EnergyStableEuler stepper(system);
        double before = 0;
        for (int frame = 0; frame < 20; ++frame) {
            moving.move(std::pow(10, random.uniform(-2, 1.3)) * static_cast<double>(h));
            REQUIRE(taut::step_through(stepper, state, h, 1, moving.contacts));
            touched += moving.contacts.touching();
            const auto kinetic = static_cast<double>(system.kinetic_energy(state));
            const auto potential = static_cast<double>(system.potential_energy(state));
            const double energy = kinetic + potential + moving.contacts.energy();
            const double work = moving.contacts.work();
            if (frame > 0) {
                const double size = std::abs(energy) + std::abs(before) + kinetic +
                                    std::abs(potential) + std::abs(work);
                worst = std::max(worst, (energy - before - work) / size /
                                            std::numeric_limits<Scalar>::epsilon());
            }
            before = energy;
        }
    }
    CHECK(worst < 100);
    CHECK(touched > 5000);
}

TEMPLATE_TEST_CASE("skin: a guard books its work", "[contact]", (Case<float, 3>), (Case<double, 1>),
                   (Case<double, 2>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    constexpr double unit = static_cast<double>(std::numeric_limits<Scalar>::epsilon());
    Random random(44);
    for (int scene = 0; scene < 40; ++scene) {
        RandomOptions options;
        options.particles = 2 + random.below(8);
        options.springs = 2 * options.particles;
        options.pinned = 0;
        const auto system = random_system<Scalar, Dim>(random, options);
        auto state = random_state(random, system);
        Scene<std::decay_t<decltype(system)>> moving(random, system, state.x, scene % 3);
        taut::Guarded guard(system);
        double most = 0, work = 0, rounding = 0;
        for (int frame = 0; frame < 30; ++frame) {
            moving.move(0.01);
            const auto report = guard.advance(state, Scalar(1.0 / 60), moving.contacts);
            REQUIRE(report);
            const auto kinetic = static_cast<double>(system.kinetic_energy(state));
            const double energy = kinetic + static_cast<double>(system.potential_energy(state)) +
                                  moving.contacts.energy();
            const double size = std::abs(energy) + std::abs(moving.contacts.work()) + 1;
            CHECK(std::abs(report.energy - energy) <= 100 * unit * size + report.slack);
            CHECK(std::abs(report.work - moving.contacts.work()) <= 100 * unit * size);
            if (frame == 0) {
                most = energy + 0.1 * kinetic + std::max(0.0, -report.balance);
                continue;
            }
            work += report.work;
            rounding += 2 * report.slack;
            CHECK(energy <= most + work + rounding);
        }
    }
}

TEST_CASE(
    "skin: a cloth on a skin that walks stays as near as it must, before its backstops and "
    "on its tethers",
    "[contact]") {
    auto cloth = taut::hanging_cloth<float>({12, 12});
    auto state = cloth.initial_state();
    const taut::Points<float, 3> start = state.x;
    const Eigen::Vector3f out = Eigen::Vector3f(start.col(1) - start.col(0))
                                    .cross(Eigen::Vector3f(start.col(12) - start.col(0)))
                                    .normalized();
    const taut::Points<float, 3> normals = out.replicate(1, cloth.size());
    Contacts contacts(cloth);
    taut::Skin skin(contacts, start, normals);
    std::stringstream text;
    for (Index i = 0; i < cloth.size(); ++i) text << float(i / 12) / 11 << "\n";
    const auto weights = taut::read_weights<float>(text);
    skin.limit_all(weights, {0.2f, 0.01f});
    Index pin = 0;
    while (!cloth.is_pinned(pin)) ++pin;
    Index corner = cloth.size() - 1;
    const float length = (start.col(corner) - start.col(pin)).norm();
    skin.tether(corner, pin, length);
    taut::Guarded guard(cloth);
    float farthest = -1, behind = -1, longest = -1;
    for (int f = 1; f <= 300; ++f) {
        const float t = float(f) / 60;
        const Eigen::Vector3f shift =
            0.5f * std::sin(3 * t) * out + Eigen::Vector3f(0.3f * t, 0, 0);
        taut::Points<float, 3> places = start;
        places.colwise() += shift;
        for (Index i = 0; i < cloth.size(); ++i) {
            if (cloth.is_pinned(i)) state.v.col(i) = (places.col(i) - state.x.col(i)) * 60;
        }
        skin.move_to(places, normals);
        REQUIRE(guard.advance(state, 1.0f / 60, contacts));
        for (Index i = 0; i < cloth.size(); ++i) {
            if (cloth.is_pinned(i)) continue;
            const Eigen::Vector3f from = state.x.col(i) - places.col(i);
            farthest = std::max(farthest, from.norm() - 0.2f * weights[std::size_t(i)]);
            behind = std::max(behind, -out.dot(from) - 0.01f);
        }
        longest = std::max(longest, (state.x.col(corner) - state.x.col(pin)).norm() - length);
    }
    CHECK(farthest < 1e-3f);
    CHECK(behind < 1e-3f);
    CHECK(longest < 1e-3f);
    CHECK(contacts.work() != 0);
    CHECK(taut::energy_limit(cloth).certified > 0);
}

TEST_CASE("skin: nothing passes a wall around it, at 50 m/s a way of 0.8 m a step", "[contact]") {
    for (const float speed : {0.5f, 5.0f, 50.0f}) {
        taut::SpringSystem<float, 3> system;
        Random random(45);
        for (int i = 0; i < 40; ++i) system.add_particle(random.vector<float, 3>(-0.4, 0.4), 0.01f);
        for (Index i = 1; i < 40; ++i) system.add_spring(i - 1, i, {1});
        Contacts contacts(system);
        contacts.add(Shell<float, 3>{1, 1.1f});
        auto state = system.initial_state();
        for (Index i = 0; i < 40; ++i)
            state.v.col(i) = speed * random.vector<float, 3>(-1, 1).normalized();
        taut::EnergyStableEuler stepper(system);
        for (int frame = 0; frame < 300; ++frame)
            REQUIRE(taut::step_through(stepper, state, 1.0f / 60, 1, contacts));
        CHECK(state.x.colwise().norm().maxCoeff() < 1.05f);
    }
}

TEST_CASE("skin: what is out of range is refused by name", "[contact]") {
    auto cloth = taut::hanging_cloth<float>({12, 12});
    Index pin = 0, free = 0;
    while (!cloth.is_pinned(pin)) ++pin;
    while (cloth.is_pinned(free)) ++free;
    Contacts contacts(cloth);
    taut::Points<float, 3> x = cloth.initial_state().x, bad = x, none = 0 * x;
    bad(1, 3) = std::numeric_limits<float>::quiet_NaN();
    using Skin = taut::Skin<decltype(cloth)>;
    CHECK_THROWS_WITH(Skin(contacts, bad), ContainsSubstring("positions"));
    CHECK_THROWS_WITH(Skin(contacts, x, bad), ContainsSubstring("normals"));
    CHECK_THROWS_WITH(Skin(contacts, x, none), ContainsSubstring("normal of particle 0"));
    CHECK_THROWS_WITH(Skin(contacts, x.leftCols(4)), ContainsSubstring("positions"));
    Skin skin(contacts, x);
    const auto refuses = [&](Index i, const taut::SkinLimit<float>& limit, const char* name) {
        CHECK_THROWS_WITH(skin.limit(i, limit), ContainsSubstring(name));
    };
    refuses(-1, {}, "no particle -1");
    refuses(cloth.size(), {}, "no particle");
    refuses(pin, {0.1f}, "is pinned");
    refuses(free, {-1.0f}, "max_distance");
    refuses(free, {bad(1, 3)}, "max_distance");
    refuses(free, {1, -1}, "backstop_distance");
    refuses(free, {1, 1, 0}, "backstop_radius");
    refuses(free, {1, 1, 1}, "normals");
    CHECK_THROWS_WITH(skin.tether(free, free, 1), ContainsSubstring("no pin"));
    CHECK_THROWS_WITH(skin.tether(pin, pin, 1), ContainsSubstring("is pinned"));
    CHECK_THROWS_WITH(skin.tether(free, pin, -1), ContainsSubstring("length"));
    CHECK_THROWS_WITH(skin.move_to(bad), ContainsSubstring("positions"));
    CHECK_THROWS_WITH(skin.limit_all({0.5f}, {}), ContainsSubstring("1 weights"));
    std::vector<float> weights(std::size_t(cloth.size()), 0.5f);
    weights[3] = 1.5f;
    CHECK_THROWS_WITH(skin.limit_all(weights, {1}), ContainsSubstring("weight 3"));
    skin.tether(free, pin, 1);
    cloth.unpin(pin);
    auto state = cloth.initial_state();
    taut::Guarded guard(cloth);
    CHECK_THROWS_WITH(guard.advance(state, 1.0f / 60, contacts), ContainsSubstring("no pin"));
}

}  // namespace taut_test::skin_test
