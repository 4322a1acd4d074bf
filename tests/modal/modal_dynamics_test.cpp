// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <taut/modal/modal_dynamics.hpp>
#include <taut/network/spring_system.hpp>
#include <taut/lattice/chain.hpp>
#include <taut/own_matrices/own_matrices.hpp>

#include "../support/catch.hpp"
#include "../support/decompositions.hpp"
#include "../support/dense.hpp"
#include "../support/faults.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::modal_dynamics_test {

using taut::LinearSystem;
using taut::ModalBasis;
using taut::ModalDynamics;
using taut::integrator_detail::ModePropagator;

namespace {

using Linear = LinearSystem<double>;
using LinearState = taut::State<double, 1>;

constexpr Index size = 8;

/// e^A, by the series of A/2^s and s squares.
Eigen::MatrixXd exponential(const Eigen::MatrixXd& A) {
    const int squares = std::max(0, std::ilogb(A.cwiseAbs().rowwise().sum().maxCoeff()) + 2);
    const RealMatrix part = A.cast<Real>() * std::ldexp(Real(1), -squares);
    RealMatrix sum = RealMatrix::Identity(A.rows(), A.cols()), term = sum;
    for (int i = 1; i <= 24; ++i) {
        term = term * part / i;
        sum += term;
    }
    for (int i = 0; i < squares; ++i) sum = sum * sum;
    return sum.cast<double>();
}

/// A definite K with Rayleigh damping on it, and a load.
Linear rayleigh_system(Random& random) {
    const Eigen::MatrixXd B = random.points<double, size>(size, -1, 1);
    const Eigen::MatrixXd K = 20 * B * B.transpose() + Eigen::MatrixXd::Identity(size, size);
    const Eigen::VectorXd mass = random.vector<double, size>(0.5, 2);
    const Eigen::MatrixXd M = mass.asDiagonal();
    const Eigen::MatrixXd D = 0.3 * M + 0.02 * K;
    return {mass, D.sparseView(), K.sparseView(), random.vector<double, size>(-5, 5)};
}

/// The lowest `count` modes, by a dense generalised eigensolver.
ModalBasis dense_basis(const Linear& system, Index count) {
    const Eigen::MatrixXd K(system.stiffness());
    const Eigen::MatrixXd D(system.damping());
    const Eigen::MatrixXd M = system.mass().asDiagonal();
    const auto modes = generalized_modes(K, M);
    ModalBasis basis;
    basis.k = modes.values.head(count);
    basis.shapes = modes.vectors.leftCols(count);
    basis.d = (basis.shapes.transpose() * D * basis.shapes).diagonal();
    basis.p = basis.shapes.transpose() * system.load();
    return basis;
}

/// (u, v) after a time, by the exponential of the whole generator.
LinearState exact(const Linear& system, const LinearState& start, const Eigen::VectorXd& force,
                  double time) {
    const Index N = system.size();
    Eigen::MatrixXd C = Eigen::MatrixXd::Zero(2 * N + 1, 2 * N + 1);
    const Eigen::MatrixXd inverse = system.inverse_mass().asDiagonal();
    C.block(0, N, N, N).setIdentity();
    C.block(N, 0, N, N) = -inverse * Eigen::MatrixXd(system.stiffness());
    C.block(N, N, N, N) = -inverse * Eigen::MatrixXd(system.damping());
    C.block(N, 2 * N, N, 1) = inverse * (system.load() + force);
    Eigen::VectorXd w(2 * N + 1);
    w << flat(start.x), flat(start.v), 1;
    const Eigen::VectorXd end = exponential(time * C) * w;
    return {end.head(N).transpose(), end.segment(N, N).transpose(), start.time + time};
}

LinearState draw_state(Random& random) {
    return {random.points<double, 1>(size, -1, 1), random.points<double, 1>(size, -1, 1)};
}

LinearState rest(Index n) { return {LinearState::zero(n), LinearState::zero(n)}; }

}  // namespace

