// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// Whose a mode of a Pencil is, and what other stiffness or mass would make of the scene.

namespace taut {

template <class Real>
std::vector<SpringShare> Pencil::spring_shares(const Eigen::VectorXd& u) const {
    std::vector<SpringShare> shares;
    double total = 0;
    for (std::size_t s = 0; s < links_.size(); ++s) {
        const auto [axial, transverse] = coefficients(matrices::K_plus, links_[s]);
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
        const Index index = matrices_ ? j : free_[static_cast<std::size_t>(j)];
        shares.push_back({index, total > 0 ? energy / total : 0});
    }
    return shares;
}

template <class Real>
Pencil Pencil::explicit_part(const std::vector<Real>& shares) const {
    Pencil pencil = *this;
    for (std::size_t s = 0; s < links_.size(); ++s) {
        const double part = 1 - shares[static_cast<std::size_t>(names_[s].spring)];
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

template <class Real>
Pencil Pencil::scaled(Real stiffness, Real mass) const {
    constexpr double least = std::numeric_limits<double>::min();
    Pencil pencil = *this;
    pencil.mass_ *= mass;
    if (matrices_) pencil.matrices_ = matrices_->scaled(stiffness, mass, is_rayleigh());
    for (Link& link : pencil.links_) {
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
