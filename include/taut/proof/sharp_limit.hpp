// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "../conditions/mode.hpp"
#include "any_pose.hpp"
#include "energy_limit.hpp"
#include "pencil_matrix.hpp"

// Limits at any pose by a polynomial of the matrix [T45]: longer than those of the splitting bound,
// in the time of some hundred steps.

namespace taut {

namespace proof_detail {

/// Rows of a sparse square matrix.
struct SparseRows {
    Buffer<int> end;  // of each row, in what follows
    Buffer<int> column;
    Buffer<double> value;

    int size() const { return static_cast<int>(end.size()); }
    int begin(int i) const { return i > 0 ? end[i - 1] : 0; }
    /// visit(column, value) for the entries of row i.
    template <class Visitor>
    void visit_row(int i, const Visitor& visit) const {
        for (int e = begin(i); e < end[i]; ++e) visit(column[e], value[e]);
    }
    int longest() const {
        int most = 0;
        for (int i = 0; i < size(); ++i) most = (std::max)(most, end[i] - begin(i));
        return most;
    }
    /// One entry of each column in a row, the sum: no entry of a square has more terms than the
    /// longest of its rows entries.
    void merge() {
        Buffer<int> place(size(), -1);  // of each column
        int used = 0;
        for (int i = 0, e = 0; i < size(); ++i) {
            const int first = used;
            for (; e < end[i]; ++e) {
                int& at = place[column[e]];
                if (at < first) {
                    at = used++;
                    column[at] = column[e];
                    value[at] = value[e];
                } else {
                    value[at] += value[e];
                }
            }
            end[i] = used;
        }
    }
};

/// visit(i, sum) for each row, with sum = (Σ_j |a_ij| p_j)/p_i. @returns the largest, which bounds
/// every |eigenvalue|, for all weights p > 0
template <class Rows, class Visitor>
double weighted_norm(Rows& a, const Buffer<double>& p, const Visitor& visit) {
    double largest = 0;
    for (int i = 0; i < a.size(); ++i) {
        double sum = 0;
        a.visit_row(i, [&](int j, double value) { sum += (std::abs)(value)*p[j]; });
        sum /= p[i];
        visit(i, sum);
        largest = (std::max)(largest, sum);
    }
    return largest;
}
template <class Rows>
double weighted_norm(Rows& a, const Buffer<double>& p) {
    return weighted_norm(a, p, [](int, double) {});
}

/// 2A² − I, one row after the other.
class DoubledSquare {
public:
    explicit DoubledSquare(const SparseRows& a) : a_(a), sum_(a.size()), row_(a.size(), -1) {}
    int size() const { return a_.size(); }
    /// visit(column, value) for the entries of row i.
    template <class Visitor>
    void visit_row(int i, const Visitor& visit) {
        columns_.clear();
        add(i, i, -1);
        for (int e = a_.begin(i); e < a_.end[i]; ++e) {
            const int k = a_.column[e];
            const double twice = 2 * a_.value[e];
            for (int f = a_.begin(k); f < a_.end[k]; ++f) add(i, a_.column[f], twice * a_.value[f]);
        }
        for (const int j : columns_) visit(j, sum_[j]);
    }

private:
    void add(int i, int j, double term) {
        if (row_[j] == i) {
            sum_[j] += term;
            return;
        }
        row_[j] = i;
        sum_[j] = term;
        columns_.push_back(j);
    }

