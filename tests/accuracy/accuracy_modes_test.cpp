// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// Apart from accuracy_test.cpp, as each makes steppers of all methods.
#include <taut/own_matrices/own_matrices.hpp>

#include "../support/catch.hpp"
#include "../support/tolerance.hpp"
#include "chain_modes.hpp"

namespace taut_test::accuracy_modes_test {

using taut::LinearSolver;
using taut::Method;

TEMPLATE_TEST_CASE("accuracy: predicted against measured on every mode of a chain", "[accuracy]",
                   float, double) {
    using Scalar = TestType;
    const auto chain = chain_modes<Scalar>();
    const auto& modes = chain.modes;
    REQUIRE(modes.size() == 6);
    constexpr double blur = 2e4 * Tolerance<Scalar>::epsilon;
    for (const taut::Mode& mode : modes) {
        // A step at which a faster mode grows would drown this one.
        const auto stable = [&](Method method) {
            return 0.9 * taut::critical_step(method, modes.back().k, 1);
        };
        for (const double z : {0.05, 0.2, 0.5}) {
            // But explicit Euler: its undamped modes all grow.
            for (const Method method :
                 {Method::symplectic_euler, Method::velocity_verlet, Method::implicit_euler,
                  Method::bdf2, Method::energy_stable_euler}) {
                const double h = z / mode.omega();
                if (!is_implicit(method) && h > stable(method)) continue;
                INFO(name(method) << ", omega = " << mode.omega() << ", z = " << z);
                for (const auto solver : {LinearSolver::direct, LinearSolver::conjugate_gradient}) {
                    if (!is_implicit(method) && solver != LinearSolver::direct) continue;
                    const taut::Candidate candidate{method, h, solver, 1e-6};
                    const auto seen = taut::measured_mode_error(chain.linear, mode, candidate);
                    REQUIRE(seen);
                    const auto predicted = taut::mode_error(method, z, mode.zeta());
                    CHECK_THAT(seen->artificial_damping,
                               WithinAbs(predicted.artificial_damping,
                                         0.1 * std::abs(predicted.artificial_damping) + blur));
                    CHECK_THAT(seen->period_error,
                               WithinAbs(predicted.period_error,
                                         0.1 * std::abs(predicted.period_error) + blur));
                }
            }
        }
    }
}

}  // namespace taut_test::accuracy_modes_test
