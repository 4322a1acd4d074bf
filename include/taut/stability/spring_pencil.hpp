// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "../model/block_pattern.hpp"
#include "../model/free_particles.hpp"
#include "../model/spring_mechanics.hpp"
#include "detail/small_eigenvalue.hpp"
#include "pencil.hpp"

namespace taut {

/// The pencil of springs at one pose: no matrix, 84 bytes a spring in three dimensions.
template <int Dim>
class SpringPencil final : public ScenePencil {
public:
    using Vector = Eigen::Matrix<double, Dim, 1>;
    using Block = Eigen::Matrix<double, Dim, Dim>;

    /// What of a system's damping a pencil has.
    enum class Damping { all, half };

    /// The tangents of `system` at x, Dim × n, m. A spring that rounding may take across a kink of
    /// its law has the larger T′ of the two sides; a bound and a proof hold for both.
    template <class System>
    static SpringPencil at_pose(const System& system,
                                const Points<TangentReal<typename System::Scalar>, Dim>& x);
    /// The graph Laplacians L_k and L_c of theory [T23], a pencil of dimension 1 whatever the
    /// system's: L_k ⊗ I bounds K at every pose.
    template <class System>
    static SpringPencil any_pose(const System& system, Damping counted = Damping::all);

    /// The pencil of what stays explicit beside implicit shares, all over the margin θ [T33]:
    /// springs times (1 − s)/θ, d0/θ. Of any_pose.
    /// @param shares  s of each spring of the system, in index order, 0 …; beyond 1 they take
    ///                springs away, and only `quadratic` and `multiply` serve, with the true K
    SpringPencil explicit_part(const std::vector<double>& shares, double margin) const;

    void multiply(const Combination& c, const Eigen::VectorXd& u,
                  Eigen::VectorXd& y) const override;
    Enclosed quadratic(const Combination& c, const Eigen::VectorXd& u) const override;
    double upper_bound(const Combination& c, double enough = 0) const override;
    SparseMatrix<double> assemble(const Combination& c) const override {
        return assemble(c, [&](const Link& link) { return coefficients(c, link); });
    }
    SparseMatrix<double> assemble_least(const Combination& c) const override {
        return assemble(c, [&](const Link& link) { return extreme_coefficients(c, link, -1); });
    }
    double assembly_error(const Combination& c, const Eigen::VectorXd& s) const override;
    /// The bound of [T26] before the division by the masses: λ_max(Σ_b (1 + p_b/p_i) P_b) of each
    /// free particle for the springs' part of S, weights p > 0, one for each free particle.
    std::vector<double> particle_loads(const Combination& c, const std::vector<double>& p) const {
        return loads(splitting(c, p));
    }
    std::vector<SpringShare> spring_shares(const Eigen::VectorXd& u) const override;
    std::vector<ParticleShare> particle_shares(const Eigen::VectorXd& u) const override;
    std::shared_ptr<const ScenePencil> scaled(double stiffness, double mass) const override;

private:
    using Pencil::facts_;
    using Pencil::mass_;
    using Pencil::rayleigh_;

    struct Link {
        int a;  // free particle, or −1 when pinned
        int b;
        Vector d;           // unit vector, or zero
        double axial;       // T′, N/m; at a kink that of the stiffer side
        double softer;      // and that of the other one; the same elsewhere
        double transverse;  // T/l, N/m
        double damping;     // N·s/m, axial
        double bound;       // of the law, N/m: what rounding errors of the tangent are relative to
    };
    struct Coefficients {
        double axial;
        double transverse;
    };

