// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "scene.hpp"

namespace taut_test {

/// M, K, K⁺ and D of a pose, dense and in double, pinned particles included; written from [T2] and
/// [T28] with nothing of the library's assembly in it.
struct DenseMatrices {
    Eigen::MatrixXd M, K, K_plus, D;
};
DenseMatrices dense_matrices(const Scene& scene, const AnyState& state);

/// The degrees of freedom of the free particles, ascending.
std::vector<Index> free_dofs(const Scene& scene);

/// The columns of a Dim × n matrix one below the other.
Eigen::VectorXd flat(const Eigen::MatrixXd& points);

/// Total force on every particle, one below the other.
Eigen::VectorXd flat_force(const Scene& scene, const AnyState& state);

/// −∂f/∂x (or −∂f/∂v) over all degrees of freedom by central differences of step h.
Eigen::MatrixXd difference_quotient(const Scene& scene, AnyState state, bool of_velocity, double h);

}  // namespace taut_test
