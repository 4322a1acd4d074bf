// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <numeric>
#include <taut/lattice/chain.hpp>
#include <taut/tradeoff/tradeoff.hpp>

#include "../support/catch.hpp"
#include "../support/compiled_once.hpp"
#include "../support/message.hpp"
#include "../support/random.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::measure_test {

using taut::Candidate;
using taut::Method;

namespace {

using Row = taut::SpringSystem<double, 1>;

/// Masses between two walls, at the mercy of gravity.
Row row() {
    taut::ChainOptions options;
    options.masses = 8;
    options.mass = 0.01;
    options.stiffness = 1000;
    auto system = taut::chain<double, 1>(options);
    system.set_gravity(Row::Vector(-9.81));
    return system;
}

/// One mass in a well, let go 1 m from rest: x(t) has a closed form.
template <class Scalar = double, int Dim = 1>
struct Swing {
    static constexpr double omega = 3;

    double zeta;
    taut::SpringSystem<Scalar, Dim> system;
    taut::State<Scalar, Dim> start;

    explicit Swing(double damping = 0.1) : zeta(damping) {
        using Vector = Eigen::Matrix<Scalar, Dim, 1>;
        system.add_particle(10 * Vector::UnitX(), 1);
        system.add_particle(Vector::Zero(), 1);
        system.pin(1);
        system.add_spring(0, 1, Scalar(omega * omega), static_cast<Scalar>(2 * zeta * omega));
        start = system.initial_state();
        start.x(0, 0) += 1;
    }
    double displacement(double t) const {
        const double w = omega * std::sqrt(1 - zeta * zeta);
        return std::exp(-zeta * omega * t) * (std::cos(w * t) + zeta * omega / w * std::sin(w * t));
    }
};

/// A trajectory that no scene has made: energies as given, one particle that moves evenly.
template <class Scalar>
taut::Trajectory<Scalar, 3> made_by_hand(Random& random, std::size_t samples, Index stride) {
    taut::Trajectory<Scalar, 3> path;
    path.stride = stride;
    for (std::size_t j = 0; j < samples; ++j) {
        path.x.push_back(taut::Points<Scalar, 3>::Constant(3, 1, static_cast<Scalar>(j)));
        path.energy.push_back(random.uniform(-3, 3));
        path.kinetic.push_back(random.uniform(0.1, 2));
    }
    return path;
}

double order_of(double coarse, double fine) { return std::log2(coarse / fine); }

}  // namespace

TEST_CASE("extrapolation: order 12 on a damped swing", "[tradeoff]") {
    const Swing<> swing;
    taut::GraggExtrapolation<decltype(swing.system)> stepper(swing.system);
    const auto error = [&](Index count) {
        auto state = swing.start;
        REQUIRE(stepper.step(state, 4.0 / static_cast<double>(count), count));
        CHECK_THAT(state.time, WithinRel(4.0, 1e-12));
        return std::abs(state.x(0, 0) - 10 - swing.displacement(4));
    };
    const double coarse = error(5);
    const double fine = error(10);
    CHECK(coarse > 1e-10);
    CHECK(order_of(coarse, fine) > 10);
    CHECK(error(40) < 1e-12);
}

TEST_CASE("measure_tradeoff: errors are those against the closed form", "[tradeoff]") {
    const Swing<> swing;
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
                const double exact = swing.displacement(0.1 * sample);
                squares += std::pow(state.x(0, 0) - 10 - exact, 2);
                furthest = std::max(furthest, std::abs(exact - 1));
            }
        });
        const double expected = std::sqrt(squares / (41 * 2)) / furthest;
        CHECK_THAT(point.position_error, WithinRel(expected, 1e-3));
    }
    CHECK(10 * result.reference_error <= best);
    // One refinement is enough; a gain of four times what it reached takes another.
    options.samples = 2;
    const auto one = taut::measure_tradeoff(swing.system, swing.start, 4, {candidates[2]}, options);
    CHECK(one.reference_settled);
    options.gain = 4 * one.points[0].position_error / one.reference_error;
    const auto two = taut::measure_tradeoff(swing.system, swing.start, 4, {candidates[2]}, options);
    CHECK(two.reference_settled);
    CHECK(two.reference_error < 0.25 * one.reference_error);
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
    const Row scene = row();
    const double h = 0.1 * taut::any_pose_limit(scene).certified;
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
            const auto predicted = taut::mode_error(point.candidate.method,
                                                    point.candidate.h * result.modes[j].omega());
            CHECK_THAT(
                point.modes[j]->artificial_damping,
                WithinAbs(predicted.artificial_damping, 0.1 * predicted.artificial_damping + 1e-9));
            CHECK_THAT(point.modes[j]->period_error, WithinRel(predicted.period_error, 0.1));
        }
    }
}

