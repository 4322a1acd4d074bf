// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "../core/buffer.hpp"
#include "../core/error.hpp"
#include "../core/types.hpp"
#include "../conditions/method.hpp"
#include "../network/combination.hpp"
#include "../network/damping.hpp"
#include "../network/spring_mechanics.hpp"
#include "detail/range_check.hpp"
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

class Pencil;

/// Matrices without springs behind them, in a Pencil's place: see Pencil for the functions.
class BareMatrices {
public:
    virtual ~BareMatrices() = default;
    /// y ← S u.
    virtual void multiply(const Combination& c, const Eigen::VectorXd& u,
                          Eigen::VectorXd& y) const = 0;
    /// uᵀS u with its rounding error.
    virtual Enclosed quadratic(const Combination& c, const Eigen::VectorXd& u) const = 0;
    /// A proved upper bound on the largest eigenvalue of M⁻¹S.
    virtual double upper_bound(const Combination& c) const = 0;
    /// By factorisation. @param known  an ε that is proved
    virtual double deficit(const Pencil& pencil, const Combination& c, double known) const = 0;
    /// S as a sparse matrix, both triangles.
    virtual SparseMatrix<double> assemble(const Combination& c) const = 0;
    /// A bound on max_i Σ_j s_i |E_ij| s_j, E the rounding errors of assemble(c).
    virtual double assembly_error(const Combination& c, const Eigen::VectorXd& s) const = 0;
    /// The same with K times `stiffness` and M times `mass`. @param rayleigh  whether D follows M
    virtual std::shared_ptr<const BareMatrices> scaled(double stiffness, double mass,
                                                       bool rayleigh) const = 0;
    /// Weakens a limit that was found as that of springs, with K⁺, D ⪰ 0, where they are not known
    /// to be so, and tells of growth.
    virtual void amend(Method method, const Pencil& pencil,
                       proof_detail::UnroundedLimit& limit) const = 0;
};

/// M, D, K of the free degrees of freedom, as the analysis needs them: in double, from springs at
/// one pose or at any (plain arrays, no matrix, whatever the system's scalar, dimension and laws),
/// or from matrices; as an operator, its quotients and its bounds. S is a sum such as
/// 4M − 2hD − h²K, see Combination.
class Pencil {
public:
    /// What of a system's damping a pencil has.
    enum class Damping { all, half };
    /// What is known of the matrices, as the functions below tell it.
    struct Facts {
        int dim = 1;
        bool stiffness_semidefinite = false;
        bool projected_semidefinite = false;
        bool damping_semidefinite = false;
        bool is_rayleigh = false;
        double resolution = 0;
    };

    /// The tangents of `system` at x, Dim × n, m. A spring that rounding may take across a kink of
    /// its law has the larger T′ of the two sides; a bound and a proof hold for both.
    template <class System>
    static Pencil at_pose(const System& system,
                          const Points<TangentReal<typename System::Scalar>, int(System::Dim)>& x);
    /// The graph Laplacians L_k and L_c of theory [T23], of dimension 1 whatever the system's:
    /// L_k ⊗ I bounds K at every pose.
    template <class System>
    static Pencil any_pose(const System& system, Damping counted = Damping::all);
    /// Of bare matrices. @param mass  N, kg: the diagonal of M   @param lost  see lost()
    Pencil(Eigen::VectorXd mass, const RayleighDamping& rayleigh, const Facts& facts,
           std::string lost, std::shared_ptr<const BareMatrices> matrices)
        : mass_(std::move(mass)),
          rayleigh_(rayleigh),
          facts_(facts),
          lost_(std::move(lost)),
          matrices_(std::move(matrices)) {}
    Pencil() = default;

    /// N, degrees of freedom.
    Index size() const { return mass_.size(); }
    /// N, kg: the diagonal of M.
    const Eigen::VectorXd& mass() const { return mass_; }
    /// Degrees of freedom of one particle; 1 where there are no particles.
    int dim() const { return facts_.dim; }

