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
#include "../method/method.hpp"
#include "../model/combination.hpp"
#include "../model/damping.hpp"
#include "../model/tangent_matrix.hpp"
#include "step_limit.hpp"

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
/// from matrices, as an operator, its quotients and its bounds. S is a sum such as 4M − 2hD − h²K,
/// see Combination.
class Pencil {
public:
    virtual ~Pencil() = default;

    /// N, degrees of freedom.
    Index size() const { return mass_.size(); }
    /// N, kg: the diagonal of M.
    const Eigen::VectorXd& mass() const { return mass_; }
    /// Degrees of freedom of one particle; 1 where there are no particles.
    int dim() const { return facts_.dim; }

    /// y ← S u.
    virtual void multiply(const Combination& c, const Eigen::VectorXd& u,
                          Eigen::VectorXd& y) const = 0;
    /// uᵀS u with its rounding error.
    virtual Enclosed quadratic(const Combination& c, const Eigen::VectorXd& u) const = 0;
    /// A proved upper bound on the largest eigenvalue of M⁻¹S, rounding included [T26]. For springs
    /// it is never below the factor of M, the mass-proportional part of D counted.
    /// @param enough  stop improving the bound once it is at most this
    virtual double upper_bound(const Combination& c, double enough = 0) const = 0;
    /// An ε ≥ 0, in the units of M⁻¹S, with S ⪰ −εM proved: by the bound, for bare matrices also by
    /// factorisation.
    virtual double deficit(const Combination& c) const { return std::max(0.0, upper_bound(-c)); }
    /// S as a sparse matrix, both triangles.
    virtual SparseMatrix<double> assemble(const Combination& c) const = 0;
    /// The same with each spring that may be on either side of a kink on the side where its part of
    /// S is the least, so that a proof of S ≻ 0 holds on both.
    virtual SparseMatrix<double> assemble_least(const Combination& c) const { return assemble(c); }
    /// A bound on max_i Σ_j s_i |E_ij| s_j, E the rounding errors of assemble(c) and of
    /// the tangents.
    virtual double assembly_error(const Combination& c, const Eigen::VectorXd& s) const = 0;

    /// Whether K is known to be positive semi-definite, up to resolution().
    bool stiffness_semidefinite() const { return facts_.stiffness_semidefinite; }
    /// Whether K⁺ is: that of springs always.
    bool projected_semidefinite() const { return facts_.projected_semidefinite; }
    /// Whether D is.
    bool damping_semidefinite() const { return facts_.damping_semidefinite; }
    /// Whether D = d0·M + αK⁺ (d0·M of bare matrices: to 4 ulp), so that M, D and K⁺ share their
    /// eigenvectors [T13].
    bool is_rayleigh() const { return facts_.is_rayleigh; }
    /// How much of k_max rest lengths and positions, which are rounded to Scalar, may leave as
    /// compression that nobody meant; 0 for bare matrices.
    double resolution() const { return facts_.resolution; }
    /// The Rayleigh part of D, as steppers hold it, in the system's Scalar.
    const RayleighDamping& rayleigh() const { return rayleigh_; }
    /// A κ ≥ 0, 1/s², with K ⪰ −κM proved by the bound, rounding of the scene counted.
    double compression() const {
        const bool exact = stiffness_semidefinite() && resolution() == 0;
        return exact ? 0 : std::max(0.0, upper_bound(-matrices::K));
    }
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

    /// What is known of the matrices, as the functions above tell it.
    struct Facts {
        int dim = 1;
        bool stiffness_semidefinite = false;
        bool projected_semidefinite = false;
        bool damping_semidefinite = false;
        bool is_rayleigh = false;
        double resolution = 0;
    };

    Eigen::VectorXd mass_;
    RayleighDamping rayleigh_;
    Facts facts_;

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

/// A pencil that knows the scene it came from: whose a mode is, and what other stiffness or mass
/// would make of it.
class ScenePencil : public Pencil {
public:
    /// The springs' shares in the elastic energy of mode u, by K⁺, in no order; empty without
    /// springs.
    virtual std::vector<SpringShare> spring_shares(const Eigen::VectorXd& u) const = 0;
    /// The particles' shares in its kinetic energy, in no order; without springs a "particle" is a
    /// degree of freedom.
    virtual std::vector<ParticleShare> particle_shares(const Eigen::VectorXd& u) const = 0;
    /// The same scene with K (and αK⁺) times `stiffness` and M (and d0·M) times `mass`; dampers
    /// stay. What is scaled below the normal numbers keeps its allowance for rounding.
    virtual std::shared_ptr<const ScenePencil> scaled(double stiffness, double mass) const = 0;
    /// Weakens a limit that was found as that of springs, with K⁺, D ⪰ 0, where they are not known
    /// to be so, and tells of growth. @returns false where nothing but springs stands behind K and
    /// D
    virtual bool amend(Method, stability_detail::UnroundedLimit&) const { return false; }
};

}  // namespace taut