TEST_CASE("measure_tradeoff: a run that breaks off has no error but infinity", "[tradeoff]") {
    const Row scene = row();
    taut::TradeoffMeter<Row> meter(scene, scene.initial_state(), 0.1);
    meter.add("gives up", 0.01,
              [calls = 0](Row::State&, double, Index) mutable { return ++calls < 3; });
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

TEMPLATE_TEST_CASE("measure_tradeoff: the drift of runs that are made by hand", "[tradeoff]",
                   (Case<float, 3>), (Case<double, 1>)) {
    using Scalar = typename TestType::Scalar;
    Random random(1131);
    for (int repeat = 0; repeat < 40; ++repeat) {
        const Index stride = 1 + random.below(5);
        const auto samples = static_cast<std::size_t>(1 + random.below(40));
        const auto run = made_by_hand<Scalar>(random, samples, stride);
        // Samples past the last whole stride are no part of the comparison.
        const auto length = (samples - 1) * static_cast<std::size_t>(stride) + 1 +
                            static_cast<std::size_t>(random.below(stride));
        const auto reference = made_by_hand<Scalar>(random, length, 1);
        double gained = 0, last = 0;
        // Of 4k … 4k + 3 samples the last k, and never none.
        for (std::size_t at = samples - std::max<std::size_t>(1, samples / 4); at < samples; ++at) {
            gained += run.energy[at] - reference.energy[at * static_cast<std::size_t>(stride)];
            ++last;
        }
        const double liveliest =
            *std::max_element(reference.kinetic.begin(), reference.kinetic.end());
        INFO("repeat " << repeat << ": " << samples << " samples, stride " << stride);
        CHECK_THAT(taut::energy_drift(run, reference), WithinRel(gained / last / liveliest, 1e-12));
    }
    // One that broke off has no drift but infinity.
    const auto reference = made_by_hand<Scalar>(random, 13, 1);
    for (const std::size_t samples : {1, 4, 5, 6}) {
        const auto run = made_by_hand<Scalar>(random, samples, 3);
        CHECK(std::isinf(taut::energy_drift(run, reference)) == (samples != 5));
        CHECK(std::isinf(taut::position_error(run, reference)) == (samples != 5));
    }

    // By the meter: undamped, the mass owns ω²/2 for ever, and moves with ½ω² sin² ωt.
    const Swing<Scalar, TestType::Dim> swing(0);
    constexpr double omega = swing.omega;
    for (const Index stride : {1, 3}) {
        taut::TradeoffOptions options;
        options.samples = 24;
        const double interval = 4.0 / 24;
        taut::TradeoffMeter<decltype(swing.system)> meter(swing.system, swing.start, 4, options);
        std::vector<double> gains;
        meter.add(
            "by hand", static_cast<double>(stride) * interval, [&](auto& state, double, Index) {
                gains.push_back(random.uniform(0, 2));
                state.x(0, 0) = 10;
                state.v(0, 0) = static_cast<Scalar>(std::sqrt(omega * omega + 2 * gains.back()));
                return true;
            });
        const auto result = meter.finish();
        const std::size_t last = (gains.size() + 1) / 4;
        const double gained =
            std::accumulate(gains.end() - static_cast<Index>(last), gains.end(), 0.0);
        double liveliest = 0;
        for (int j = 0; j <= 24; ++j)
            liveliest =
                std::max(liveliest, std::pow(omega * std::sin(omega * interval * j), 2) / 2);
        CHECK(result.points[0].finished);
        CHECK_THAT(result.points[0].energy_drift,
                   WithinRel(gained / static_cast<double>(last) / liveliest,
                             Tolerance<Scalar>::accumulated));
    }
}

TEST_CASE("measure_tradeoff: wrong input is named", "[tradeoff]") {
    const Row scene = row();
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
