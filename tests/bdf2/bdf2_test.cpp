// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <Eigen/SparseLU>
#include <cmath>
#include <limits>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/model/spring_system.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/solver/conjugate_gradient.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <vector>

#include "../support/catch.hpp"
#include "../support/check_stepper.hpp"
#include "../support/decompositions.hpp"
#include "../support/direct_euler.hpp"
#include "../support/stiff_chain.hpp"
#include "direct_bdf2.hpp"

namespace taut_test::bdf2_test {

using taut::Bdf2;
using taut::GeneralLinearSystem;
using taut::LinearSystem;

namespace {

using Sparse = taut::SparseMatrix<double>;
using LinearState = taut::State<double, 1>;

constexpr Index size = 6;

Eigen::MatrixXd draw_matrix(Random& random) { return random.points<double, size>(size, -1, 1); }

Eigen::MatrixXd semidefinite(Random& random, int rank) {
    const Eigen::MatrixXd A = draw_matrix(random).leftCols(rank);
    return A * A.transpose();
}

LinearState draw_state(Random& random) {
    return {random.points<double, 1>(size, -1, 1), random.points<double, 1>(size, -1, 1)};
}

/// (u, v) of a state as one vector.
Eigen::VectorXd joined(const LinearState& u) {
    Eigen::VectorXd w(2 * size);
    w << flat(u.x), flat(u.v);
    return w;
}

/// Largest distance of the positions at three refinements, as the order they show.
template <class System>
double observed_order(const System& system, const typename System::State& start, double duration,
                      int steps, const std::vector<double>& pattern) {
    const auto end = [&](int count) {
        auto state = start;
        DirectBdf2 stepper(system);
        double sum = 0;
        for (const double part : pattern) sum += part;
        const double h = duration * static_cast<double>(pattern.size()) / (sum * count);
        for (int i = 0; i < count; ++i) {
            REQUIRE(stepper.step(state, h * pattern[static_cast<std::size_t>(i) % pattern.size()]));
        }
        return state;
    };
    const auto coarse = end(steps);
    const auto middle = end(2 * steps);
    const auto fine = end(4 * steps);
    return std::log2((coarse.x - middle.x).norm() / (middle.x - fine.x).norm());
}

}  // namespace

TEST_CASE("bdf2: the first step is implicit Euler's, to rounding", "[integrator]") {
    Random random(1);
    RandomOptions options;
    options.rayleigh = true;
    options.dampers = true;
    const auto system = random_system<double, 3>(random, options);
    auto state = random_state(random, system);
    auto euler = state;
    DirectBdf2 stepper(system);
    DirectEuler reference(system);
    REQUIRE(stepper.step(state, 0.0625));
    REQUIRE(reference.step(euler, 0.0625));
    CHECK(distance(state.x, euler.x) <= Tolerance<double>::accumulated);
    CHECK(distance(state.v, euler.v) <= Tolerance<double>::accumulated * largest(euler.v));
}

TEMPLATE_TEST_CASE("bdf2: a step satisfies its own update equation, at equal and unequal steps",
                   "[integrator]", (taut::SpringSystem<double, 1>),
                   (taut::SpringSystem<double, 3, taut::Hookean, Glue>)) {
    for (const double ratio : {1.0, 0.25, 2.0}) {
        Random random(2);
        RandomOptions options;
        options.rayleigh = true;
        options.dampers = true;
        const auto system = random_like<TestType>(random, options);
        const auto before = random_state(random, system);
        auto state = before;
        DirectBdf2 stepper(system);
        REQUIRE(stepper.step(state, 0.0625));
        const auto now = state;
        const double h = ratio * 0.0625;
        const taut::Report report = stepper.step(state, h);
        REQUIRE(report);
        CHECK(report.residual < Tolerance<double>::accumulated);

        // Differentiating the parabola through three times gives these weights.
        const double next = (1 + 2 * ratio) / (1 + ratio);
        const double past = ratio * ratio / (1 + ratio);
        const auto rate = [&](const auto& of) {
            return Eigen::VectorXd(
                (next * flat(of(state)) - (1 + ratio) * flat(of(now)) + past * flat(of(before))) /
                h);
        };
        const auto dense = dense_matrices(system, now);
        const auto free = free_dofs(system);
        const Eigen::VectorXd force = flat_force(system, now) -
                                      dense.K_plus * (flat(state.x) - flat(now.x)) -
                                      dense.D * (flat(state.v) - flat(now.v));
        const Eigen::VectorXd inertia = dense.M * rate([](const auto& s) { return s.v; });
        CHECK(distance(inertia(free), force(free)) <=
              Tolerance<double>::accumulated * largest(inertia));
        CHECK(distance(rate([](const auto& s) { return s.x; }), flat(state.v)) <=
              Tolerance<double>::accumulated * largest(state.v));
    }
}

TEST_CASE("bdf2: order 2 while no spring is compressed, at equal and unequal steps",
          "[integrator]") {
    const auto system = smooth_scene<double, 3>();
    const auto start = system.initial_state();
    auto state = start;
    DirectBdf2 stepper(system);
    for (int i = 0; i < 50; ++i) {
        REQUIRE(stepper.step(state, 0.004));
        system.for_each_tangent(state.x, [](const auto& spring) { CHECK(spring.transverse > 0); });
    }
    using Stepper = Bdf2<taut::SpringSystem<double, 3>>;
    CHECK_THAT(observed_order(system, start, 0.2, 200, {1}), WithinAbs(Stepper::order, 0.05));
    CHECK_THAT(observed_order(system, start, 0.2, 200, {1, 0.5, 0.9, 0.8}),
               WithinAbs(Stepper::order, 0.05));
}

TEST_CASE("bdf2: a compressed spring's transverse part lags: order 1", "[integrator]") {
    Random random(3);
    const auto system = random_system<double, 2>(random);
    const auto start = random_state(random, system);
    const double order = observed_order(system, start, 0.05, 400, {1});
    CHECK(order > 0.9);
    CHECK(order < 1.5);
}

TEST_CASE("bdf2: a step more than twice its predecessor starts anew, one of twice does not",
          "[integrator]") {
    Random random(4);
    const auto system = random_system<double, 2>(random);
    const auto start = random_state(random, system);
    for (const double h : {0.002, 0.0021}) {
        auto used = start;
        DirectBdf2 stepper(system);
        REQUIRE(stepper.step(used, 0.001, 3));
        auto fresh = used;
        DirectBdf2 other(system);
        REQUIRE(stepper.step(used, h));
        REQUIRE(other.step(fresh, h));
        CHECK(same_bits(used, fresh) == (h > 0.002));
    }
}

TEST_CASE("bdf2: a failed call leaves the state, and the next one starts anew", "[integrator]") {
    const auto system = taut::chain<double, 2>({5, taut::ChainEnds::fixed_fixed, 1, 100});
    Random random(5);
    auto state = random_state(random, system);
    DirectBdf2 stepper(system);
    REQUIRE(stepper.step(state, 0.01, 3));
    const auto before = state;
    CHECK(stepper.step(state, std::numeric_limits<double>::quiet_NaN()).status ==
          taut::Status::invalid_step);
    CHECK(same_bits(state, before));
    auto expected = before;
    DirectBdf2 fresh(system);
    REQUIRE(fresh.step(expected, 0.01));
    REQUIRE(stepper.step(state, 0.01));
    CHECK(same_bits(state, expected));
}

TEST_CASE("bdf2: the energy norm of two successive states never rises, at any step",
          "[integrator]") {
    // G-stability (G. Dahlquist 1978): for ẇ = Cw with no energy gain, BDF2 cannot gain in this
    // norm of two successive w. Semi-definite K and D: zero modes and undamped ones are among them.
    for (std::uint32_t seed = 1; seed <= 8; ++seed) {
        Random random(seed);
        const Eigen::VectorXd mass = random.vector<double, size>(0.5, 2);
        const Eigen::MatrixXd K = semidefinite(random, 4) * (seed % 2 == 0 ? 1.0 : 1e4);
        const Eigen::MatrixXd D = semidefinite(random, static_cast<int>(seed % 4));
        const LinearSystem<double> system(mass, D.sparseView(), K.sparseView());
        for (const double h : {1e-3, 0.1, 1.0, 1e3}) {
            INFO("seed " << seed << ", h " << h);
            auto u = draw_state(random);
            DirectBdf2 stepper(system);
            const auto squared = [&](const Eigen::VectorXd& w) {
                const auto v = w.tail(size);
                return w.head(size).dot(K * w.head(size)) + v.dot(mass.cwiseProduct(v));
            };
            Eigen::VectorXd past = joined(u);
            REQUIRE(stepper.step(u, h));
            Eigen::VectorXd now = joined(u);
            double norm = squared(now) + squared(2 * now - past);
            const double start = norm;
            for (int i = 0; i < 100; ++i) {
                REQUIRE(stepper.step(u, h));
                past = now;
                now = joined(u);
                const double next = squared(now) + squared(2 * now - past);
                // A zero mode drifts far: its rounding meets the stiffest spring.
                const double scale = start + now.head(size).squaredNorm() * largest(K);
                REQUIRE(next <= norm + scale * Tolerance<double>::rounding);
                norm = next;
            }
        }
    }
}

TEST_CASE("bdf2: the artificial damping ratio of a mode is (h omega)^3/4", "[integrator]") {
    const auto oscillator = taut::chain<double, 1>({1, taut::ChainEnds::fixed_free, 1, 4});
    for (const double z : {0.05, 0.1}) {  // hω, ω = 2/s
        auto state = oscillator.initial_state();
        state.x(0, 0) += 0.0625;
        DirectBdf2 stepper(oscillator);
        const auto swing = [&] { return std::hypot(state.x(0, 0), state.v(0, 0) / 2); };
        REQUIRE(stepper.step(state, z / 2, 10));  // past the first step
        const double before = swing();
        const int steps = static_cast<int>(2 / (z * z * z));
        REQUIRE(stepper.step(state, z / 2, steps));
        const double ratio = std::log(before / swing()) / (steps * z);
        CHECK_THAT(ratio, WithinRel(z * z * z / 4, 0.05));
    }
}

TEST_CASE("bdf2: an unsymmetric system is stepped by SparseLU, as a dense solve does",
          "[integrator]") {
    Random random(6);
    Eigen::MatrixXd K = semidefinite(random, size);
    K(0, 5) += 2;
    const Eigen::MatrixXd D = draw_matrix(random);
    const Eigen::VectorXd mass = random.vector<double, size>(0.5, 2);
    const Eigen::VectorXd load = random.vector<double, size>(-1, 1);
    const GeneralLinearSystem<double> system(mass, D.sparseView(), K.sparseView(), load);
    Bdf2<GeneralLinearSystem<double>, Eigen::SparseLU<Sparse>> stepper(system);
    auto u = draw_state(random);
    const auto before = u;
    const double h = 0.125;
    REQUIRE(stepper.step(u, h));
    const auto now = u;
    REQUIRE(stepper.step(u, h));
    const Eigen::MatrixXd M = mass.asDiagonal();
    const double t = 2 * h / 3;
    const Eigen::VectorXd x = (4 * flat(now.x) - flat(before.x)) / 3;
    const Eigen::VectorXd b = M * (4 * flat(now.v) - flat(before.v)) / 3 + t * (load - K * x);
    const Eigen::VectorXd v = dense_solve(M + t * D + t * t * K, b);
    CHECK(distance(flat(u.v), v) <= Tolerance<double>::accumulated);
    CHECK(distance(flat(u.x), x + t * v) <= Tolerance<double>::accumulated);
}

TEST_CASE("bdf2: conjugate gradients take the direct solver's steps, and their cap is reported",
          "[integrator]") {
    Random random(12);
    const auto system = random_system<double, 3>(random);
    using System = std::decay_t<decltype(system)>;
    auto by_factors = random_state(random, system);
    auto by_gradients = by_factors;
    DirectBdf2 direct(system);
    using Solver = taut::ConjugateGradient<double, 3>;
    Bdf2<System, Solver> iterative(system);
    iterative.configure([](auto& solver) { solver.setTolerance(1e-12); });
    REQUIRE(direct.step(by_factors, 0.02, 5));
    REQUIRE(iterative.step(by_gradients, 0.02, 5));
    CHECK(distance(by_factors.v, by_gradients.v) <= 1e-9 * largest(by_factors.v));

    const auto chain = stiff_chain();
    using Chain = std::decay_t<decltype(chain)>;
    Bdf2<Chain, taut::ConjugateGradient<double, 1>> capped(chain);
    capped.configure([](auto& solver) { solver.setTolerance(1e-13); });
    auto state = chain.initial_state();
    const auto before = state;
    CHECK(capped.step(state, 1.0).status == taut::Status::not_converged);
    CHECK(same_bits(state, before));
}

TEST_CASE("bdf2: more of a swing's energy survives than with implicit Euler at the same step",
          "[integrator]") {
    // A chain of eight links swings for two seconds. Up to this stiffness: beyond, what the one
    // linearised solve leaves out of a turning link costs both methods nearly everything.
    for (const double stiffness : {10.0, 100.0, 1e3, 1e4}) {
        taut::SpringSystem<double, 2> chain;
        const double angle = 0.5;
        for (int i = 0; i < 9; ++i) {
            chain.add_particle({0.1 * i * std::sin(angle), -0.1 * i * std::cos(angle)}, 0.01);
            if (i > 0) chain.add_spring(i - 1, i, stiffness);
        }
        chain.pin(0);
        chain.set_gravity({0, -9.81});
        const auto lost = [&](auto stepper) {
            auto state = chain.initial_state();
            const double start = chain.energy(state);
            REQUIRE(stepper.step(state, 1.0 / 60, 120));
            return start - chain.energy(state);
        };
        const double by_euler = lost(taut::ImplicitEuler(chain));
        const double by_bdf2 = lost(Bdf2(chain));
        INFO("stiffness " << stiffness << ": lost " << by_euler << " J and " << by_bdf2 << " J");
        CHECK(by_bdf2 < 0.8 * by_euler);
    }
}

}  // namespace taut_test::bdf2_test
