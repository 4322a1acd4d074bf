// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "../core/error.hpp"
#include "../core/types.hpp"
#include "../model/damping.hpp"
#include "../model/tangent_matrix.hpp"

namespace taut {

/// A computed number and a bound on its rounding error.
struct Enclosed {
    double value = 0;
    double error = 0;

    /// The least that the exact number can be.
    double lower() const { return value - error; }
    /// The most that it can be.
    double upper() const { return value + error; }
};

/// How much of a mode's elastic energy one spring holds.
struct SpringShare {
    Index index = 0;  ///< of the spring, as SpringSystem counts them
    Index a = 0;      ///< its particles
    Index b = 0;
    double share = 0;  ///< 0 … 1; the shares of all springs add up to 1
};

/// How much of a mode's kinetic energy one particle holds.
struct ParticleShare {
    Index index = 0;
    double share = 0;  ///< 0 … 1
};

/// What tangents are computed in before they are taken to double: Scalar, but double for float.
template <class Scalar>
using TangentReal = std::conditional_t<std::is_same_v<Scalar, float>, double, Scalar>;

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
    /// Degrees of freedom of one particle; 1 where there are no particles.
    virtual int dim() const = 0;

    /// y ← S u.
    virtual void multiply(const Combination& c, const Eigen::VectorXd& u,
                          Eigen::VectorXd& y) const = 0;
    /// uᵀS u with its rounding error.
    virtual Enclosed quadratic(const Combination& c, const Eigen::VectorXd& u) const = 0;
    /// A proved upper bound on the largest eigenvalue of M⁻¹S, rounding included [T26]. For springs
    /// it is never below c.mass + c.damping·d0.
    /// @param enough  stop improving the bound once it is at most this
    virtual double upper_bound(const Combination& c, double enough = 0) const = 0;
    /// An ε ≥ 0, in the units of M⁻¹S, with S ⪰ −εM proved: by the bound, for bare matrices also by
    /// factorisation.
    virtual double deficit(const Combination& c) const {
        return std::max(0.0, upper_bound({-c.mass, -c.stiffness, -c.damping, c.project}));
    }
    /// S as a sparse matrix, both triangles.
    virtual SparseMatrix<double> assemble(const Combination& c) const = 0;
    /// The same with each spring that may be on either side of a kink on the side where its part of
    /// S is the least, so that a proof of S ≻ 0 holds on both.
    virtual SparseMatrix<double> assemble_least(const Combination& c) const { return assemble(c); }
    /// A bound on max_i Σ_j s_i |E_ij| s_j, E the rounding errors of assemble(c) and of
    /// the tangents.
    virtual double assembly_error(const Combination& c, const Eigen::VectorXd& s) const = 0;

    /// Shares in the energy of mode u, in no order; empty without springs. Elastic energy by K⁺.
    virtual std::vector<SpringShare> spring_shares(const Eigen::VectorXd& u) const = 0;
    /// Without springs a "particle" is a degree of freedom.
    virtual std::vector<ParticleShare> particle_shares(const Eigen::VectorXd& u) const = 0;
    /// The same with K (and αK⁺) times `stiffness` and M (and d0·M) times `mass`; dampers stay.
    /// What is scaled below the normal numbers keeps its allowance for rounding.
    virtual std::shared_ptr<const Pencil> scaled(double stiffness, double mass) const = 0;

    /// Whether K⁺ differs from K where K is indefinite: springs, not bare matrices.
    virtual bool projects() const = 0;
    /// Whether K (not K⁺) is known to be positive semi-definite.
    virtual bool stiffness_semidefinite() const = 0;
    /// Whether D is known to be positive semi-definite.
    virtual bool damping_semidefinite() const = 0;
    /// Whether D = d0·M + αK⁺ (d0·M of bare matrices: to 4 ulp), so that M, D and K⁺ share their
    /// eigenvectors [T13].
    virtual bool is_rayleigh() const = 0;
    /// The Rayleigh part of D, as steppers hold it, in the system's Scalar.
    const RayleighDamping& rayleigh() const { return rayleigh_; }
    /// Names the first number of the system that is out of the analysis's range, with its value;
    /// empty where there is none. A pencil that lost one says nothing about its system.
    const std::string& lost() const { return lost_; }

    /// Fails by that name if there is one.
    void require_range(const char* where) const {
        if (!lost_.empty()) fail(where, ": ", lost_);
    }

protected:
    /// The value of a mass, a stiffness or a damping in double: 0, or of a size whose square keeps
    /// its digits. @param what  what it is of particle, spring or row `index`
    template <class Real>
    double in_range(Real value, const char* what, Index index) {
        return within(value, what, index, 1 / square_holds, square_holds);
    }
    /// Notes a length, m, whose square overflows.
    template <class Real>
    void check_length(Real value, const char* what, Index index) {
        within(value, what, index, 0, square_holds);
    }

    Eigen::VectorXd mass_;      // N, kg
    RayleighDamping rayleigh_;  // the Rayleigh part of D

private:
    static constexpr double square_holds = 0x1p500;

    template <class Real>
    double within(Real value, const char* what, Index index, double least, double most) {
        const std::common_type_t<Real, double> size = std::abs(value);
        if (lost_.empty() && size != 0 && !(size >= least && size <= most)) {
            char text[160];
            std::snprintf(text, sizeof text,
                          "the %s %lld is %.9Lg; the analysis is in double and takes 0 and sizes "
                          "from %.3g to %.3g",
                          what, static_cast<long long>(index), static_cast<long double>(value),
                          least, most);
            lost_ = text;
        }
        return static_cast<double>(value);
    }

    std::string lost_;
};

}  // namespace taut
