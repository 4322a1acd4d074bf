// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/network/spring_system.hpp>

#include "exact_law.hpp"

// M, D, K, K⁺ of a system [T1], [T2], [T27], [T28] in as many bits as the referee asks for, written
// from the theory's equations with nothing of the library's analysis in them.

namespace soundness {

using taut::Index;

/// What a limit is about. D = d0·M + α·K⁺ + dampers.
struct Exact {
    std::vector<Real> mass;  ///< N
    Rounded K;
    Rounded K_plus;
    Rounded dampers;
    Rounded bound;  ///< every spring's block at its law's bound: what rounding is relative to
    Real d0 = 0;
    Real alpha = 0;
    bool springs = false;          ///< K⁺ differs from K where springs are compressed
    bool moved = false;            ///< a spring's slope is not that at its length
    bool kinked = false;           ///< by far: it is across a kink
    std::function<Exact()> again;  ///< the same in the bits that are set when it is called

    explicit Exact(int n)
        : mass(static_cast<std::size_t>(n)), K(n), K_plus(n), dampers(n), bound(n) {}
    int size() const { return K.size(); }
};

/// A sum of M, K, K⁺ and D.
class Sum {
public:
    explicit Sum(const Exact& e) : e_(e) {}
    Sum& mass(const Real& c) { return add(mass_, c); }
    Sum& stiffness(const Real& c) { return add(stiffness_, c); }
    Sum& projected(const Real& c) { return add(projected_, c); }
    Sum& bound(const Real& c) { return add(bound_, c); }
    Sum& damping(const Real& c) { return mass(c * e_.d0).projected(c * e_.alpha).add(dampers_, c); }

    Rounded matrix() const {
        Rounded A(e_.size());
        for (int i = 0; i < e_.size(); ++i) {
            A.value(i, i) = mass_.value * e_.mass[i];
            A.magnitude(i, i) = mass_.size * e_.mass[i];
        }
        accumulate(A, stiffness_, e_.K);
        accumulate(A, projected_, e_.K_plus);
        accumulate(A, dampers_, e_.dampers);
        accumulate(A, bound_, e_.bound);
        return A;
    }

private:
    struct Coefficient {
        Real value = 0;
        Real size = 0;  // of what it was added up from
    };
    Sum& add(Coefficient& coefficient, const Real& c) {
        coefficient.value += c;
        coefficient.size += abs(c);
        return *this;
    }
    static void accumulate(Rounded& A, const Coefficient& c, const Rounded& B) {
        if (c.size == 0) return;
        for (int i = 0; i < A.size(); ++i) {
            for (int j = 0; j < A.size(); ++j) {
                if (B.magnitude(i, j) == 0) continue;
                A.value(i, j) += c.value * B.value(i, j);
                A.magnitude(i, j) += c.size * B.magnitude(i, j);
            }
        }
    }

