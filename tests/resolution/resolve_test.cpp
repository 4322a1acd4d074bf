// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <taut/model/tension_only.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/scene/with_law.hpp>
#include <taut/resolution/resolution.hpp>
#include <vector>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::resolve_test {

using taut::resolve;
using taut::Resolved;

namespace {

constexpr int samples = 30;

/// A soft cloth, so that its stretch shows, held at two corners and blown sideways.
taut::SpringSystem<double, 3> soft_cloth(Index side, double stretch) {
    taut::ClothOptions options;
    options.rows = options.columns = side;
    options.stretch = stretch;
    options.bend = stretch / 100;
    auto cloth = taut::hanging_cloth<double>(options);
    for (Index i = 0; i < cloth.size(); ++i)
        cloth.set_constant_force(i, {0, 0.5 * static_cast<double>(cloth.mass(i)), 0});
    return cloth;
}

/// A rope in the plane, pinned at one end, laid out level.
taut::SpringSystem<double, 2> rope(Index n, double stiffness) {
    taut::SpringSystem<double, 2> system;
    for (Index i = 0; i < n; ++i)
        system.add_particle({static_cast<double>(i) / static_cast<double>(n - 1), 0},
                            1 / static_cast<double>(n));
    for (Index i = 0; i + 1 < n; ++i)
        system.add_spring(i, i + 1, stiffness * static_cast<double>(n - 1));
    system.pin(0);
    system.set_gravity({0, -9.81});
    return system;
}

/// The positions of the scene itself, stepped at its energy_limit, at the start and at each sample.
template <class System>
std::vector<taut::Points<double, System::Dim>> true_motion(const System& system,
                                                           typename System::State state,
                                                           double duration) {
    const double limit = static_cast<double>(taut::energy_limit(system).certified);
    const double interval = duration / samples;
    const auto steps = static_cast<Index>(std::ceil(interval / limit));
    taut::EnergyStableEuler stepper(system);
    std::vector<taut::Points<double, System::Dim>> path{state.x.template cast<double>()};
    for (int s = 0; s < samples; ++s) {
        REQUIRE(stepper.step(
            state, static_cast<typename System::Scalar>(interval / static_cast<double>(steps)),
            steps));
        path.push_back(state.x.template cast<double>());
    }
    return path;
}

/// How far the lifted motion of a coarse network is from the scene's, of its size.
template <class System>
double true_error(const System& system, const typename System::State& state,
                  const taut::Coarsening<System>& coarse, double duration, double size) {
    const auto fine = true_motion(system, state, duration);
    const auto path = true_motion(coarse.system, coarse.restricted(state), duration);
    double worst = 0;
    for (std::size_t s = 0; s < fine.size(); ++s) {
        const auto moved =
            coarse.lifted((path[s] - path[0]).template cast<typename System::Scalar>());
        const auto apart = fine[s] - fine[0] - moved.template cast<double>();
        worst = std::max(worst, std::sqrt(apart.colwise().squaredNorm().mean()));
    }
    return worst / size;
}

template <class System>
void check_promise(const System& system, const typename System::State& state, double duration,
                   double goal) {
    const auto found = resolve(system, state, duration, goal);
    INFO(found.why);
    REQUIRE(found.outcome == Resolved::coarse);
    REQUIRE(found.coarsening);
    const auto& level = found.levels[static_cast<std::size_t>(found.chosen)];
    CHECK(found.coarsening->system.size() == level.particles);
    CHECK(2 * level.error <= goal);
    CHECK(found.cheaper() > 1);
    const double truth = true_error(system, state, *found.coarsening, duration, found.size);
    CHECK(truth <= goal);
    CHECK(level.error <= 2 * truth);
    CHECK(level.error >= truth / 2);
    CHECK(found.search_cost <= 0.3 * found.fine_cost);
}

}  // namespace

