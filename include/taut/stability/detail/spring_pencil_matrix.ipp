// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// SpringPencil as a sparse matrix, and what its rounding comes to.

namespace taut {

template <int Dim>
template <class CoefficientsOf>
SparseMatrix<double> SpringPencil<Dim>::assemble(const Combination& c,
                                                 CoefficientsOf&& coefficients_of) const {
    const BlockPattern pattern(size() / Dim, [&](const auto& visit) {
        for (const Link& link : links_) {
            if (link.a >= 0 && link.b >= 0) visit(link.a, link.b);
        }
    });
    SparseMatrix<double> S = pattern.zero<double, Dim>();
    const auto add = [&](int row, int column, const Block& P) {
        if (row >= 0 && column >= 0) pattern.add(S, pattern.place(row, column), column, P);
    };
    for (const Link& link : links_) {
        const auto [axial, transverse] = coefficients_of(link);
        const Block P = spring_block(link.d, axial, transverse);
        add(link.a, link.a, P);
        add(link.b, link.b, P);
        add(link.a, link.b, -P);
        add(link.b, link.a, -P);
    }
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

}  // namespace taut
