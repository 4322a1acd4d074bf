// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// What Stability says of a method that has no Limit.
#include <taut/proof/stability.hpp>

#include "../support/catch.hpp"
#include "../support/compiled_once.hpp"
#include "../support/message.hpp"

namespace taut_test::stability_bdf2_test {

using taut::Method;

namespace {

/// Five particles on a line, the first one pinned.
taut::SpringSystem<double, 1> line() {
    taut::SpringSystem<double, 1> system;
    for (int i = 0; i < 5; ++i) system.add_particle(Eigen::Matrix<double, 1, 1>(i), 0.1 + 0.05 * i);
    for (int i = 0; i < 4; ++i) system.add_spring(i, i + 1, 100.0 * (i + 1));
    system.pin(0);
    system.set_rayleigh({0.3, 2e-3});
    return system;
}

}  // namespace

TEST_CASE("bdf2: no step is called safe or unsafe, but by name", "[proof]") {
    const auto system = line();
    const taut::Stability<double> stability(system, system.initial_state());
    const auto refused = [&](auto ask) { return missing(message_of(ask), {"bdf2", "proved"}); };
    constexpr Method bdf2 = Method::bdf2;
    CHECK(refused([&] { (void)stability.max_step(bdf2); }) == "");
    CHECK(refused([&] { (void)taut::max_step(stability, bdf2, 1e-3); }) == "");
    CHECK(refused([&] { (void)taut::certify(stability, bdf2, 1e-3); }) == "");
    CHECK(refused([&] { (void)stability.max_stiffness_scale(bdf2, 1e-3); }) == "");
    CHECK(refused([&] { (void)stability.min_mass_scale(bdf2, 1e-3); }) == "");
    CHECK(refused([&] { (void)stability.rayleigh_window(bdf2, 1e-3); }) == "");
}

TEST_CASE("bdf2: the radius of a system is that of its worst mode", "[proof]") {
    const auto system = line();
    const taut::Stability<double> stability(system, system.initial_state());
    const taut::DenseAnalysis<> dense(stability.pencil());
    for (const double h : {1e-4, 1e-2, 1.0, 100.0}) {
        double worst = 0;
        for (const double k : dense.stiffness_eigenvalues())
            worst = std::max(worst, taut::spectral_radius(Method::bdf2, k, 0.3 + 2e-3 * k, h));
        CHECK(worst < 1);
        CHECK_THAT(taut::spectral_radius(stability, Method::bdf2, h), WithinRel(worst, 1e-7));
    }
}

}  // namespace taut_test::stability_bdf2_test
