// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "dense.hpp"

namespace taut_test {

/// What is left of an implicit Euler step's equation: r = M(v⁺ − v) − h f(x⁺) on the free degrees
/// of freedom, and what it is relative to.
struct Residual {
    Eigen::VectorXd r;  // N·s
    double scale = 0;   // N·s
    int iterations = 0;

    double relative() const { return scale > 0 ? r.norm() / scale : 0; }
};

/// Implicit Euler, solved: x⁺ minimises ‖x⁺ − x − hv‖²_M/(2h²) + U(x⁺), by dense Newton with a line
/// search. For undamped scenes of convex laws, pins at rest; nothing of the library's steppers.
template <class System>
Residual converged_step(const System& system, typename System::State& state, double h) {
    const auto free = free_dofs(system);
    const auto dofs = static_cast<Index>(free.size());
    const auto start = state;
    const auto dense = dense_matrices(system, start);
    const Eigen::VectorXd mass = dense.M.diagonal()(free);
    const Eigen::VectorXd x = flat(start.x)(free);
    const Eigen::VectorXd v = flat(start.v)(free);
    const auto place = [&](const Eigen::VectorXd& next) {
        for (Index j = 0; j < dofs; ++j) {
            state.x.data()[free[static_cast<std::size_t>(j)]] = next[j];
            state.v.data()[free[static_cast<std::size_t>(j)]] = (next[j] - x[j]) / h;
        }
    };
    const auto residual_at = [&](const Eigen::VectorXd& next) {
        place(next);
        const Eigen::VectorXd force = flat_force(system, state)(free);
        return Eigen::VectorXd(mass.cwiseProduct((next - x) / h - v) - h * force);
    };
    const auto objective = [&](const Eigen::VectorXd& next) {
        place(next);
        const Eigen::VectorXd off = next - x - h * v;
        return off.dot(mass.cwiseProduct(off)) / (2 * h * h) + system.potential_energy(state);
    };
    Residual result;
    Eigen::VectorXd next = x;
    result.r = residual_at(next);
    result.scale = result.r.norm() + mass.cwiseProduct(v).norm();
    for (; result.iterations < 500 && result.relative() > 1e-12; ++result.iterations) {
        place(next);
        const auto at = dense_matrices(system, state);
        Eigen::MatrixXd A = h * at.K(free, free);
        A.diagonal() += mass / h;
        const Eigen::VectorXd step = -A.ldlt().solve(result.r);
        const double value = objective(next);
        const double slope = result.r.dot(step) / h;
        double t = 1;
        Eigen::VectorXd trial = next + step;
        // Where the objective's differences drown in rounding, the residual's do not.
        while (t > 1e-12 && objective(trial) > value + 1e-4 * t * slope &&
               residual_at(trial).norm() > 0.5 * result.r.norm()) {
            t /= 2;
            trial = next + t * step;
        }
        if (!(t > 1e-12)) break;
        next = trial;
        result.r = residual_at(next);
    }
    place(next);
    state.time += h;
    return result;
}

}  // namespace taut_test