    template <class System>
    void set_particles(const System& system);
    /// @param tangent  tangent(index), a Link without its ends and its damper
    template <class Set, class Tangent>
    void add_link(const Set& set, std::size_t s, const Tangent& tangent);
    Coefficients coefficients(const Combination& c, const Link& link) const;
    /// The largest (sign = 1) or least (−1) on either side of a kink.
    Coefficients extreme_coefficients(const Combination& c, const Link& link, int sign) const;
    template <class CoefficientsOf>
    SparseMatrix<double> assemble(const Combination& c, CoefficientsOf&& coefficients_of) const;
    /// What the rounding errors of a link's block are relative to, N/m.
    double magnitude(const Combination& c, const Link& link) const {
        const double factor = std::abs(c.stiffness()) + std::abs(c.projected()) +
                              std::abs(c.damping()) * rayleigh_.stiffness_proportional;
        return factor * std::max(link.bound, std::abs(link.transverse)) +
               std::abs(c.damping()) * link.damping;
    }
    double mass_coefficient(const Combination& c) const {
        return c.mass() + c.damping() * rayleigh_.mass_proportional;
    }
    /// One choice of weights in [T26]: of each free particle the block Σ_b (1 + p_b/p_i) P_b, and a
    /// bound on its rounding error, N/m.
    struct Splitting {
        std::vector<Block, Eigen::aligned_allocator<Block>> block;
        std::vector<double> rounding;
    };
    Splitting splitting(const Combination& c, const std::vector<double>& p) const;
    std::vector<double> loads(const Splitting& split) const;
    double largest_quotient(const Splitting& split) const;
    double quotient(double load, std::size_t i) const {
        // A quotient that vanished by underflow is not zero.
        const double r = load / mass_[static_cast<Index>(Dim * i)];
        return load > 0 ? std::max(r, std::numeric_limits<double>::min()) : r;
    }
    Vector segment(const Eigen::VectorXd& u, int i) const {
        return i < 0 ? Vector(Vector::Zero()) : Vector(u.segment<Dim>(Dim * i));
    }

    FreeParticles free_;
    std::vector<int> degree_;                // springs at each free particle
    std::vector<Link> links_;                // springs with at least one free end
    std::vector<std::array<int, 3>> names_;  // of each link: spring, particle a, particle b
    int springs_ = 0;                        // met so far, links or not
};

template <int Dim>
template <class System>
void SpringPencil<Dim>::set_particles(const System& system) {
    using Scalar = typename System::Scalar;
    rayleigh_ = {held_as<Scalar>(system.rayleigh().mass_proportional),
                 held_as<Scalar>(system.rayleigh().stiffness_proportional)};
    free_ = FreeParticles(system);
    mass_.resize(Dim * free_.count());
    facts_ = {Dim,  true, true,
              true, true, 16 * static_cast<double>(std::numeric_limits<Scalar>::epsilon())};
    degree_.assign(static_cast<std::size_t>(free_.count()), 0);
    for (Index j = 0; j < free_.count(); ++j) {
        mass_.template segment<Dim>(Dim * j).setConstant(
            in_range(system.mass(free_[j]), "mass of particle", free_[j]));
    }
    links_.reserve(static_cast<std::size_t>(system.spring_count()));
}

/// For each spring of the system in turn; one without a free end is counted only.
template <int Dim>
template <class Set, class Tangent>
void SpringPencil<Dim>::add_link(const Set& set, std::size_t s, const Tangent& tangent) {
    const int index = springs_++;
    const auto a = static_cast<int>(free_.place(set.a[s]));
    const auto b = static_cast<int>(free_.place(set.b[s]));
    if (a < 0 && b < 0) return;
    Link link = tangent(index);
    link.a = a;
    link.b = b;
    link.damping = in_range(set.damping_of(s), "damping of spring", index);
    names_.push_back({index, set.a[s], set.b[s]});
    links_.push_back(link);
    if (a >= 0) ++degree_[a];
    if (b >= 0) ++degree_[b];
    if (link.damping > 0) facts_.is_rayleigh = false;
}

template <int Dim>
template <class System>
SpringPencil<Dim> SpringPencil<Dim>::at_pose(
    const System& system, const Points<TangentReal<typename System::Scalar>, Dim>& x) {
    using Real = TangentReal<typename System::Scalar>;
    SpringPencil pencil;
    pencil.set_particles(system);
    for (Index i = 0; i < system.size(); ++i) {
        pencil.check_length(x.col(i).cwiseAbs().maxCoeff(), "position of particle", i);
    }
    system.for_each_set([&](const auto& set) {
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            pencil.add_link(set, s, [&](int index) {
                const SpringTangent<Real, Dim> t = set.tangent(s, x);
                const auto [softer, stiffer] = set.axial_range(s, x, t);
                // At l = 0 there is no axis: the whole tangent is isotropic, in one dimension too.
                const Real transverse = Dim == 1 && t.d[0] != 0 ? 0 : t.transverse;
                // A few ulp below zero are rounding of l − L.
                const Real rounding = -16 * std::numeric_limits<Real>::epsilon() * t.bound;
                if (softer < rounding || transverse < rounding)
                    pencil.facts_.stiffness_semidefinite = false;
                Link link{};
                link.d = t.d.template cast<double>();
                link.axial = static_cast<double>(stiffer);
                link.softer = static_cast<double>(softer);
                link.transverse = static_cast<double>(transverse);
                link.bound = pencil.in_range(t.bound, "stiffness of spring", index);
                pencil.check_length(static_cast<Real>(set.rest_length[s]), "rest length of spring",
                                    index);
                return link;
            });
        }
    });
    return pencil;
}

