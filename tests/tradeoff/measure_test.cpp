// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/lattice/chain.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/tradeoff/tradeoff.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random.hpp"

namespace taut_test::measure_test {

using taut::Candidate;
using taut::Method;

namespace {

using Cloth = taut::SpringSystem<double, 3>;

Cloth cloth() {
    taut::ClothOptions options;
    options.rows = options.columns = 4;
    return taut::hanging_cloth<double>(options);
}

/// One damped mass in a well: x(t) has a closed form.
struct Swing {
    static constexpr double omega = 3;
    static constexpr double zeta = 0.1;

    taut::SpringSystem<double, 1> system;
    taut::State<double, 1> start;

    Swing() {
        using Vector = Eigen::Matrix<double, 1, 1>;
        system.add_particle(Vector(10), 1);
        system.add_particle(Vector(0), 1);
        system.pin(1);
        system.add_spring(0, 1, omega * omega, 2 * zeta * omega);
        start = system.initial_state();
        start.x(0, 0) += 1;
    }
    static double displacement(double t) {
        const double w = omega * std::sqrt(1 - zeta * zeta);
        return std::exp(-zeta * omega * t) * (std::cos(w * t) + zeta * omega / w * std::sin(w * t));
    }
};

double order_of(double coarse, double fine) { return std::log2(coarse / fine); }

}  // namespace

TEST_CASE("extrapolation: order 12 on a damped swing", "[tradeoff]") {
    const Swing swing;
    taut::GraggExtrapolation<decltype(swing.system)> stepper(swing.system);
    const auto error = [&](Index count) {
        auto state = swing.start;
        REQUIRE(stepper.step(state, 4.0 / static_cast<double>(count), count));
        CHECK_THAT(state.time, WithinRel(4.0, 1e-12));
        return std::abs(state.x(0, 0) - 10 - Swing::displacement(4));
    };
    const double coarse = error(5);
    const double fine = error(10);
    CHECK(coarse > 1e-10);
    CHECK(order_of(coarse, fine) > 10);
    CHECK(error(40) < 1e-12);
}

TEST_CASE("measure_tradeoff: errors are those against the closed form", "[tradeoff]") {
    const Swing swing;
    std::vector<Candidate> candidates;
    for (const Method method : {Method::symplectic_euler, Method::velocity_verlet,
                                Method::implicit_euler, Method::bdf2}) {
        candidates.push_back({method, 0.01});
        candidates.push_back({method, 0.005});
    }
    taut::TradeoffOptions options;
    options.samples = 40;
    const auto result = taut::measure_tradeoff(swing.system, swing.start, 4, candidates, options);
    REQUIRE(result.points.size() == candidates.size());
    CHECK(result.reference_settled);
    double best = 1;
    for (std::size_t p = 0; p < candidates.size(); ++p) {
        const auto& point = result.points[p];
        INFO(point.name << ", h = " << point.candidate.h);
        CHECK(point.finished);
        CHECK_THAT(point.candidate.h, WithinRel(candidates[p].h, 1e-9));
        best = std::min(best, point.position_error);
        // The same by hand: the run sampled every 0.1 s.
        double squares = 0;
        double furthest = 0;
        taut::with_stepper(swing.system, candidates[p], [&](auto& stepper) {
            auto state = swing.start;
            for (int sample = 1; sample <= 40; ++sample) {
                REQUIRE(stepper.step(state, candidates[p].h,
                                     static_cast<Index>(std::llround(0.1 / candidates[p].h))));
                const double exact = Swing::displacement(0.1 * sample);
                squares += std::pow(state.x(0, 0) - 10 - exact, 2);
                furthest = std::max(furthest, std::abs(exact - 1));
            }
        });
        const double expected = std::sqrt(squares / (41 * 2)) / furthest;
        CHECK_THAT(point.position_error, WithinRel(expected, 1e-3));
    }
    CHECK(10 * result.reference_error <= best);
    // Half the step: half the error at order 1, a quarter at order 2. Damping makes Verlet order 1.
    const auto order = [&](std::size_t p) {
        return order_of(result.points[p].position_error, result.points[p + 1].position_error);
    };
    CHECK_THAT(order(0), WithinAbs(1, 0.15));
    CHECK_THAT(order(2), WithinAbs(1, 0.15));
    CHECK_THAT(order(4), WithinAbs(1, 0.15));
    CHECK_THAT(order(6), WithinAbs(2, 0.15));
}

TEST_CASE("measure_tradeoff: implicit Euler loses energy, symplectic Euler keeps it",
          "[tradeoff]") {
    const Cloth scene = cloth();
    const double h = 0.25 * taut::any_pose_limit(scene).certified;
    const auto result = taut::measure_tradeoff(scene, scene.initial_state(), 0.3,
                                               {{Method::symplectic_euler, h},
                                                {Method::velocity_verlet, h},
                                                {Method::implicit_euler, 0.01}});
    CHECK(std::abs(result.points[0].energy_drift) < 0.01);
    CHECK(std::abs(result.points[1].energy_drift) < 0.001);
    CHECK(result.points[2].energy_drift < -0.05);
    CHECK(result.points[1].position_error < 0.1 * result.points[0].position_error);
}

TEST_CASE("measure_tradeoff: the modes' errors are those predicted", "[tradeoff]") {
    taut::ChainOptions chain;
    chain.masses = 5;
    chain.stiffness = 100;
    const auto system = taut::chain<double, 1>(chain);
    auto start = system.initial_state();
    start.v(0, 1) = 0.1;
    taut::TradeoffOptions options;
    options.modes = 2;
    const std::vector<Candidate> candidates = {
        {Method::symplectic_euler, 0.05}, {Method::implicit_euler, 0.05}, {Method::bdf2, 0.05}};
    const auto result = taut::measure_tradeoff(system, start, 1, candidates, options);
    REQUIRE(result.modes.size() == 2);
    for (const auto& point : result.points) {
        REQUIRE(point.modes.size() == 2);
        for (std::size_t j = 0; j < 2; ++j) {
            REQUIRE(point.modes[j]);
            const auto predicted =
                taut::mode_error(point.candidate.method, point.candidate.h * result.modes[j].omega);
            CHECK_THAT(
                point.modes[j]->artificial_damping,
                WithinAbs(predicted.artificial_damping, 0.1 * predicted.artificial_damping + 1e-9));
            CHECK_THAT(point.modes[j]->period_error, WithinRel(predicted.period_error, 0.1));
        }
    }
}

TEST_CASE("measure_tradeoff: a run that breaks off has no error but infinity", "[tradeoff]") {
    const Cloth scene = cloth();
    taut::TradeoffMeter<Cloth> meter(scene, scene.initial_state(), 0.1);
    meter.add("gives up", 0.01,
              [calls = 0](Cloth::State&, double, Index) mutable { return ++calls < 3; });
    // Above the interval of the samples, 1/600 s: whole intervals a step.
    meter.add(Candidate{Method::implicit_euler, 0.0101});
    // One step is all there is time for.
    meter.add(Candidate{Method::implicit_euler, 7});
    // Far above its limit.
    meter.add(Candidate{Method::symplectic_euler, 0.01});
    const auto result = meter.finish();
    CHECK_FALSE(result.points[0].finished);
    CHECK(std::isinf(result.points[0].position_error));
    CHECK(std::isinf(result.points[0].energy_drift));
    CHECK(result.points[1].finished);
    CHECK_THAT(result.points[1].candidate.h, WithinRel(0.01, 1e-9));
    CHECK(result.points[1].steps == 10);
    CHECK(result.points[1].position_error < 1);
    CHECK_THAT(result.points[2].candidate.h, WithinRel(0.1, 1e-9));
    CHECK(result.points[2].steps == 1);
    CHECK(!(result.points[3].position_error < 10));
    const auto front = taut::pareto(result.points);
    for (const auto& point : front) CHECK(point.name != "gives up");
}

TEST_CASE("pareto: exactly the points that none beats", "[tradeoff]") {
    Random random(921);
    for (int repeat = 0; repeat < 50; ++repeat) {
        std::vector<taut::TradeoffPoint> points(12);
        for (auto& point : points) {
            point.finished = random.below(6) > 0;
            point.cost = static_cast<double>(1 + random.below(8));
            point.position_error = static_cast<double>(1 + random.below(8));
        }
        const auto front = taut::pareto(points);
        for (std::size_t j = 1; j < front.size(); ++j) {
            CHECK(front[j - 1].cost < front[j].cost);
            CHECK(front[j - 1].position_error > front[j].position_error);
        }
        for (const auto& point : points) {
            if (!point.finished) continue;
            const bool reached = std::any_of(front.begin(), front.end(), [&](const auto& best) {
                return best.cost <= point.cost && best.position_error <= point.position_error;
            });
            CHECK(reached);
        }
        for (const auto& best : front) {
            CHECK(best.finished);
            const bool beaten = std::any_of(points.begin(), points.end(), [&](const auto& point) {
                return point.finished && point.cost <= best.cost &&
                       point.position_error <= best.position_error &&
                       (point.cost < best.cost || point.position_error < best.position_error);
            });
            CHECK_FALSE(beaten);
        }
    }
}

TEST_CASE("measure_tradeoff: wrong input is named", "[tradeoff]") {
    const Cloth scene = cloth();
    const auto start = scene.initial_state();
    CHECK(missing(message_of([&] { (void)taut::measure_tradeoff(scene, start, -1, {}); }),
                  {"duration is -1"}) == "");
    CHECK(missing(message_of([&] {
                      (void)taut::measure_tradeoff(scene, start, 1, {{Method::bdf2, 0}});
                  }),
                  {"Candidate::h is 0"}) == "");
    taut::TradeoffOptions options;
    options.samples = 0;
    CHECK(missing(message_of([&] { (void)taut::measure_tradeoff(scene, start, 1, {}, options); }),
                  {"samples is 0", ">= 1"}) == "");
}

}  // namespace taut_test::measure_test
