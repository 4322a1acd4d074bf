// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <taut/bdf2/bdf2.hpp>
#include <taut/guard/guard.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/network/state_view.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/scene/with_law.hpp>
#include <taut/tight/tight.hpp>
#include <taut/wind/wind.hpp>
#include <taut/network/tension_only.hpp>
#include <vector>

#include "../support/catch.hpp"

// What Guarded is made from and takes: steppers, views, responses.

namespace taut_test::guarded_types_test {

namespace {

using taut::Index;

constexpr double frame = 1.0 / 60;  // s

/// An engine's memory: a view of four numbers a particle.
template <class Stored>
struct Arrays {
    explicit Arrays(Index n)
        : x(static_cast<std::size_t>(4 * n), -77), v(x), view(x.data(), v.data(), n, 4) {}
    std::vector<Stored> x, v;
    taut::StateView<Stored, 3> view;
};

}  // namespace

TEST_CASE("guarded_types: implicit steppers, views, responses and options", "[guard]") {
    using Net = taut::SpringSystem<float, 3, taut::TensionOnly>;
    auto net = taut::with_law<taut::TensionOnly>(taut::hanging_cloth<float>({8, 8}));
    taut::Guarded<taut::ImplicitEuler<Net>> implicit(net);
    auto state = net.initial_state();
    CHECK(implicit.advance(state, float(frame)).substeps == 1);
    taut::Guarded<taut::SymplecticEuler<Net>> symplectic(net, {1e-4f, 500});
    CHECK(symplectic.options().max_substeps == 500);
    CHECK_FALSE(symplectic.limit().has_value());
    Arrays<double> arrays(64);
    auto& view = arrays.view;
    view.copy_from(net.initial_state());
    double highest = 0;
    for (int i = 0; i < 60; ++i) {
        const auto report = symplectic.advance(view, float(frame), [&](auto& s) {
            for (Index p = 0; p < 64; ++p) {
                if (s.x(2, p) < -0.2f) s.v(2, p) = std::max(s.v(2, p), 0.0f);
            }
        });
        REQUIRE(report);
        CHECK(report.substeps == 167);
        highest = std::max(highest, view.v.norm());
    }
    CHECK_THAT(view.time, WithinRel(1, 1e-4));
    CHECK(highest < 100);
    CHECK(symplectic.limit()->revision == net.revision());
    net.set_mass(5, 1);
    REQUIRE(symplectic.advance(view, float(frame)));
    CHECK(symplectic.limit()->revision == net.revision());
    CHECK(symplectic.proved_limit()->revision == net.revision());
}

TEST_CASE("guarded_types: limits of the user's hold until the system changes", "[guard]") {
    auto cloth = taut::hanging_cloth<float>({12, 12});
    taut::Guarded guard(cloth);
    const auto narrow = taut::any_pose_limit(cloth, 0.01);
    const auto energy = taut::energy_limit(cloth, 0.01);
    REQUIRE(narrow.certified > 1.1f * taut::any_pose_limit(cloth).certified);
    guard.set_limits(narrow, energy);
    auto state = cloth.initial_state();
    state.v.row(2).tail(132).setConstant(20);
    const double start = cloth.energy(state);
    for (int i = 0; i < 60; ++i) {
        const auto report = guard.advance(state, float(frame));
        REQUIRE(report);
        CHECK(report.substeps == taut::Index(std::ceil(frame / (0.95 * narrow.certified))));
        CHECK(report.energy < 1.1 * start);
    }
    cloth.set_mass(5, 1);
    CHECK_THROWS_WITH(guard.set_limits(narrow, energy),
                      ContainsSubstring("the system has changed"));
    REQUIRE(guard.advance(state, float(frame)));
    CHECK(guard.limit()->certified == taut::any_pose_limit(cloth).certified);
    CHECK(guard.proved_limit()->certified == taut::energy_limit(cloth).certified);
}

TEST_CASE("guarded_types: a frame of a view is that of a state, and one refused leaves it alone",
          "[guard]") {
    auto cloth = taut::hanging_cloth<float>({6, 6});
    taut::Guarded on_view(cloth), on_state(cloth);
    auto expected = cloth.initial_state();
    Arrays<float> arrays(cloth.size());
    auto& view = arrays.view;
    view.copy_from(expected);
    for (int i = 0; i < 5; ++i) {
        REQUIRE(on_view.advance(view, float(frame)));
        REQUIRE(on_state.advance(expected, float(frame)));
    }
    CHECK(view.x == expected.x);
    CHECK(view.v == expected.v);
    for (std::size_t i = 3; i < arrays.x.size(); i += 4) CHECK(arrays.x[i] + arrays.v[i] == -154);
    cloth.set_external_force(
        [](const auto&, auto& f) { f(0, 7) = std::numeric_limits<float>::infinity(); });
    CHECK_FALSE(on_view.advance(view, float(frame)));
    CHECK(view.x == expected.x);
    CHECK(view.v == expected.v);
}

TEST_CASE("guarded_types: wind does work beside a force of the state", "[guard]") {
    auto cloth = taut::hanging_cloth<float>({12, 12});
    taut::Wind<float> wind;
    wind.velocity = {3, 10, 4};
    for (int i = 0; i + 13 < 144; ++i) wind.triangles.push_back({i, i + 1, i + 12});
    set_wind(cloth, wind);
    cloth.set_external_force([](const auto& s, auto& f) { f -= 0.01f * s.v; });
    taut::Guarded at_once(cloth), singly(cloth);
    auto state = cloth.initial_state();
    auto other = state;
    double work = 0, expected = 0;
    for (int i = 0; i < 4; ++i) {
        const auto a = at_once.advance(state, float(frame));
        const auto b = singly.advance(other, float(frame), [](auto&) {});
        REQUIRE((a && b));
        work += a.work;
        expected += b.work;
    }
    CHECK(expected > 0.01);
    CHECK_THAT(work, WithinRel(expected, 0.05));
}

TEST_CASE("guarded_types: it goes on from its own digits where the arrays have fewer", "[guard]") {
    const auto cloth = taut::hanging_cloth<double>({6, 6});
    taut::Guarded<taut::Bdf2<taut::SpringSystem<double, 3>>> on_view(cloth), on_state(cloth);
    auto expected = cloth.initial_state();
    Arrays<float> arrays(cloth.size());
    auto& view = arrays.view;
    view.copy_from(expected);
    view.copy_to(expected);  // as floats have it
    for (int i = 0; i < 10; ++i) {
        REQUIRE(on_view.advance(view, frame));
        REQUIRE(on_state.advance(expected, frame));
    }
    CHECK(view.x == expected.x.cast<float>());
    CHECK(view.v == expected.v.cast<float>());
    view.v(1, 20) += 1;  // what the engine changes counts
    expected.x = view.x.cast<double>();
    expected.v = view.v.cast<double>();
    REQUIRE(on_view.advance(view, frame));
    REQUIRE(on_state.advance(expected, frame));
    CHECK(view.v == expected.v.cast<float>());
}

}  // namespace taut_test::guarded_types_test
