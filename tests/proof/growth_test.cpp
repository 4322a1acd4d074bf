// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/integrator/implicit_euler.hpp>

#include "../support/catch.hpp"
#include "../support/proof_scenes.hpp"

// The predictions of Stability, simulated: bounded below certified, growing above refuted.

namespace taut_test::growth_test {

using taut::Method;

namespace {

/// The largest energy of 1000 steps, over that of the start.
template <class Stepper>
double largest_energy(const taut::LinearSystem<double>& linear, const Multipliers& multipliers,
                      double h) {
    Random random(7);
    Stepper stepper(linear);
    auto state = linear.initial_state();
    RealVector y(multipliers.step(Stepper::method, h).rows());
    for (Index i = 0; i < y.size(); ++i) y[i] = random.uniform(-1, 1);
    state.x = multipliers.position(y).template cast<double>().transpose();
    // A velocity without a zero mode in it: the one that the positions would have.
    y.reverseInPlace();
    state.v = multipliers.omega() * multipliers.position(y).template cast<double>().transpose();
    const double start = linear.energy(state);
    double largest = 0;
    for (int i = 0; i < 1000; ++i) {
        if (!stepper.step(state, h)) return std::numeric_limits<double>::infinity();
        largest = std::max(largest, linear.energy(state) / start);
    }
    return largest;
}

template <class Stepper>
void check_bounded(const StabilityCase& c, const taut::LinearSystem<double>& linear,
                   const Multipliers& multipliers) {
    const auto limit = c.analysis.max_step(Stepper::method);
    if (!(limit.certified > 0)) return;
    const double h = limit.unbounded() ? 10 / multipliers.omega() : 0.99 * limit.certified;
    CHECK(largest_energy<Stepper>(linear, multipliers, h) < 1e4);
}

/// Starts at 1.01·refuted along the critical eigenvector z and compares with Re μⁿz.
template <class Stepper, class Scalar>
void check_growth(const StabilityCase& c, const Matrices& matrices) {
    const double refuted = c.analysis.max_step(Stepper::method).refuted;
    if (!std::isfinite(refuted) || refuted == 0) return;
    const Exact e = exact_matrices(matrices);
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
    if (needed > (is_float ? 300 : 2e4)) return;  // the eigenvalue has decided
    const auto n = static_cast<Index>(std::ceil(needed));
    const ComplexVector z = modes.vectors.col(critical);
    const taut::LinearSystem<Scalar> linear = linear_system<Scalar>(matrices);
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
    const ComplexVector grown = std::pow(mu, static_cast<Real>(n)) * z;
    const RealVector measured =
        multipliers.reduced_position(state.x.transpose().template cast<Real>()) / scale;
    const RealVector expected = grown.real().head(measured.size());
    CHECK(static_cast<double>((measured - expected).norm() / grown.norm()) <
          (is_float ? 1e-2 : 1e-6));
    CHECK(std::pow(std::abs(mu), static_cast<Real>(n)) > 999);
}

template <class Scalar>
void check_all_growth(const StabilityCase& c, const Matrices& matrices) {
    using Linear = taut::LinearSystem<Scalar>;
    check_growth<taut::ExplicitEuler<Linear>, Scalar>(c, matrices);
    check_growth<taut::SymplecticEuler<Linear>, Scalar>(c, matrices);
    check_growth<taut::VelocityVerlet<Linear>, Scalar>(c, matrices);
}

}  // namespace

TEST_CASE("growth: unforced, the linearised scene stays bounded at 0.99 of certified", "[proof]") {
    for (const auto& c : stability_cases(false, true)) {
        if (c.exact.size() == 0) continue;
        const Multipliers multipliers(c.exact);
        if (multipliers.buckled()) continue;
        INFO(c.text);
        using Linear = taut::LinearSystem<double>;
        const Linear linear = linear_system<double>(linearized(c.scene, c.state));
        check_bounded<taut::ExplicitEuler<Linear>>(c, linear, multipliers);
        check_bounded<taut::SymplecticEuler<Linear>>(c, linear, multipliers);
        check_bounded<taut::VelocityVerlet<Linear>>(c, linear, multipliers);
        check_bounded<taut::ImplicitEuler<Linear>>(c, linear, multipliers);
    }
}

TEST_CASE("growth: at 1.01 of refuted the critical mode grows as |mu|^n", "[proof][slow]") {
    for (const bool single : {false, true}) {
        for (const auto& c : stability_cases(single, true)) {
            if (c.exact.size() == 0) continue;
            INFO(c.scene.kind() << ", " << c.text);
            const auto matrices = linearized(c.scene, c.state);
            single ? check_all_growth<float>(c, matrices) : check_all_growth<double>(c, matrices);
        }
    }
}

}  // namespace taut_test::growth_test
