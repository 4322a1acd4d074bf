// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "../../core/error.hpp"
#include "../../network/spring_system.hpp"
#include "../../network/tension_only.hpp"
#include "lammps_types.hpp"

namespace taut::io_detail {

/// What LAMMPS has no equal for is refused by name, or left out with a warning.
class LammpsEquals {
public:
    explicit LammpsEquals(bool nearest) : nearest_(nearest) {}

    /// @param what     the subject of a sentence, and what LAMMPS lacks
    /// @param nearest  what is written in its place, if it may be
    void lacks(const std::string& what, const char* nearest) {
        if (!nearest_) {
            fail("write_lammps: ", what, "; LammpsOptions::nearest allows it to be ", nearest);
        }
        warnings.push_back(what + "; it was " + nearest);
    }
    std::vector<std::string> warnings;

private:
    bool nearest_;
};

/// Everything but the springs.
template <class System>
void check_forces(const System& system, LammpsEquals& equals) {
    const auto& outside = system.external_forces();
    const auto refuse = [&](bool present, const char* what) {
        if (present) {
            equals.lacks(what + std::string(" has no equal in the script that is written"),
                         "left out");
        }
    };
    refuse(system.rayleigh().stiffness_proportional > 0,
           "stiffness-proportional Rayleigh damping (set_rayleigh)");
    refuse(outside.outside != nullptr, outside.outside ? outside.outside->name() : "");
    refuse(static_cast<bool>(outside.whole), "a force of the state (set_external_force)");
    refuse(outside.constants > 0, "a constant force (set_constant_force)");
}

/// The springs of one law, of which the first that LAMMPS lacks is named.
/// @param first  index of the law's first spring
template <class Set>
void check_law(const Set& set, Index first, LammpsEquals& equals) {
    using Law = typename Set::Law;
    if (set.size() == 0) return;
    if constexpr (std::is_same_v<Law, TensionOnly>) {
        equals.lacks(std::to_string(set.size()) + " springs, the first of them spring " +
                         std::to_string(first) +
                         ", are TensionOnly, and LAMMPS's harmonic bond pushes, too",
                     "written as a harmonic bond of the same stiffness");
    } else if constexpr (!std::is_same_v<Law, Hookean>) {
        fail("write_lammps: spring ", first,
             " is neither Hookean nor TensionOnly; LAMMPS's harmonic bond is no such law");
    }
    for (std::size_t s = 0; s < set.damping.size(); ++s) {
        if (set.damping[s] > 0) {
            equals.lacks("spring " + std::to_string(first + static_cast<Index>(s)) +
                             " has a damper of " + detail::text(set.damping[s]) +
                             " N s/m (and so may others), which LAMMPS's bonds lack",
                         "left out");
            break;
        }
    }
}

/// What the data file needs to know before its first bond: types, and the longest bond.
class LammpsBonds {
public:
    static constexpr Index most = 1 << 20;  // types, of 24 bytes on every rank

    template <class System>
    void count(const System& system, const typename System::State& state);
    /// visit(type, a, b) for every spring, in index order.
    template <class System, class Visitor>
    void for_each(const System& system, Visitor&& visit) {
        visit_bonds(system, [&](Index, double k, double L, Index a, Index b) {
            visit(types_.add({k, L}), a, b);
        });
    }
    const TypeTable& types() const { return types_; }
    /// m, now or at rest.
    double longest() const { return longest_; }

private:
    /// visit(spring, k, L, a, b), of laws that check_law let pass.
    template <class System, class Visitor>
    static void visit_bonds(const System& system, Visitor&& visit) {
        Index s = 0;
        system.for_each_set([&](const auto& set) {
            using Law = typename std::decay_t<decltype(set)>::Law;
            if constexpr (std::is_same_v<Law, Hookean> || std::is_same_v<Law, TensionOnly>) {
                for (std::size_t i = 0; i < set.a.size(); ++i) {
                    visit(s++, static_cast<double>(set.parameters[i].stiffness),
                          static_cast<double>(set.rest_length[i]), Index(set.a[i]),
                          Index(set.b[i]));
                }
            }
        });
    }

    TypeTable types_{most};
    double longest_ = 0;
};

template <class System>
void LammpsBonds::count(const System& system, const typename System::State& state) {
    visit_bonds(system, [&](Index s, double k, double L, Index a, Index b) {
        const double l =
            (state.x.col(b).template cast<double>() - state.x.col(a).template cast<double>())
                .stableNorm();
        if (!(l > 0) || !detail::is_finite(l)) {
            fail("write_lammps: spring ", s, " is ", l, " m long, from particle ", a, " to ", b,
                 "; it must be finite and > 0, since LAMMPS gives no pull without a direction");
        }
        longest_ = (std::max)({longest_, l, L});
        if (types_.add({k, L}) == 0) {
            fail(
                "write_lammps: spring ", s, " (stiffness ", k, " N/m, rest length ", L,
                " m) would be bond type ", most + 1, "; at most ", most,
                " pairs of stiffness and rest length are allowed, since every rank of LAMMPS keeps "
                "them all");
        }
    });
}

/// The type of every particle: those that are free come first, since LAMMPS's groups name ranges
/// of types. Where masses are too many, two types stand for free and pinned, and each particle
/// brings its own mass.
class LammpsAtoms {
public:
    static constexpr Index most = 256;  // types: LAMMPS keeps two tables of most² numbers

    template <class System>
    explicit LammpsAtoms(const System& system) {
        for (Index i = 0; i < system.size() && !per_atom_; ++i) {
            const bool added = table(system.is_pinned(i)).add(key(system, i)) > 0;
            per_atom_ = !added || free_.size() + pinned_.size() > most;
        }
        if (per_atom_) {
            free_types_ = 1;
            types_ = 2;
        } else {
            free_types_ = free_.size();
            types_ = free_types_ + pinned_.size();
        }
    }

    template <class System>
    Index type(const System& system, Index i) {
        const bool pinned = system.is_pinned(i);
        if (per_atom_) return pinned ? 2 : 1;
        return (pinned ? free_types_ : 0) + table(pinned).add(key(system, i));
    }
    /// visit(type, kg) of each, where masses go by type.
    template <class Visitor>
    void for_each_mass(Visitor&& visit) const {
        Index type = 0;
        for (const TypeTable* t : {&free_, &pinned_}) {
            for (const auto& key : t->keys()) visit(++type, key.first);
        }
    }
    bool per_atom() const { return per_atom_; }
    Index free_types() const { return free_types_; }
    Index types() const { return types_; }

private:
    template <class System>
    static TypeTable::Key key(const System& system, Index i) {
        return {static_cast<double>(system.mass(i)), 0};
    }
    TypeTable& table(bool pinned) { return pinned ? pinned_ : free_; }

    TypeTable free_{most};
    TypeTable pinned_{most};
    bool per_atom_ = false;
    Index free_types_ = 0;
    Index types_ = 0;
};

}  // namespace taut::io_detail
