// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/conditions/mode.hpp>
#include <taut/tradeoff/mode_probe.hpp>

#include "../support/catch.hpp"
#include "../support/faults.hpp"
#include "../support/message.hpp"
#include "../support/methods.hpp"
#include "../support/random.hpp"

namespace taut_test::accuracy_test {

using taut::accurate_step;
using taut::Candidate;
using taut::Method;
using taut::mode_error;
using taut::ModeTolerance;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Steps of a stepper on one mass and one spring, seen as a swing about rest. The spring is far
/// longer than the swing, so it is linear to rounding.
template <class System>
std::optional<taut::ModeError> measured(const System& system, double omega, double zeta, double h,
                                        Method method) {
    const Candidate candidate{method, h};
    const auto rest = system.initial_state();
    Eigen::VectorXd swing(40);
    taut::with_stepper(system, candidate, [&](auto& stepper) {
        auto state = rest;
        state.x(0, 0) += 1e-3;
        // Past BDF2's second multiplier; others would only lose digits.
        REQUIRE(stepper.step(state, h, method == Method::bdf2 ? 40 : 1));
        for (Index j = 0; j < swing.size(); ++j) {
            swing[j] = state.x(0, 0) - rest.x(0, 0);
            REQUIRE(stepper.step(state, h));
        }
    });
    const auto mu = taut::tradeoff_detail::fitted_multiplier(swing);
    if (!mu) return std::nullopt;
    const auto rate = std::log(*mu) / h;
    return taut::ModeError{-rate.real() / std::abs(rate) - zeta,
                           omega * std::sqrt(1 - zeta * zeta) / rate.imag() - 1};
}

}  // namespace

TEST_CASE("accuracy: at small steps the errors of the theory [T25]", "[accuracy]") {
    struct Term {
        Method method;
        double damping, damping_power, period;
    };
    const Term terms[] = {{Method::explicit_euler, -0.5, 1, 1.0 / 3},
                          {Method::symplectic_euler, 0, 1, -1.0 / 24},
                          {Method::velocity_verlet, 0, 1, -1.0 / 24},
                          {Method::implicit_euler, 0.5, 1, 1.0 / 3},
                          {Method::bdf2, 0.25, 3, 1.0 / 3},
                          {Method::energy_stable_euler, 0.5, 1, -1.0 / 6}};
    CHECK(std::size(terms) == all_methods.size());
    for (const Term& term : terms) {
        for (const double z : {1e-4, 1e-3, 1e-2}) {
            INFO(name(term.method) << ", z = " << z);
            const auto error = mode_error(term.method, z);
            const double scale = std::pow(z, term.damping_power);
            CHECK_THAT(error.artificial_damping,
                       WithinAbs(term.damping * scale, z * z * scale + 1e-15));
            CHECK_THAT(error.period_error, WithinAbs(term.period * z * z, z * z * z));
        }
    }
}

TEST_CASE("accuracy: where a step turns the pair real, the larger multiplier is what is seen",
          "[accuracy]") {
    int real = 0;
    for (double z = 0.05; z < 6; z += 0.05) {
        for (double zeta = 0; zeta < 1; zeta += 0.09) {
            const auto check = [&](Method method, double ratio) {
                // μ² − (2 − b)μ + (1 − hd) = 0.
                const double b = z * (2 * ratio + z), constant = 1 - 2 * ratio * z;
                const double under = (2 - b) * (2 - b) / 4 - constant;
                if (under <= 1e-9 || std::abs(b - 2) < 1e-9) return;
                const double middle = 1 - b / 2;
                const double mu = middle + std::copysign(std::sqrt(under), middle);
                const double decay = -std::log(std::abs(mu)), phase = mu < 0 ? std::acos(-1.0) : 0;
                INFO(name(method) << ", z " << z << ", zeta " << zeta);
                CHECK_THAT(mode_error(method, z, zeta).artificial_damping,
                           WithinAbs(decay / std::hypot(decay, phase) - zeta, 1e-9));
                ++real;
            };
            check(Method::symplectic_euler, zeta);
            check(Method::velocity_verlet, zeta);
            check(Method::energy_stable_euler, zeta + z / 2);
        }
    }
    CHECK(real > 1000);
}