template <int Dim>
template <class System>
SpringPencil<Dim> SpringPencil<Dim>::any_pose(const System& system, Damping counted) {
    static_assert(Dim == 1, "taut::SpringPencil::any_pose: the Laplacians have one row a particle");
    using Real = TangentReal<typename System::Scalar>;
    SpringPencil pencil;
    pencil.set_particles(system);
    if (counted == Damping::half) {
        pencil.rayleigh_.mass_proportional /= 2;
        pencil.rayleigh_.stiffness_proportional /= 2;
    }
    system.for_each_set([&](const auto& set) {
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            pencil.add_link(set, s, [&](int index) {
                const Real bound = set[s].template cast<Real>().stiffness_bound();
                Link link{};
                link.d = Vector::Ones();
                link.bound = pencil.in_range(bound, "stiffness of spring", index);
                link.axial = link.softer = link.bound;
                link.transverse = 0;
                return link;
            });
        }
    });
    if (counted == Damping::half) {
        for (Link& link : pencil.links_) link.damping /= 2;
    }
    return pencil;
}

template <int Dim>
auto SpringPencil<Dim>::coefficients(const Combination& c, const Link& link) const -> Coefficients {
    const double on_plus = c.projected() + c.damping() * rayleigh_.stiffness_proportional;
    const auto elastic = [&](double slope) {
        return c.stiffness() * slope + on_plus * k_plus(slope);
    };
    return {elastic(link.axial) + c.damping() * link.damping, elastic(link.transverse)};
}

template <int Dim>
auto SpringPencil<Dim>::extreme_coefficients(const Combination& c, const Link& link, int sign) const
    -> Coefficients {
    Coefficients extreme = coefficients(c, link);
    if (link.softer == link.axial) return extreme;
    Link other = link;
    // Between the two the factor bends at most where K⁺ does, at 0.
    for (const double axial : {link.softer, std::clamp(0.0, link.softer, link.axial)}) {
        other.axial = axial;
        const double factor = coefficients(c, other).axial;
        if (sign * factor > sign * extreme.axial) extreme.axial = factor;
    }
    return extreme;
}

template <int Dim>
void SpringPencil<Dim>::multiply(const Combination& c, const Eigen::VectorXd& u,
                                 Eigen::VectorXd& y) const {
    y = mass_coefficient(c) * mass_.cwiseProduct(u);
    for (const Link& link : links_) {
        const auto [axial, transverse] = coefficients(c, link);
        const Vector du = segment(u, link.a) - segment(u, link.b);
        const Vector pull = spring_product(link.d, axial, transverse, du);
        if (link.a >= 0) y.segment<Dim>(Dim * link.a) += pull;
        if (link.b >= 0) y.segment<Dim>(Dim * link.b) -= pull;
    }
}