    /// y ← S u.
    void multiply(const Combination& c, const Eigen::VectorXd& u, Eigen::VectorXd& y) const;
    /// uᵀS u with its rounding error.
    Enclosed quadratic(const Combination& c, const Eigen::VectorXd& u) const;
    /// A proved upper bound on the largest eigenvalue of M⁻¹S, rounding included [T26]. For springs
    /// it is never below the factor of M, the mass-proportional part of D counted.
    double upper_bound(const Combination& c) const;
    /// The same for a pencil of any_pose, sharper: by a polynomial of M⁻¹S [T45]. Never above
    /// upper_bound. Defined by sharp_limit.hpp.
    template <class Real = double>
    Real polynomial_bound(const Combination& c) const;
    /// An ε ≥ 0, in the units of M⁻¹S, with S ⪰ −εM proved: by the bound, for bare matrices also by
    /// factorisation.
    double deficit(const Combination& c) const {
        const double bound = (std::max)(0.0, upper_bound(-c));
        return matrices_ ? matrices_->deficit(*this, c, bound) : bound;
    }
    /// S as a sparse matrix, both triangles. Defined by pencil_matrix.hpp, as the next two.
    template <class Real = double>  // a template, as below: only its callers compile it
    SparseMatrix<Real> assemble(const Combination& c) const;
    /// The same with each spring that may be on either side of a kink on the side where its part of
    /// S is the least, so that a proof of S ≻ 0 holds on both.
    template <class Real = double>
    SparseMatrix<Real> assemble_least(const Combination& c) const;
    /// A bound on max_i Σ_j s_i |E_ij| s_j, E the rounding errors of assemble(c) and of
    /// the tangents.
    template <class Real = double>
    Real assembly_error(const Combination& c, const Eigen::VectorXd& s) const;
    /// The bound of [T26] before the division by the masses: λ_max(Σ_b (1 + p_b/p_i) P_b) of each
    /// free particle for the springs' part of S, weights p > 0, one for each free particle.
    template <class Real = double>
    std::vector<Real> particle_loads(const Combination& c, const std::vector<Real>& p) const;

    /// The springs' shares in uᵀS u, in no order: of K⁺ those in the elastic energy of mode u.
    /// Empty without springs. Defined by bracket.hpp, as the next one.
    template <class Real = double>
    std::vector<SpringShare> spring_shares(const Eigen::VectorXd& u,
                                           const Combination& c = matrices::K_plus) const;
    /// The particles' shares in its kinetic energy, in no order; without springs a "particle" is a
    /// degree of freedom.
    template <class Real = double>
    std::vector<ParticleShare> particle_shares(const Eigen::VectorXd& u) const;
    /// The same scene with K (and αK⁺) times `stiffness` and M (and d0·M) times `mass`; dampers
    /// stay. What is scaled below the normal numbers keeps its allowance for rounding.
    template <class Real = double>
    Pencil scaled(Real stiffness, Real mass) const;
    /// Puts a damper c beside each spring, on the whole relative velocity of its ends: c·L ⊗ I in
    /// D, L the graph Laplacian of that spring. @param dampers  N·s/m, ≥ 0, in index order
    template <class Real>
    void add_dampers(const std::vector<Real>& dampers);
    /// The pencil of what stays explicit beside implicit shares [T33]: springs times 1 − s.
    /// @param shares  s of each spring of the system, in index order, 0 …; beyond 1 they take
    ///                springs away, and only `quadratic` and `multiply` serve, with the true K
    template <class Real = double>
    Pencil explicit_part(const std::vector<Real>& shares) const;

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
        return exact ? 0 : (std::max)(0.0, upper_bound(-matrices::K));
    }
    /// What stands in the place of springs, or null.
    const BareMatrices* matrices() const { return matrices_.get(); }
    /// Names the first number of the system that is out of the analysis's range, with its value;
    /// empty where there is none. A pencil that lost one says nothing about its system.
    const std::string& lost() const { return lost_; }
    /// Fails by that name if there is one.
    void require_range(const char* where) const {
        if (!lost_.empty()) fail(where, ": ", lost_);
    }