    const Exact& e_;
    Coefficient mass_, stiffness_, projected_, dampers_, bound_;
};

/// Adds a spring's block axial·ddᵀ + transverse·(I − ddᵀ) at the degrees of freedom a … and b …,
/// −1 for a pinned end.
inline void add_block(Rounded& A, int a, int b, const std::vector<Real>& d, const Real& axial,
                      const Real& transverse, const Real& magnitude) {
    const int dim = static_cast<int>(d.size());
    for (const auto& [row, column] : {std::array<int, 2>{a, a}, {b, b}, {a, b}, {b, a}}) {
        if (row < 0 || column < 0) continue;
        for (int i = 0; i < dim; ++i) {
            for (int j = 0; j < dim; ++j) {
                const Real along = d[i] * d[j];
                Real entry = (axial - transverse) * along;
                if (i == j) entry += transverse;
                A.value(row + i, column + j) += row == column ? entry : Real(-entry);
                A.magnitude(row + i, column + j) += magnitude;
            }
        }
    }
}

/// Which slope counts where a spring is within `reach` of a kink, in units of the rounding of its
/// coordinates and rest length to Scalar.
struct Side {
    bool stiffer;
    double reach;
};

/// T′ of that side: of both slopes at each jump and of those at both ends.
template <class Law, class Parameters>
Real slope_on_side(Law law, const Parameters& p, const Real& L, const Real& l, const Real& reach,
                   bool stiffer) {
    constexpr int parts = 16;
    const auto slope = [&](const Real& at) { return law_tangent(law, p, L, at).slope; };
    Real chosen = slope(l);
    const auto count = [&](const Real& value) {
        chosen = stiffer ? std::max(chosen, value) : std::min(chosen, value);
    };
    // Between two kinks of Buckling the slope may show just below L alone.
    for (const Real& at : {Real(L - scaled(L, -60)), L}) {
        if (at > 0 && abs(at - l) <= 1.01 * reach) count(slope(at));
    }
    for (int i = 0; i < parts; ++i) {
        Real low = l + reach * (Real(2 * i) / parts - 1);
        Real high = l + reach * (Real(2 * i + 2) / parts - 1);
        if (!(high > 0)) continue;
        if (!(low > 0)) low = high / 2;
        Real at_low = slope(low);
        Real at_high = slope(high);
        count(at_low);
        count(at_high);
        if (abs(at_high - at_low) <= scaled(std::max(abs(at_low), abs(at_high)), -12)) continue;
        for (int halving = 0; halving < 100; ++halving) {
            const Real middle = (low + high) / 2;
            const Real at_middle = slope(middle);
            if (abs(at_middle - at_low) < abs(at_middle - at_high)) {
                low = middle;
                at_low = at_middle;
            } else {
                high = middle;
                at_high = at_middle;
            }
        }
        count(at_low);
        count(at_high);
    }
    return chosen;
}

/// The system at pose x, Dim × n, m, which the library takes as exact but for kinks.
template <class System, class Pose>
Exact exact_at_pose(const System& system, const Pose& x, const Side& side) {
    using Scalar = typename System::Scalar;
    constexpr int Dim = System::Dim;
    std::vector<int> first;
    int count = 0;
    for (Index i = 0; i < system.size(); ++i) {
        first.push_back(system.is_pinned(i) ? -1 : Dim * count);
        if (!system.is_pinned(i)) ++count;
    }
    Exact e(Dim * count);
    e.springs = true;
    e.d0 = taut::held_as<Scalar>(system.rayleigh().mass_proportional);
    e.alpha = taut::held_as<Scalar>(system.rayleigh().stiffness_proportional);
    for (Index i = 0; i < system.size(); ++i) {
        for (int k = 0; first[i] >= 0 && k < Dim; ++k) e.mass[first[i] + k] = system.mass(i);
    }
    system.for_each_set([&](const auto& set) {
        using Law = typename std::decay_t<decltype(set)>::Law;
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            const int a = first[set.a[s]];
            const int b = first[set.b[s]];
            if (a < 0 && b < 0) continue;
            const auto p = set.parameters[s].template cast<Real>();
            const Real L = set.rest_length[s];
            std::vector<Real> d(Dim);
            Real square = 0;
            for (int k = 0; k < Dim; ++k) {
                d[k] = Real(x(k, set.b[s])) - Real(x(k, set.a[s]));
                square += d[k] * d[k];
            }
            const Real most = law_bound(Law{}, p, L);
            const std::vector<Real> none(Dim);
            add_block(e.bound, a, b, none, 0, most, most);
            if (square < std::numeric_limits<Scalar>::min()) {
                // The ends coincide [T3]: no axis, and no damper along it.
                add_block(e.K, a, b, none, 0, most, most);
                add_block(e.K_plus, a, b, none, 0, most, most);
                continue;
            }
            const Real l = sqrt(square);
            for (Real& component : d) component /= l;
            const Tangent t = law_tangent(Law{}, p, L, l);
            Real size = L;
            for (const Index end : {Index(set.a[s]), Index(set.b[s])}) {
                Real largest = 0;
                for (int k = 0; k < Dim; ++k)
                    largest = std::max(largest, Real(abs(Real(x(k, end)))));
                size += largest;
            }
            const Real reach = size * (side.reach * std::numeric_limits<Scalar>::epsilon());
            const Real axial = slope_on_side(Law{}, p, L, l, reach, side.stiffer);
            e.moved = e.moved || axial != t.slope;
            e.kinked = e.kinked || abs(axial - t.slope) > scaled(std::max(axial, t.slope), -20);
            const Real across = Dim == 1 ? Real(0) : Real(t.tension / l);
            // The slope may be that of the other side.
            const Real magnitude = t.magnitude + most;
            add_block(e.K, a, b, d, axial, across, magnitude);
            add_block(e.K_plus, a, b, d, axial > 0 ? axial : Real(0), across > 0 ? across : Real(0),
                      magnitude);
            const Real c = set.damping_of(s);
            if (c > 0) add_block(e.dampers, a, b, d, c, 0, c);
        }
    });
    return e;
}

