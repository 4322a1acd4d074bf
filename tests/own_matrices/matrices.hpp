// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <taut/conditions/method.hpp>
#include <taut/proof/pencil.hpp>
#include <taut/proof/step_limit.hpp>

#include "../support/referee.hpp"
#include "../support/scene.hpp"

// What the library makes of matrices and of linearised scenes, compiled once.

namespace taut_test::own_matrices {

enum class Digits { of_float, of_double, of_long_double };

/// M, D, K and load, rounded to `digits`.
struct Matrices {
    RealVector mass;
    RealMatrix D;  ///< 0 × 0: none
    RealMatrix K;
    RealVector load;
    Digits digits = Digits::of_double;

    Matrices(const RealVector& mass, const RealMatrix& D, const RealMatrix& K,
             Digits digits = Digits::of_double, const RealVector& load = {});
    Exact exact() const { return {mass, K, K, D.size() > 0 ? D : RealMatrix(0 * K)}; }
};

/// A LinearSystem or GeneralLinearSystem of float or double.
struct AnyLinear {
    Eigen::MatrixXd stiffness, damping;
    Eigen::VectorXd load, inverse_mass;
    std::uint64_t revision;
    AnyState start;
    std::function<Eigen::VectorXd(const AnyState&)> force;
    std::function<double(const AnyState&)> energy;
    std::function<AnyState(const AnyState&)> to_free;
    std::function<void(const AnyState&, AnyState&)> from_free;
};
AnyLinear linear_system(const Matrices& matrices);
AnyLinear general_system(const Matrices& matrices);
/// Of a plain scene.
AnyLinear linearized(const Scene& scene, const AnyState& pose);

using AnyPencil = std::shared_ptr<const taut::Pencil>;
AnyPencil pencil_of(const Matrices& matrices);
taut::StepLimit<double> limit_of(const Matrices& matrices, taut::Method method, double tightness);

}  // namespace taut_test::own_matrices
