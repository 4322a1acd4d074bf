// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/stepper_battery.hpp"
#include "direct_imex.hpp"
#include "imex_scenes.hpp"

namespace taut_test::imex_test {

namespace {

/// A third of the springs wholly implicit, a third in part.
double mixed_share(Index s) { return s % 3 == 0 ? 1 : s % 3 == 1 ? 0.25 : 0; }

RandomOptions many_springs(Index particles, Index springs) {
    RandomOptions options;
    options.particles = particles;
    options.springs = springs;
    options.dampers = true;
    return options;
}

/// Whether steps of h and h/4 are A's formula, of pins that move, too.
/// @param glued  whether Glue stays: where a tension falls, φ hangs on what is left of a difference
///               of energies
void check_written_out(Random& random, const Kind& kind, const RandomOptions& options, bool forced,
                       bool glued) {
    auto scene = random_scene(random, kind, options);
    for (Index s = options.springs; kind.laws == Laws::any && !glued && s-- > 0;)
        scene.remove_spring(LawOf::glue, s);
    RealMatrix forces = RealMatrix::Zero(kind.dim, scene.size());
    for (Index i = 0; forced && i < scene.size(); ++i) {
        const auto force = random_vector(random, kind.dim, -10, 10);
        scene.set_constant_force(i, force);
        forces.col(i) = force.cast<Real>();
    }
    const double step = 0.0625;
    const auto stepper = imex(scene, step, mixed_share);
    const ImexMatrices matrices(scene, step, mixed_share);
    const RealMatrix A = matrices.free_part(matrices.A);
    CHECK(stepper->implicit_springs() >= scene.spring_count() / 2);
    const auto start = random_state(random, scene);
    for (const double h : {step, step / 4}) {
        auto state = start;
        for (int i = 0; i < 4; ++i) {
            const auto before = state;
            REQUIRE(stepper->step(state, h));
            const auto time = static_cast<Real>(h);
            const StepAhead ahead(scene, before, time, forces);
            const RealMatrix change =
                (state.v - before.v)(Eigen::all, matrices.free).transpose().cast<Real>();
            const Real off = (A * change - impulses(scene, matrices, ahead, before, time, forces))
                                 .cwiseAbs()
                                 .maxCoeff();
            const Real most = A.cwiseAbs().maxCoeff() * state.v.cwiseAbs().maxCoeff();
            CHECK(off <= (glued ? 64 : 1) * static_cast<Real>(kind.rounding()) * most);
            CHECK(gap(state.x, before.x + h * state.v) <=
                  kind.rounding() * state.v.cwiseAbs().maxCoeff());
            const auto added = static_cast<double>(matrices.added_energy(scene, state));
            CHECK_THAT(stepper->added_kinetic(state), WithinRel(added, 1e-12));
        }
        auto at_once = start;
        REQUIRE(stepper->step(at_once, h, 4));
        CHECK(at_once == state);
    }
    CHECK(stepper->factorizations() == 1);
}

/// A cloth of rows × columns in its plane, unit masses and springs, two corners pinned; the springs
/// of the last row are `hem` times as stiff.
Scene hemmed_cloth(const Kind& kind, Index rows, Index columns, double hem) {
    Scene scene(kind);
    for (Index i = 0; i < rows * columns; ++i) {
        Eigen::VectorXd place = Eigen::VectorXd::Zero(kind.dim);
        place[kind.dim - 1] = static_cast<double>(-(i / columns));
        place[0] += static_cast<double>(i % columns);
        scene.add_particle(place, 1);
    }
    for (Index i = 0; i < rows * columns; ++i) {
        AnySpring spring{i, i + 1, i / columns + 1 == rows ? hem : 1, 1};
        spring.law = laws_of(kind)[0];
        if ((i + 1) % columns != 0) scene.add_spring(spring);
        spring.b = i + columns;
        spring.stiffness = 1;
        if (spring.b < scene.size()) scene.add_spring(spring);
    }
    scene.pin(0);
    scene.pin(columns - 1);
    return scene;
}

}  // namespace

TEST_CASE("imex: it keeps what steppers promise", "[imex]") {
    test_stepper({[](const Scene& scene) { return imex(scene, 0.0625, mixed_share); }, imex_kinds});
}

TEST_CASE("imex: a step is A's formula written out", "[imex]") {
    for (const Kind& kind : imex_kinds) {
        Random random(8710);
        for (int repeat = 0; repeat < 12; ++repeat) {
            INFO(kind << ", system " << repeat);
            auto options = repeat == 0 ? many_springs(400, 500) : many_springs(24, 30);
            options.dampers = repeat % 3 == 0;
            options.rayleigh = repeat % 4 < 2;
            const bool glued = kind.laws == Laws::any && repeat % 2 == 1;
            check_written_out(random, kind, options, repeat % 5 == 0, glued);
        }
    }
}

TEST_CASE("imex: a StateView is stepped as a State is", "[imex]") {
    Random random(8740);
    const auto scene = random_scene(random, {false, 2, Laws::strings}, many_springs(400, 500));
    const double step = 8 * scene.energy_limit().certified;
    const auto stepper = imex(scene, step);
    CHECK(stepper->implicit_springs() > 0);
    auto state = random_state(random, scene);
    auto viewed = state;
    REQUIRE(stepper->step(state, step, 70));
    REQUIRE(imex_of_view(scene, step)->step(viewed, step, 70));
    CHECK(state.x == viewed.x);
    CHECK(state.v == viewed.v);
}

TEST_CASE("imex: where no spring needs it, it is EnergyStableEuler to the bit", "[imex]") {
    for (const Kind& kind : imex_kinds) {
        Random random(8720);
        for (int repeat = 0; repeat < 12; ++repeat) {
            INFO(kind << ", scene " << repeat);
            RandomOptions options;
            options.dampers = repeat % 2 == 0;
            options.rayleigh = repeat % 3 == 0;
            const auto scene = random_scene(random, kind, options);
            // A third: the bounds by rows are wider than what is certified.
            const double h = scene.rounded(scene.energy_limit().certified / 3);
            const auto stepper = imex(scene, h);
            CHECK(stepper->implicit_springs() == 0);
            CHECK(stepper->touched() == 0);
            CHECK(stepper->limit().certified == h);
            auto state = random_state(random, scene);
            auto expected = state;
            REQUIRE(stepper->step(state, h, 9));
            REQUIRE(scene.stepper(taut::Method::energy_stable_euler)->step(expected, h, 9));
            CHECK(state == expected);
            CHECK(stepper->added_kinetic(state) == 0);
        }
    }
}

TEST_CASE("imex: a cloth with a stiff hem takes the step of the cloth", "[imex]") {
    for (const Kind& kind : imex_kinds) {
        if (kind.dim == 1) continue;
        const double limit = hemmed_cloth(kind, 12, 16, 1).energy_limit().certified;
        for (const double stiffer : {10.0, 1e3, 1e6}) {
            INFO(kind << ", hem times " << stiffer);
            const auto cloth = hemmed_cloth(kind, 12, 16, stiffer);
            const auto stepper = imex(cloth, 0.8 * limit);
            CHECK(stepper->limit().certified == cloth.rounded(0.8 * limit));
            Index index = 0;
            for (const AnySpring& spring : cloth.springs())
                CHECK(stepper->share(index++) == (spring.stiffness > 1 ? 1 : 0));
            CHECK(stepper->touched() == 16);
        }
    }
}

TEST_CASE("imex: an edit makes the inertia anew, nothing else does", "[imex]") {
    Random random(8750);
    auto scene = random_scene(random, {false, 3, Laws::any}, many_springs(20, 40));
    const double step = 10 * scene.energy_limit().certified;
    const auto stepper = imex(scene, step);
    auto state = scene.initial_state();
    const auto check = [&](std::int64_t factorizations) {
        REQUIRE(stepper->step(state, step));
        CHECK(stepper->factorizations() == factorizations);
        const auto fresh = imex(scene, step);
        CHECK(stepper->limit().revision == scene.revision());
        CHECK(stepper->limit().certified == fresh->limit().certified);
        CHECK(stepper->implicit_springs() == fresh->implicit_springs());
        CHECK(stepper->added_kinetic(state) == fresh->added_kinetic(state));
    };
    check(1);
    scene.set_gravity(Eigen::Vector3d(0, 0, -1));
    REQUIRE(stepper->step(state, step / 7));
    check(1);
    scene.set_mass(9, 0.01);
    check(2);
    scene.set_rayleigh(0.1, 0.01);
    check(3);
    scene.pin(7);
    check(4);
    for (const LawOf law : laws_of(scene.kind()))
        for (Index s = 40; s-- > 0;) scene.remove_spring(law, s);
    check(4);  // nothing is implicit
}

TEST_CASE("imex: shares that are given certify what they leave", "[imex]") {
    for (const Kind& kind : imex_kinds) {
        Random random(8760);
        for (int repeat = 0; repeat < 10; ++repeat) {
            INFO(kind << ", scene " << repeat);
            auto options = many_springs(8, 20);
            options.dampers = repeat % 2 == 0;
            options.pinned = 3;  // springs between pins are nobody's load
            auto scene = random_scene(random, kind, options);
            const double none = scene.energy_limit().certified;
            const auto certified = [&](const std::function<double(Index)>& share) {
                return imex(scene, 20 * none, share)->limit().certified;
            };
            const auto evenly = [&](double share) {
                return certified([=](Index) { return share; });
            };
            const double exact = kind.single ? 1e-6 : 1e-9;
            CHECK_THAT(evenly(0), WithinRel(none, exact));
            CHECK(evenly(0.5) > 1.3 * none);
            CHECK(evenly(0.5) < 2.1 * none);
            CHECK(evenly(1) == scene.rounded(20 * none));
            const double edge = std::min(edge_of_own(scene, mixed_share), 20 * none);
            CHECK(certified(mixed_share) <= edge * (1 + 1e-6));
            CHECK(certified(mixed_share) >= 0.9 * edge);
            // No spring takes drag off the step.
            scene.set_rayleigh(0.2 / none, 0);
            CHECK_THAT(evenly(1), WithinRel(10 * none, exact));
            CHECK_THAT(certified({}), WithinRel(10 * none, exact));
        }
    }
}

TEST_CASE("imex: wrong options and masses that are lost are told by name", "[imex][bad_input]") {
    const Kind kind{false, 2, Laws::strings};
    Random random(8780);
    const auto scene = random_scene(random, kind);
    const auto message = [&](double step, std::function<double(Index)> share, int threads) {
        return message_of([&] { imex(scene, step, share, threads); });
    };
    for (const double step : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
        CHECK(missing(message(step, {}, 1), {"ImexEuler", "step"}) == "");
    for (const double share : {-0.1, 1.1, std::nan("")}) {
        const auto one = [=](Index s) { return s == 4 ? share : 0; };
        CHECK(missing(message(0.1, one, 1), {"ImexEuler", "share of spring 4", "[0, 1]"}) == "");
    }
    CHECK(missing(message(0.1, {}, 0), {"threads", "0"}) == "");
    // Beyond the digits of double nothing is left of the masses.
    const auto lost = imex(scene, 1e12);
    auto state = random_state(random, scene);
    const auto before = state;
    CHECK(lost->step(state, 1).status == taut::Status::masses_lost);
    CHECK(lost->limit().certified == 0);
    CHECK(state == before);
    // Far above every limit it overflows; the state is as before.
    state.v *= 1e300;
    const auto fast = state;
    CHECK_FALSE(imex(scene, 1)->step(state, 1e6, 100));
    CHECK(state == fast);
}

}  // namespace taut_test::imex_test