/// The graph Laplacians [T23], n × n: K⁺ = K = L_k.
template <class System>
Exact exact_laplacians(const System& system) {
    using Scalar = typename System::Scalar;
    std::vector<int> row;
    int count = 0;
    for (Index i = 0; i < system.size(); ++i) row.push_back(system.is_pinned(i) ? -1 : count++);
    Exact e(count);
    e.springs = true;
    e.d0 = taut::held_as<Scalar>(system.rayleigh().mass_proportional);
    e.alpha = taut::held_as<Scalar>(system.rayleigh().stiffness_proportional);
    for (Index i = 0; i < system.size(); ++i) {
        if (row[i] >= 0) e.mass[row[i]] = system.mass(i);
    }
    system.for_each_set([&](const auto& set) {
        using Law = typename std::decay_t<decltype(set)>::Law;
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            const int a = row[set.a[s]];
            const int b = row[set.b[s]];
            const Real most =
                law_bound(Law{}, set.parameters[s].template cast<Real>(), Real(set.rest_length[s]));
            const std::vector<Real> axis(1, Real(1));
            for (Rounded* A : {&e.K, &e.K_plus, &e.bound}) add_block(*A, a, b, axis, most, 0, most);
            const Real c = set.damping_of(s);
            if (c > 0) add_block(e.dampers, a, b, axis, c, 0, c);
        }
    });
    return e;
}

/// Bare matrices: they are exact.
template <class Scalar>
Exact exact_matrices(const taut::LinearSystem<Scalar>& system) {
    const int n = static_cast<int>(system.size());
    Exact e(n);
    const auto copy = [](const taut::SparseMatrix<Scalar>& from, Rounded& to) {
        for (Index j = 0; j < from.outerSize(); ++j) {
            for (typename taut::SparseMatrix<Scalar>::InnerIterator entry(from, j); entry;
                 ++entry) {
                const auto i = static_cast<int>(entry.row());
                to.value(i, static_cast<int>(j)) = entry.value();
                to.magnitude(i, static_cast<int>(j)) = std::abs(entry.value());
            }
        }
    };
    for (int i = 0; i < n; ++i) e.mass[i] = system.mass()[i];
    copy(system.stiffness(), e.K);
    copy(system.stiffness(), e.K_plus);
    copy(system.damping(), e.dampers);
    return e;
}

/// How many binary orders lie between the largest and the smallest entry of the stiffness, or of
/// the terms of the damping: so many bits can hide what a soft spring does behind a stiff one.
inline long spread(const Exact& e) {
    const auto orders = [&](const auto& visit_all) {
        long low = std::numeric_limits<long>::max();
        long high = std::numeric_limits<long>::min();
        visit_all([&](const Real& value) {
            if (value == 0) return;
            low = std::min(low, exponent(value));
            high = std::max(high, exponent(value));
        });
        return high < low ? 0 : high - low;
    };
    const auto entries = [&](const Rounded& A, const Real& factor, const auto& visit) {
        for (int i = 0; i < A.size(); ++i) {
            for (int j = 0; j < A.size(); ++j) visit(factor * A.magnitude(i, j));
        }
    };
    const long stiffness = orders([&](const auto& visit) { entries(e.K, Real(1), visit); });
    const long damping = orders([&](const auto& visit) {
        entries(e.K, e.alpha, visit);
        entries(e.dampers, Real(1), visit);
        for (const Real& m : e.mass) visit(e.d0 * m);
    });
    return std::max(stiffness, damping);
}

/// The same of M⁻¹K and M⁻¹D, with that of the frequencies.
inline long spread_by_mass(const Exact& e) {
    long low = std::numeric_limits<long>::max();
    long high = std::numeric_limits<long>::min();
    const auto visit = [&](const Rounded& A) {
        for (int i = 0; i < A.size(); ++i) {
            for (int j = 0; j < A.size(); ++j) {
                if (A.magnitude(i, j) == 0) continue;
                const long order = exponent(A.magnitude(i, j)) - exponent(e.mass[i]);
                low = std::min(low, order);
                high = std::max(high, order);
            }
        }
    };
    visit(Sum(e).stiffness(1).matrix());
    visit(Sum(e).damping(1).matrix());
    return high < low ? 0 : high - low;
}

inline bool is_zero(const Rounded& A) {
    for (int i = 0; i < A.size(); ++i) {
        for (int j = 0; j < A.size(); ++j) {
            if (A.value(i, j) != 0) return false;
        }
    }
    return true;
}
inline bool is_same(const Rounded& A, const Rounded& B) {
    for (int i = 0; i < A.size(); ++i) {
        for (int j = 0; j < A.size(); ++j) {
            if (A.value(i, j) != B.value(i, j)) return false;
        }
    }
    return true;
}

/// What each make() gives, in as many bits as the widest of them needs: what is called rounding
/// later goes by the bits that are set then.
inline std::vector<Exact> in_enough_bits(const std::vector<std::function<Exact()>>& makes) {
    constexpr long few = 320;
    set_bits(few);
    long needed = few;
    for (const auto& make : makes) needed = std::max(needed, 256 + spread(make()));
    set_bits(needed);
    std::vector<Exact> systems;
    for (const auto& make : makes) {
        systems.push_back(make());
        systems.back().again = make;
    }
    return systems;
}

}  // namespace soundness
