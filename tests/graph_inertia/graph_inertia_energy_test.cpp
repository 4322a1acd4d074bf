// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/graph_inertia/graph_inertia.hpp>
#include <taut/stability/any_pose.hpp>

#include "../support/catch.hpp"
#include "../support/energy_networks.hpp"
#include "../support/graph_matrices.hpp"
#include "../support/tolerance.hpp"

// What graph inertia keeps of a linear scene's energy [T33], and that with all dissipation no
// energy rises at any step [T35].

namespace taut_test::graph_inertia_energy_test {

using taut::GraphInertia;
using taut::GraphInertiaOptions;
using taut::Hookean;
using taut::SpringSystem;

namespace {

/// The matrices of a stepper's step h, n × n: of A(v⁺ − v) = h f − h D_i v, f with D.
struct StepMatrices {
    Eigen::MatrixXd A, braking, M, K, D, damped;

    template <class System>
    explicit StepMatrices(const System& system, const GraphInertia<System>& stepper) {
        const auto& shares = stepper.shares();
        const auto g = graph_matrices(system, shares.shares, shares.margin, shares.step);
        braking = 2 * stepper.options().dissipation / shares.step * g.elastic;
        A = g.heavy() + shares.step / 2 * braking;
        M = g.M;
        K = g.K;
        D = system.rayleigh().mass_proportional * g.M + g.C;
        damped = g.damped;
    }
    /// Of velocities alone, those of pins being 0: vᵀSv over all axes.
    static double form(const Eigen::MatrixXd& S, const Eigen::MatrixXd& v) {
        return (v.transpose() * S * v).trace();
    }
    /// What rounding is relative to, J: |v|ᵀ|A||v|.
    double size(const Eigen::MatrixXd& v) const {
        const Eigen::VectorXd speed = v.rowwise().norm();
        return speed.dot(A.cwiseAbs() * speed);
    }
};

template <class Points>
Eigen::MatrixXd rows(const Points& points) {
    return points.template cast<double>().transpose();
}

/// ½vᵀM̃v + U + ½h vᵀf − ¼h vᵀDv of a linear scene, J: f of springs and gravity, M̃ = A − ½hD_i.
template <class System, class State>
double kept_energy(const System& system, const StepMatrices& m, const State& state, double h) {
    const Eigen::MatrixXd x = rows(state.x), v = rows(state.v);
    Eigen::MatrixXd weight = m.M * Eigen::MatrixXd::Ones(x.rows(), 1) *
                             system.gravity().template cast<double>().transpose();
    for (Index i = 0; i < system.size(); ++i) weight.row(i) *= system.is_pinned(i) ? 0 : 1;
    const Eigen::MatrixXd f = weight - m.K * x;
    const double potential = StepMatrices::form(m.K, x) / 2 - weight.cwiseProduct(x).sum();
    return StepMatrices::form(m.A - h / 2 * m.braking - h / 2 * m.D, v) / 2 + potential +
           h / 2 * v.cwiseProduct(f).sum();
}

/// Steps that raise H + ½vᵀBv by more than rounding; B = A − M − h D_i, no less than the inertia of
/// dampers.
template <class System>
int rises(Random& random, const System& system, double h, const GraphInertiaOptions& options,
          int steps) {
    using Scalar = typename System::Scalar;
    constexpr double eps = std::numeric_limits<Scalar>::epsilon();
    GraphInertia<System> stepper(system, options);
    if (const auto report = stepper.prepare(static_cast<Scalar>(h)); !report) {
        CHECK(report.status == taut::Status::masses_lost);
        return 0;
    }
    const StepMatrices m(system, stepper);
    auto state = thrown(random, system);
    const auto part = static_cast<Scalar>(random.below(2) == 0 ? h : 0.7 * h);
    const double step = static_cast<double>(part);
    // As a sum that loses nothing: what is left of A − h D_i beside M.
    const Eigen::MatrixXd B = m.damped + (stepper.shares().step - step) * m.braking;
    const auto energy = [&](const typename System::State& s) {
        return total_energy(system, s) + static_cast<Real>(StepMatrices::form(B, rows(s.v)) / 2);
    };
    int count = 0;
    Real before = energy(state);
    for (int i = 0; i < steps; ++i) {
        double allowed = rounding(system, state, step) + 32 * eps * m.size(rows(state.v));
        REQUIRE(stepper.step(state, part));
        allowed += 32 * eps * m.size(rows(state.v)) + rounding(system, state, step);
        const Real after = energy(state);
        count += after > before + static_cast<Real>(allowed);
        before = after;
    }
    return count;
}

template <class System>
int rises_of_networks(std::uint32_t seed, double dissipation, bool damped, int networks) {
    Random random(seed);
    int count = 0;
    for (int repeat = 0; repeat < networks; ++repeat) {
        auto system = random_network<System>(random, repeat % 3 == 0 ? 8 : 3);
        const auto limit = taut::any_pose_limit(system);
        if (limit.unbounded()) continue;
        constexpr bool single = std::is_same_v<typename System::Scalar, float>;
        const double h =
            static_cast<double>(limit.certified) * log_uniform(random, 0.5, single ? 30 : 1000);
        GraphInertiaOptions options;
        options.dissipation = dissipation;
        options.margin = repeat % 2 == 0 ? 0.83 : 1;
        if (damped && repeat % 2 == 0)
            system.set_rayleigh({random.uniform(0, 1.5) / h, h * log_uniform(random, 0.01, 1)});
        if (damped && repeat % 2 == 1) system.set_graph_damping(h * log_uniform(random, 0.01, 1));
        const int here = rises(random, system, h, options, 100);
        INFO("network " << repeat << ", h = " << h);
        if (dissipation == 1) CHECK(here == 0);
        count += here;
    }
    return count;
}

}  // namespace

TEMPLATE_TEST_CASE("graph_inertia: the kept energy of a linear scene changes by damping alone",
                   "[integrator]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>),
                   (Case<float, 2>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using System = SpringSystem<Scalar, Dim>;
    Random random(4400 + Dim);
    for (int repeat = 0; repeat < 40; ++repeat) {
        auto system = linear_network<System>(random, 3);
        const auto limit = taut::any_pose_limit(system);
        if (limit.unbounded()) continue;
        const double h = static_cast<double>(limit.certified) * log_uniform(random, 0.5, 30);
        system.set_gravity(random.template vector<Scalar, Dim>(-1, 1));
        if (repeat % 4 == 1) system.set_rayleigh({random.uniform(0, 1) / h, 0.2 * h});
        if (repeat % 4 == 2) system.set_graph_damping(h * log_uniform(random, 0.01, 1));
        if (Dim == 1 && repeat % 4 == 3) {
            system.add_spring(taut::Spring<Scalar, Hookean>{
                0, 1, {Scalar(1)}, Scalar(0), static_cast<Scalar>(random.uniform(0, 3) / h)});
        }
        GraphInertiaOptions options;
        options.dissipation = repeat % 5 == 0 ? 0 : repeat % 5 == 1 ? 1 : random.uniform(0, 1);
        GraphInertia<System> stepper(system, options);
        REQUIRE(stepper.prepare(static_cast<Scalar>(h)));
        const StepMatrices m(system, stepper);
        auto state = random_state(random, system);
        for (Index i = 0; i < system.size(); ++i) {
            if (system.is_pinned(i)) state.v.col(i).setZero();
        }
        const auto step = static_cast<Scalar>(repeat % 2 == 0 ? h : 0.6 * h);
        INFO("network " << repeat << ", h = " << step << ", dissipation " << options.dissipation);
        for (int i = 0; i < 40; ++i) {
            const auto before = state;
            REQUIRE(stepper.step(state, step));
            const auto t = static_cast<double>(step);
            const Eigen::MatrixXd mean = rows(before.v) + rows(state.v);
            const double lost = t / 4 * StepMatrices::form(m.D + m.braking, mean);
            const double change =
                kept_energy(system, m, state, t) - kept_energy(system, m, before, t);
            const double size = m.size(rows(before.v)) + m.size(rows(state.v)) +
                                StepMatrices::form(m.K.cwiseAbs(), rows(before.x).cwiseAbs()) +
                                StepMatrices::form(m.K.cwiseAbs(), rows(state.x).cwiseAbs()) +
                                m.M.trace() * largest(state.x);
            CHECK(lost >= -Tolerance<double>::rounding * size);
            CHECK_THAT(change + lost, WithinAbs(0, Tolerance<Scalar>::rounding * size));
        }
    }
}

TEMPLATE_TEST_CASE("graph_inertia: with all dissipation the energy never rises, at any step",
                   "[integrator][slow]", (Mixed<double, 1>), (Mixed<double, 2>), (Mixed<double, 3>),
                   (Strings<double, 3>), (Mixed<float, 1>), (Mixed<float, 2>),
                   (Strings<float, 3>)) {
    rises_of_networks<TestType>(4410, 1, false, 40);
    rises_of_networks<TestType>(4411, 1, true, 30);
}

TEST_CASE("graph_inertia: with less dissipation it may", "[integrator]") {
    CHECK(rises_of_networks<Mixed<double, 3>>(4410, 0, false, 40) > 40);
}

TEMPLATE_TEST_CASE("graph_inertia: axial dampers, and their inertia, take no energy theorem away",
                   "[integrator]", (Mixed<double, 2>), (Mixed<double, 3>)) {
    Random random(4420);
    for (int repeat = 0; repeat < 40; ++repeat) {
        RandomOptions options;
        options.dampers = true;
        options.pinned = random.below(3);
        auto system = random_like<TestType>(random, options);
        const double h = taut::any_pose_limit(system).certified * log_uniform(random, 0.5, 1000);
        GraphInertiaOptions how;
        how.dissipation = 1;
        INFO("network " << repeat << ", h = " << h);
        CHECK(rises(random, system, h, how, 100) == 0);
    }
}

}  // namespace taut_test::graph_inertia_energy_test
