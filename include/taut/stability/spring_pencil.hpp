// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "../model/block_pattern.hpp"
#include "detail/small_eigenvalue.hpp"
#include "pencil.hpp"

namespace taut {

/// The pencil of springs at one pose: no matrix, 76 bytes a spring in three dimensions.
template <int Dim>
class SpringPencil final : public Pencil {
public:
    using Vector = Eigen::Matrix<double, Dim, 1>;
    using Block = Eigen::Matrix<double, Dim, Dim>;

    /// The tangents of `system` at x, Dim × n, m.
    template <class System>
    static SpringPencil at_pose(const System& system, const Points<double, Dim>& x);
    /// The graph Laplacians L_k and L_c of theory [T23], a pencil of dimension 1 whatever the
    /// system's: L_k ⊗ I bounds K at every pose.
    template <class System>
    static SpringPencil any_pose(const System& system);

    int dim() const override { return Dim; }
    void multiply(const Combination& c, const Eigen::VectorXd& u,
                  Eigen::VectorXd& y) const override;
    Enclosed quadratic(const Combination& c, const Eigen::VectorXd& u) const override;
    double upper_bound(const Combination& c, double enough = 0) const override;
    SparseMatrix<double> assemble(const Combination& c) const override;
    double assembly_error(const Combination& c, const Eigen::VectorXd& s) const override;
    /// The bound of [T26] before the division by the masses: λ_max(Σ_b (1 + p_b/p_i) P_b) of each
    /// free particle for the springs' part of S, weights p > 0, one for each free particle.
    std::vector<double> particle_loads(const Combination& c, const std::vector<double>& p) const {
        return loads(splitting(c, p));
    }
    /// visit(a, b, d, axial, transverse) for every spring with a free end: free particles (−1 when
    /// pinned), unit vector, and S of the spring = axial ddᵀ + transverse(I − ddᵀ), N/m.
    template <class Visitor>
    void for_each_link(const Combination& c, Visitor&& visit) const {
        for (const Link& link : links_) {
            const auto [axial, transverse] = coefficients(c, link);
            visit(link.a, link.b, link.d, axial, transverse);
        }
    }
    /// Springs with a free end.
    Index link_count() const { return static_cast<Index>(links_.size()); }
    std::vector<SpringShare> spring_shares(const Eigen::VectorXd& u) const override;
    std::vector<ParticleShare> particle_shares(const Eigen::VectorXd& u) const override;
    std::shared_ptr<const Pencil> scaled(double stiffness, double mass) const override;
    bool projects() const override { return true; }
    bool stiffness_semidefinite() const override { return !compressed_; }
    bool damping_semidefinite() const override { return true; }
    bool is_rayleigh() const override { return !damped_; }

private:
    struct Link {
        int a;  // free particle, or −1 when pinned
        int b;
        Vector d;           // unit vector, or zero
        double axial;       // T′, N/m
        double transverse;  // T/l, N/m
        double damping;     // N·s/m
        double bound;       // of the law, N/m: what rounding errors of the tangent are relative to
    };
    struct Coefficients {
        double axial;
        double transverse;
    };

