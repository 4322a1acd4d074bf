// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <limits>
#include <taut/own_matrices/linear_system.hpp>
#include <taut/model/spring_system.hpp>
#include <taut/own_matrices/own_matrices.hpp>

#include "../support/catch.hpp"
#include "../support/dense.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::linear_system_test {

using taut::GeneralLinearSystem;
using taut::LinearSystem;

namespace {

template <class Scalar>
using Dense = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

template <class Scalar>
taut::SparseMatrix<Scalar> sparse(const Dense<Scalar>& dense) {
    return dense.sparseView();
}

template <class Scalar>
Dense<Scalar> draw_matrix(Random& random, Index n) {
    return random.points<Scalar, 8>(n, -1, 1);
}

const Eigen::VectorXd mass = Eigen::Vector3d(1, 2, 4);
const Eigen::MatrixXd K = (Eigen::Matrix3d() << 3, -1, 0, -1, 3, -2, 0, -2, 3).finished();

/// What the constructor says about K with one entry replaced.
template <template <class> class System = LinearSystem>
std::string with_entry(Index row, Index column, double value, bool as_damping = false) {
    Eigen::MatrixXd changed = K;
    changed(row, column) = value;
    return message_of([&] {
        if (as_damping) System<double>(mass, sparse<double>(changed), sparse<double>(K));
        if (!as_damping) System<double>(mass, {}, sparse<double>(changed));
    });
}

}  // namespace

TEMPLATE_TEST_CASE("linear_system: force and energy are load - K u - D v and its potential",
                   "[model]", float, double) {
    Random random(1);
    const Dense<TestType> A = draw_matrix<TestType>(random, 8);
    const Dense<TestType> B = draw_matrix<TestType>(random, 8);
    const Dense<TestType> S = A + A.transpose();
    const Dense<TestType> BB = B + B.transpose();
    const auto m = random.vector<TestType, 8>(0.5, 2);
    const auto load = random.vector<TestType, 8>(-1, 1);
    const LinearSystem<TestType> system(m, sparse<TestType>(BB), sparse<TestType>(S), load);
    auto u = system.initial_state();
    CHECK(u.x.isZero(0));
    CHECK(u.v.isZero(0));
    u.x = random.points<TestType, 1>(8, -1, 1);
    u.v = random.points<TestType, 1>(8, -1, 1);

    taut::Points<TestType, 1> f;
    system.force(u, f);
    const Dense<TestType> expected = load - S * u.x.transpose() - BB * u.v.transpose();
    CHECK(distance(f.transpose(), expected) <= Tolerance<TestType>::rounding * largest(expected));

    double energy = 0;
    for (int i = 0; i < 8; ++i) {
        energy += static_cast<double>(m[i] * u.v(i) * u.v(i) / 2 - load[i] * u.x(i));
        for (int j = 0; j < 8; ++j) energy += static_cast<double>(u.x(i) * S(i, j) * u.x(j) / 2);
    }
    CHECK_THAT(static_cast<double>(system.energy(u)),
               Catch::Matchers::WithinAbs(energy, Tolerance<TestType>::rounding * 10));
    CHECK(distance(system.inverse_mass().cwiseProduct(m), Eigen::VectorXd::Ones(8)) <=
          Tolerance<TestType>::rounding);
    CHECK(system.revision() == 0);
}

TEST_CASE("linear_system: an unsymmetric D or K is a GeneralLinearSystem's, with the same force",
          "[model]") {
    Random random(2);
    const Eigen::MatrixXd A = draw_matrix<double>(random, 8);
    const Eigen::MatrixXd B = draw_matrix<double>(random, 8);
    const GeneralLinearSystem<double> system(Eigen::VectorXd::Ones(8), sparse<double>(B),
                                             sparse<double>(A));
    auto u = system.initial_state();
    u.x = random.points<double, 1>(8, -1, 1);
    u.v = random.points<double, 1>(8, -1, 1);
    taut::Points<double, 1> f;
    system.force(u, f);
    CHECK(distance(f.transpose(), -A * u.x.transpose() - B * u.v.transpose()) <=
          Tolerance<double>::rounding * 10);
}

TEST_CASE("linear_system: no damping and no load mean zeros of the right size", "[model]") {
    const LinearSystem<double> system(mass, {}, sparse<double>(K));
    CHECK(system.damping().rows() == 3);
    CHECK(system.damping().cols() == 3);
    CHECK(system.damping().nonZeros() == 0);
    CHECK((system.load() == Eigen::Vector3d::Zero()));
}