private:
    struct Link {
        int a;  // free particle, or −1 when pinned
        int b;
        double d[3];        // unit vector, or zero; zero beyond the dimension
        double axial;       // T′, N/m; at a kink that of the stiffer side
        double softer;      // and that of the other one; the same elsewhere
        double transverse;  // T/l, N/m
        double damping;     // N·s/m, along d
        double across;      // and across it
        double bound;       // of the law, N/m: what rounding errors of the tangent are relative to
    };
    struct Name {  // of a link, as the system counts
        int spring, a, b;
    };
    struct Coefficients {
        double axial;
        double transverse;
    };

    template <class System>
    static Pencil of_particles(const System& system, int dim, proof_detail::RangeCheck& check);
    template <class System, class Tangent>
    void add_springs(const System& system, proof_detail::RangeCheck& check, const Tangent& tangent);
    Coefficients coefficients(const Combination& c, const Link& link) const;
    /// The largest (sign = 1) or least (−1) on either side of a kink.
    Coefficients extreme_coefficients(const Combination& c, const Link& link, int sign) const;
    template <class Real, class CoefficientsOf>
    SparseMatrix<Real> assemble_links(const Combination& c,
                                      const CoefficientsOf& coefficients_of) const;
    template <int Dim>
    SparseMatrix<double> assemble_in(const Buffer<Coefficients>& of_links) const;
    /// What the rounding errors of a link's block are relative to, N/m.
    double magnitude(const Combination& c, const Link& link) const {
        const double factor = (std::abs)(c.stiffness()) + (std::abs)(c.projected()) +
                              (std::abs)(c.damping()) * rayleigh_.stiffness_proportional;
        return factor * (std::max)(link.bound, (std::abs)(link.transverse)) +
               (std::abs)(c.damping()) * link.damping;
    }
    double mass_coefficient(const Combination& c) const {
        return c.mass() + c.damping() * rayleigh_.mass_proportional;
    }
    double particle_mass(std::size_t i) const { return mass_.data()[i * std::size_t(dim())]; }
    struct Splitting;
    Splitting splitting(const Combination& c) const;
    void spread(const double* p, Splitting& split) const;
    double load(const Splitting& split, std::size_t i) const;
    double largest_quotient(const Splitting& split) const;
    double quotient(double load, std::size_t i) const {
        // A quotient that vanished by underflow is not zero.
        const double r = load / particle_mass(i);
        return load > 0 ? (std::max)(r, (std::numeric_limits<double>::min)()) : r;
    }
    /// In the order of Eigen's sums.
    static double dot(const double* a, const double* b) {
        return a[0] * b[0] + (a[1] * b[1] + a[2] * b[2]);
    }
    /// u_a − u_b of a link.
    void difference(const double* u, const Link& link, double du[3]) const {
        for (int k = 0; k < 3; ++k) du[k] = 0;
        for (int k = 0; k < dim(); ++k) {
            const double of_a = link.a < 0 ? 0 : u[dim() * Index(link.a) + k];
            const double of_b = link.b < 0 ? 0 : u[dim() * Index(link.b) + k];
            du[k] = of_a - of_b;
        }
    }

    Eigen::VectorXd mass_;
    RayleighDamping rayleigh_;
    Facts facts_;
    Buffer<int> free_;    // the system's index of each free particle
    Buffer<int> degree_;  // springs at each free particle
    Buffer<Link> links_;  // springs with at least one free end
    Buffer<Name> names_;  // of each link
    std::string lost_;
    std::shared_ptr<const BareMatrices> matrices_;
};

namespace proof_detail {

using namespace matrices;

inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace proof_detail
}  // namespace taut

#include "detail/pencil_scene.ipp"

#if !defined(TAUT_COMPILED)
#include "pencil-inl.hpp"
#endif