TEST_CASE("modal_dynamics: one mode moves as its equation says, damped in any way", "[modal]") {
    // ω t up to 30: the rounding of the phase grows with it.
    const double tolerance = Tolerance<double>::accumulated;
    for (const double h : {1e-3, 0.1, 3.0}) {
        for (const double k : {0.0, 0.01, 4.0, 100.0, -1.0}) {
            for (const double d : {0.0, 0.05, 2 * std::sqrt(std::abs(k)), 50.0}) {
                INFO("h " << h << ", k " << k << ", d " << d);
                const auto m = ModePropagator::over(h, k, d);
                Eigen::Matrix3d C;
                C << 0, 1, 0, -k, -d, 1, 0, 0, 0;
                const Eigen::Matrix3d expected = exponential(h * C);
                Eigen::Matrix3d found;
                found << m.a11, m.a12, m.b1, m.a21, m.a22, m.b2, 0, 0, 1;
                CHECK(distance(found, expected) <= tolerance * largest(expected));
            }
        }
    }
    const auto critical = ModePropagator::over(0.7, 9, 6);  // e^(−3h)(1 + 3h), e^(−3h) h
    CHECK_THAT(critical.a11, WithinRel(std::exp(-2.1) * 3.1, Tolerance<double>::rounding));
    CHECK_THAT(critical.a12, WithinRel(std::exp(-2.1) * 0.7, Tolerance<double>::rounding));
    const auto rigid = ModePropagator::over(1e3, 0, 0);
    CHECK(rigid.a12 == 1e3);
    CHECK(rigid.b1 == 5e5);
    // Long at rest in k q = p.
    const auto stiff = ModePropagator::over(1e3, 1e8, 1e6);
    CHECK_THAT(stiff.b1, WithinRel(1e-8, Tolerance<double>::rounding));
}

TEST_CASE("modal_dynamics: an undamped mode neither grows nor fades, however large the step",
          "[modal]") {
    for (const double h : {1e-3, 1.0, 1e6, 1e12, 1e18}) {
        INFO("h " << h);
        const auto m = ModePropagator::over(h, 2, 0);
        double q = 1;
        double v = 0;
        for (int i = 0; i < 100000; ++i) {
            const double next = m.a11 * q + m.a12 * v;
            v = m.a21 * q + m.a22 * v;
            q = next;
        }
        CHECK_THAT(v * v / 2 + q * q, WithinRel(1.0, 1e5 * Tolerance<double>::rounding));
    }
}

TEST_CASE("modal_dynamics: two steps are one of twice the length, near and far from critical",
          "[modal]") {
    Random random(9);
    for (int trial = 0; trial < 500; ++trial) {
        const double k = trial % 7 == 0 ? 0 : std::pow(10, random.uniform(-4, 8));
        const double d = 2 * std::sqrt(k) * std::pow(10, random.uniform(-3, 3));
        const double h = std::pow(10, random.uniform(-4, 1)) / (std::sqrt(k) + 1e-3);
        INFO("h " << h << ", k " << k << ", d " << d);
        const auto one = ModePropagator::over(h, k, d);
        const auto two = ModePropagator::over(2 * h, k, d);
        Eigen::Matrix2d A, A2;
        A << one.a11, one.a12, one.a21, one.a22;
        A2 << two.a11, two.a12, two.a21, two.a22;
        const Eigen::Vector2d b(one.b1, one.b2);
        const Eigen::Vector2d unit(std::sqrt(k) + d + 1e-3, 1);  // of (q, q̇), to compare entries
        const Eigen::Matrix2d off = unit.asDiagonal() * (A * A - A2) * unit.asDiagonal().inverse();
        CHECK(largest(off) <= Tolerance<double>::accumulated);
        const Eigen::Vector2d sum = b + A * b;
        CHECK_THAT(sum[0], WithinRel(two.b1, 1e-9) || WithinAbs(two.b1, 1e-12 / (k + 1e-3)));
    }
}

