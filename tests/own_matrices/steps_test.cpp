// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/bdf2/bdf2.hpp>
#include <taut/integrator/implicit_euler.hpp>

#include "../support/catch.hpp"
#include "../support/compiled_once.hpp"
#include "../support/proof_scenes.hpp"

namespace taut_test::own_matrices {

namespace {

using System = taut::LinearSystem<double>;

System draw_system(Random& random, Index n) {
    const auto positive = [&]() -> taut::SparseMatrix<double> {
        const Eigen::VectorXd spectrum = random_vector(random, n).array() + 2;
        return with_spectrum(random, spectrum).sparseView();
    };
    return {random_vector(random, n).array() + 2, positive(), positive(), random_vector(random, n)};
}

}  // namespace

TEST_CASE("steps: implicit Euler and BDF2 solve their equations, with the matrices of now",
          "[own_matrices]") {
    Random random(31);
    constexpr Index n = 6;
    constexpr double h = 0.5;
    System system = draw_system(random, n);
    taut::ImplicitEuler<System> euler(system);
    taut::Bdf2<System> bdf2(system);
    for (int repeat = 0; repeat < 3; ++repeat) {
        INFO("repeat " << repeat);
        if (repeat > 0) system = draw_system(random, n);
        // M a·v + h (D v + K x) = h f, with a·x = h v; a·x = Σ a_j x_j of the last steps.
        const auto check = [&](const Eigen::VectorXd& ax, const Eigen::VectorXd& av,
                               const System::State& now) {
            const Eigen::VectorXd x = now.x.transpose(), v = now.v.transpose();
            CHECK((ax - h * v).norm() < 1e-13);
            CHECK((system.mass().cwiseProduct(av) +
                   h * (system.damping() * v + system.stiffness() * x - system.load()))
                      .norm() < 1e-12);
        };
        auto state = system.initial_state();
        state.x = random_vector(random, n).transpose();
        state.v = random_vector(random, n).transpose();
        auto first = state;
        REQUIRE(euler.step(first, h));
        check((first.x - state.x).transpose(), (first.v - state.v).transpose(), first);
        auto second = state;
        REQUIRE(bdf2.step(second, h));
        CHECK((second.x - first.x).norm() < 1e-13);
        first = second;
        REQUIRE(bdf2.step(second, h));
        check((1.5 * second.x - 2 * first.x + 0.5 * state.x).transpose(),
              (1.5 * second.v - 2 * first.v + 0.5 * state.v).transpose(), second);
    }
}

}  // namespace taut_test::own_matrices
