// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// Pencils of a SpringSystem: what is left of it are arrays of doubles.

namespace taut {

/// Masses and damping, without springs.
template <class System>
Pencil Pencil::of_particles(const System& system, int dim, proof_detail::RangeCheck& check) {
    using Scalar = typename System::Scalar;
    Pencil pencil;
    pencil.rayleigh_ = {held_as<Scalar>(system.rayleigh().mass_proportional),
                        held_as<Scalar>(system.rayleigh().stiffness_proportional)};
    pencil.facts_ = {dim,  true, true,
                     true, true, 16 * static_cast<double>(std::numeric_limits<Scalar>::epsilon())};
    for (Index i = 0; i < system.size(); ++i) {
        if (!system.is_pinned(i)) pencil.free_.push_back(static_cast<int>(i));
    }
    pencil.mass_.resize(dim * static_cast<Index>(pencil.free_.size()));
    double* mass = pencil.mass_.data();
    for (const int i : pencil.free_) {
        const double m = check.in_range(system.mass(i), "mass of particle", i);
        for (int k = 0; k < dim; ++k) *mass++ = m;
    }
    pencil.degree_.assign(pencil.free_.size(), 0);
    return pencil;
}

/// @param tangent  tangent(set, s, index): a Link without its ends and its damper
template <class System, class Tangent>
void Pencil::add_springs(const System& system, proof_detail::RangeCheck& check,
                         const Tangent& tangent) {
    // A few ulp below zero are rounding of l − L.
    constexpr double rounding =
        -16 *
        static_cast<double>(std::numeric_limits<TangentReal<typename System::Scalar>>::epsilon());
    Buffer<int> place(static_cast<std::size_t>(system.size()), -1);  // −1: pinned
    for (std::size_t j = 0; j < free_.size(); ++j) {
        place[free_[j]] = static_cast<int>(j);
    }
    const auto count = static_cast<std::size_t>(system.spring_count());
    links_.reserve(count);
    names_.reserve(count);
    int springs = 0;
    system.for_each_set([&](const auto& set) {
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            const int index = springs++;
            const int a = place[set.a[s]];
            const int b = place[set.b[s]];
            if (a < 0 && b < 0) continue;
            Link link = tangent(set, s, index);
            link.a = a;
            link.b = b;
            link.damping = check.in_range(set.damping_of(s), "damping of spring", index);
            if (link.damping > 0) facts_.is_rayleigh = false;
            if (link.softer < rounding * link.bound || link.transverse < rounding * link.bound) {
                facts_.stiffness_semidefinite = false;
            }
            if (a >= 0) ++degree_[a];
            if (b >= 0) ++degree_[b];
            names_.push_back({index, set.a[s], set.b[s]});
            links_.push_back(link);
        }
    });
    lost_ = check.lost();
}

template <class System>
Pencil Pencil::at_pose(const System& system,
                       const Points<TangentReal<typename System::Scalar>, int(System::Dim)>& x) {
    using Real = TangentReal<typename System::Scalar>;
    constexpr int Dim = System::Dim;
    proof_detail::RangeCheck check;
    Pencil pencil = of_particles(system, Dim, check);
    for (Index i = 0; i < system.size(); ++i) {
        Real largest = 0;
        for (int k = 0; k < Dim; ++k) largest = (std::max)(largest, (std::abs)(x(k, i)));
        check.check_length(largest, "position of particle", i);
    }
    pencil.add_springs(system, check, [&](const auto& set, std::size_t s, int index) {
        const SpringTangent<Real, Dim> t = set.tangent(s, x);
        const auto [softer, stiffer] = set.axial_range(s, x, t);
        Link link{};
        for (int k = 0; k < Dim; ++k) link.d[k] = static_cast<double>(t.d[k]);
        link.axial = static_cast<double>(stiffer);
        link.softer = static_cast<double>(softer);
        // At l = 0 there is no axis: the whole tangent is isotropic, in one dimension too.
        link.transverse = Dim == 1 && t.d[0] != 0 ? 0 : static_cast<double>(t.transverse);
        link.bound = check.in_range(t.bound, "stiffness of spring", index);
        check.check_length(static_cast<Real>(set.rest_length[s]), "rest length of spring", index);
        return link;
    });
    return pencil;
}

template <class System>
Pencil Pencil::any_pose(const System& system, Damping counted) {
    using Real = TangentReal<typename System::Scalar>;
    proof_detail::RangeCheck check;
    Pencil pencil = of_particles(system, 1, check);
    pencil.add_springs(system, check, [&](const auto& set, std::size_t s, int index) {
        const Real bound = set[s].template cast<Real>().stiffness_bound();
        Link link{};
        link.d[0] = 1;
        link.bound = check.in_range(bound, "stiffness of spring", index);
        link.axial = link.softer = link.bound;
        return link;
    });
    if (counted == Damping::half) {
        pencil.rayleigh_.mass_proportional /= 2;
        pencil.rayleigh_.stiffness_proportional /= 2;
        for (Link& link : pencil.links_) link.damping /= 2;
    }
    return pencil;
}

}  // namespace taut
