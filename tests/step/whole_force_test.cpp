// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "../support/catch.hpp"
#include "../support/scene.hpp"

// A force of the whole state, between the steps of one call: the sweep takes the state out of its
// planes, and puts the forces in, tile by tile.

namespace taut_test::whole_force_test {

namespace {

using taut::Method;

/// A grid of several blocks, in one dimension a chain; shuffled, its particles get an order, and
/// its springs lie in stars.
Scene grid(Random& random, const Kind& kind, bool shuffled) {
    const int rows = kind.dim > 1 ? 47 : 1, columns = kind.dim > 1 ? 61 : 3001;
    std::vector<Index> name(static_cast<std::size_t>(rows * columns));
    std::iota(name.begin(), name.end(), Index(0));
    for (std::size_t i = name.size() - 1; i > 0 && shuffled; --i)
        std::swap(name[i], name[static_cast<std::size_t>(random.below(static_cast<Index>(i) + 1))]);
    Scene scene(kind);
    for (std::size_t i = 0; i < name.size(); ++i)
        scene.add_particle(random_vector(random, kind.dim, -1, 1), random.uniform(1, 2));
    const auto join = [&](int i, int j) {
        AnySpring spring;
        spring.a = name[static_cast<std::size_t>(i)];
        spring.b = name[static_cast<std::size_t>(j)];
        spring.stiffness = random.uniform(20, 200);
        spring.rest_length = random.uniform(0, 1);
        scene.add_spring(spring);
    };
    for (int i = 0; i < rows * columns; ++i) {
        if ((i + 1) % columns > 0) join(i, i + 1);
        if (i + columns < rows * columns) join(i, i + columns);
    }
    scene.pin(name[1]);
    for (const Index i : {Index(0), name[700]})
        scene.set_constant_force(i, random_vector(random, kind.dim, -9, 9));
    return scene;
}

template <class Check>
void for_each_scene(Check&& check) {
    Random random(58);
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        check(random_scene(random, kind), random);
        for (const bool shuffled : {false, true}) check(grid(random, kind, shuffled), random);
    }
}

/// States that a force of the whole state was asked at; it depends on x, v, time and index.
struct Asked {
    std::vector<AnyState> states;

    explicit Asked(Scene& scene) {
        scene.set_external_force([this](const AnyState& given, Eigen::MatrixXd& f) {
            states.push_back(given);
            f += (1 + 100 * given.time) * given.x - 0.5 * given.v;
            for (Index i = 0; i < f.cols(); ++i) f(0, i) += static_cast<double>(i % 7);
        });
    }
};

constexpr Index count = 67;  // more than lie between checks without such a force
constexpr double step = 0x1p-10;

}  // namespace

TEST_CASE("whole_force: many steps are those one by one, by one thread and by two",
          "[integrator]") {
    for_each_scene([](Scene scene, Random& random) {
        const auto start = random_state(random, scene);
        for (const Method method :
             {Method::symplectic_euler, Method::explicit_euler, Method::velocity_verlet}) {
            INFO(scene.kind() << ", " << scene.size() << ", " << static_cast<int>(method));
            Asked asked(scene);
            std::vector<AnyState> before;
            auto expected = start;
            const auto stepper = scene.stepper(method);
            for (Index i = 0; i < count; ++i) {
                before.push_back(expected);
                REQUIRE(stepper->step(expected, step));
            }
            const auto one_by_one = std::exchange(asked.states, {});
            // Once a step: where it starts; velocity Verlet where it ends, and once before.
            if (method != Method::velocity_verlet) CHECK(one_by_one == before);
            for (const int threads : {1, 2}) {
                auto state = start;
                REQUIRE(scene.stepper(method, threads)->step(state, step, count));
                CHECK(state == expected);
                CHECK(std::exchange(asked.states, {}) == one_by_one);
            }
        }
    });
}

TEST_CASE("whole_force: one that adds nothing changes no bit", "[integrator]") {
    for_each_scene([](Scene scene, Random& random) {
        INFO(scene.kind() << ", " << scene.size());
        auto without = random_state(random, scene);
        auto with = without;
        REQUIRE(scene.stepper(Method::symplectic_euler)->step(without, step, count));
        scene.set_external_force([](const AnyState&, Eigen::MatrixXd&) {});
        REQUIRE(scene.stepper(Method::symplectic_euler)->step(with, step, count));
        CHECK(with == without);
    });
}

TEST_CASE("whole_force: it is never asked at a state that is not finite", "[integrator]") {
    for_each_scene([](Scene scene, Random& random) {
        INFO(scene.kind() << ", " << scene.size());
        const auto start = random_state(random, scene);
        const Index last = scene.size() - 1;
        int calls = 0;
        scene.set_external_force([&](const AnyState& given, Eigen::MatrixXd& f) {
            CHECK((given.x.allFinite() && given.v.allFinite()));
            if (given.time > 4.5 * step) f(0, last) = std::numeric_limits<double>::infinity();
            ++calls;
        });
        for (const int threads : {1, 2}) {
            auto state = start;
            const auto report =
                scene.stepper(Method::symplectic_euler, threads)->step(state, step, count);
            CHECK(report.status == taut::Status::diverged);
            CHECK(report.iterations == 5);
            CHECK(report.where == last);
            CHECK(std::exchange(calls, 0) == 12);  // five good steps and a bad one, and once more
        }
    });
}

}  // namespace taut_test::whole_force_test