    const SparseRows& a_;
    Buffer<double> sum_;   // of each column
    Buffer<int> row_;      // that this is of
    Buffer<int> columns_;  // of the row
};

}  // namespace proof_detail

template <class Real>
Real Pencil::polynomial_bound(const Combination& combination) const {
    constexpr double eps = std::numeric_limits<double>::epsilon();
    constexpr double share = 0.3;       // s in the splitting bound
    constexpr double longest_row = 96;  // of T₂(C), on the average: else it takes too long
    const double known = upper_bound(combination);
    const double s = share * known;
    if (matrices_ || dim() != 1 || !(s > 0) || !detail::is_finite(1 / s)) return known;
    const int n = static_cast<int>(size());

    // C = M⁻¹S/s − I, the diagonal first in each row.
    proof_detail::SparseRows c;
    c.end.resize(n);
    for (int i = 0; i < n; ++i) c.end[i] = c.begin(i) + 1 + degree_[i];
    c.column.resize(c.begin(n));
    c.value.resize(c.begin(n));
    Buffer<int> next(n);
    for (int i = 0; i < n; ++i) {
        next[i] = c.begin(i) + 1;
        c.column[c.begin(i)] = i;
        c.value[c.begin(i)] = mass_coefficient(combination) * particle_mass(i);
    }
    for (const Link& link : links_) {
        const double k = coefficients(combination, link).axial;
        const auto add = [&](int i, int j) {
            if (i < 0) return;
            c.value[c.begin(i)] += k;
            c.column[next[i]] = j < 0 ? i : j;
            c.value[next[i]++] = j < 0 ? 0 : -k;
        };
        add(link.a, link.b);
        add(link.b, link.a);
    }
    c.merge();  // before any division, so that S stays symmetric to the bit
    for (int i = 0; i < n; ++i) {
        for (int e = c.begin(i); e < c.end[i]; ++e) c.value[e] = c.value[e] / particle_mass(i) / s;
        c.value[c.begin(i)] -= 1;
    }

    proof_detail::SparseRows second;  // T₂(C)
    const double most = (std::min)(longest_row * n, double((std::numeric_limits<int>::max)()));
    proof_detail::DoubledSquare squares(c);
    for (int i = 0; i < n; ++i) {
        squares.visit_row(i, [&](int j, double value) {
            second.column.push_back(j);
            second.value.push_back(value);
        });
        if (!(static_cast<double>(second.column.size()) <= most)) return known;
        second.end.push_back(static_cast<int>(second.column.size()));
    }
    double terms = 0;  // of its square: those of a hub are many
    for (const int j : second.column) terms += second.end[j] - second.begin(j);
    if (terms > longest_row * longest_row * n) return known;
    Eigen::VectorXd scale(n);
    Buffer<double> p(n), quotients(n);
    for (int i = 0; i < n; ++i) p[i] = scale.data()[i] = 1 / std::sqrt(particle_mass(i));
    for (int repeat = 0; repeat < 12; ++repeat) {
        const double norm =
            weighted_norm(second, p, [&](int i, double sum) { quotients[i] = sum; });
        if (!(norm > 0 && detail::is_finite(norm))) break;
        for (int i = 0; i < n; ++i) p[i] *= std::sqrt((std::max)(quotients[i] / norm, 1e-4));
    }
    proof_detail::DoubledSquare fourth(second);
    double norm = weighted_norm(fourth, p);
    // Each entry of T₄(C) is within (110 + 19·longest) ε of that of (|C| + 2I)⁴.
    const double size = 1.01 * weighted_norm(c, p) + 2;
    const double longest = second.longest();
    norm = norm * (1 + (64 + longest * longest) * eps) +
           (128 + 20 * longest) * eps * size * size * size * size;
    const double growth = std::cosh(std::acosh((std::max)(norm, 1.0)) / 4);
    const double bound = s * (1 + growth) * (1 + 64 * eps) + assembly_error(combination, scale);
    return detail::is_finite(bound) && bound < known ? bound : known;
}

namespace proof_detail {

/// That bound on k_max, which is all that the limit of a Rayleigh-damped scene asks for.
template <class Real = double>
Real sharp_k_max(const Pencil& laplacian) {
    return laplacian.is_rayleigh() ? laplacian.polynomial_bound(matrices::K_plus) : 0;
}

/// The limit of symplectic_by_bounds by that bound. @param k  sharp_k_max
template <class Real = double>
UnroundedLimit sharp_by_laplacian(const Pencil& laplacian, Real k, Real part) {
    using namespace matrices;
    UnroundedLimit limit = by_laplacian(laplacian);
    double& h = limit.certified;
    if (h > 0 && detail::is_finite(h) && laplacian.is_rayleigh()) {
        const auto& rayleigh = laplacian.rayleigh();
        const double d = rayleigh.mass_proportional + rayleigh.stiffness_proportional * k;
        h = (std::max)(h, critical_step(Method::symplectic_euler, k, d));
    } else if (h > 0 && detail::is_finite(h)) {
        // As in certified_symplectic: from h the step h/√g is safe as well.
        for (int repeat = 0; repeat < 3; ++repeat) {
            const double g = laplacian.polynomial_bound(2 * h * D + h * h * K_plus) / 4;
            const double larger = h / std::sqrt(g);
            if (!(larger > h * 1.01)) break;
            h = larger;
        }
    }
    h *= part;
    return limit;
}

}  // namespace proof_detail

/// any_pose_limit(system) and energy_limit(system) by a sharper bound [T45]: on cloths and garments
/// within 4 % of the conditions' own ends, where the splitting bound leaves 5 to 20 %. They take as
/// long as some hundred steps, and tearing asks for them anew.
template <class Scalar, int Dim, class... Laws>
std::pair<StepLimit<Scalar>, StepLimit<Scalar>> sharp_limits(
    const SpringSystem<Scalar, Dim, Laws...>& system) {
    using namespace proof_detail;
    const Pencil laplacian = Pencil::any_pose(system);
    const Pencil halved = Pencil::any_pose(system, Pencil::Damping::half);
    const double k = sharp_k_max(laplacian);  // of both
    return {rounded<Scalar>(sharp_by_laplacian(laplacian, k, 1.0), system.revision()),
            rounded<Scalar>(sharp_by_laplacian(halved, k, 0.5), system.revision())};
}

/// The first of sharp_limits(system).
template <class Scalar, int Dim, class... Laws>
StepLimit<Scalar> sharp_any_pose_limit(const SpringSystem<Scalar, Dim, Laws...>& system) {
    using namespace proof_detail;
    const Pencil laplacian = Pencil::any_pose(system);
    return rounded<Scalar>(sharp_by_laplacian(laplacian, sharp_k_max(laplacian), 1.0),
                           system.revision());
}

/// The second of sharp_limits(system).
template <class Scalar, int Dim, class... Laws>
StepLimit<Scalar> sharp_energy_limit(const SpringSystem<Scalar, Dim, Laws...>& system) {
    using namespace proof_detail;
    const Pencil halved = Pencil::any_pose(system, Pencil::Damping::half);
    return rounded<Scalar>(sharp_by_laplacian(halved, sharp_k_max(halved), 0.5), system.revision());
}

}  // namespace taut