TEMPLATE_TEST_CASE("linear_system: asymmetry of a few ulp is averaged, of many is refused",
                   "[model]", float, double) {
    const TestType ulp = std::numeric_limits<TestType>::epsilon();
    Dense<TestType> almost = K.cast<TestType>();
    almost(0, 1) *= 1 + 4 * ulp;
    const LinearSystem<TestType> system(mass.cast<TestType>(), sparse<TestType>(almost),
                                        sparse<TestType>(almost));
    for (const auto* A : {&system.stiffness(), &system.damping()}) {
        const Dense<TestType> kept(*A);
        CHECK((kept == kept.transpose()));
        CHECK(kept(0, 1) == almost(1, 0) * (1 + 2 * ulp));
        CHECK(kept(1, 2) == almost(1, 2));
    }
    almost(0, 1) = almost(1, 0) * (1 + 1000 * ulp);
    CHECK(missing(message_of([&] {
                      LinearSystem<TestType>(mass.cast<TestType>(), {}, sparse<TestType>(almost));
                  }),
                  {"stiffness", "symmetric", "GeneralLinearSystem"}) == "");
}

TEMPLATE_TEST_CASE("linear_system: each pair of entries is judged by its own rows", "[model]",
                   float, double) {
    const TestType ulp = std::numeric_limits<TestType>::epsilon();
    Random random(4);
    for (int repeat = 0; repeat < 200; ++repeat) {
        // Stiff and soft rows beside each other, some of them coupled.
        const Dense<TestType> A = draw_matrix<TestType>(random, 8);
        Dense<TestType> S = A + A.transpose();
        for (Index i = 0; i < 8; ++i) {
            const auto scale = static_cast<TestType>(log_uniform(random, 1e-6, 1e6));
            S.row(i) *= scale;
            S.col(i) *= scale;
        }
        S = S.template triangularView<Eigen::Lower>();
        S += Dense<TestType>(S.transpose());
        const Index i = random.below(8);
        const Index j = (i + 1 + random.below(7)) % 8;
        const TestType own =
            std::min(S.row(i).cwiseAbs().maxCoeff(), S.row(j).cwiseAbs().maxCoeff());
        const auto accepted = [&](TestType asymmetry, bool as_damping) {
            Dense<TestType> changed = S;
            changed(i, j) += asymmetry * own;
            const auto one = Eigen::Matrix<TestType, 8, 1>::Ones().eval();
            return message_of([&] {
                       if (as_damping) {
                           LinearSystem<TestType>(one, sparse<TestType>(changed),
                                                  sparse<TestType>(S));
                       } else {
                           LinearSystem<TestType>(one, {}, sparse<TestType>(changed));
                       }
                   })
                .empty();
        };
        INFO("matrix " << repeat << ", (" << i << ", " << j << ")");
        for (const bool as_damping : {false, true}) {
            CHECK(accepted(0, as_damping));
            CHECK(accepted(8 * ulp, as_damping));
            CHECK_FALSE(accepted(64 * ulp, as_damping));
            CHECK_FALSE(accepted(TestType(0.1), as_damping));
        }
    }
    // A circulatory block that a stiff neighbour hid.
    Dense<TestType> hiding = Dense<TestType>::Zero(3, 3);
    hiding(0, 0) = TestType(1e12);
    hiding.bottomRightCorner(2, 2) << TestType(1e-6), TestType(1e-4), TestType(-1e-4),
        TestType(1e-6);
    CHECK(missing(message_of([&] {
                      LinearSystem<TestType>(mass.cast<TestType>(), {}, sparse<TestType>(hiding));
                  }),
                  {"stiffness", "symmetric", "(2, 1)", "(1, 2)"}) == "");
}

TEST_CASE("linear_system: exactly symmetric matrices are kept to the bit", "[model]") {
    Random random(3);
    const Eigen::MatrixXd A = draw_matrix<double>(random, 8);
    const Eigen::MatrixXd S = A + A.transpose();
    const LinearSystem<double> system(Eigen::VectorXd::Ones(8), sparse<double>(S),
                                      sparse<double>(S));
    CHECK((Eigen::MatrixXd(system.stiffness()) == S));
    CHECK((Eigen::MatrixXd(system.damping()) == S));
}