TEST_CASE("modal_dynamics: with all modes it is the full solution, at any step", "[modal]") {
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
        Random random(seed);
        const auto system = rayleigh_system(random);
        ModalDynamics<double, 1> modal(system, rest(size), dense_basis(system, size));
        auto start = draw_state(random);
        start.time = 1.5;
        modal.set_state(start);
        const Eigen::VectorXd force = random.vector<double, size>(-3, 3);
        modal.set_force(force.transpose());
        const auto before = modal.state();
        CHECK(distance(before.x, start.x) <= Tolerance<double>::rounding * 10);
        double time = 0;
        for (const double h : {0.25, 0.01, 4.0}) {
            const taut::Report report = modal.step(h, 3);
            REQUIRE(report);
            CHECK(report.iterations == 3);
            time += 3 * h;
            const auto expected = exact(system, start, force, time);
            const auto found = modal.state();
            CHECK(distance(found.x, expected.x) <= Tolerance<double>::accumulated);
            CHECK(distance(found.v, expected.v) <= Tolerance<double>::accumulated * 10);
            CHECK_THAT(found.time, WithinRel(expected.time, Tolerance<double>::rounding));
        }
    }
}

TEST_CASE("modal_dynamics: the error falls with every mode that is added", "[modal]") {
    Random random(6);
    const auto system = rayleigh_system(random);
    const auto start = draw_state(random);
    const auto full = exact(system, start, Eigen::VectorXd::Zero(size), 0.8);
    double last = std::numeric_limits<double>::infinity();
    for (Index r = 1; r <= size; ++r) {
        ModalDynamics<double, 1> modal(system, rest(size), dense_basis(system, r));
        CHECK(modal.size() == r);
        modal.set_state(start);
        REQUIRE(modal.step(0.4, 2));
        const Eigen::VectorXd off = flat(modal.state().x) - flat(full.x);
        const double error = std::sqrt(off.dot(system.mass().cwiseProduct(off)));
        CHECK(error < last);
        last = error;
    }
    CHECK(last <= Tolerance<double>::accumulated);
}

TEMPLATE_TEST_CASE("modal_dynamics: on springs it moves the free particles about the pose",
                   "[modal]", float, double) {
    Random random(7);
    RandomOptions options;
    options.rayleigh = true;
    const auto springs = random_system<double, 3>(random, options);
    auto pose = springs.initial_state();
    pose.x = 3 * pose.x;  // stretched
    const auto linear = taut::linearize(springs, pose);
    ModalDynamics<TestType, 3> modal(linear, pose, dense_basis(linear, linear.size()));
    auto state = pose;
    state.x.rightCols(6) += random.points<double, 3>(6, -0.01, 0.01);
    state.v.rightCols(6) = random.points<double, 3>(6, -0.1, 0.1);
    modal.set_state({state.x.template cast<TestType>(), state.v.template cast<TestType>(), 0});
    taut::Report report;
    CHECK(faults_of([&] { report = modal.step(0.3); }) == 0);
    REQUIRE(report);
    auto expected = pose;
    linear.from_free(
        exact(linear, linear.to_free(state), Eigen::VectorXd::Zero(linear.size()), 0.3), expected);
    const auto found = modal.state();
    CHECK(faults_of([&] { modal.state(); }) == 0);
    const double tolerance = Tolerance<TestType>::accumulated * largest(expected.x);
    CHECK(distance(found.x, expected.x) <= tolerance);
    CHECK(distance(found.v, expected.v) <= 10 * tolerance);
    CHECK((found.x.leftCols(2).template cast<double>() ==
           pose.x.leftCols(2).template cast<TestType>().template cast<double>()));
    CHECK((found.v.leftCols(2).array() == 0).all());
}