TEST_CASE("accuracy: predicted against measured on one mass and one spring", "[accuracy]") {
    Random random(902);
    for (int repeat = 0; repeat < 60; ++repeat) {
        const double stiffness = std::exp2(random.uniform(-3, 14));
        const double omega = std::sqrt(stiffness / 0.5);
        const double zeta = repeat % 3 == 0 ? 0 : random.uniform(0.01, 0.6);
        taut::SpringSystem<double, 1> system;
        using Vector = Eigen::Matrix<double, 1, 1>;
        system.add_particle(Vector(10), 0.5);
        system.add_particle(Vector(0), 1);
        system.pin(1);
        system.add_spring(0, 1, stiffness, 2 * zeta * omega * 0.5);
        const double z = std::exp2(random.uniform(-5, -1));
        for (const Method method : all_methods) {
            INFO(name(method) << ", z = " << z << ", zeta = " << zeta);
            // Damped by h besides, it may not swing at all.
            if (method == Method::energy_stable_euler && zeta + z > 0.95) continue;
            const auto seen = measured(system, omega, zeta, z / omega, method);
            REQUIRE(seen);
            const auto predicted = mode_error(method, z, zeta);
            // Ten per cent is what is promised; what is left here is the rounding of x.
            CHECK_THAT(seen->artificial_damping,
                       WithinAbs(predicted.artificial_damping,
                                 1e-3 * std::abs(predicted.artificial_damping) + 1e-7));
            CHECK_THAT(
                seen->period_error,
                WithinAbs(predicted.period_error, 1e-3 * std::abs(predicted.period_error) + 1e-7));
        }
    }
}

TEST_CASE("accuracy: accurate_step is the last step within tolerance", "[accuracy]") {
    Random random(903);
    for (int repeat = 0; repeat < 100; ++repeat) {
        ModeTolerance tolerance;
        tolerance.damping_ratio = std::exp2(random.uniform(-14, -1));
        tolerance.period = std::exp2(random.uniform(-14, -1));
        if (repeat % 5 == 1) tolerance.damping_ratio = infinity;
        if (repeat % 5 == 2) tolerance.period = infinity;
        const double omega = std::exp2(random.uniform(-4, 12));
        const double zeta = repeat % 2 == 0 ? 0 : random.uniform(0, 0.5);
        for (const Method method : all_methods) {
            INFO(name(method) << ", damping " << tolerance.damping_ratio << ", period "
                              << tolerance.period << ", zeta = " << zeta);
            const double h = accurate_step(method, tolerance, omega, zeta);
            REQUIRE(h > 0);
            const auto admitted = [&](double z) {
                const auto error = mode_error(method, z, zeta);
                return std::abs(error.artificial_damping) <= tolerance.damping_ratio &&
                       std::abs(error.period_error) <= tolerance.period;
            };
            for (int part = 1; part <= 50; ++part)
                CHECK(admitted(h * omega * (1 - 1e-9) * part / 50));
            CHECK_FALSE(admitted(h * omega * (1 + 1e-9)));
            CHECK_THAT(accurate_step(method, tolerance, 2 * omega, zeta), WithinRel(h / 2, 1e-12));
        }
    }
    CHECK(accurate_step(Method::implicit_euler, {1, infinity}, 100) == infinity);
}

TEST_CASE("accuracy: no floating-point trap is sprung", "[accuracy]") {
    for (const double k : {0.0, 1.0, 1e6}) {
        for (const double d : {0.0, 0.5, 2.0}) {
            for (const Method method : all_methods) {
                CAPTURE(k, d, taut::name(method));
                CHECK(faults_of([&] { taut::critical_step(method, k, d); }) == 0);
                if (method != Method::bdf2) {  // which has three
                    CHECK(faults_of([&] { taut::multipliers(method, k, d, 1e-3); }) == 0);
                }
                CHECK(faults_of([&] { accurate_step(method, {}, 10, 0.01); }) == 0);
            }
        }
    }
}

TEST_CASE("accuracy: wrong input is named", "[accuracy]") {
    using taut_test::missing;
    CHECK(missing(message_of([] { (void)mode_error(Method::bdf2, 0); }), {"z is 0", "> 0"}) == "");
    CHECK(missing(message_of([] { (void)mode_error(Method::bdf2, 1, 1); }), {"zeta is 1", "< 1"}) ==
          "");
    CHECK(missing(message_of([] { (void)accurate_step(Method::bdf2, {}, -1); }),
                  {"up_to_frequency is -1"}) == "");
    CHECK(missing(message_of([] {
                      (void)accurate_step(Method::bdf2, {0, 1}, 1);
                  }),
                  {"tolerance is 0"}) == "");
}

}  // namespace taut_test::accuracy_test