TEST_CASE("linear_system: bad input: an asymmetric K or D is refused with the entry named",
          "[model][bad_input]") {
    CHECK(missing(with_entry(2, 1, -2.5),
                  {"stiffness", "(2, 1)", "(1, 2)", "-2.5", "-2", "symmetric"}) == "");
    CHECK(missing(with_entry(2, 1, -2.5, true),
                  {"damping", "(2, 1)", "(1, 2)", "-2.5", "symmetric"}) == "");
    // One triangle alone, as symmetric Matrix Market files store it.
    CHECK(missing(with_entry(0, 2, 0.5), {"stiffness", "0.5", "symmetric"}) == "");
    CHECK(with_entry<GeneralLinearSystem>(2, 1, -2.5) == "");
    CHECK(with_entry<GeneralLinearSystem>(2, 1, -2.5, true) == "");
}

TEST_CASE("linear_system: bad input: entries that are not finite", "[model][bad_input]") {
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        CHECK(missing(with_entry(1, 1, bad), {"stiffness(1, 1)", "finite"}) == "");
        CHECK(missing(with_entry(1, 1, bad, true), {"damping(1, 1)", "finite"}) == "");
        CHECK(missing(with_entry<GeneralLinearSystem>(0, 1, bad), {"stiffness(0, 1)", "finite"}) ==
              "");
        Eigen::VectorXd load = mass;
        load[2] = bad;
        CHECK(missing(message_of([&] { LinearSystem<double>(mass, {}, sparse<double>(K), load); }),
                      {"load[2]", "finite"}) == "");
    }
}

TEST_CASE("linear_system: bad input: M not positive", "[model][bad_input]") {
    for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
        Eigen::VectorXd m = mass;
        m[1] = bad;
        CHECK(missing(message_of([&] { LinearSystem<double>(m, {}, sparse<double>(K)); }),
                      {"mass[1] is ", "finite and > 0"}) == "");
        CHECK(missing(message_of([&] { GeneralLinearSystem<double>(m, {}, sparse<double>(K)); }),
                      {"mass[1] is ", "finite and > 0"}) == "");
    }
    CHECK(missing(message_of([&] { LinearSystem<double>({}, {}, {}); }), {"mass is empty"}) == "");
}

TEST_CASE("linear_system: bad input: a mass whose inverse is not finite", "[model][bad_input]") {
    Eigen::VectorXd m = mass;
    m[1] = std::numeric_limits<double>::denorm_min();
    CHECK(missing(message_of([&] { LinearSystem<double>(m, {}, sparse<double>(K)); }),
                  {"mass[1] is "}) == "");
}

TEST_CASE("linear_system: bad input: shapes", "[model][bad_input]") {
    using Matrix = taut::SparseMatrix<double>;
    const auto good = sparse<double>(K);
    CHECK(missing(message_of([&] { LinearSystem<double>(mass, {}, Matrix(2, 2)); }),
                  {"stiffness is 2 by 2", "3 by 3"}) == "");
    CHECK(missing(message_of([&] { LinearSystem<double>(mass, {}, Matrix(3, 2)); }),
                  {"stiffness is 3 by 2", "3 by 3"}) == "");
    CHECK(missing(message_of([&] { LinearSystem<double>(mass, {}, Matrix()); }),
                  {"stiffness is 0 by 0"}) == "");
    CHECK(missing(message_of([&] { LinearSystem<double>(mass, Matrix(4, 4), good); }),
                  {"damping is 4 by 4", "3 by 3"}) == "");
    CHECK(missing(message_of([&] { LinearSystem<double>(mass, {}, good, Eigen::Vector2d(1, 2)); }),
                  {"load has 2", "3"}) == "");

    const LinearSystem<double> system(mass, {}, good);
    taut::State<double, 1> u{taut::State<double, 1>::zero(2), taut::State<double, 1>::zero(3), 0};
    taut::Points<double, 1> f;
    CHECK(missing(message_of([&] { system.force(u, f); }), {"2 positions", "3 velocities"}) == "");
    CHECK(missing(message_of([&] { static_cast<void>(system.energy(u)); }), {"2 positions"}) == "");
}