TEST_CASE("resolve: what meets the goal does so against the scene itself", "[tradeoff][slow]") {
    for (const double stretch : {4.0, 40.0}) {
        const auto cloth = soft_cloth(40, stretch);
        for (const double goal : {0.15, 0.06}) {
            INFO("stretch " << stretch << " N/m, goal " << goal);
            check_promise(cloth, cloth.initial_state(), 0.4, goal);
        }
    }
    const auto line = rope(600, 20);
    for (const double goal : {0.1, 0.03}) check_promise(line, line.initial_state(), 0.6, goal);
    const auto strings = taut::with_law<taut::TensionOnly>(soft_cloth(40, 40));
    check_promise(strings, strings.initial_state(), 0.3, 0.1);
}

TEST_CASE("resolve: a moving start, in float", "[tradeoff]") {
    taut::ClothOptions options;
    options.rows = options.columns = 40;
    options.stretch = 30;
    options.bend = 0.3;
    const auto cloth = taut::hanging_cloth<float>(options);
    auto state = cloth.initial_state();
    for (Index i = 0; i < cloth.size(); ++i)
        if (!cloth.is_pinned(i)) state.v(1, i) = 2 * state.x(0, i);
    check_promise(cloth, state, 0.3, 0.1);
}

TEST_CASE("resolve: the same answer every time, and it can be built again", "[tradeoff]") {
    const auto cloth = soft_cloth(30, 20);
    const auto state = cloth.initial_state();
    const auto one = resolve(cloth, state, 0.3, 0.1), other = resolve(cloth, state, 0.3, 0.1);
    REQUIRE(one.coarsening);
    CHECK(one.why == other.why);
    REQUIRE(one.levels.size() == other.levels.size());
    for (std::size_t l = 0; l < one.levels.size(); ++l) {
        CHECK(one.levels[l].difference == other.levels[l].difference);
        CHECK(one.levels[l].cost == other.levels[l].cost);
    }
    CHECK(one.floor == other.floor);
    const auto again = taut::coarsen(cloth, one.coarsening->system.size());
    CHECK(again.seeds == one.coarsening->seeds);
}

TEST_CASE("resolve: a goal that asks for all particles is told so, within the budget",
          "[tradeoff]") {
    const auto cloth = soft_cloth(30, 20);
    const auto found = resolve(cloth, cloth.initial_state(), 0.3, 1e-4);
    CHECK(found.outcome == Resolved::fine);
    CHECK_FALSE(found.coarsening);
    CHECK(found.cheaper() == 1);
    CHECK(found.search_cost <= 0.3 * found.fine_cost);
    CHECK(missing(found.why, {"own 900 particles", "0.01 %"}) == "");
    // Too small for any level.
    const auto small = soft_cloth(4, 20);
    CHECK(resolve(small, small.initial_state(), 0.3, 0.5).outcome == Resolved::fine);
    taut::ResolveOptions thrifty;
    thrifty.budget = 1e-6;
    const auto none = resolve(cloth, cloth.initial_state(), 0.3, 0.1, thrifty);
    CHECK(none.outcome == Resolved::fine);
    CHECK(none.search_cost == 0);
}

TEST_CASE("resolve: chaos is told from a coarse mesh", "[tradeoff]") {
    // A stiff rope that swings and whips for seconds.
    auto whip = rope(400, 3000);
    const auto found = resolve(whip, whip.initial_state(), 8, 1e-3);
    INFO(found.why);
    CHECK(found.outcome == Resolved::unpredictable);
    CHECK(2 * found.floor > 1e-3);
    CHECK_FALSE(found.coarsening);
    CHECK(missing(found.why, {"No number of particles", "over 8 s"}) == "");
    // The same in its first moments is not chaos.
    CHECK(resolve(whip, whip.initial_state(), 0.1, 0.05).floor < 1e-5);
}

TEST_CASE("resolve: nothing moves, or all is pinned", "[tradeoff]") {
    auto rest = rope(100, 20);
    rest.set_gravity({0, 0});
    const auto still = resolve(rest, rest.initial_state(), 5, 0.01);
    CHECK(still.outcome == Resolved::nothing_moves);
    CHECK(missing(still.why, {"Nothing moves"}) == "");
    auto pinned = rope(100, 20);
    for (Index i = 0; i < pinned.size(); ++i) pinned.pin(i);
    CHECK(resolve(pinned, pinned.initial_state(), 5, 0.01).outcome == Resolved::nothing_moves);
    // A pin that is carried along is a motion.
    auto carried = rest.initial_state();
    carried.v(1, 0) = 1;
    CHECK(resolve(rest, carried, 0.2, 0.1).outcome != Resolved::nothing_moves);
}

