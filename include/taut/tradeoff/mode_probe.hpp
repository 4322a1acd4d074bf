// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>
#include <vector>

#include "../mass_scaling/detail/low_modes.hpp"
#include "../own_matrices/linear_system.hpp"
#include "../proof/mode.hpp"
#include "../proof/pencil.hpp"
#include "../accuracy/accuracy.hpp"
#include "../recommend/candidate.hpp"

// The errors of accuracy.hpp, measured: a stepper is started in one mode and its swing is fitted.

namespace taut {

namespace tradeoff_detail {

/// The multiplier μ, Im μ ≥ 0, that evenly spaced samples of one swing follow: least squares on
/// a_{j+1} = t·a_j − q·a_{j−1} (R. de Prony, 1795). Nothing where the fit has real roots.
template <class Real = double>  // a template: only its callers compile the expressions
std::optional<std::complex<double>> fitted_multiplier(const VectorX<Real>& samples) {
    const Index rows = samples.size() - 2;
    if (rows < 2 || !detail::all_finite(samples)) return std::nullopt;
    // In ε = μ − 1, from second and first differences, so that slow swings lose no digits.
    const VectorX<Real> value = samples.segment(1, rows);
    const VectorX<Real> first = value - samples.head(rows);
    const VectorX<Real> second = samples.tail(rows) - value - first;
    // a_{j+1} − 2a_j + a_{j−1} = a(a_j − a_{j−1}) + b·a_j with q = 1 + a, t = 2 + a + b, by Gram
    // and Schmidt.
    const double share = value.dot(first) / value.squaredNorm();
    const VectorX<Real> rest = first - share * value;
    const double a = rest.dot(second) / rest.squaredNorm();
    const double b = value.dot(second - a * first) / value.squaredNorm();
    const double q = 1 + a;
    const double half = (2 + a + b) / 2;
    // q − half² without cancellation for slow swings.
    const double under = -b - (a + b) * (a + b) / 4;
    if (!(under > 0) || !detail::is_finite(q)) return std::nullopt;
    return std::complex<double>(half, std::sqrt(under));
}

}  // namespace tradeoff_detail

/// Up to `count` of the lowest modes above the zero modes at a pose, K⁺ for K, ascending.
/// Dense eigenvectors for small scenes, Krylov vectors for large ones: numerical, no proof.
template <class Scalar, int Dim, class... Laws>
std::vector<Mode> lowest_modes(const SpringSystem<Scalar, Dim, Laws...>& system,
                               const State<Scalar, Dim>& state, Index count) {
    const auto pencil = Pencil::at_pose(system, state.x.template cast<TangentReal<Scalar>>());
    std::vector<Mode> modes;
    const Eigen::MatrixXd shapes = proof_detail::low_modes(pencil);
    Eigen::VectorXd y;
    for (Index j = 0; j < std::min<Index>(count, shapes.cols()); ++j) {
        Mode mode;
        mode.shape = shapes.col(j);
        pencil.multiply(matrices::K_plus, mode.shape, y);
        mode.k = mode.shape.dot(y);
        pencil.multiply(matrices::D, mode.shape, y);
        mode.d = mode.shape.dot(y);
        modes.push_back(std::move(mode));
    }
    return modes;
}

/// What the steps of `candidate` do to one mode of a linear system without load: started in the
/// mode's shape, its swing is projected on the mode and fitted. Nothing where a step fails or the
/// steps do not swing. EnergyStableEuler, which needs springs, is symplectic Euler with D + hK.
/// @param most_steps  the swing is followed for less than a period where that would take more
template <class Scalar>
std::optional<ModeError> measured_mode_error(const LinearSystem<Scalar>& system, const Mode& mode,
                                             const Candidate& candidate, Index most_steps = 4000) {
    constexpr Index samples = 26;
    constexpr Index settling = 40;  // the second multiplier of BDF2 shrinks by 3 and more a step
    if (candidate.method == Method::energy_stable_euler) {
        const auto alpha = static_cast<Scalar>(candidate.h);
        return measured_mode_error(
            LinearSystem<Scalar>(system.mass(), system.damping() + alpha * system.stiffness(),
                                 system.stiffness()),
            mode, {Method::symplectic_euler, candidate.h}, most_steps);
    }
    const auto h = static_cast<Scalar>(candidate.h);
    const double z = mode.omega() * static_cast<double>(h);
    const Index stride = std::clamp<Index>(static_cast<Index>(0.5 / z), 1,
                                           std::max<Index>(1, (most_steps - settling) / samples));
    const Eigen::VectorXd weights = system.mass().template cast<double>().cwiseProduct(mode.shape);
    Eigen::VectorXd swing(samples);
    bool alive = true;
    with_stepper(system, candidate, [&](auto& stepper) {
        auto state = system.initial_state();
        state.x = mode.shape.template cast<Scalar>().transpose();
        alive = static_cast<bool>(stepper.step(state, h, settling));
        for (Index j = 0; alive && j < samples; ++j) {
            swing[j] = weights.dot(state.x.transpose().template cast<double>());
            alive = static_cast<bool>(stepper.step(state, h, stride));
        }
    });
    if (!alive) return std::nullopt;
    const auto mu = tradeoff_detail::fitted_multiplier<double>(swing);
    if (!mu) return std::nullopt;
    const std::complex<double> rate = std::log(*mu) / (static_cast<double>(stride) * z);
    const double zeta = mode.zeta();
    const double frequency = std::sqrt((std::max)(0.0, (1 - zeta) * (1 + zeta)));
    const double ratio = -rate.real() / (std::abs)(rate);
    return ModeError{ratio - zeta, frequency / rate.imag() - 1};
}

}  // namespace taut
