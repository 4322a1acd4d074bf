// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "../network/block_pattern.hpp"
#include "pencil_matrix.hpp"

namespace taut {

template <class Real, class CoefficientsOf>
SparseMatrix<Real> Pencil::assemble_links(const Combination& c,
                                          const CoefficientsOf& coefficients_of) const {
    Buffer<Coefficients> of_links;
    of_links.reserve(links_.size());
    for (const Link& link : links_) of_links.push_back(coefficients_of(link));
    SparseMatrix<Real> S = dim() == 1   ? assemble_in<1>(of_links)
                           : dim() == 2 ? assemble_in<2>(of_links)
                                        : assemble_in<3>(of_links);
    S.diagonal() += mass_coefficient(c) * mass_;
    return S;
}

template <int Dim>
SparseMatrix<double> Pencil::assemble_in(const Buffer<Coefficients>& of_links) const {
    using Matrix = Eigen::Matrix<double, Dim, Dim>;
    Buffer<BlockPair> pairs;
    pairs.reserve(links_.size());
    for (const Link& link : links_) pairs.push_back({link.a, link.b});
    const BlockPattern pattern(size() / Dim, pairs);
    SparseMatrix<double> S = pattern.zero<double, Dim>();
    const auto add = [&](int row, int column, const Matrix& P) {
        if (row >= 0 && column >= 0) pattern.add(S, pattern.place(row, column), column, P);
    };
    for (std::size_t s = 0; s < links_.size(); ++s) {
        const Link& link = links_[s];
        const auto [axial, transverse] = of_links[s];
        const Eigen::Matrix<double, Dim, 1> d(link.d);
        const Matrix P = spring_block(d, axial, transverse);
        add(link.a, link.a, P);
        add(link.b, link.b, P);
        add(link.a, link.b, -P);
        add(link.b, link.a, -P);
    }
    return S;
}

template <class Real>
SparseMatrix<Real> Pencil::assemble(const Combination& c) const {
    if (matrices_) return matrices_->assemble(c);
    return assemble_links<Real>(c, [&](const Link& link) { return coefficients(c, link); });
}

template <class Real>
SparseMatrix<Real> Pencil::assemble_least(const Combination& c) const {
    if (matrices_) return matrices_->assemble(c);
    return assemble_links<Real>(
        c, [&](const Link& link) { return extreme_coefficients(c, link, -1); });
}

/// Each entry of a link's block carries ≤ 24 roundings of its magnitude (the tangent's own among
/// them), and adding d of them up d more; a row of Dim entries meets two blocks of each link.
template <class Real>
Real Pencil::assembly_error(const Combination& c, const Eigen::VectorXd& s) const {
    if (matrices_) return matrices_->assembly_error(c, s);
    Buffer<double> row(degree_.size());
    Buffer<double> scale(degree_.size());
    for (std::size_t i = 0; i < scale.size(); ++i) {
        scale[i] = s.segment(dim() * static_cast<Index>(i), dim()).maxCoeff();
        row[i] = (std::abs)(mass_coefficient(c)) * particle_mass(i) * scale[i] * scale[i];
    }
    for (const Link& link : links_) {
        const double entry = dim() * magnitude(c, link);
        const double sa = link.a < 0 ? 0 : scale[link.a];
        const double sb = link.b < 0 ? 0 : scale[link.b];
        if (link.a >= 0) row[link.a] += entry * sa * (sa + sb);
        if (link.b >= 0) row[link.b] += entry * sb * (sa + sb);
    }
    double largest = 0;
    for (std::size_t i = 0; i < row.size(); ++i) {
        largest = (std::max)(largest, (degree_[i] + 32) * row[i]);
    }
    return largest * std::numeric_limits<double>::epsilon();
}

}  // namespace taut
