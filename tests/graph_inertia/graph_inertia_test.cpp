// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/graph_inertia/graph_inertia.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/model/state_view.hpp>
#include <taut/stability/any_pose.hpp>
#include <taut/wind/wind.hpp>

#include "../support/catch.hpp"
#include "../support/check_stepper.hpp"
#include "../support/graph_matrices.hpp"
#include "../support/sweep_checks.hpp"

// The step of [T33]: its equation, what it keeps, when it factorises and what it refuses.

namespace taut_test::graph_inertia_test {

using taut::GraphInertia;
using taut::GraphInertiaOptions;
using taut::Hookean;
using taut::SpringSystem;
using taut::Status;

namespace {

/// n × Dim, in double.
template <class Points>
Eigen::MatrixXd rows(const Points& points) {
    return points.template cast<double>().transpose();
}

/// Laws, dampers, damping of every kind, gravity, and forces from outside.
template <class Scalar, int Dim>
Mixed<Scalar, Dim> any_scene(Random& random, int repeat) {
    RandomOptions options;
    options.particles = 5 + random.below(8);
    options.dampers = repeat % 2 == 0;
    options.rayleigh = repeat % 3 == 0;
    options.pinned = random.below(3);
    auto system = random_like<Mixed<Scalar, Dim>>(random, options);
    if (repeat % 4 == 1) system.set_graph_damping(0.01);
    if (repeat % 4 == 2)
        system.set_external_force([](const auto& state, auto& f) {
            f.array() += Scalar(3) * state.x.array() - state.v.array();
        });
    if (repeat % 4 == 3)
        system.set_external_force([](const auto& state, auto& f) {
            for (Index i = 0; i < f.cols(); ++i)
                f.col(i) += Scalar(i) * state.x.col(i) - state.v.col(i);
        });
    if constexpr (Dim == 3) {
        if (repeat % 3 == 1)
            taut::set_wind(system, taut::Wind<Scalar>{{1, 2, 3}, {{0, 1, 2}, {2, 3, 4}}});
    }
    return system;
}

template <class System>
double limit_of(const System& system) {
    return static_cast<double>(taut::any_pose_limit(system).certified);
}

/// How far A(v⁺ − v) = h f − h D_i v is from true, free rows, of what its terms are: A = M̃ + ½h₀D_i
/// with h₀ the step of the shares. @param jump  Δv of pins, n × Dim; of D_i the mean velocity
template <class System, class State>
double residual(const System& system, const GraphInertia<System>& stepper, const State& before,
                const State& after, double h, const Eigen::MatrixXd& jump) {
    const auto& shares = stepper.shares();
    const auto g = graph_matrices(system, shares.shares, shares.margin, shares.step);
    const Eigen::MatrixXd D = 2 * stepper.options().dissipation / shares.step * g.elastic;
    const Eigen::MatrixXd A = g.heavy() + shares.step / 2 * D;
    decltype(before.x) force;
    system.force(before, force);
    const Eigen::MatrixXd v = rows(before.v), change = rows(after.v) - v + jump, f = rows(force);
    const Eigen::MatrixXd wrong = A * change - h * f + h * (D * (v - jump));
    const Eigen::MatrixXd terms = A.cwiseAbs() * (v.cwiseAbs() + rows(after.v).cwiseAbs());
    const double size = terms.maxCoeff() + h * largest(f) + h * g.K.diagonal().maxCoeff();
    double worst = 0;
    for (const Index i : free_particles(system)) {
        worst = std::max(worst, wrong.row(i).cwiseAbs().maxCoeff());
    }
    return worst / size;
}

}  // namespace

TEMPLATE_TEST_CASE("graph_inertia: a step satisfies its own update equation", "[integrator]",
                   (Case<double, 1>), (Case<double, 2>), (Case<double, 3>), (Case<float, 1>),
                   (Case<float, 2>), (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(4300 + Dim);
    int touched = 0;
    for (int repeat = 0; repeat < 36; ++repeat) {
        const auto system = any_scene<Scalar, Dim>(random, repeat);
        const auto h = static_cast<Scalar>(limit_of(system) * log_uniform(random, 0.5, 30));
        GraphInertiaOptions options;
        options.margin = repeat % 2 == 0 ? 0.83 : 1;
        options.dissipation = repeat % 5 < 2 ? 0 : repeat % 5 == 2 ? 1 : random.uniform(0, 1);
        GraphInertia<Mixed<Scalar, Dim>> stepper(system, options);
        const auto before = random_state(random, system);
        const Eigen::MatrixXd still = Eigen::MatrixXd::Zero(system.size(), Dim);
        // The second step is shorter, with the same factor.
        for (const Scalar step : {h, h / 3}) {
            auto state = before;
            INFO("scene " << repeat << ", h = " << step << ", dissipation " << options.dissipation);
            REQUIRE(stepper.step(state, step));
            CHECK(residual(system, stepper, before, state, static_cast<double>(step), still) <=
                  Tolerance<Scalar>::rounding);
            CHECK(distance(state.x, before.x + step * state.v) <=
                  Tolerance<Scalar>::rounding * (1 + static_cast<double>(step) * largest(state.v)));
            CHECK(state.time == step);
            for (Index i = 0; i < system.size(); ++i) {
                if (system.is_pinned(i)) CHECK((state.v.col(i) == before.v.col(i)));
            }
        }
        CHECK(stepper.factorizations() == (stepper.touched() > 0 ? 1 : 0));
        touched += stepper.touched() > 0;
        const auto g =
            graph_matrices(system, stepper.shares().shares, options.margin, stepper.shares().step);
        // What joins two pins holds nothing.
        auto at_rest = before;
        for (Index i = 0; i < system.size(); ++i) at_rest.v.col(i) *= Scalar(!system.is_pinned(i));
        const Eigen::MatrixXd v = rows(at_rest.v);
        const double added = ((v.transpose() * (g.heavy() - g.M) * v).trace()) / 2;
        CHECK_THAT(stepper.added_kinetic(at_rest), WithinAbs(added, 1e-5 * (1 + added)));
    }
    CHECK(touched > 18);
}

TEMPLATE_TEST_CASE("graph_inertia: pins that change velocity carry implicit springs with them",
                   "[integrator]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>),
                   (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(4310 + Dim);
    for (int repeat = 0; repeat < 20; ++repeat) {
        auto system = any_scene<Scalar, Dim>(random, repeat);
        system.pin(0);
        system.pin(1);
        system.add_spring(taut::Spring<Scalar, Hookean>{0, 1, {Scalar(1000)}, Scalar(1)});
        const auto h = static_cast<Scalar>(limit_of(system) * log_uniform(random, 2, 30));
        GraphInertiaOptions options;
        options.dissipation = repeat % 3 == 0 ? 0 : repeat % 3 == 1 ? 1 : random.uniform(0, 1);
        GraphInertia<Mixed<Scalar, Dim>> stepper(system, options);
        auto state = random_state(random, system);
        REQUIRE(stepper.step(state, h));
        for (const Scalar step : {h, h / 2}) {
            Eigen::MatrixXd jump = Eigen::MatrixXd::Zero(system.size(), Dim);
            for (const Index i : {Index(0), Index(1)}) {
                const auto change = random.vector<Scalar, Dim>(-1, 1);
                state.v.col(i) += change;
                jump.row(i) = change.template cast<double>().transpose();
            }
            auto before = state;
            INFO("scene " << repeat << ", dissipation " << options.dissipation);
            REQUIRE(stepper.step(state, step));
            CHECK(residual(system, stepper, before, state, static_cast<double>(step), jump) <=
                  Tolerance<Scalar>::rounding);
            // Put elsewhere, it is another start: nobody knows how the pins moved before.
            state.x.col(0).array() += 1 + 50 * step;  // farther than a step moves a pin
            state.v.col(1).array() += Scalar(1);
            before = state;
            jump.setZero();
            REQUIRE(stepper.step(state, step));
            CHECK(residual(system, stepper, before, state, static_cast<double>(step), jump) <=
                  Tolerance<Scalar>::rounding);
        }
    }
}

TEMPLATE_TEST_CASE("graph_inertia: where no spring has a share it is symplectic Euler",
                   "[integrator]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>),
                   (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(4320 + Dim);
    for (int repeat = 0; repeat < 10; ++repeat) {
        const auto system = any_scene<Scalar, Dim>(random, repeat);
        const auto h = static_cast<Scalar>(0.5 * limit_of(system));
        auto state = random_state(random, system);
        auto expected = state;
        GraphInertia<Mixed<Scalar, Dim>> stepper(system);
        taut::SymplecticEuler<Mixed<Scalar, Dim>> plain(system);
        REQUIRE(stepper.step(state, h, 20));
        REQUIRE(plain.step(expected, h, 20));
        CHECK(stepper.factorizations() == 0);
        CHECK(stepper.touched() == 0);
        CHECK(stepper.shares().step == static_cast<double>(h));
        CHECK(distance(state.v, expected.v) <=
              Tolerance<Scalar>::rounding * (largest(expected.v) + largest(expected.x)));
        CHECK(distance(state.x, expected.x) <=
              Tolerance<Scalar>::rounding * (largest(expected.v) + largest(expected.x)));
    }
}

TEMPLATE_TEST_CASE("graph_inertia: linear momentum is kept to rounding", "[integrator]",
                   (Case<double, 1>), (Case<double, 2>), (Case<double, 3>), (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(4330);
    for (const double dissipation : {0.0, 0.4, 1.0}) {
        RandomOptions options;
        options.pinned = 0;
        options.gravity = false;
        options.dampers = true;
        auto system = random_like<Mixed<Scalar, Dim>>(random, options);
        system.set_rayleigh({0, 0.0078125});
        auto state = random_state(random, system);
        const auto momentum = [&] {
            Eigen::VectorXd sum = Eigen::VectorXd::Zero(Dim);
            for (Index i = 0; i < system.size(); ++i) {
                sum += static_cast<double>(system.mass(i)) * state.v.col(i).template cast<double>();
            }
            return sum;
        };
        const Eigen::VectorXd before = momentum();
        GraphInertiaOptions how;
        how.dissipation = dissipation;
        GraphInertia<Mixed<Scalar, Dim>> stepper(system, how);
        REQUIRE(stepper.step(state, static_cast<Scalar>(5 * limit_of(system)), 200));
        CHECK(stepper.touched() > 0);
        CHECK(distance(momentum(), before) <= 100 * Tolerance<Scalar>::accumulated);
    }
}

TEMPLATE_TEST_CASE("graph_inertia: the sweep's corrected steps are those of the plain path",
                   "[integrator]", (Case<double, 1>), (Case<double, 3>), (Case<float, 2>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using System = SpringSystem<Scalar, Dim>;
    Random random(4340);
    for (int repeat = 0; repeat < 4; ++repeat) {
        auto system = repeat % 2 == 0 ? net<Scalar, Dim>(random, 9, 12)
                                      : irregular<Scalar, Dim>(random, 700, true);
        if (repeat > 1) system.set_external_force([](const auto& s, auto& f) { f += s.x; });
        const auto correct = [&](const auto& a, const auto& v) {
            for (Index i = 0; i < system.size(); i += 2) {
                using Vector = Eigen::Matrix<Scalar, Dim, 1>;
                const Vector own = a(i), velocity = v(i);
                a.set(i, Vector(own / 2 - velocity));
            }
        };
        const auto start = random_state(random, system);
        auto state = start, expected = start;
        const auto h = static_cast<Scalar>(0.001);
        taut::integrator_detail::sweep::Sweep<System> sweep;
        REQUIRE(sweep.run_corrected(system, state, h, 20, 1, correct));
        taut::integrator_detail::ExplicitSteps<System> plain({});
        for (int i = 0; i < 20; ++i) plain.corrected_step(system, expected, h, correct);
        CHECK(distance(state.v, start.v) > 1e-3);
        CHECK(distance(state.v, expected.v) <= Tolerance<Scalar>::rounding * largest(expected.v));
        CHECK(distance(state.x, expected.x) <= Tolerance<Scalar>::rounding * largest(expected.x));
    }
}

TEMPLATE_TEST_CASE("graph_inertia: threads, counts and views give the same bits", "[integrator]",
                   (Case<double, 2>), (Case<double, 3>), (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(4350);
    const auto system = irregular<Scalar, Dim>(random, 1500, true);
    const auto h = static_cast<Scalar>(1.5 * limit_of(system));
    const auto start = random_state(random, system);
    GraphInertia<SpringSystem<Scalar, Dim>> one(system);
    auto expected = start;
    REQUIRE(one.step(expected, h, 6));
    REQUIRE(one.touched() > 0);
    REQUIRE(one.touched() < system.size());
    for (const int threads : {2, 3, 8}) {
        GraphInertiaOptions options;
        options.threads = threads;
        GraphInertia<SpringSystem<Scalar, Dim>> many(system, options);
        auto state = start;
        REQUIRE(many.step(state, h, 6));
        CHECK(same_bits(state, expected));
    }
    GraphInertia<SpringSystem<Scalar, Dim>> singly(system);
    auto state = start;
    for (int i = 0; i < 6; ++i) REQUIRE(singly.step(state, h));
    CHECK(same_bits(state, expected));
    // An engine's arrays.
    auto x = start.x, v = start.v;
    taut::StateView<Scalar, Dim> view(x.data(), Dim, v.data(), Dim, system.size());
    GraphInertia<SpringSystem<Scalar, Dim>> viewing(system);
    REQUIRE(viewing.step(view, h, 2));
    REQUIRE(viewing.step(view, h, 4));
    CHECK((x == expected.x && v == expected.v));
}

}  // namespace taut_test::graph_inertia_test
