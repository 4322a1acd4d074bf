// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <limits>

#include "../core/types.hpp"
#include "../model/damping.hpp"
#include "../model/tangent_matrix.hpp"

namespace taut {

/// A computed number and a bound on its rounding error.
struct Enclosed {
    double value = 0;
    double error = 0;

    double lower() const { return value - error; }
    double upper() const { return value + error; }
};

/// M, D, K of the free degrees of freedom, as the analysis needs them: in double, from springs or
/// from matrices. K⁺ is K without negative transverse stiffness where springs are behind it [T27];
/// for bare matrices K⁺ = K. A Combination is S = mass·M + stiffness·K⁺ (or K) + damping·D.
class Pencil {
public:
    virtual ~Pencil() = default;

    /// N, degrees of freedom.
    Index size() const { return mass_.size(); }
    /// N, kg: the diagonal of M.
    const Eigen::VectorXd& mass() const { return mass_; }

    /// y ← S u.
    virtual void multiply(const Combination& c, const Eigen::VectorXd& u,
                          Eigen::VectorXd& y) const = 0;
    /// uᵀS u with its rounding error.
    virtual Enclosed quadratic(const Combination& c, const Eigen::VectorXd& u) const = 0;
    /// A proved upper bound on the largest eigenvalue of M⁻¹S, rounding included [T26]. For springs it
    /// is never below c.mass + c.damping·d0.
    virtual double upper_bound(const Combination& c) const = 0;
    /// S as a sparse matrix, both triangles.
    virtual Eigen::SparseMatrix<double> assemble(const Combination& c) const = 0;

    /// Whether K (not K⁺) is known to be positive semi-definite.
    virtual bool stiffness_semidefinite() const = 0;
    /// Whether D is known to be positive semi-definite.
    virtual bool damping_semidefinite() const = 0;
    /// Whether D = d0·M + αK⁺ exactly, so that M, D and K⁺ share their eigenvectors [T13].
    virtual bool is_rayleigh() const = 0;
    const RayleighDamping& rayleigh() const { return rayleigh_; }

protected:
    Eigen::VectorXd mass_;       // N, kg
    RayleighDamping rayleigh_;   // the Rayleigh part of D
};

}  // namespace taut
