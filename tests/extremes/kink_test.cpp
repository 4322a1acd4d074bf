// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/proof/stability.hpp>
#include <taut/network/tension_only.hpp>

#include "../support/catch.hpp"
#include "../support/compiled_once.hpp"
#include "../support/random.hpp"

namespace taut_test::kink_test {

using taut::Method;

// No scene is of strings in float in one dimension: only there is a string undamped at its kink.
TEST_CASE("kink: undamped float strings are certified on both sides", "[extremes]") {
    for (std::uint32_t seed = 1670; seed < 1870; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        using Vector = Eigen::Matrix<float, 1, 1>;
        taut::SpringSystem<float, 1, taut::TensionOnly> system;
        system.add_particle(Vector(0.0f), 1);
        system.add_particle(Vector(1.0f), 1);
        system.pin(0);
        const auto k = static_cast<float>(log_uniform(random, 1, 1e4));
        const auto c = static_cast<float>(std::sqrt(k) * log_uniform(random, 0.1, 10));
        system.add_spring(taut::Spring<float, taut::TensionOnly>{0, 1, {k}, 1, c});
        auto state = system.initial_state();
        const float end = seed % 3 == 0 ? 0 : 2;
        for (Index ulps = random.below(4); ulps > 0; --ulps)
            state.x(0, 1) = std::nextafter(state.x(0, 1), end);

        // [T9], [T10]: taut or slack, whichever is less.
        const long double K = k, d = c, square = d * d - 4 * K;
        const long double taut_limit = square < 0 ? d / K : 4 / (d + std::sqrt(square));
        const long double euler = std::min(taut_limit, 2 / d);
        const long double symplectic = 4 / (d + std::sqrt(d * d + 4 * K));
        const taut::Stability<float> stability(system, state);
        for (const double tightness : {0.0, 1e-6}) {
            for (const Method method : {Method::explicit_euler, Method::symplectic_euler}) {
                const long double truth = method == Method::explicit_euler ? euler : symplectic;
                const auto limit = taut::max_step(stability, method, tightness);
                CAPTURE(name(method), tightness, limit.certified, limit.refuted);
                CHECK(static_cast<long double>(limit.certified) <= truth);
                CHECK(static_cast<long double>(limit.refuted) >= truth);
                // The bound alone cannot tell D − hK⁺ ⪰ 0 from its rounding.
                if (tightness > 0 || method == Method::symplectic_euler) CHECK(limit.certified > 0);
            }
        }
    }
}

}  // namespace taut_test::kink_test
