// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/tradeoff/tradeoff.hpp>

#include "../support/catch.hpp"
#include "../support/random.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::trajectory_test {

namespace {

/// A trajectory that no scene has made: energies as given, one particle that moves evenly.
template <class Scalar, int Dim>
taut::Trajectory<Scalar, Dim> made_by_hand(Random& random, std::size_t samples, Index stride) {
    taut::Trajectory<Scalar, Dim> path;
    path.stride = stride;
    for (std::size_t j = 0; j < samples; ++j) {
        path.x.push_back(taut::Points<Scalar, Dim>::Constant(Dim, 1, static_cast<Scalar>(j)));
        path.energy.push_back(random.uniform(-3, 3));
        path.kinetic.push_back(random.uniform(0.1, 2));
    }
    return path;
}

}  // namespace

TEMPLATE_TEST_CASE(
    "energy_drift: what the last quarter has over the reference, by its largest kinetic energy",
    "[tradeoff]", float, double) {
    Random random(1131);
    for (int repeat = 0; repeat < 40; ++repeat) {
        const Index stride = 1 + random.below(5);
        const auto samples = static_cast<std::size_t>(1 + random.below(40));
        const auto run = made_by_hand<TestType, 3>(random, samples, stride);
        // Samples past the last whole stride are no part of the comparison.
        const auto length = (samples - 1) * static_cast<std::size_t>(stride) + 1 +
                            static_cast<std::size_t>(random.below(stride));
        const auto reference = made_by_hand<TestType, 3>(random, length, 1);
        double gained = 0;
        double last = 0;
        double liveliest = 0;
        for (std::size_t j = 0; j < length; ++j) {
            liveliest = std::max(liveliest, reference.kinetic[j]);
            const auto at = j / static_cast<std::size_t>(stride);
            // Of 4k … 4k + 3 samples the last k, and never none.
            if (j % static_cast<std::size_t>(stride) != 0) continue;
            if (samples < 4 ? at + 1 != samples : at < samples - samples / 4) continue;
            gained += run.energy[at] - reference.energy[j];
            ++last;
        }
        INFO(samples << " samples, stride " << stride);
        CHECK_THAT(taut::energy_drift(run, reference), WithinRel(gained / last / liveliest, 1e-12));
    }
}

TEMPLATE_TEST_CASE("energy_drift: a run that broke off has no drift but infinity", "[tradeoff]",
                   float, double) {
    Random random(1132);
    const auto reference = made_by_hand<TestType, 2>(random, 13, 1);
    CHECK(std::isfinite(taut::energy_drift(made_by_hand<TestType, 2>(random, 5, 3), reference)));
    for (const std::size_t samples : {1, 4, 6}) {
        const auto run = made_by_hand<TestType, 2>(random, samples, 3);
        CHECK(std::isinf(taut::energy_drift(run, reference)));
        CHECK(std::isinf(taut::position_error(run, reference)));
    }
}

TEMPLATE_TEST_CASE("measure_tradeoff: the reported drift of a run that is made by hand",
                   "[tradeoff]", float, double) {
    // One mass of 1 kg on a spring of ω² N/m, let go 1 m from rest: it owns ω²/2 for ever, and
    // moves with ½ω² sin² ωt.
    constexpr double omega = 3;
    constexpr double duration = 4;
    using Vector = Eigen::Matrix<TestType, 1, 1>;
    taut::SpringSystem<TestType, 1> system;
    system.add_particle(Vector(TestType(2)), 1);
    system.add_particle(Vector(TestType(0)), 1);
    system.pin(1);
    system.add_spring(0, 1, TestType(omega * omega));
    auto start = system.initial_state();
    start.x(0, 0) += 1;
    Random random(1133);
    for (const Index stride : {1, 3}) {
        taut::TradeoffOptions options;
        options.samples = 24;
        const double interval = duration / static_cast<double>(options.samples);
        taut::TradeoffMeter<decltype(system)> meter(system, start, duration, options);
        std::vector<double> gains;
        meter.add("by hand", static_cast<double>(stride) * interval,
                  [&](taut::State<TestType, 1>& state, double, Index) {
                      gains.push_back(random.uniform(0, 2));
                      state.x(0, 0) = 2;
                      state.v(0, 0) =
                          static_cast<TestType>(std::sqrt(omega * omega + 2 * gains.back()));
                      return true;
                  });
        const auto result = meter.finish();
        double gained = 0;
        const std::size_t last = (gains.size() + 1) / 4;
        for (std::size_t j = gains.size() - last; j < gains.size(); ++j) gained += gains[j];
        double liveliest = 0;
        for (Index j = 0; j <= options.samples; ++j) {
            const double v = omega * std::sin(omega * interval * static_cast<double>(j));
            liveliest = std::max(liveliest, v * v / 2);
        }
        CHECK(result.points[0].finished);
        CHECK_THAT(result.points[0].energy_drift,
                   WithinRel(gained / static_cast<double>(last) / liveliest,
                             Tolerance<TestType>::accumulated));
    }
}

}  // namespace taut_test::trajectory_test