template <int Dim>
Enclosed SpringPencil<Dim>::quadratic(const Combination& c, const Eigen::VectorXd& u) const {
    // As a sum over springs the form loses nothing to cancellation between neighbours.
    Enclosed sum;
    const double on_mass = mass_coefficient(c);
    for (Index i = 0; i < size(); ++i) {
        const double term = mass_[i] * u[i] * u[i];
        sum.value += on_mass * term;
        sum.error += std::abs(on_mass) * term;
    }
    const bool springs =
        c.stiffness() != 0 || c.projected() != 0 ||
        (c.damping() != 0 && (!is_rayleigh() || rayleigh_.stiffness_proportional > 0));
    for (std::size_t s = 0; springs && s < links_.size(); ++s) {
        const Link& link = links_[s];
        const auto [axial, transverse] = coefficients(c, link);
        const Vector du = segment(u, link.a) - segment(u, link.b);
        const double along = link.d.dot(du);
        const double across = (du - along * link.d).squaredNorm();
        sum.value += axial * along * along + transverse * across;
        sum.error += magnitude(c, link) * du.squaredNorm();
    }
    // Each term carries ≤ 32 roundings, the sum one more for each term; √terms would be typical.
    const double terms = static_cast<double>(size()) + static_cast<double>(links_.size()) + 32;
    sum.error *= terms * std::numeric_limits<double>::epsilon();
    return sum;
}

template <int Dim>
std::vector<SpringShare> SpringPencil<Dim>::spring_shares(const Eigen::VectorXd& u) const {
    std::vector<SpringShare> shares;
    double total = 0;
    for (std::size_t s = 0; s < links_.size(); ++s) {
        const auto [axial, transverse] = coefficients(matrices::K_plus, links_[s]);
        const Vector du = segment(u, links_[s].a) - segment(u, links_[s].b);
        const double along = links_[s].d.dot(du);
        const double energy =
            axial * along * along + transverse * (du - along * links_[s].d).squaredNorm();
        const auto [index, a, b] = names_[s];
        shares.push_back({index, a, b, energy});
        total += energy;
    }
    for (auto& share : shares) share.share = total > 0 ? share.share / total : 0;
    return shares;
}

template <int Dim>
std::vector<ParticleShare> SpringPencil<Dim>::particle_shares(const Eigen::VectorXd& u) const {
    std::vector<ParticleShare> shares;
    const double total = mass_.dot(u.cwiseAbs2());
    for (Index j = 0; j < free_.count(); ++j) {
        const double energy = mass_[Dim * j] * u.segment<Dim>(Dim * j).squaredNorm();
        shares.push_back({free_[j], total > 0 ? energy / total : 0});
    }
    return shares;
}

template <int Dim>
SpringPencil<Dim> SpringPencil<Dim>::explicit_part(const std::vector<double>& shares,
                                                   double margin) const {
    SpringPencil pencil = *this;
    pencil.rayleigh_.mass_proportional /= margin;
    for (std::size_t s = 0; s < links_.size(); ++s) {
        const double part = (1 - shares[static_cast<std::size_t>(names_[s][0])]) / margin;
        Link& link = pencil.links_[s];
        for (double* value : {&link.axial, &link.softer, &link.transverse, &link.damping}) {
            *value *= part;
        }
        link.bound *= std::abs(part);
        if (part >= 0) continue;
        // K⁺, which Rayleigh's α acts through, has no negative springs.
        link.damping += rayleigh_.stiffness_proportional * link.axial;
        pencil.facts_.is_rayleigh = false;
        pencil.facts_.stiffness_semidefinite = false;
        pencil.facts_.damping_semidefinite = false;
    }
    return pencil;
}

template <int Dim>
std::shared_ptr<const ScenePencil> SpringPencil<Dim>::scaled(double stiffness, double mass) const {
    constexpr double least = std::numeric_limits<double>::min();
    auto pencil = std::make_shared<SpringPencil>(*this);
    pencil->mass_ *= mass;
    for (Link& link : pencil->links_) {
        link.axial *= stiffness;
        link.softer *= stiffness;
        link.transverse *= stiffness;
        // The rounding that a bound stands for must not vanish with it.
        const bool zero = link.bound == 0 || stiffness == 0;
        link.bound = std::max(link.bound * stiffness, zero ? 0 : least);
    }
    return pencil;
}

}  // namespace taut

#include "detail/spring_pencil_bound.ipp"
#include "detail/spring_pencil_matrix.ipp"
