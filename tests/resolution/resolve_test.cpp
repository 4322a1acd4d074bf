// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/proof_scenes.hpp"
#include "resolution_scenes.hpp"

namespace taut_test::resolution {

using taut::Resolved;

namespace {

constexpr int samples = 30;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// A sheet of side × side particles in the plane z = 0, `edge` apart.
Scene grid(const Kind& kind, Index side, double edge, double mass) {
    Scene scene(kind);
    for (Index i = 0; i < side * side; ++i) {
        Eigen::VectorXd place = Eigen::VectorXd::Zero(kind.dim);
        place[0] = edge * static_cast<double>(i % side);
        place[1] = -edge * static_cast<double>(i / side);
        scene.add_particle(place, mass);
    }
    return scene;
}

/// A soft cloth, so that its stretch shows, held at two corners and blown sideways.
Scene soft_cloth(Index side, double stretch, bool single = false) {
    taut::ClothOptions options{side, side};
    options.stretch = stretch;
    options.bend = stretch / 100;
    Scene cloth = cloth_scene(options, single);
    for (Index i = 0; i < cloth.size(); ++i)
        cloth.set_constant_force(i, Eigen::Vector3d(0, 0.5 * cloth.mass(i), 0));
    return cloth;
}

/// A rope in the plane, pinned at one end, laid out level.
Scene rope(Index n, double stiffness) {
    Scene scene({false, 2});
    const double l = 1 / static_cast<double>(n - 1);
    for (Index i = 0; i < n; ++i)
        scene.add_particle(Eigen::Vector2d(static_cast<double>(i) * l, 0),
                           1 / static_cast<double>(n));
    for (Index i = 0; i + 1 < n; ++i) scene.add_spring({i, i + 1, stiffness / l, l});
    scene.pin(0);
    scene.set_gravity(Eigen::Vector2d(0, -9.81));
    return scene;
}

/// The positions of the scene itself, stepped at its energy_limit, at the start and at each sample.
std::vector<Eigen::MatrixXd> true_motion(const Scene& scene, AnyState state, double duration) {
    const double interval = duration / samples;
    const auto steps = static_cast<Index>(std::ceil(interval / scene.energy_limit().certified));
    const auto stepper = scene.stepper(taut::Method::energy_stable_euler);
    std::vector<Eigen::MatrixXd> path{state.x};
    for (int s = 0; s < samples; ++s) {
        REQUIRE(stepper->step(state, interval / static_cast<double>(steps), steps));
        path.push_back(state.x);
    }
    return path;
}

/// How far the lifted motion of a coarse network is from the scene's, of its size.
double true_error(const Scene& scene, const AnyState& state, const AnyCoarsening& coarse,
                  double duration, double size) {
    const auto fine = true_motion(scene, state, duration);
    const auto path = true_motion(coarse.system, coarse.restricted(state), duration);
    double worst = 0;
    for (std::size_t s = 0; s < fine.size(); ++s) {
        const Eigen::MatrixXd apart = fine[s] - fine[0] - coarse.lifted(path[s] - path[0]);
        worst = std::max(worst, std::sqrt(apart.colwise().squaredNorm().mean()));
    }
    return worst / size;
}

void check_promise(const Scene& scene, double duration, double goal, const AnyState& state) {
    const auto found = resolve(scene, state, duration, goal);
    INFO("goal " << goal << ": " << found.why);
    REQUIRE(found.outcome == Resolved::coarse);
    REQUIRE(found.coarse);
    const auto& level = found.levels[static_cast<std::size_t>(found.chosen)];
    CHECK(found.coarse->system.size() == level.particles);
    CHECK(2 * level.error <= goal);
    CHECK(found.cheaper > 1);
    const double truth = true_error(scene, state, *found.coarse, duration, found.size);
    CHECK(truth <= goal);
    CHECK(level.error <= 2 * truth);
    CHECK(level.error >= truth / 2);
    CHECK(found.search_cost <= 0.3 * found.fine_cost);
    // Half of the distance of the last two is part of every error.
    const std::size_t last = found.levels.size() - 1;
    const double tail = found.levels[last - 1].difference / 2;
    for (std::size_t l = 0; l < last; ++l)
        CHECK(found.levels[l].error >= std::hypot(found.levels[l].difference, tail) * (1 - 1e-12));
}

/// Answers that say the goal is met must be true; to be refused is well.
void check_honest(const Scene& scene, double duration, std::initializer_list<double> goals) {
    for (const double goal : goals) {
        const auto state = scene.initial_state();
        const auto found = resolve(scene, state, duration, goal);
        INFO("goal " << goal << ": " << found.why);
        CHECK(found.outcome != Resolved::nothing_moves);
        if (found.coarse)
            CHECK(true_error(scene, state, *found.coarse, duration, found.size) <= goal);
    }
}

}  // namespace

TEST_CASE("resolve: what meets the goal does so against the scene itself", "[resolution][slow]") {
    for (const double stretch : {4.0, 40.0}) {
        const Scene cloth = soft_cloth(40, stretch);
        for (const double goal : {0.15, 0.06}) {
            INFO("stretch " << stretch << " N/m");
            check_promise(cloth, 0.4, goal, cloth.initial_state());
        }
    }
    const Scene line = rope(600, 20);
    for (const double goal : {0.1, 0.03}) check_promise(line, 0.6, goal, line.initial_state());
    const Scene strings = as_strings(soft_cloth(40, 40));
    check_promise(strings, 0.3, 0.1, strings.initial_state());
}

TEST_CASE("resolve: a moving start, in float", "[resolution]") {
    const Scene cloth = soft_cloth(40, 30, true);
    auto state = cloth.initial_state();
    for (Index i = 0; i < cloth.size(); ++i)
        if (!cloth.is_pinned(i)) state.v(1, i) = 2 * state.x(0, i);
    check_promise(cloth, 0.3, 0.1, state);
}

TEST_CASE("resolve: the same answer every time, and it can be built again", "[resolution]") {
    const Scene cloth = soft_cloth(30, 20);
    const auto state = cloth.initial_state();
    const auto one = resolve(cloth, state, 0.3, 0.1), other = resolve(cloth, state, 0.3, 0.1);
    REQUIRE(one.coarse);
    CHECK(one.why == other.why);
    REQUIRE(one.levels.size() == other.levels.size());
    for (std::size_t l = 0; l < one.levels.size(); ++l) {
        CHECK(one.levels[l].difference == other.levels[l].difference);
        CHECK(one.levels[l].cost == other.levels[l].cost);
    }
    CHECK(one.floor == other.floor);
    CHECK(coarsen(cloth, one.coarse->system.size()).seeds == one.coarse->seeds);
}

TEST_CASE("resolve: a goal that asks for all particles is told so, within the budget",
          "[resolution]") {
    const Scene cloth = soft_cloth(30, 20), small = soft_cloth(4, 20);
    const auto found = resolve(cloth, cloth.initial_state(), 0.3, 1e-4);
    CHECK(found.outcome == Resolved::fine);
    CHECK_FALSE(found.coarse);
    CHECK(found.cheaper == 1);
    CHECK(found.search_cost <= 0.3 * found.fine_cost);
    CHECK(missing(found.why, {"own 900 particles", "0.01 %"}) == "");
    // Too small for any level.
    CHECK(resolve(small, small.initial_state(), 0.3, 0.5).outcome == Resolved::fine);
    taut::ResolveOptions thrifty;
    thrifty.budget = 1e-6;
    const auto none = resolve(cloth, cloth.initial_state(), 0.3, 0.1, thrifty);
    CHECK(none.outcome == Resolved::fine);
    CHECK(none.search_cost == 0);
}

TEST_CASE("resolve: chaos is told from a coarse mesh", "[resolution]") {
    // A stiff rope that swings and whips for seconds.
    const Scene whip = rope(400, 3000);
    const auto found = resolve(whip, whip.initial_state(), 8, 1e-3);
    INFO(found.why);
    CHECK(found.outcome == Resolved::unpredictable);
    CHECK_FALSE(found.coarse);
    CHECK(missing(found.why, {"No number of particles", "over 8 s"}) == "");
    for (const double goal : {1e-3, found.floor / 5, found.floor, 10 * found.floor}) {
        const auto other = resolve(whip, whip.initial_state(), 8, goal);
        CAPTURE(goal, other.floor);
        CHECK((other.outcome == Resolved::unpredictable) == (2 * other.floor > goal));
    }
    // The same in its first moments is not chaos.
    CHECK(resolve(whip, whip.initial_state(), 0.1, 0.05).floor < 1e-5);
}

TEST_CASE("resolve: what moves is told from what does not", "[resolution]") {
    Scene rest = rope(100, 20), pinned = rope(100, 20);
    rest.set_gravity(Eigen::Vector2d::Zero());
    for (Index i = 0; i < 100; ++i) pinned.pin(i);
    for (const Scene* scene : {&rest, &pinned}) {
        const auto still = resolve(*scene, scene->initial_state(), 5, 0.01);
        CHECK(still.outcome == Resolved::nothing_moves);
        CHECK(missing(still.why, {"Nothing moves"}) == "");
        // A pin that is carried along is a motion.
        auto carried = scene->initial_state();
        carried.v(1, 0) = 1;
        CHECK(resolve(*scene, carried, 0.2, 0.1).outcome != Resolved::nothing_moves);
    }
    // What moves by less than 1e-9 of the size does not, whatever the size.
    Scene far({false, 2});
    for (const double x : {0.0, 1e3}) far.add_particle(Eigen::Vector2d(x, 0), 1);
    auto creeping = far.initial_state();
    creeping.v(1, 1) = 1e-8;
    CHECK(resolve(far, creeping, 5, 0.01).outcome == Resolved::nothing_moves);
    // What may buckle does.
    Scene column({false, 2});
    for (Index i = 0; i < 100; ++i) {
        const auto y = 1e-17 * static_cast<double>(i % 3);
        column.add_particle(Eigen::Vector2d(static_cast<double>(i), y), 0.1);
        if (i > 0) column.add_spring({i - 1, i, 50, 1.5});
    }
    column.pin(0);
    column.pin(99);
    const auto found = resolve(column, column.initial_state(), 10, 0.01);
    INFO(found.why);
    CHECK(found.outcome != Resolved::nothing_moves);
    CHECK(found.outcome != Resolved::coarse);
}

TEST_CASE("resolve: a scene that diverges, and a search that takes too long", "[resolution]") {
    const Scene cloth = soft_cloth(30, 20);
    auto wild = cloth.initial_state();
    for (Index i = 0; i < cloth.size(); ++i)
        if (!cloth.is_pinned(i)) wild.v.col(i).setConstant(i % 2 == 0 ? 1e307 : -1e307);
    const auto diverged = resolve(cloth, wild, 1e3, 0.1);
    INFO(diverged.why);
    CHECK(diverged.outcome == Resolved::diverged);
    CHECK_FALSE(diverged.coarse);

    taut::ResolveOptions hurried;
    hurried.seconds = 5;
    hurried.clock = [] {
        static double now = 0;
        return now += 1;
    };
    const auto cut = resolve(cloth, cloth.initial_state(), 0.3, 0.1, hurried);
    CHECK(cut.outcome == Resolved::cut_short);
    CHECK(missing(cut.why, {"time", "of the cost"}) == "");
    CHECK_FALSE(cut.coarse);
}

TEST_CASE("resolve: parts that no spring joins each keep a particle", "[resolution]") {
    Scene two = rope(500, 20);
    for (Index i = 0; i < 500; ++i) {
        two.add_particle(Eigen::Vector2d(static_cast<double>(i) / 499, 2), 0.002);
        if (i > 0) two.add_spring({499 + i, 500 + i, 20 * 499, 1.0 / 499});
    }
    check_promise(two, 0.4, 0.1, two.initial_state());
    // A small part beside a large one is not left out: a long one of few particles.
    Scene both = rope(500, 20);
    for (Index i = 0; i < 40; ++i) {
        both.add_particle(Eigen::Vector2d(static_cast<double>(i), 5), 0.01);
        if (i > 0) both.add_spring({499 + i, 500 + i, 200, 1});
    }
    both.pin(500);
    check_honest(both, 0.5, {0.003, 0.02});
}

TEST_CASE("resolve: no goal is said to be met where a scene gives way in one place",
          "[resolution][slow]") {
    // A sheet hung by its top row, with one row of springs 20 000 times as soft.
    constexpr Index side = 33;
    Scene sheet = grid({false, 2}, side, 0.03, 3e-4);
    for (Index i = 0; i < side * side; ++i) {
        const double k = i / side == 12 ? 0.05 : 1000;
        const bool last = i % side == side - 1;
        if (!last) sheet.add_spring({i, i + 1, 1000, 0.03});
        if (i / side == side - 1) continue;
        sheet.add_spring({i, i + side, k, 0.03});
        if (!last) sheet.add_spring({i, i + side + 1, k, std::sqrt(2.0) * 0.03});
    }
    for (Index c = 0; c < side; ++c) sheet.pin(c);
    sheet.set_gravity(Eigen::Vector2d(0, -9.81));
    check_honest(sheet, 0.3, {0.05, 0.1});

    const Scene chain = with_springs(rope(1000, 20), [](AnySpring& spring) {
        if (spring.a == 350) spring.stiffness = 5;
    });
    check_honest(chain, 0.4, {0.05, 0.1});
}

TEST_CASE("resolve: no goal is said to be met where slack and taut threads share their ends",
          "[resolution]") {
    constexpr Index side = 30;
    Scene net = grid({false, 3, Laws::strings}, side, 0.1, 0.01);
    const auto join = [&](Index a, Index b) {
        for (const double rest : {0.07, 0.13})
            net.add_spring({a, b, 20, rest, 0, LawOf::tension_only});
    };
    for (Index i = 0; i < side * side; ++i) {
        if (i % side < side - 1) join(i, i + 1);
        if (i / side < side - 1) join(i, i + side);
    }
    check_honest(net, 0.3, {0.05, 0.1});
}

TEST_CASE("resolve: bad input", "[resolution][bad_input]") {
    Scene line = rope(100, 20);
    auto state = line.initial_state();
    const auto refused = [&](double duration, double goal, const taut::ResolveOptions& options,
                             std::initializer_list<const char*> words) {
        return missing(message_of([&] { resolve(line, state, duration, goal, options); }), words);
    };
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
    line.set_external_force([](const AnyState&, Eigen::MatrixXd&) {});
    CHECK(refused(1, 0.1, {}, {"set_external_force"}) == "");
    line.set_external_force({});
    state.x(0, 7) = not_a_number;
    CHECK(refused(1, 0.1, {}, {"particle 7"}) == "");
    state.x.conservativeResize(2, 9);
    CHECK(refused(1, 0.1, {}, {"resolve", "9"}) == "");
    line = Scene({false, 2});
    for (int i = 0; i < 50; ++i) line.add_particle(Eigen::Vector2d(1, 1), 1);
    line.set_gravity(Eigen::Vector2d(0, -1));
    state = line.initial_state();
    CHECK(refused(1, 0.1, {}, {"resolve", "size is 0"}) == "");
}

}  // namespace taut_test::resolution
