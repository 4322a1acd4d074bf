// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// Whose a mode of a Pencil is.

namespace taut {

template <class Real>
std::vector<SpringShare> Pencil::spring_shares(const Eigen::VectorXd& u,
                                               const Combination& c) const {
    std::vector<SpringShare> shares;
    double total = 0;
    for (std::size_t s = 0; s < links_.size(); ++s) {
        const auto [axial, transverse] = coefficients(c, links_[s]);
        const double* d = links_[s].d;
        double du[3];
        difference(u.data(), links_[s], du);
        const double along = dot(d, du);
        double energy = axial * along * along;
        for (int k = 0; k < 3; ++k) energy += transverse * std::pow(du[k] - along * d[k], 2);
        const auto [index, a, b] = names_[s];
        shares.push_back({index, a, b, energy});
        total += energy;
    }
    for (auto& share : shares) share.share = total > 0 ? share.share / total : 0;
    return shares;
}

template <class Real>
std::vector<ParticleShare> Pencil::particle_shares(const Eigen::VectorXd& u) const {
    std::vector<ParticleShare> shares;
    const double total = mass_.dot(u.cwiseAbs2());
    for (Index j = 0; j < size() / dim(); ++j) {
        const double energy = mass_[dim() * j] * u.segment(dim() * j, dim()).squaredNorm();
        const Index index = matrices_ ? j : free_[j];
        shares.push_back({index, total > 0 ? energy / total : 0});
    }
    return shares;
}

}  // namespace taut