TEST_CASE("resolve: a scene that diverges, and a search that takes too long", "[tradeoff]") {
    const auto cloth = soft_cloth(30, 20);
    auto wild = cloth.initial_state();
    for (Index i = 0; i < cloth.size(); ++i)
        if (!cloth.is_pinned(i)) wild.v.col(i).setConstant(i % 2 == 0 ? 1e307 : -1e307);
    const auto diverged = resolve(cloth, wild, 1e3, 0.1);
    INFO(diverged.why);
    CHECK(diverged.outcome == Resolved::diverged);
    CHECK_FALSE(diverged.coarsening);

    taut::ResolveOptions hurried;
    hurried.seconds = 5;
    hurried.clock = [] {
        static double now = 0;
        return now += 1;
    };
    const auto cut = resolve(cloth, cloth.initial_state(), 0.3, 0.1, hurried);
    CHECK(cut.outcome == Resolved::cut_short);
    CHECK(missing(cut.why, {"time", "of the cost"}) == "");
    CHECK_FALSE(cut.coarsening);
}

TEST_CASE("resolve: parts that no spring joins each keep a particle", "[tradeoff]") {
    taut::SpringSystem<double, 2> two = rope(500, 20);
    for (Index i = 0; i < 500; ++i) {
        two.add_particle({static_cast<double>(i) / 499, 2}, 0.002);
        if (i > 0) two.add_spring(499 + i, 500 + i, 20 * 499);
    }
    check_promise(two, two.initial_state(), 0.4, 0.1);
}

/// Answers that say the goal is met must be true; to be refused is well.
template <class System>
void check_honest(const System& system, const typename System::State& state, double duration,
                  double goal) {
    const auto found = resolve(system, state, duration, goal);
    INFO(found.why);
    CHECK(found.outcome != Resolved::nothing_moves);
    if (!found.coarsening) return;
    CHECK(true_error(system, state, *found.coarsening, duration, found.size) <= goal);
}

TEST_CASE("resolve: no goal is said to be met where a scene gives way in one place",
          "[tradeoff][slow]") {
    // A sheet hung by its top row, with one row of springs 20 000 times as soft.
    taut::SpringSystem<double, 2> sheet;
    constexpr Index side = 33;
    for (Index r = 0; r < side; ++r)
        for (Index c = 0; c < side; ++c)
            sheet.add_particle({0.03 * static_cast<double>(c), -0.03 * static_cast<double>(r)},
                               3e-4);
    const auto at = [](Index r, Index c) { return r * side + c; };
    for (Index r = 0; r < side; ++r) {
        for (Index c = 0; c < side; ++c) {
            const double k = r == 12 ? 0.05 : 1000;
            if (c + 1 < side) sheet.add_spring(at(r, c), at(r, c + 1), 1000);
            if (r + 1 == side) continue;
            sheet.add_spring(at(r, c), at(r + 1, c), k);
            if (c + 1 < side) sheet.add_spring(at(r, c), at(r + 1, c + 1), k);
        }
    }
    for (Index c = 0; c < side; ++c) sheet.pin(c);
    sheet.set_gravity({0, -9.81});
    for (const double goal : {0.05, 0.1}) check_honest(sheet, sheet.initial_state(), 0.3, goal);

    auto chain = rope(1000, 20);
    chain.set_stiffness(350, 5);
    for (const double goal : {0.05, 0.1}) check_honest(chain, chain.initial_state(), 0.4, goal);
}

