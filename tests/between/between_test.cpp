// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <limits>
#include <stdexcept>
#include <taut/between/between.hpp>
#include <taut/taut.hpp>
#include <vector>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"
#include "../support/sweep_checks.hpp"

namespace taut_test::between_test {

namespace {

template <class Scalar>
constexpr auto h = static_cast<Scalar>(0.001);  // s
constexpr Index steps = 7;

/// Tosses some particles, pins too, by numbers that depend on where they are.
template <class Scalar, class X, class V>
void toss(Index i, Scalar time, X& x, V& v) {
    x *= Scalar(0.875) + time;
    v -= x * static_cast<Scalar>(i % 3);
}

/// Grids, what is scattered in batches, and stars; damped and not; asked for the state or not.
template <class Scalar, int Dim, class Visit>
void each_system(const Visit& visit) {
    Random random(91);
    for (const bool damped : {false, true}) {
        RandomOptions options;
        options.dampers = options.rayleigh = damped;
        options.pinned = damped ? 3 : 0;
        auto scattered = random_system<Scalar, Dim>(random, options);
        auto grid = net<Scalar, Dim>(random, 40, 40);
        if (damped) {
            grid.pin(1);
            const auto force = [](const auto& state, auto& f) {
                f += static_cast<Scalar>(state.time) * state.x - state.v;
            };
            scattered.set_external_force(force);
            grid.set_external_force(force);
        }
        visit(scattered, random_state(random, scattered));
        visit(grid, random_state(random, grid));
        const auto mesh = irregular<Scalar, Dim>(random, 2600, damped);
        visit(mesh, random_state(random, mesh));
    }
}

/// visit(make), make(options) a stepper of each kind.
template <class System, class Visit>
void each_stepper(const System& system, const Visit& visit) {
    visit([&](taut::ExplicitOptions options) { return taut::SymplecticEuler(system, options); });
    visit([&](taut::ExplicitOptions options) { return taut::EnergyStableEuler(system, options); });
}

}  // namespace

TEMPLATE_TEST_CASE("between: looking on changes no bit and sees every step once", "[between]",
                   (Case<float, 2>), (Case<float, 3>), (Case<double, 1>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    each_system<Scalar, TestType::Dim>([](const auto& system, const auto& start) {
        each_stepper(system, [&](const auto& make) {
            auto together = start, alone = start, watched = start;
            auto first = make({}), second = make({}), third = make({2});
            REQUIRE(first.step(together, h<Scalar>, steps));
            Index calls = 0;
            const auto report = step_between(third, watched, h<Scalar>, steps, [&](auto& now) {
                ++calls;
                REQUIRE(second.step(alone, h<Scalar>));
                bool same = now.size() == system.size() && now.time() == alone.time;
                for (Index i = 0; i < now.size(); ++i) {
                    same = same && now.x(i) == alone.x.col(i) && now.v(i) == alone.v.col(i);
                }
                CHECK(same);
                CHECK_FALSE(now.changed());
            });
            CHECK(report);
            CHECK(report.iterations == steps);
            CHECK(calls == steps);
            CHECK(same_bits(watched, together));
            CHECK(same_bits(watched, alone));
        });
    });
}

TEMPLATE_TEST_CASE("between: what is set is what single calls would find", "[between]",
                   (Case<float, 2>), (Case<float, 3>), (Case<double, 1>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    each_system<Scalar, TestType::Dim>([](const auto& system, const auto& start) {
        each_stepper(system, [&](const auto& make) {
            auto alone = start, together = start;
            auto first = make({}), second = make({});
            const auto wanted = [](Index step, Index i) { return step != 3 && i % 5 == 1; };
            for (Index step = 0; step < steps; ++step) {
                REQUIRE(first.step(alone, h<Scalar>));
                for (Index i = 0; i < system.size(); ++i) {
                    if (!wanted(step, i)) continue;
                    auto x = alone.x.col(i);
                    auto v = alone.v.col(i);
                    toss(i, alone.time, x, v);
                }
            }
            Index step = 0;
            REQUIRE(step_between(second, together, h<Scalar>, steps, [&](auto& now) {
                for (Index i = 0; i < now.size(); ++i) {
                    if (!wanted(step, i)) continue;
                    auto x = now.x(i);
                    auto v = now.v(i);
                    toss(i, now.time(), x, v);
                    now.set_x(i, x);
                    now.set_v(i, v);
                }
                ++step;
            }));
            CHECK(same_bits(together, alone));
            // What was set after the last step counts in the next call.
            REQUIRE(first.step(alone, h<Scalar>, 2));
            REQUIRE(second.step(together, h<Scalar>, 2));
            CHECK(same_bits(together, alone));
        });
    });
}

TEMPLATE_TEST_CASE("between: what is refused or thrown out of leaves the state alone", "[between]",
                   (Case<float, 3>), (Case<double, 2>)) {
    using Scalar = typename TestType::Scalar;
    each_system<Scalar, TestType::Dim>([](const auto& system, const auto& start) {
        each_stepper(system, [&](const auto& make) {
            for (const Index when : {Index(1), Index(4), steps}) {
                for (const bool position : {false, true}) {
                    auto state = start;
                    auto stepper = make({});
                    Index calls = 0;
                    const auto spoil = [&](auto& now) {
                        if (++calls != when) return;
                        auto bad = now.x(5);
                        bad[0] = position ? std::numeric_limits<Scalar>::infinity()
                                          : std::numeric_limits<Scalar>::quiet_NaN();
                        position ? now.set_x(5, bad) : now.set_v(5, bad);
                    };
                    const auto report = step_between(stepper, state, h<Scalar>, steps, spoil);
                    CHECK(report.status == taut::Status::diverged);
                    CHECK(report.iterations == when - 1);
                    CHECK(report.where == 5);
                    CHECK(calls == when);
                    CHECK(same_bits(state, start));

                    const auto stop = [](auto&) { throw std::runtime_error("enough"); };
                    CHECK_THROWS_AS(step_between(stepper, state, h<Scalar>, steps, stop),
                                    std::runtime_error);
                    CHECK(same_bits(state, start));

                    auto expected = start;
                    auto fresh = make({});
                    REQUIRE(fresh.step(expected, h<Scalar>, steps));
                    REQUIRE(stepper.step(state, h<Scalar>, steps));
                    CHECK(same_bits(state, expected));
                    CHECK(calls == when);
                }
            }
        });
    });
}

TEST_CASE("between: on an engine's arrays, and nobody is called for no step", "[between]") {
    const auto cloth = taut::hanging_cloth<double>({9, 7});
    auto state = cloth.initial_state();
    std::vector<float> x(static_cast<std::size_t>(3 * cloth.size())), v = x;
    taut::StateView<float, 3> view(x.data(), v.data(), cloth.size());
    view.copy_from(state);
    Index calls = 0;
    const auto count = [&](taut::BetweenSteps<double, 3>& now) {
        ++calls;
        now.set_v(8, {0, 0, 1});
    };
    taut::SymplecticEuler stepper(cloth);
    REQUIRE(step_between(stepper, view, 1e-4, 0, count));
    CHECK(calls == 0);
    CHECK(step_between(stepper, view, -1.0, 5, count).status == taut::Status::invalid_step);
    CHECK(calls == 0);
    REQUIRE(step_between(stepper, view, 1e-4, 5, count));
    CHECK(calls == 5);
    CHECK(v[3 * 8 + 2] == 1);
}

}  // namespace taut_test::between_test