    template <class System>
    void set_particles(const System& system);
    void add_link(int a, int b, const Vector& d, double axial, double transverse, double damping,
                  double bound);
    Coefficients coefficients(const Combination& c, const Link& link) const;
    /// What the rounding errors of a link's block are relative to, N/m.
    double magnitude(const Combination& c, const Link& link) const {
        const double factor =
            std::abs(c.stiffness) + std::abs(c.damping) * rayleigh_.stiffness_proportional;
        return factor * std::max(link.bound, std::abs(link.transverse)) +
               std::abs(c.damping) * link.damping;
    }
    double mass_coefficient(const Combination& c) const {
        return c.mass + c.damping * rayleigh_.mass_proportional;
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

    std::vector<int> free_;                  // particle → free particle, or −1
    std::vector<int> degree_;                // springs at each free particle
    std::vector<Link> links_;                // springs with at least one free end
    std::vector<std::array<int, 3>> names_;  // of each link: spring, particle a, particle b
    int springs_ = 0;                        // met so far, links or not
    bool compressed_ = false;                // a spring has negative stiffness
    bool damped_ = false;                    // a spring has a damper
};

template <int Dim>
template <class System>
void SpringPencil<Dim>::set_particles(const System& system) {
    rayleigh_ = system.rayleigh();
    free_.assign(static_cast<std::size_t>(system.size()), -1);
    int count = 0;
    for (Index i = 0; i < system.size(); ++i) {
        if (!system.is_pinned(i)) free_[i] = count++;
    }
    mass_.resize(Dim * count);
    degree_.assign(static_cast<std::size_t>(count), 0);
    for (Index i = 0; i < system.size(); ++i) {
        if (free_[i] >= 0) {
            mass_.template segment<Dim>(Dim * free_[i])
                .setConstant(static_cast<double>(system.mass(i)));
        }
    }
    links_.reserve(static_cast<std::size_t>(system.spring_count()));
}

template <int Dim>
void SpringPencil<Dim>::add_link(int a, int b, const Vector& d, double axial, double transverse,
                                 double damping, double bound) {
    const int index = springs_++;
    if (free_[a] < 0 && free_[b] < 0) return;
    names_.push_back({index, a, b});
    links_.push_back({free_[a], free_[b], d, axial, transverse, damping, bound});
    if (free_[a] >= 0) ++degree_[free_[a]];
    if (free_[b] >= 0) ++degree_[free_[b]];
    // One dimension has no transverse direction; a few ulp below zero are rounding of l − L.
    const double rounding = -16 * std::numeric_limits<double>::epsilon() * bound;
    compressed_ = compressed_ || axial < rounding || (Dim > 1 && transverse < rounding);
    damped_ = damped_ || damping > 0;
}

template <int Dim>
template <class System>
SpringPencil<Dim> SpringPencil<Dim>::at_pose(const System& system, const Points<double, Dim>& x) {
    SpringPencil pencil;
    pencil.set_particles(system);
    system.for_each_tangent(x, [&](const SpringTangent<double, Dim>& t) {
        // At l = 0 there is no axis: the whole tangent is isotropic, in one dimension too.
        const double transverse = Dim == 1 && t.d[0] != 0 ? 0 : t.transverse;
        pencil.add_link(static_cast<int>(t.a), static_cast<int>(t.b), t.d, t.axial, transverse,
                        t.damping, t.bound);
    });
    return pencil;
}

template <int Dim>
template <class System>
SpringPencil<Dim> SpringPencil<Dim>::any_pose(const System& system) {
    static_assert(Dim == 1, "taut::SpringPencil::any_pose: the Laplacians have one row a particle");
    SpringPencil pencil;
    pencil.set_particles(system);
    system.for_each_set([&](const auto& set) {
        using Law = typename std::decay_t<decltype(set)>::Law;
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            const auto parameters = set.parameters[s].template cast<double>();
            const double bound =
                Law::stiffness_bound(parameters, static_cast<double>(set.rest_length[s]));
            pencil.add_link(set.a[s], set.b[s], Vector::Ones(), bound, 0,
                            static_cast<double>(set.damping_of(s)), bound);
        }
    });
    return pencil;
}

template <int Dim>
auto SpringPencil<Dim>::coefficients(const Combination& c, const Link& link) const -> Coefficients {
    const double plus = c.damping * rayleigh_.stiffness_proportional;
    const double axial = std::max(link.axial, 0.0);
    const double transverse = std::max(link.transverse, 0.0);
    return {
        c.stiffness * (c.project ? axial : link.axial) + plus * axial + c.damping * link.damping,
        c.stiffness * (c.project ? transverse : link.transverse) + plus * transverse};
}

template <int Dim>
void SpringPencil<Dim>::multiply(const Combination& c, const Eigen::VectorXd& u,
                                 Eigen::VectorXd& y) const {
    y = mass_coefficient(c) * mass_.cwiseProduct(u);
    for (const Link& link : links_) {
        const auto [axial, transverse] = coefficients(c, link);
        const Vector du = segment(u, link.a) - segment(u, link.b);
        const Vector pull = transverse * du + (axial - transverse) * link.d.dot(du) * link.d;
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
        c.stiffness != 0 || (c.damping != 0 && (damped_ || rayleigh_.stiffness_proportional > 0));
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
SparseMatrix<double> SpringPencil<Dim>::assemble(const Combination& c) const {
    const BlockPattern pattern(size() / Dim, [&](const auto& visit) {
        for (const Link& link : links_) {
            if (link.a >= 0 && link.b >= 0) visit(link.a, link.b);
        }
    });
    SparseMatrix<double> S = pattern.zero<double, Dim>();
    const auto add = [&](int row, int column, const Block& P) {
        if (row >= 0 && column >= 0) pattern.add(S, pattern.place(row, column), column, P);
    };
    for_each_link(c, [&](int a, int b, const Vector& d, double axial, double transverse) {
        const Block P = spring_block(d, axial, transverse);
        add(a, a, P);
        add(b, b, P);
        add(a, b, -P);
        add(b, a, -P);
    });
    S.diagonal() += mass_coefficient(c) * mass_;
    return S;
}

/// Each entry of a link's block carries ≤ 24 roundings of its magnitude (the tangent's own among
/// them), and adding d of them up d more; a row of Dim entries meets two blocks of each link.
template <int Dim>
double SpringPencil<Dim>::assembly_error(const Combination& c, const Eigen::VectorXd& s) const {
    std::vector<double> row(degree_.size());
    std::vector<double> scale(degree_.size());
    for (std::size_t i = 0; i < scale.size(); ++i) {
        const auto first = static_cast<Index>(Dim * i);
        scale[i] = s.segment<Dim>(first).maxCoeff();
        row[i] = std::abs(mass_coefficient(c)) * mass_[first] * scale[i] * scale[i];
    }
    for (const Link& link : links_) {
        const double entry = Dim * magnitude(c, link);
        const double sa = link.a < 0 ? 0 : scale[link.a];
        const double sb = link.b < 0 ? 0 : scale[link.b];
        if (link.a >= 0) row[link.a] += entry * sa * (sa + sb);
        if (link.b >= 0) row[link.b] += entry * sb * (sa + sb);
    }
    double largest = 0;
    for (std::size_t i = 0; i < row.size(); ++i) {
        largest = std::max(largest, (degree_[i] + 32) * row[i]);
    }
    return largest * std::numeric_limits<double>::epsilon();
}

template <int Dim>
std::vector<SpringShare> SpringPencil<Dim>::spring_shares(const Eigen::VectorXd& u) const {
    std::vector<SpringShare> shares;
    double total = 0;
    for (std::size_t s = 0; s < links_.size(); ++s) {
        const auto [axial, transverse] = coefficients({0, 1, 0}, links_[s]);
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
    for (std::size_t i = 0; i < free_.size(); ++i) {
        if (free_[i] < 0) continue;
        const Index first = Dim * free_[i];
        const double energy = mass_[first] * u.segment<Dim>(first).squaredNorm();
        shares.push_back({static_cast<Index>(i), total > 0 ? energy / total : 0});
    }
    return shares;
}

template <int Dim>
std::shared_ptr<const Pencil> SpringPencil<Dim>::scaled(double stiffness, double mass) const {
    auto pencil = std::make_shared<SpringPencil>(*this);
    pencil->mass_ *= mass;
    for (Link& link : pencil->links_) {
        link.axial *= stiffness;
        link.transverse *= stiffness;
        link.bound *= stiffness;
    }
    return pencil;
}

}  // namespace taut

#include "detail/spring_pencil_bound.ipp"
