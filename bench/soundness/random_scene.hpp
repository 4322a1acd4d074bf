// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <taut/network/buckling.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/network/spring_system.hpp>
#include <taut/network/tension_only.hpp>
#include <vector>

#include "../../tests/support/random.hpp"

// Spring scenes and linear systems of up to 30 unknowns, one for each seed.

namespace soundness {

using taut::Index;

/// How far masses, stiffnesses, dampings and lengths lie apart.
enum class Range { plain, wide, ends };

inline const char* name(Range range) {
    switch (range) {
        case Range::plain: return "five decades";
        case Range::wide: return "40 decades";
        case Range::ends: return "the ends of the range";
    }
    return "";
}

/// Random numbers of one scene.
class Draw {
public:
    explicit Draw(std::uint32_t seed) : random_(seed) {
        const Index range = below(8);
        range_ = range < 4 ? Range::plain : range < 6 ? Range::wide : Range::ends;
    }

    Range range() const { return range_; }
    Index below(Index n) { return random_.below(n); }
    bool one_in(Index n) { return below(n) == 0; }
    /// All bits of a double, in [low, high).
    double uniform(double low, double high) {
        double unit = random_.uniform(0, 1);
        unit += 0x1p-24 * random_.uniform(0, 1);
        unit += 0x1p-48 * random_.uniform(0, 1);
        return low + (high - low) * std::min(unit, 1 - 0x1p-53);
    }
    /// Around 2^centre, by the range.
    template <class Scalar>
    Scalar around(double centre) {
        if (one_in(12)) return static_cast<Scalar>(std::exp2(std::round(centre)));
        const double spread = range_ == Range::plain  ? 8
                              : range_ == Range::wide ? 66
                              : one_in(4)             ? 200
                                                      : 12;
        const double most = std::numeric_limits<Scalar>::max_exponent - 1;
        const double least =
            std::numeric_limits<Scalar>::min_exponent - std::numeric_limits<Scalar>::digits;
        const double order =
            std::clamp(uniform(centre - spread, centre + spread), least + 1, most - 1);
        return static_cast<Scalar>(std::ldexp(uniform(1, 2), static_cast<int>(order)));
    }
    /// The binary order about which a scene's masses (or stiffnesses, …) lie.
    template <class Scalar>
    double centre() {
        const double most = std::numeric_limits<Scalar>::max_exponent - 10;
        return range_ == Range::ends && one_in(2) ? uniform(-most, most) : 0;
    }

private:
    taut_test::Random random_;
    Range range_;
};

template <class Scalar>
auto draw_parameters(Draw& draw, double order, Scalar, taut::Hookean) {
    return taut::Hookean::Parameters<Scalar>{draw.around<Scalar>(order)};
}
template <class Scalar>
auto draw_parameters(Draw& draw, double order, Scalar L, taut::TensionOnly) {
    return draw_parameters(draw, order, L, taut::Hookean{});
}
/// The beam shows where c_b > 31.5 k_b/L³, in half of the springs or so.
template <class Scalar>
auto draw_parameters(Draw& draw, double order, Scalar L, taut::Buckling) {
    const auto stiffness = draw.around<Scalar>(order);
    const auto onset = draw.one_in(8) ? Scalar(0) : draw.around<Scalar>(order);
    const auto share = static_cast<Scalar>(std::exp2(draw.uniform(-12, 0)));
    const Scalar bending = draw.one_in(8) ? Scalar(0) : share * onset * L * L * L;
    return taut::Buckling::Parameters<Scalar>{stiffness,
                                              std::isfinite(bending) ? bending : Scalar(1), onset};
}

/// Springs of all laws that are judged.
template <class Scalar, int Dim>
using Springs = taut::SpringSystem<Scalar, Dim, taut::Hookean, taut::TensionOnly, taut::Buckling>;

/// A scene and the pose to analyse.
template <class System>
struct Scene {
    System system;
    typename System::State state;
};

/// Springs of all laws between particles anywhere, on a lattice, or on one another; as long as in
/// rest to the bit, to some ulp, or not at all.
template <class System>
Scene<System> random_scene(Draw& draw) {
    using Scalar = typename System::Scalar;
    constexpr int Dim = System::Dim;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    Scene<System> scene;
    System& system = scene.system;
    const double masses = draw.centre<Scalar>();
    const double stiffnesses = draw.centre<Scalar>();
    const double dampings = draw.centre<Scalar>();
    const double lengths = draw.centre<Scalar>();
    const auto unit = static_cast<Scalar>(std::exp2(std::round(lengths)));
    const bool lattice = draw.one_in(3);
    const Scalar origin = draw.one_in(6) ? unit * static_cast<Scalar>(draw.uniform(0, 1e5)) : 0;
    const Index free = 1 + draw.below(30 / Dim);
    const Index pinned = draw.below(3);
    const auto place = [&] {
        return Vector(Vector::NullaryExpr([&] {
            return origin + unit * static_cast<Scalar>(lattice ? static_cast<double>(draw.below(4))
                                                               : draw.uniform(-1, 1));
        }));
    };
    std::vector<Vector> places;
    for (Index i = 0; i < free + pinned; ++i) {
        places.push_back(i > 0 && draw.one_in(20) ? places.back() : place());
        const auto mass = draw.around<Scalar>(masses);
        system.add_particle(draw.one_in(4) ? place() : places.back(), mass);
        if (i >= free) system.pin(i);
    }
    scene.state = system.initial_state();
    if (draw.one_in(2)) {
        for (Index i = 0; i < system.size(); ++i) scene.state.x.col(i) = places[i];
    }
    const bool dampers = draw.one_in(2);
    const Index laws = static_cast<Index>(std::tuple_size_v<typename System::SpringSets>);
    const Index one_law = draw.below(2 * laws);  // in half of the scenes
    const Index springs = system.size() > 1 ? draw.below(3 * system.size()) + 1 : 0;
    for (Index s = 0; s < springs; ++s) {
        const Index a = draw.below(system.size());
        const Index b = (a + 1 + draw.below(system.size() - 1)) % system.size();
        const Index chosen = one_law < laws ? one_law : draw.below(laws);
        const Scalar length = (scene.state.x.col(b) - scene.state.x.col(a)).norm();
        Scalar rest = length;
        switch (draw.below(8)) {
            case 0: break;
            case 1: rest = std::nextafter(length, Scalar(0)); break;
            case 2: rest = std::nextafter(length, std::numeric_limits<Scalar>::max()); break;
            case 3: rest = 0; break;
            case 4: rest *= static_cast<Scalar>(1 + std::exp2(draw.uniform(-56, -2))); break;
            default: rest = unit * static_cast<Scalar>(draw.uniform(0, 2));
        }
        const Scalar damping =
            dampers && draw.one_in(2) ? draw.around<Scalar>(dampings) : Scalar(0);
        Index law = 0;
        system.for_each_set([&](const auto& set) {
            using Law = typename std::decay_t<decltype(set)>::Law;
            if (law++ != chosen) return;
            system.add_spring(taut::Spring<Scalar, Law>{
                a, b, draw_parameters(draw, stiffnesses, rest, Law{}), rest, damping});
        });
    }
    if (draw.one_in(2)) {
        const double d0 = draw.one_in(3) ? 0 : draw.around<double>((stiffnesses - masses) / 2);
        const double alpha = draw.one_in(3) ? 0 : draw.around<double>((masses - stiffnesses) / 2);
        system.set_rayleigh({d0, alpha});
    }
    return scene;
}

/// Symmetric matrices of one kind or another: graph Laplacians, with a diagonal or without, any
/// signs, products BᵀB of low rank, a scaled diagonal.
template <class Scalar>
taut::SparseMatrix<Scalar> random_matrix(Draw& draw, Index n, double order) {
    std::vector<Eigen::Triplet<Scalar>> entries;
    const auto add = [&](Index i, Index j, Scalar value) {
        entries.emplace_back(static_cast<int>(i), static_cast<int>(j), value);
        if (i != j) entries.emplace_back(static_cast<int>(j), static_cast<int>(i), value);
    };
    const Index kind = draw.below(5);
    const Index pairs = draw.below(3 * n + 1);
    if (kind == 4) {
        for (Index r = 0; r < 1 + draw.below(n); ++r) {
            std::vector<Scalar> b;
            for (Index i = 0; i < n; ++i) {
                const Scalar value = draw.around<Scalar>(order / 2);
                b.push_back(draw.one_in(2) ? Scalar(0) : draw.one_in(2) ? value : -value);
            }
            for (Index i = 0; i < n; ++i) {
                for (Index j = 0; j <= i; ++j) {
                    if (b[i] != 0 && b[j] != 0) add(i, j, b[i] * b[j]);
                }
            }
        }
    }
    for (Index s = 0; kind < 4 && s < pairs && n > 1; ++s) {
        const Index a = draw.below(n);
        const Index b = (a + 1 + draw.below(n - 1)) % n;
        const Scalar value = draw.around<Scalar>(order);
        const bool sign = draw.one_in(2);
        add(a, b, kind == 3 && sign ? value : -value);
        if (kind < 3) {
            add(a, a, value);
            add(b, b, value);
        }
    }
    for (Index i = 0; i < n; ++i) {
        const Scalar value = draw.around<Scalar>(order);
        if (kind == 0 || draw.one_in(2)) continue;
        add(i, i, kind == 3 && draw.one_in(3) ? -value : value);
    }
    taut::SparseMatrix<Scalar> A(n, n);
    A.setFromTriplets(entries.begin(), entries.end());
    return A;
}

/// Bare matrices; D none, d0·M but for an entry or an ulp, a multiple of K, or any other.
template <class Scalar>
taut::LinearSystem<Scalar> random_linear(Draw& draw) {
    const Index n = 1 + draw.below(30);
    const double masses = draw.centre<Scalar>();
    const double stiffnesses = draw.centre<Scalar>();
    taut::VectorX<Scalar> mass(n);
    for (Scalar& m : mass) m = draw.around<Scalar>(masses);
    const auto K = random_matrix<Scalar>(draw, n, stiffnesses);
    taut::SparseMatrix<Scalar> D(n, n);
    const double rate = (stiffnesses - masses) / 2;
    switch (draw.below(5)) {
        case 0: break;
        case 1: {
            const auto d0 = draw.around<Scalar>(rate);
            taut::VectorX<Scalar> diagonal = d0 * mass;
            if (draw.one_in(3)) {
                Scalar& entry = diagonal[draw.below(n)];
                entry = draw.one_in(2) ? draw.around<Scalar>(rate + masses)
                                       : std::nextafter(entry, Scalar(0));
            }
            D = taut::SparseMatrix<Scalar>(diagonal.asDiagonal());
            break;
        }
        case 2: D = draw.around<Scalar>(-rate) * K; break;
        default: D = random_matrix<Scalar>(draw, n, rate + masses);
    }
    return taut::LinearSystem<Scalar>(std::move(mass), std::move(D), K);
}

}  // namespace soundness