TEST_CASE("diagonal_mass: takes the diagonal and names what is off it", "[model][bad_input]") {
    using Matrix = taut::SparseMatrix<double>;
    Eigen::MatrixXd M = mass.asDiagonal();
    CHECK((taut::diagonal_mass(sparse<double>(M)) == mass));

    Matrix stored_zero = sparse<double>(M);
    stored_zero.insert(0, 1) = 0;
    CHECK((taut::diagonal_mass(stored_zero) == mass));

    M(0, 2) = 0.5;
    CHECK(missing(message_of([&] { taut::diagonal_mass(sparse<double>(M)); }),
                  {"diagonal_mass", "M(0, 2) is 0.5", "diagonal"}) == "");
    CHECK(missing(message_of([&] { taut::diagonal_mass(Matrix(3, 2)); }),
                  {"diagonal_mass", "3 by 2", "square"}) == "");
    // A missing diagonal entry is a mass of zero, which the system refuses.
    CHECK(missing(message_of([&] {
                      LinearSystem<double>(taut::diagonal_mass(Matrix(3, 3)), {},
                                           sparse<double>(K));
                  }),
                  {"mass[0] is 0"}) == "");
}

TEMPLATE_TEST_CASE("linear_system: to_free and from_free are each other's inverse", "[model]",
                   (Case<float, 3>), (Case<double, 1>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(4);
    auto system = random_system<Scalar, Dim>(random, {8, 14, 0});
    system.pin(2);
    system.pin(5);
    const auto pose = random_state(random, system);
    auto state = random_state(random, system);
    state.time = 3;
    const auto linear = taut::linearize(system, pose);
    CHECK(linear.size() == Dim * 6);

    const auto u = linear.to_free(state);
    CHECK(u.time == 3);
    CHECK(linear.to_free(pose).x.isZero(0));
    auto back = random_state(random, system);
    const auto pinned_x = back.x.col(5).eval();
    const auto pinned_v = back.v.col(2).eval();
    linear.from_free(u, back);
    CHECK(back.time == 3);
    CHECK((back.x.col(5) == pinned_x));
    CHECK((back.v.col(2) == pinned_v));
    for (const Index i : {0, 1, 3, 4, 6, 7}) {
        CHECK(distance(back.x.col(i), state.x.col(i)) <= Tolerance<Scalar>::rounding);
        CHECK((back.v.col(i) == state.v.col(i)));
    }
}

TEMPLATE_TEST_CASE(
    "linear_system: a linearised system has the spring system's force, to first order", "[model]",
    (Case<double, 2>), (Case<double, 3>)) {
    constexpr int Dim = TestType::Dim;
    Random random(5);
    RandomOptions options;
    options.rayleigh = true;
    const auto system = random_system<double, Dim>(random, options);
    auto state = random_state(random, system);
    state.v.setZero();
    const auto linear = taut::linearize(system, state);
    const auto free = free_dofs(system);
    const auto error = [&](double size) {
        Random again(6);
        auto moved = state;
        for (Index i = 0; i < system.size(); ++i) {
            if (system.is_pinned(i)) continue;
            moved.x.col(i) += size * again.template vector<double, Dim>(-1, 1);
            moved.v.col(i) += size * again.template vector<double, Dim>(-1, 1);
        }
        taut::Points<double, 1> f;
        linear.force(linear.to_free(moved), f);
        return distance(f.transpose(), Eigen::VectorXd(flat_force(system, moved)(free)));
    };
    CHECK(error(1e-4) < 1e-2);
    // Second order: a tenth of the displacement leaves a hundredth of the error.
    CHECK(error(1e-5) < 0.02 * error(1e-4) + Tolerance<double>::difference * 1e-4);
}

TEST_CASE("linear_system: bad input: to_free and from_free of the wrong system or size",
          "[model][bad_input]") {
    Random random(7);
    const auto system = random_system<double, 2>(random);
    const auto linear = taut::linearize(system, system.initial_state());
    const LinearSystem<double> own(mass, {}, sparse<double>(K));
    auto state = system.initial_state();
    CHECK(missing(message_of([&] { static_cast<void>(own.to_free(state)); }),
                  {"not linearised from a SpringSystem of dimension 2"}) == "");
    const taut::State<double, 3> wrong_dim{taut::State<double, 3>::zero(8),
                                           taut::State<double, 3>::zero(8), 0};
    CHECK(missing(message_of([&] { static_cast<void>(linear.to_free(wrong_dim)); }),
                  {"dimension 3"}) == "");

    const auto u = linear.to_free(state);
    const auto before = state;
    state.x.conservativeResize(2, 7);
    CHECK(missing(message_of([&] { static_cast<void>(linear.to_free(state)); }),
                  {"7 positions", "8 velocities", "8 particles"}) == "");
    CHECK(missing(message_of([&] { linear.from_free(u, state); }),
                  {"7 positions", "8 particles"}) == "");
    CHECK((state.x == before.x.leftCols(7)));
}

}  // namespace taut_test::linear_system_test