TEST_CASE("resolve: no goal is said to be met where slack and taut threads share their ends",
          "[tradeoff]") {
    taut::SpringSystem<double, 3, taut::TensionOnly> net;
    constexpr Index side = 30;
    for (Index r = 0; r < side; ++r)
        for (Index c = 0; c < side; ++c)
            net.add_particle({0.1 * static_cast<double>(c), 0.1 * static_cast<double>(r), 0}, 0.01);
    const auto join = [&](Index a, Index b) {
        for (const double rest : {0.07, 0.13})
            net.add_spring(taut::Spring<double, taut::TensionOnly>{a, b, {20}, rest, 0});
    };
    for (Index r = 0; r < side; ++r) {
        for (Index c = 0; c < side; ++c) {
            if (c + 1 < side) join(r * side + c, r * side + c + 1);
            if (r + 1 < side) join(r * side + c, (r + 1) * side + c);
        }
    }
    for (const double goal : {0.05, 0.1}) check_honest(net, net.initial_state(), 0.3, goal);
}

TEST_CASE("resolve: a small part beside a large one is not left out", "[tradeoff]") {
    taut::SpringSystem<double, 2> both = rope(500, 20);
    // A long one beside it, of few particles.
    for (Index i = 0; i < 40; ++i) {
        both.add_particle({static_cast<double>(i), 5}, 0.01);
        if (i > 0) both.add_spring(499 + i, 500 + i, 200);
    }
    both.pin(500);
    for (const double goal : {0.003, 0.02}) check_honest(both, both.initial_state(), 0.5, goal);
}

TEST_CASE("resolve: what may buckle is not called still", "[tradeoff]") {
    taut::SpringSystem<double, 2> column;
    for (Index i = 0; i < 100; ++i) {
        column.add_particle({static_cast<double>(i), 1e-17 * static_cast<double>(i % 3)}, 0.1);
        if (i > 0) column.add_spring(taut::Spring<double, taut::Hookean>{i - 1, i, {50}, 1.5, 0});
    }
    column.pin(0);
    column.pin(99);
    const auto found = resolve(column, column.initial_state(), 10, 0.01);
    INFO(found.why);
    CHECK(found.outcome != Resolved::nothing_moves);
    CHECK(found.outcome != Resolved::coarse);
    auto carried = rope(50, 20);
    auto state = carried.initial_state();
    for (Index i = 0; i < 50; ++i) carried.pin(i);
    state.v.setConstant(1);
    CHECK(resolve(carried, state, 1, 0.1).outcome != Resolved::nothing_moves);
}

TEST_CASE("resolve: bad input", "[tradeoff][bad_input]") {
    auto line = rope(100, 20);
    auto state = line.initial_state();
    const auto refused = [&](double duration, double goal, const taut::ResolveOptions& options,
                             std::initializer_list<const char*> words) {
        return missing(message_of([&] { resolve(line, state, duration, goal, options); }), words);
    };
    const double not_a_number = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {0.0, -1.0, not_a_number}) {
        CHECK(refused(bad, 0.1, {}, {"resolve", "duration", "> 0"}) == "");
        CHECK(refused(1, bad, {}, {"resolve", "goal", "> 0"}) == "");
    }
    taut::ResolveOptions options;
    options.safety = 0.5;
    CHECK(refused(1, 0.1, options, {"safety is 0.5", ">= 1"}) == "");
    options = {};
    options.budget = 0;
    CHECK(refused(1, 0.1, options, {"budget is 0"}) == "");
    options = {};
    options.samples = 0;
    CHECK(refused(1, 0.1, options, {"samples is 0"}) == "");
    {
        taut::SpringSystem<double, 2> point;
        for (int i = 0; i < 50; ++i) point.add_particle({1, 1}, 1);
        point.set_gravity({0, -1});
        CHECK(missing(message_of([&] { resolve(point, point.initial_state(), 1, 0.1); }),
                      {"resolve", "size is 0"}) == "");
    }
    line.set_external_force([](const auto&, auto&) {});
    CHECK(refused(1, 0.1, {}, {"set_external_force"}) == "");
    line.set_external_force({});
    state.x(0, 7) = not_a_number;
    CHECK(refused(1, 0.1, {}, {"particle 7"}) == "");
    state.x.conservativeResize(2, 9);
    CHECK(refused(1, 0.1, {}, {"resolve", "9"}) == "");
}

}  // namespace taut_test::resolve_test
