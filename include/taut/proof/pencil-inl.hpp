// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "detail/small_eigenvalue.hpp"
#include "pencil.hpp"

// The products of a Pencil, its weighted splitting bound [T26], and what other stiffness or mass
// would make of the scene. Plain loops.

namespace taut {

TAUT_INLINE auto Pencil::coefficients(const Combination& c, const Link& link) const
    -> Coefficients {
    const double on_plus = c.projected() + c.damping() * rayleigh_.stiffness_proportional;
    const auto elastic = [&](double slope) {
        return c.stiffness() * slope + on_plus * k_plus(slope);
    };
    return {elastic(link.axial) + c.damping() * link.damping,
            elastic(link.transverse) + c.damping() * link.across};
}

TAUT_INLINE auto Pencil::extreme_coefficients(const Combination& c, const Link& link,
                                              int sign) const -> Coefficients {
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

TAUT_INLINE void Pencil::multiply(const Combination& c, const Eigen::VectorXd& u,
                                  Eigen::VectorXd& y) const {
    if (matrices_) return matrices_->multiply(c, u, y);
    y.resize(size());
    const double on_mass = mass_coefficient(c);
    const double *from = u.data(), *mass = mass_.data();
    double* to = y.data();
    for (Index i = 0; i < size(); ++i) to[i] = on_mass * (mass[i] * from[i]);
    for (const Link& link : links_) {
        const auto [axial, transverse] = coefficients(c, link);
        const double* d = link.d;
        double du[3];
        difference(from, link, du);
        const double along = (axial - transverse) * dot(d, du);
        for (int k = 0; k < dim(); ++k) {
            const double pull = transverse * du[k] + along * d[k];
            if (link.a >= 0) to[dim() * Index(link.a) + k] += pull;
            if (link.b >= 0) to[dim() * Index(link.b) + k] -= pull;
        }
    }
}

TAUT_INLINE Enclosed Pencil::quadratic(const Combination& c, const Eigen::VectorXd& u) const {
    if (matrices_) return matrices_->quadratic(c, u);
    // As a sum over springs the form loses nothing to cancellation between neighbours.
    Enclosed sum;
    const double on_mass = mass_coefficient(c);
    for (Index i = 0; i < size(); ++i) {
        const double term = mass_.data()[i] * u.data()[i] * u.data()[i];
        sum.value += on_mass * term;
        sum.error += term * (std::abs)(on_mass);
    }
    const bool springs =
        c.stiffness() != 0 || c.projected() != 0 ||
        (c.damping() != 0 && (!is_rayleigh() || rayleigh_.stiffness_proportional > 0));
    for (std::size_t s = 0; springs && s < links_.size(); ++s) {
        const Link& link = links_[s];
        const auto [axial, transverse] = coefficients(c, link);
        const double* d = link.d;
        double du[3], across[3];
        difference(u.data(), link, du);
        const double along = dot(d, du);
        for (int k = 0; k < 3; ++k) across[k] = du[k] - along * d[k];
        sum.value += axial * along * along + transverse * dot(across, across);
        sum.error += magnitude(c, link) * dot(du, du);
    }
    // Each term carries ≤ 32 roundings, the sum one more for each term; √terms would be typical.
    const double terms = static_cast<double>(size()) + static_cast<double>(links_.size()) + 32;
    sum.error *= terms * std::numeric_limits<double>::epsilon();
    return sum;
}

/// One choice of weights in [T26]: of each free particle the block Σ_b (1 + p_b/p_i) P_b, and a
/// bound on its rounding error, N/m.
struct Pencil::Splitting {
    using Block = proof_detail::SymmetricBlock;
    /// A spring's P.
    struct Term {
        int a, b;
        double axial, transverse, size;
        const double* d;
    };
    Buffer<Term> term;
    Buffer<double> line;  // of one dimension in place of blocks
    Buffer<Block> block;
    Buffer<double> rounding;
};

/// The springs' part of S, as far as it may be positive.
TAUT_INLINE auto Pencil::splitting(const Combination& c) const -> Splitting {
    Splitting split;
    split.term.reserve(links_.size());
    split.rounding.resize(degree_.size());
    if (dim() == 1) split.line.resize(degree_.size());
    if (dim() > 1) split.block.resize(degree_.size());
    // The factor of every K⁺: where it is not positive, neither is any transverse coefficient,
    // whatever the rounding of the tangents.
    const double factor = c.projected() + c.damping() * rayleigh_.stiffness_proportional;
    const double eps = std::numeric_limits<double>::epsilon();
    for (const Link& link : links_) {
        const auto [axial, transverse] = extreme_coefficients(c, link, 1);
        const double size = magnitude(c, link);
        const double least = -64 * eps * size;
        const bool by_signs = c.stiffness() == 0 && factor <= 0 &&
                              (c.damping() <= 0 || (axial < least && link.across == 0));
        const bool by_damper = link.across > 0 && axial < least && transverse < least;
        if (by_signs || by_damper) continue;  // not positive for certain
        split.term.push_back(
            {link.a, link.b, (std::max)(axial, 0.0), (std::max)(transverse, 0.0), size, link.d});
    }
    return split;
}

/// Gives each particle its parts of the springs, by weights p.
TAUT_INLINE void Pencil::spread(const double* p, Splitting& split) const {
    std::fill(split.line.begin(), split.line.end(), 0.0);
    std::fill(split.block.begin(), split.block.end(), Splitting::Block{});
    std::fill(split.rounding.begin(), split.rounding.end(), 0.0);
    const auto for_each_end = [&](const Splitting::Term& t, const auto& add) {
        const auto a = static_cast<std::size_t>(t.a), b = static_cast<std::size_t>(t.b);
        const bool both = t.a >= 0 && t.b >= 0;
        const auto give = [&](std::size_t i, double weight) {
            split.rounding[i] += weight * t.size;
            add(i, weight);
        };
        if (t.a >= 0) give(a, both ? 1 + p[b] / p[a] : 1);
        if (t.b >= 0) give(b, both ? 1 + p[a] / p[b] : 1);
    };
    for (const auto& t : split.term) {
        const double* d = t.d;
        if (dim() == 1) {
            const double k = d[0] * d[0] * (t.axial - t.transverse) + t.transverse;
            for_each_end(t, [&](std::size_t i, double weight) { split.line[i] += weight * k; });
            continue;
        }
        Splitting::Block P;
        for (int j = 0; j < dim(); ++j) {
            for (int i = j; i < dim(); ++i) P(i, j) = d[i] * d[j] * (t.axial - t.transverse);
            P(j, j) += t.transverse;
        }
        for_each_end(t, [&](std::size_t i, double weight) {
            for (int e = 0; e < 6; ++e) split.block[i].entry[e] += weight * P.entry[e];
        });
    }
    const double eps = std::numeric_limits<double>::epsilon();
    for (std::size_t i = 0; i < split.rounding.size(); ++i) {
        double& size = split.rounding[i];
        if (size > 0) {
            size = (std::max)(size * (degree_[i] + 64) * eps, (std::numeric_limits<double>::min)());
        }
    }
}

/// An upper bound on the largest eigenvalue of a particle's block, N/m.
TAUT_INLINE double Pencil::load(const Splitting& split, std::size_t i) const {
    constexpr double margin = 1 + 64 * std::numeric_limits<double>::epsilon();
    if (dim() == 1) return split.line[i] * margin + split.rounding[i];
    return proof_detail::eigenvalue_upper_bound(split.block[i], dim()) + split.rounding[i];
}

/// The largest load over mass, 1/s². One small factorisation settles most particles of a
/// regular scene.
TAUT_INLINE double Pencil::largest_quotient(const Splitting& split) const {
    double largest = 0;
    for (std::size_t i = 0; i < split.rounding.size(); ++i) {
        const double below = largest * particle_mass(i) * (1 - 1e-15) - split.rounding[i];
        if (dim() > 1 && proof_detail::proved_above(split.block[i], below)) continue;
        const double r = quotient(load(split, i), i);
        if (!detail::is_finite(r)) return std::numeric_limits<double>::infinity();
        largest = (std::max)(largest, r);
    }
    return largest;
}

template <class Real>
std::vector<Real> Pencil::particle_loads(const Combination& c, const std::vector<Real>& p) const {
    Splitting split = splitting(c);
    spread(p.data(), split);
    std::vector<Real> loads(p.size());
    for (std::size_t i = 0; i < p.size(); ++i) loads[i] = load(split, i);
    return loads;
}

TAUT_INLINE double Pencil::upper_bound(const Combination& c) const {
    if (matrices_) return matrices_->upper_bound(c);
    constexpr int most_repeats = 40;
    constexpr double worth_repeating = 1e-3;  // of the bound, over five repeats
    Buffer<double> p(degree_.size());
    for (std::size_t i = 0; i < p.size(); ++i) p[i] = 1 / std::sqrt(particle_mass(i));
    Splitting split = splitting(c);
    spread(p.data(), split);
    double best = largest_quotient(split);
    if (!detail::is_finite(best)) return std::numeric_limits<double>::infinity();
    double earlier = best;
    Buffer<double> r(p.size());
    for (int repeat = 1; repeat <= most_repeats && best > 0; ++repeat) {
        // A particle whose bound is far below the largest must not lose all its weight at once.
        for (std::size_t i = 0; i < r.size(); ++i) r[i] = quotient(load(split, i), i);
        const double largest = *std::max_element(r.begin(), r.end());
        for (std::size_t i = 0; i < p.size(); ++i) {
            p[i] *= std::sqrt((std::max)(r[i] / largest, 1e-4));
        }
        spread(p.data(), split);
        best = (std::min)(best, largest_quotient(split));
        if (repeat % 5 == 0) {
            if (best > earlier * (1 - worth_repeating)) break;
            earlier = best;
        }
    }
    const double rounding = 1 + 16 * std::numeric_limits<double>::epsilon();
    return best * rounding +
           mass_coefficient(c) * (mass_coefficient(c) > 0 ? rounding : 1 / rounding);
}

template <class Real>
Pencil Pencil::explicit_part(const std::vector<Real>& shares) const {
    Pencil pencil = *this;
    for (std::size_t s = 0; s < links_.size(); ++s) {
        const double part = 1 - detail::at(shares, names_[s].spring);
        Link& link = pencil.links_[s];
        for (double* value :
             {&link.axial, &link.softer, &link.transverse, &link.damping, &link.across}) {
            *value *= part;
        }
        link.bound *= (std::abs)(part);
        if (part >= 0) continue;
        // K⁺, which Rayleigh's α acts through, has no negative springs.
        link.damping += rayleigh_.stiffness_proportional * link.axial;
        pencil.facts_.is_rayleigh = false;
        pencil.facts_.stiffness_semidefinite = false;
        pencil.facts_.damping_semidefinite = false;
    }
    return pencil;
}

template <class Real>
void Pencil::add_dampers(const std::vector<Real>& dampers) {
    for (std::size_t s = 0; s < links_.size(); ++s) {
        const double c = detail::at(dampers, names_[s].spring);
        Link& link = links_[s];
        link.damping += c;
        link.across += dim() == 1 && link.d[0] != 0 ? 0 : c;
        if (c > 0) facts_.is_rayleigh = false;
    }
}

template <class Real>
Pencil Pencil::scaled(Real stiffness, Real mass) const {
    constexpr double least = (std::numeric_limits<double>::min)();
    Pencil pencil = *this;
    pencil.mass_ *= mass;
    if (matrices_) pencil.matrices_ = matrices_->scaled(stiffness, mass, is_rayleigh());
    for (Link& link : pencil.links_) {
        link.axial *= stiffness;
        link.softer *= stiffness;
        link.transverse *= stiffness;
        // The rounding that a bound stands for must not vanish with it.
        const bool zero = link.bound == 0 || stiffness == 0;
        link.bound = (std::max)(link.bound * stiffness, zero ? 0 : least);
    }
    return pencil;
}

}  // namespace taut
