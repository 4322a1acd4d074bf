// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/network/combination.hpp>
#include <vector>

#include "../support/scene.hpp"

namespace taut_test {

/// The kinds that the functions below know: every scalar, dimension and law is one's.
std::vector<Kind> tangent_kinds();
std::vector<Kind> linearized_kinds();

/// taut::linearize, of linearized_kinds() alone.
struct Linearization {
    Eigen::VectorXd mass, load;
    Eigen::MatrixXd K, D;
    Index entries;  ///< that K and D store
};
Linearization linearization(const Scene& scene, const AnyState& state);

/// TangentMatrix::assemble of each sum, all into one matrix.
std::vector<Eigen::MatrixXd> assembled(const Scene& scene, const AnyState& state,
                                       const std::vector<taut::Combination>& sums);

/// A taut::SpringTangent.
struct AnyTangent {
    Index a, b;
    Eigen::VectorXd d;
    double axial, transverse, bound, damping;
    double plus_axial, plus_transverse;  ///< of projected()
};
std::vector<AnyTangent> tangents(const Scene& scene, const AnyState& state);

}  // namespace taut_test
