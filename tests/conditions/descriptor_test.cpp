// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// The battery that every descriptor must pass: its parts agree with the matrix of its step, and
// that one with the motion itself.
#include <taut/accuracy/detail/multiplier.hpp>
#include <taut/conditions/mode.hpp>
#include <taut/tight/detail/step_matrix.hpp>

#include "../support/catch.hpp"
#include "../support/decompositions.hpp"
#include "../support/message.hpp"
#include "../support/random.hpp"

namespace taut_test::descriptor_test {

namespace {

using Complex = std::complex<double>;
using Descriptors = decltype(taut::method::as_tuple(taut::method::All{}));

/// The multipliers of one mode: in the coordinates (√|k| x, v), by the step's matrix.
template <class Descriptor>
Eigen::VectorXcd multipliers(double k, double d, double h) {
    const double root = std::sqrt(std::abs(k));
    Eigen::MatrixXd C(2, 2);
    C << 0, root, k < 0 ? root : -root, -d;
    const Eigen::MatrixXd step = taut::method::step_matrix(Descriptor{}, C, h, 1);
    return general_eigenvalues(step.cast<Real>()).cast<Complex>();
}

template <class Descriptor>
double radius(double k, double d, double h) {
    return multipliers<Descriptor>(k, d, h).cwiseAbs().maxCoeff();
}

/// visit(k, d): undamped, light, overdamped.
template <class Visit>
void for_each_mode(std::uint32_t seed, Visit&& visit) {
    Random random(seed);
    for (int repeat = 0; repeat < 300; ++repeat) {
        const double k = log_uniform(random, 1e-3, 1e6);
        visit(k, 0.0);
        visit(k, 2 * std::sqrt(k) * log_uniform(random, 1e-3, 0.9));
        visit(k, 2 * std::sqrt(k) * log_uniform(random, 1.1, 1e2));
    }
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("descriptor: multipliers are those of the step's matrix", "[conditions]",
                        Descriptors) {
    Random random(520);
    for_each_mode(521, [&](double k, double d) {
        const double h = log_uniform(random, 1e-3, 1e2) / (std::sqrt(k) + d);
        INFO(TestType::name << ", k = " << k << ", d = " << d << ", h = " << h);
        const Eigen::VectorXcd mu = multipliers<TestType>(k, d, h);
        const double largest = mu.cwiseAbs().maxCoeff();
        // Where two of them meet, they move by the root of a rounding.
        CHECK_THAT(TestType::spectral_radius(k, d, h), WithinRel(largest, 1e-5));
        CHECK(taut::spectral_radius(TestType::method, k, d, h) ==
              TestType::spectral_radius(k, d, h));
        if constexpr (taut::method::is_absent_v<decltype(TestType::step_quadratic)>) {
            const auto refused =
                message_of([&] { (void)taut::multipliers(TestType::method, k, d, h); });
            CHECK(missing(refused, {TestType::name}) == "");
        } else {
            for (const Complex& root : taut::multipliers(TestType::method, k, d, h))
                CHECK((mu.array() - root).abs().minCoeff() <= 1e-5 * std::max(1.0, largest));
        }
    });
}

TEMPLATE_LIST_TEST_CASE("descriptor: the mode's error is that of one of these, of its order",
                        "[conditions]", Descriptors) {
    Random random(901);
    for (int repeat = 0; repeat < 500; ++repeat) {
        const double z = std::exp2(random.uniform(-12, 3));
        const double zeta = random.uniform(0, 0.99);
        INFO(TestType::name << ", z = " << z << ", zeta = " << zeta);
        const Complex mu = 1.0 + taut::method::multiplier_less_one(TestType{}, z, zeta);
        const Eigen::VectorXcd known = multipliers<TestType>(1, 2 * zeta, z);
        CHECK((known.array() - mu).abs().minCoeff() < 1e-6);
        CHECK_THAT(std::abs(mu), WithinAbs(known.cwiseAbs().maxCoeff(), 1e-6));
    }
    for (const double z : {1e-1, 1e-2, 1e-3}) {
        const Complex less_one = std::exp(Complex(0, z)) - 1.0;
        CHECK(std::abs(taut::method::multiplier_less_one(TestType{}, z, 0) - less_one) <=
              std::pow(z, TestType::order + 1));
    }
}

TEMPLATE_LIST_TEST_CASE("descriptor: stable just below the critical step, unstable just above",
                        "[conditions]", Descriptors) {
    for_each_mode(522, [&](double k, double d) {
        const double h = TestType::critical_step(k, d);
        INFO(TestType::name << ", k = " << k << ", d = " << d << ", h = " << h);
        CHECK(taut::critical_step(TestType::method, k, d) == h);
        if (h == 0) {
            CHECK(radius<TestType>(k, d, 1e-2 / std::sqrt(k)) > 1);
        } else if (std::isinf(h)) {
            CHECK(TestType::any_pose == taut::method::AnyPose::every_step);
            for (const double z : {1e-2, 1.0, 1e2})
                CHECK(radius<TestType>(k, d, z / (std::sqrt(k) + d)) <= 1 + 1e-12);
        } else {
            CHECK(radius<TestType>(k, d, h * (1 - 1e-6)) <= 1 + 1e-9);
            CHECK(radius<TestType>(k, d, h * (1 + 1e-6)) > 1);
        }
    });
}

TEMPLATE_LIST_TEST_CASE("descriptor: a buckled mode's multipliers pass a pole or -1 at its limit",
                        "[conditions]", Descriptors) {
    for_each_mode(523, [&](double kappa, double d) {
        const double h = TestType::critical_step(-kappa, d);
        INFO(TestType::name << ", k = " << -kappa << ", d = " << d << ", h = " << h);
        REQUIRE(h > 0);
        if (std::isinf(h)) return;
        const auto least = [&](double step) {
            return multipliers<TestType>(-kappa, d, step).real().minCoeff();
        };
        CHECK(least(h * (1 - 1e-6)) > -1);
        CHECK(least(h * (1 + 1e-6)) < -1);
    });
}

}  // namespace taut_test::descriptor_test
