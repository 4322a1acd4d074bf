// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <taut/newton/newton.hpp>
#include <taut/projective/projective.hpp>
#include <taut/scene/cloth.hpp>

#include "../support/catch.hpp"
#include "../support/decompositions.hpp"
#include "../support/check_stepper.hpp"
#include "../support/dense.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"
#include "../support/returning_steps.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::projective_dynamics_test {

using taut::NewtonEuler;
using taut::ProjectiveDynamics;

namespace {

template <class Scalar, int Dim>
using AllLaws = taut::SpringSystem<Scalar, Dim, taut::Hookean, TensionOnly, Buckling, Glue>;

/// Everything at once: pins that move, gravity, dampers, Rayleigh damping, an external force.
template <class System>
System draw_scene(Random& random) {
    RandomOptions options;
    options.dampers = true;
    options.rayleigh = true;
    auto system = random_like<System>(random, options);
    system.set_external_force([](const auto&, auto& f) { f.row(0).array() += 2; });
    return system;
}

template <class System>
ProjectiveDynamics<System> converging(const System& system, int window) {
    typename ProjectiveDynamics<System>::Options options;
    options.iterations = 20000;
    options.tolerance = 1e-11;
    options.window = window;
    return ProjectiveDynamics<System>(system, options);
}

/// Keeps the last matrix that it factorised.
template <class Scalar>
struct Witness : Eigen::SimplicialLLT<taut::SparseMatrix<Scalar>> {
    static inline Eigen::MatrixXd seen;

    void factorize(const taut::SparseMatrix<Scalar>& A) {
        seen = Eigen::MatrixXd(A.template cast<double>());
        Eigen::SimplicialLLT<taut::SparseMatrix<Scalar>>::factorize(A);
    }
};

/// φ of a step of h from `start` that ends in `end`.
template <class System>
double objective(const System& system, const typename System::State& start,
                 const typename System::State& end, double h) {
    taut::integrator_detail::StepObjective<System> step;
    step.begin(system, start, static_cast<typename System::Scalar>(h));
    typename System::Force g;
    return static_cast<double>(step.evaluate(system, end.x - start.x, g));
}

}  // namespace

TEMPLATE_TEST_CASE(
    "projective_dynamics: its limit is the nonlinear implicit step of Newton's method",
    "[integrator]", (taut::SpringSystem<double, 1>),
    (taut::SpringSystem<double, 3, TensionOnly, taut::Hookean>)) {
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        INFO("seed " << seed);
        Random random(seed);
        const auto system = draw_scene<TestType>(random);
        auto by_newton = system.initial_state();  // unstretched: one minimum for short steps
        by_newton.v = random_state(random, system).v;
        auto plain_state = by_newton;
        auto fast_state = by_newton;
        typename NewtonEuler<TestType>::Options options;
        options.iterations = 50;
        options.tolerance = 1e-11;
        NewtonEuler<TestType> newton(system, options);
        auto plain = converging(system, 0);
        auto fast = converging(system, 5);
        REQUIRE(newton.step(by_newton, 0.01, 10));
        REQUIRE(plain.step(plain_state, 0.01, 10));
        REQUIRE(fast.step(fast_state, 0.01, 10));
        CHECK(distance(plain_state.x, by_newton.x) <= 1e-9);
        CHECK(distance(fast_state.x, by_newton.x) <= 1e-9);
        CHECK(distance(fast_state.v, by_newton.v) <= 1e-7);
        CHECK(fast.iterations() <= plain.iterations());
        CHECK(plain.factorizations() == 1);
    }
}

TEMPLATE_TEST_CASE("projective_dynamics: no iteration raises the step's objective", "[integrator]",
                   (taut::SpringSystem<float, 2>),
                   (taut::SpringSystem<double, 3, taut::Hookean, Glue>)) {
    using Scalar = typename TestType::Scalar;
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        Random random(seed);
        const auto system = draw_scene<TestType>(random);
        const auto start = random_state(random, system);
        for (const double h : {0.01, 0.3}) {
            for (const int window : {0, 4}) {
                auto inertial = start;
                taut::integrator_detail::StepObjective<TestType> step;
                step.begin(system, start, static_cast<Scalar>(h));
                inertial.x += step.inertial();
                double last = objective(system, start, inertial, h);
                for (int iterations = 1; iterations <= 6; ++iterations) {
                    INFO("seed " << seed << ", h " << h << ", window " << window << ", "
                                 << iterations << " iterations");
                    typename ProjectiveDynamics<TestType>::Options options;
                    options.iterations = iterations;
                    options.window = window;
                    ProjectiveDynamics<TestType> stepper(system, options);
                    auto state = start;
                    REQUIRE(stepper.step(state, static_cast<Scalar>(h)));
                    const double next = objective(system, start, state, h);
                    CHECK(next <= last + Tolerance<Scalar>::rounding * std::abs(last));
                    last = next;
                }
            }
        }
    }
}