TEST_CASE("modal_dynamics: a free chain drifts and falls exactly, however large the step",
          "[modal]") {
    auto chain = taut::chain<double, 1>({6, taut::ChainEnds::free_free, 2, 50});
    chain.set_gravity(Eigen::Matrix<double, 1, 1>(-3.0));
    const auto pose = chain.initial_state();
    const auto linear = taut::linearize(chain, pose);
    auto basis = dense_basis(linear, 6);
    basis.k[0] = 0;
    CHECK(basis.rigid() == 1);
    ModalDynamics<double, 1> modal(linear, pose, basis);
    auto state = pose;
    state.v.setConstant(0.5);
    modal.set_state(state);
    REQUIRE(modal.step(1000));
    const auto end = modal.state();
    const double path = 0.5 * 1000 - 1.5 * 1e6;
    CHECK(distance(end.x.array() - path, pose.x.array()) <=
          Tolerance<double>::rounding * std::abs(path));
    CHECK(distance(end.v.array(), Eigen::Array<double, 1, 6>::Constant(0.5 - 3000)) <=
          Tolerance<double>::rounding * 3000);
}

TEST_CASE("modal_dynamics: bad input is reported or refused by name, and nothing changes",
          "[modal][bad_input]") {
    Random random(8);
    const auto system = rayleigh_system(random);
    const auto basis = dense_basis(system, 4);
    ModalDynamics<double, 1> modal(system, rest(size), basis);
    modal.set_state(draw_state(random));
    const Eigen::ArrayXd before = modal.amplitudes();
    for (const double h : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        CHECK(modal.step(h).status == taut::Status::invalid_step);
        CHECK((modal.amplitudes() == before).all());
    }
    auto state = draw_state(random);
    state.v(0, 3) = std::nan("");
    CHECK(missing(message_of([&] { modal.set_state(state); }), {"set_state", "particle 3"}) == "");
    CHECK(missing(message_of([&] { modal.set_state(rest(5)); }), {"set_state", "5", "8"}) == "");
    CHECK(missing(message_of([&] { modal.set_force(LinearState::zero(9)); }),
                  {"set_force", "9", "8"}) == "");
    CHECK(missing(message_of([&] { ModalDynamics<double, 1>(system, rest(7), basis); }),
                  {"ModalDynamics", "7 particles", "8"}) == "");
    CHECK((modal.amplitudes() == before).all());
    // A buckled mode grows until it overflows: reported, and taken back.
    auto buckled = basis;
    buckled.k[0] = -4;
    ModalDynamics<double, 1> growing(system, rest(size), buckled);
    growing.set_state(draw_state(random));
    const Eigen::ArrayXd start = growing.amplitudes();
    CHECK(growing.step(1, 1000).status == taut::Status::diverged);
    CHECK((growing.amplitudes() == start).all());
    CHECK(growing.time() == 0);
}

TEMPLATE_TEST_CASE(
    "modal_dynamics: at rest, and in modes that are nearly zero, nothing is denormal", "[modal]",
    float, double) {
    const auto chain = taut::chain<double, 1>({6, taut::ChainEnds::fixed_free, 2, 50});
    const auto pose = chain.initial_state();
    const auto linear = taut::linearize(chain, pose);
    auto basis = dense_basis(linear, 6);
    basis.d.setConstant(3);
    basis.shapes.row(2) *= 1e-30;
    ModalDynamics<TestType, 1> modal(linear, {pose.x, pose.v}, basis);
    auto state = modal.state();
    state.v.setConstant(1);
    modal.set_state(state);
    const auto normal = [](TestType v) { return v == 0 || std::isnormal(v); };
    for (int i = 0; i < 1000; ++i) {
        REQUIRE(modal.step(1));
        modal.velocities(state.v);
        REQUIRE(std::all_of(state.v.data(), state.v.data() + state.v.size(), normal));
    }
    CHECK((state.v.array() == 0).all());
}

}  // namespace taut_test::modal_dynamics_test
