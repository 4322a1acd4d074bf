// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/integrator/explicit_euler.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/integrator/velocity_verlet.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/stability/stability.hpp>

#include "../support/catch.hpp"
#include "../support/stability_scenes.hpp"

// The predictions of Stability, simulated: bounded below certified, growing above refuted.

namespace taut_test::stability_growth_test {

using taut::Method;

namespace {

template <class Stepper>
double largest_energy(const taut::LinearSystem<double>& linear, const Multipliers& multipliers,
                      double h, Index steps) {
    Random random(7);
    Stepper stepper(linear);
    auto state = linear.initial_state();
    const Index N = linear.size();
    RealVector y(multipliers.step(Stepper::method, h).rows());
    for (Index i = 0; i < y.size(); ++i) y[i] = random.uniform(-1, 1);
    state.x = multipliers.position(y).template cast<double>().transpose();
    // A velocity without a zero mode in it: the one that the positions would have.
    y.reverseInPlace();
    state.v = multipliers.omega() * multipliers.position(y).template cast<double>().transpose();
    const double start = linear.energy(state);
    double largest = 0;
    for (Index i = 0; i < steps; ++i) {
        if (!stepper.step(state, h)) return std::numeric_limits<double>::infinity();
        largest = std::max(largest, linear.energy(state) / start);
    }
    return N == 0 ? 0 : largest;
}

template <class Stepper>
void check_bounded(const StabilityCase<double>& c) {
    const Multipliers multipliers = c.multipliers();
    const auto limit = c.stability.max_step(Stepper::method);
    if (!(limit.certified > 0) || multipliers.buckled()) return;
    const double h = limit.unbounded() ? 10 / multipliers.omega() : 0.99 * limit.certified;
    CHECK(largest_energy<Stepper>(*c.linear, multipliers, h, 1000) < 1e4);
}

/// Starts at 1.01·refuted along the critical eigenvector z and compares with Re μⁿz.
template <class Stepper, class Scalar>
void check_growth(const StabilityCase<Scalar>& c) {
    const auto refuted = static_cast<double>(c.stability.max_step(Stepper::method).refuted);
    const auto& linear = *c.linear;
    if (!std::isfinite(refuted) || refuted == 0) return;
    const Exact e = exact_matrices(linear);
    const Multipliers multipliers(e);
    const auto step = static_cast<Scalar>(1.01 * refuted);
    const auto h = static_cast<double>(step);
    if (h * multipliers.omega() < 1e-6) return;  // |μ| − 1 is below rounding
    const auto modes = general_modes(multipliers.step(Stepper::method, h));
    Index critical = -1;
    Real physical = 1;
    for (Index j = 0; j < modes.values.size(); ++j) {
        const auto mu = modes.values[j];
        if (multipliers.physical(mu)) physical = std::max(physical, std::abs(mu));
        if (multipliers.physical(mu)) continue;
        if (critical < 0 || std::abs(mu) > std::abs(modes.values[critical])) critical = j;
    }
    REQUIRE(critical >= 0);
    const bool is_float = std::is_same_v<Scalar, float>;
    const std::complex<Real> mu = modes.values[critical];
    // The entries of a float K are rounded: the limit is that of the springs.
    if (is_float && std::abs(mu) < 1 + 1e-4L) return;
    CHECK(std::abs(mu) > 1);
    // Where the physics grows faster, rounding errors overtake the critical mode.
    if (physical > std::abs(mu)) return;
    const Real needed = std::log(Real(1e3)) / std::log(std::abs(mu));
    if (needed > (is_float ? 300 : 1e5)) return;  // the eigenvalue has decided
    const auto n = static_cast<Index>(std::ceil(needed));
    const ComplexVector z = modes.vectors.col(critical);
    auto state = linear.initial_state();
    const RealVector x = multipliers.position(z.real());
    RealVector v = multipliers.velocity(z.real());
    if (Stepper::method == Method::velocity_verlet) {
        // Its first kick is half of one: (I − ½hD')v = v_symplectic − hD'v_symplectic − ½hK'x.
        const Real half = static_cast<Real>(h) / 2;
        const RealVector inverse = e.mass.cwiseInverse();
        RealMatrix A = -half * (inverse.asDiagonal() * e.D);
        A.diagonal().array() += 1;
        const RealVector target = v - inverse.cwiseProduct(2 * half * (e.D * v) + half * (e.K * x));
        v = solve(A, target);
    }
    const Real scale = static_cast<Real>(multipliers.omega()) * 1e3L;
    state.x = (scale * x).template cast<Scalar>().transpose();
    state.v = (scale * v).template cast<Scalar>().transpose();
    Stepper stepper(linear);
    REQUIRE(stepper.step(state, step, n));
    const RealVector expected = (std::pow(mu, static_cast<Real>(n)) * z)
                                    .real()
                                    .head(multipliers.reduced_position(x).size());
    const RealVector measured =
        multipliers.reduced_position(state.x.transpose().template cast<Real>()) / scale;
    const Real size = (std::pow(mu, static_cast<Real>(n)) * z).norm();
    CHECK(static_cast<double>((measured - expected).norm() / size) < (is_float ? 1e-2 : 1e-6));
    CHECK(std::pow(std::abs(mu), static_cast<Real>(n)) > 999);
}

}  // namespace

TEST_CASE("stability: unforced, the linearised scene stays bounded at 0.99 of certified",
          "[stability][slow]") {
    for (const auto& c : stability_cases<double>(true)) {
        if (!c.linear) continue;
        INFO(c.text);
        using Linear = taut::LinearSystem<double>;
        check_bounded<taut::ExplicitEuler<Linear>>(c);
        check_bounded<taut::SymplecticEuler<Linear>>(c);
        check_bounded<taut::VelocityVerlet<Linear>>(c);
        check_bounded<taut::ImplicitEuler<Linear>>(c);
    }
}

TEMPLATE_TEST_CASE("stability: at 1.01 of refuted the critical mode grows as |mu|^n",
                   "[stability][slow]", double, float) {
    for (const auto& c : stability_cases<TestType>(true)) {
        if (!c.linear) continue;
        INFO(c.text);
        using Linear = taut::LinearSystem<TestType>;
        check_growth<taut::ExplicitEuler<Linear>>(c);
        check_growth<taut::SymplecticEuler<Linear>>(c);
        check_growth<taut::VelocityVerlet<Linear>>(c);
    }
}

}  // namespace taut_test::stability_growth_test