TEMPLATE_TEST_CASE("projective_dynamics: its matrix is no less than any Hessian of the objective",
                   "[integrator]", (AllLaws<double, 1>), (AllLaws<double, 2>), (AllLaws<double, 3>),
                   (AllLaws<float, 1>), (AllLaws<float, 2>), (AllLaws<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    for (std::uint32_t seed = 1; seed <= 60; ++seed) {
        Random random(seed);
        RandomOptions options;
        options.springs = 3;
        options.rayleigh = seed % 2 == 0;
        auto system = random_like<TestType>(random, options);
        for (int s = 0; s < 6; ++s) {
            const Index a = random.below(8);
            const Index b = (a + 1 + random.below(7)) % 8;
            const auto damping = static_cast<Scalar>(log_uniform(random, 0.01, 1000));
            system.template add_spring<taut::Hookean>({a, b, {Scalar(10)}, Scalar(0.5), damping});
        }
        const auto start = random_state(random, system);
        const auto h = static_cast<Scalar>(log_uniform(random, 1e-3, 10));
        ProjectiveDynamics<TestType, Witness<Scalar>> stepper(system);
        auto moved = start;
        REQUIRE(stepper.step(moved, h));

        const auto free = free_dofs(system);
        const auto n = static_cast<Index>(free.size());
        const auto damped = dense_matrices(system, start);
        for (int pose = 0; pose < 10; ++pose) {
            const auto bent = dense_matrices(system, random_state(random, system));
            const double step = static_cast<double>(h);
            const Eigen::MatrixXd hessian = bent.M + step * damped.D + step * step * bent.K;
            Eigen::MatrixXd excess(n, n);
            for (Index i = 0; i < n; ++i) {
                for (Index j = 0; j < n; ++j) {
                    const double bound =
                        i % Dim == j % Dim ? Witness<Scalar>::seen(i / Dim, j / Dim) : 0;
                    excess(i, j) = bound - hessian(free[i], free[j]);
                }
            }
            INFO("seed " << seed << ", h " << h << ", pose " << pose);
            CHECK(least_eigenvalue(excess) >=
                  -Tolerance<Scalar>::rounding * largest(Witness<Scalar>::seen));
        }
    }
}

TEST_CASE("projective_dynamics: the residual is that of the nonlinear equation", "[integrator]") {
    Random random(3);
    const auto system = draw_scene<taut::SpringSystem<double, 3>>(random);
    const auto start = random_state(random, system);
    const double h = 0.02;
    for (const int iterations : {1, 4, 40}) {
        ProjectiveDynamics<std::decay_t<decltype(system)>>::Options options;
        options.iterations = iterations;
        ProjectiveDynamics<std::decay_t<decltype(system)>> stepper(system, options);
        auto state = start;
        const taut::Report report = stepper.step(state, h);
        REQUIRE(report);
        CHECK(stepper.iterations() <= iterations);
        // M(v⁺ − v) − h f(x⁺) with the damping of the start and the external force of the start.
        auto still = state;
        still.v.setZero();
        auto undamped = system;
        undamped.set_rayleigh({});
        Eigen::Matrix3Xd f, from_damping, without;
        undamped.force(still, f);
        auto moving = start;
        moving.v = state.v;
        system.force(moving, from_damping);
        moving.v.setZero();
        system.force(moving, without);
        double squares = 0;
        double momentum = 0;
        for (Index i = 2; i < system.size(); ++i) {
            const Eigen::Vector3d g = h * system.mass(i) * (state.v.col(i) - start.v.col(i)) -
                                      h * h * (f.col(i) + from_damping.col(i) - without.col(i));
            squares += g.squaredNorm();
            const Eigen::Vector3d w =
                h * start.v.col(i) +
                h * h * (system.gravity() + Eigen::Vector3d(2, 0, 0) / system.mass(i));
            momentum += (system.mass(i) * w).squaredNorm();
        }
        CHECK(report.residual <= std::sqrt(squares / momentum) * (1 + 1e-9));
        CHECK(report.residual > 0);
        if (iterations == 40) CHECK(report.residual < 1e-2);
    }
}

TEMPLATE_TEST_CASE("projective_dynamics: without stiffness it is ballistic motion", "[integrator]",
                   float, double) {
    Random random(4);
    taut::SpringSystem<TestType, 3> system;
    for (int i = 0; i < 5; ++i) system.add_particle(random.vector<TestType, 3>(-1, 1), 2);
    for (int i = 1; i < 5; ++i) system.add_spring(0, i, 0);
    system.set_gravity({0, 0, TestType(-9.81)});
    auto state = random_state(random, system);
    const auto start = state;
    ProjectiveDynamics stepper(system);
    const auto h = TestType(0.01);
    REQUIRE(stepper.step(state, h, 10));
    for (Index i = 0; i < 5; ++i) {
        CHECK(distance(state.v.col(i), start.v.col(i) + TestType(0.1) * system.gravity()) <=
              Tolerance<TestType>::rounding);
        CHECK(distance(state.x.col(i), start.x.col(i) + TestType(0.1) * start.v.col(i) +
                                           TestType(55) * h * h * system.gravity()) <=
              Tolerance<TestType>::rounding);
    }
}

TEST_CASE("projective_dynamics: an h that returns costs no factorisation, a new scene does",
          "[integrator]") {
    Random random(5);
    auto system = random_system<double, 3>(random);
    auto state = random_state(random, system);
    ProjectiveDynamics stepper(system);
    for (const auto& [h, expected] : returning_steps) {
        REQUIRE(stepper.step(state, h, 2));
        CHECK(stepper.factorizations() == expected);
    }
    system.set_mass(4, 7);
    REQUIRE(stepper.step(state, 0.01));
    CHECK(stepper.factorizations() == 5);
    system.set_gravity({0, 1, 0});
    REQUIRE(stepper.step(state, 0.01));
    CHECK(stepper.factorizations() == 5);
}

TEST_CASE("projective_dynamics: any of Eigen's symmetric solvers gives the same step",
          "[integrator]") {
    Random random(6);
    const auto system = draw_scene<taut::SpringSystem<double, 3>>(random);
    using System = std::decay_t<decltype(system)>;
    const auto start = random_state(random, system);
    auto interleaved_state = start;
    auto eigen_state = start;
    ProjectiveDynamics interleaved(system);
    ProjectiveDynamics<System, Eigen::SimplicialLLT<taut::SparseMatrix<double>>> eigen(system);
    REQUIRE(interleaved.step(interleaved_state, 0.01, 5));
    REQUIRE(eigen.step(eigen_state, 0.01, 5));
    CHECK(distance(interleaved_state.x, eigen_state.x) <= Tolerance<double>::accumulated);
}

TEST_CASE("projective_dynamics: wrong options are refused by name", "[integrator][bad_input]") {
    const auto cloth = taut::hanging_cloth<double>({3, 3});
    using Stepper = ProjectiveDynamics<std::decay_t<decltype(cloth)>>;
    const auto message = [&](auto change) {
        Stepper::Options options;
        change(options);
        return message_of([&] { Stepper stepper(cloth, options); });
    };
    CHECK(missing(message([](auto& o) { o.iterations = 0; }), {"iterations is 0", ">= 1"}).empty());
    CHECK(missing(message([](auto& o) { o.window = -1; }), {"window is -1", ">= 0"}).empty());
    CHECK(missing(message([](auto& o) { o.tolerance = -1; }), {"tolerance is -1"}).empty());
}

TEST_CASE("projective_dynamics: a bad step or state is reported and nothing is touched",
          "[integrator][bad_input]") {
    Random random(21);
    const auto springs = random_system<float, 2>(random);
    check_bad_steps<ProjectiveDynamics>(springs, random_state(random, springs));
}

TEST_CASE("projective_dynamics: count steps are count single steps, to the bit", "[integrator]") {
    check_counted_steps_are_single_steps<ProjectiveDynamics, float, 3>();
}

TEST_CASE("projective_dynamics: pinned particles obey their velocity", "[integrator]") {
    check_pinned_particles_obey_their_velocity<ProjectiveDynamics, double>();
}

TEMPLATE_TEST_CASE("projective_dynamics: linear momentum of an unpinned scene is kept to rounding",
                   "[integrator]", (Case<float, 2>), (Case<double, 3>)) {
    check_linear_momentum_is_kept<ProjectiveDynamics, typename TestType::Scalar, TestType::Dim>();
}

TEST_CASE("projective_dynamics: the measured order of convergence is the declared one",
          "[integrator]") {
    CHECK_THAT((measured_order<ProjectiveDynamics, 3>()), WithinAbs(1, 0.05));
}

TEST_CASE("projective_dynamics: changes of the system and the state between steps are taken up",
          "[integrator]") {
    check_takes_up_all_changes<ProjectiveDynamics>();
}

TEST_CASE("projective_dynamics: a scene without free particles is stepped without failure",
          "[integrator]") {
    check_nothing_free<ProjectiveDynamics>();
}

}  // namespace taut_test::projective_dynamics_test
