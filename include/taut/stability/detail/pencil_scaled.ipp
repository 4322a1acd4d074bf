// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// What other stiffness or mass would make of the scene.

namespace taut {

template <class Real>
Pencil Pencil::explicit_part(const std::vector<Real>& shares) const {
    Pencil pencil = *this;
    for (std::size_t s = 0; s < links_.size(); ++s) {
        const double part = 1 - shares[static_cast<std::size_t>(names_[s].spring)];
        Link& link = pencil.links_[s];
        for (double* value :
             {&link.axial, &link.softer, &link.transverse, &link.damping, &link.across}) {
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
void Pencil::add_dampers(const std::vector<Real>& dampers) {
    for (std::size_t s = 0; s < links_.size(); ++s) {
        const double c = dampers[static_cast<std::size_t>(names_[s].spring)];
        Link& link = links_[s];
        link.damping += c;
        link.across += dim() == 1 && link.d[0] != 0 ? 0 : c;
        if (c > 0) facts_.is_rayleigh = false;
    }
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
