// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <functional>

#include "../support/catch.hpp"
#include "../support/random.hpp"
#include "guard_scenes.hpp"

// What a guarded scene does depends little on how often it is drawn. Frames are divided into equal
// steps, whose length therefore differs a little, and what is chaotic parts from itself: without
// damping, cloth thrown at 10 m/s ends a tenth of its size elsewhere. So these are damped.

namespace taut_test::guarded_rates_test {

namespace {

/// A cloth of 12 × 12 that hangs by two corners, damped as cloth is.
Scene damped_cloth(const Kind& kind, LawOf law) {
    taut::ClothOptions options;
    options.rows = options.columns = 12;
    Scene cloth = cloth_scene(kind, options, law);
    cloth.set_rayleigh(0.5, 1e-3);
    return cloth;
}

/// Thrown at 1 to 4 m/s in a random direction.
AnyState thrown(const Scene& cloth, Random& random) {
    AnyState state = cloth.initial_state();
    const Eigen::Vector3d direction = random.vector<double, 3>(-1, 1).normalized();
    const double speed = random.uniform(1, 4);
    for (Index i = 0; i < cloth.size(); ++i) {
        for (int d = 0; d < 3; ++d)
            state.v(d, i) = cloth.is_pinned(i) ? 0 : cloth.rounded(speed * direction[d]);
    }
    return state;
}

/// A second of frames, each as long as `next` says, the last cut to what is left.
AnyState second_of(const Scene& cloth, AnyState state, const std::function<double()>& next) {
    const auto guard = guarded(cloth);
    double time = 0;
    while (time < 1 - 1e-6) {
        const auto report = guard->advance(state, std::min(next(), 1 - time));
        REQUIRE(report);
        time += report.advanced;
    }
    CHECK(std::abs(time - 1) < 1e-5);
    return state;
}

}  // namespace

TEST_CASE(
    "guarded_rates: a damped cloth ends where it does at any frame rate, and at uneven frames",
    "[guard]") {
    for (const bool single : {false, true}) {
        const Scene cloth = single ? damped_cloth({true, 3, Laws::strings}, LawOf::tension_only)
                                   : damped_cloth(any3, LawOf::hookean);
        const double size = std::sqrt(2.0);  // m, of its diagonal
        for (std::uint32_t seed = 1; seed <= 6; ++seed) {
            Random random(seed);
            const AnyState start = thrown(cloth, random);
            const AnyState even = second_of(cloth, start, [] { return 1.0 / 60; });
            const double moved = (even.x - start.x).colwise().norm().maxCoeff();
            CAPTURE(single, seed);
            CHECK(moved > 0.3 * size);
            const auto off = [&](const std::function<double()>& next) {
                const AnyState other = second_of(cloth, start, next);
                return (other.x - even.x).colwise().norm().maxCoeff() / size;
            };
            const double slow = off([] { return 1.0 / 30; });
            const double fast = off([] { return 1.0 / 144; });
            const double uneven = off([&] { return random.uniform(0.002, 0.04); });
            CAPTURE(slow, fast, uneven);
            CHECK(std::max({slow, fast, uneven}) < (single ? 0.08 : 0.015));
        }
    }
}

}  // namespace taut_test::guarded_rates_test
