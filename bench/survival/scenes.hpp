// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <taut/lattice/lattice.hpp>
#include <taut/taut.hpp>

namespace bench::survival {

using taut::Index;
template <int Dim>
using Net = taut::SpringSystem<double, Dim>;

/// Numbers that every compiler draws alike.
class Random {
public:
    explicit Random(std::uint64_t seed) : bits_(seed) {}

    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(bits_() >> 11) * 0x1p-53;
    }
    double power(double low, double high) { return std::pow(10, uniform(low, high)); }
    template <int Dim>
    Eigen::Matrix<double, Dim, 1> cube() {
        Eigen::Matrix<double, Dim, 1> x;
        for (int d = 0; d < Dim; ++d) x[d] = uniform(-1, 1);
        return x;
    }

private:
    std::mt19937_64 bits_;
};

/// A scene before its law: springs from `bends_from` on are those that resist bending.
template <int Dim>
struct Scene {
    Net<Dim> net;
    Index bends_from;
};

template <int Dim>
Scene<Dim> without_bending(Net<Dim> net) {
    const Index springs = net.spring_count();
    return {std::move(net), springs};
}

/// 1 kg on a spring of 1 m and 1000 N/m, no gravity.
template <int Dim>
Scene<Dim> one_mass(Random&) {
    Net<Dim> net;
    net.add_particle(Net<Dim>::Vector::Zero(), 1);
    net.add_particle(Net<Dim>::Vector::Unit(0), 1);
    net.add_spring(0, 1, 1000);
    net.pin(0);
    return without_bending(std::move(net));
}

/// 1 kg on 1 m, of a stiffness that its weight stretches by 10 % to 0.01 %.
inline Scene<2> pendulum(Random& random) {
    Net<2> net;
    net.add_particle({0, 0}, 1);
    net.add_particle({1, 0}, 1);
    net.add_spring(0, 1, 9.81 * random.power(1, 4));
    net.pin(0);
    net.set_gravity({0, -9.81});
    return without_bending(std::move(net));
}

/// 16 masses in a row, held at one end, under gravity.
inline Scene<3> string(Random&) {
    taut::ChainOptions options;
    options.masses = 16;
    options.ends = taut::ChainEnds::fixed_free;
    options.mass = 0.01;
    options.stiffness = 1000;
    options.spacing = 0.05;
    auto net = taut::chain<double, 3>(options);
    net.set_gravity({0, 0, -9.81});
    return without_bending(std::move(net));
}

/// The reference cloth, held at two corners.
inline Scene<3> cloth(Index size) {
    return {taut::hanging_cloth<double>({size, size}),
            2 * size * (size - 1) + 2 * (size - 1) * (size - 1)};
}

/// A cube of 4 × 4 × 4 masses, each on springs to its up to 26 neighbours; free, no gravity.
inline Scene<3> soft_body(Random&) {
    constexpr Index n = 4;
    Net<3> net;
    for (Index i = 0; i < n * n * n; ++i) {
        net.add_particle(
            0.1 * Eigen::Vector3d(static_cast<double>(i % n), static_cast<double>(i / n % n),
                                  static_cast<double>(i / n / n)),
            0.01);
    }
    const auto start = net.initial_state();
    for (Index a = 0; a < net.size(); ++a) {
        for (Index b = a + 1; b < net.size(); ++b) {
            if ((start.x.col(a) - start.x.col(b)).norm() < 0.18) net.add_spring(a, b, 1000);
        }
    }
    return without_bending(std::move(net));
}

/// 12 masses over six decades, each joined to some of the others; one is held.
inline Scene<2> unequal_masses(Random& random) {
    constexpr Index n = 12;
    Net<2> net;
    for (Index i = 0; i < n; ++i) {
        // The ends of the range are always there.
        const double decade = i == 0 ? -3 : i == 1 ? 3 : random.uniform(-3, 3);
        net.add_particle(random.cube<2>(), std::pow(10, decade));
    }
    for (Index i = 1; i < n; ++i) {
        for (int edge = 0; edge < 2; ++edge) {
            const auto other = static_cast<Index>(random.uniform(0, static_cast<double>(i)));
            net.add_spring(i, other, random.power(1, 3));
        }
    }
    net.pin(n - 1);
    return without_bending(std::move(net));
}

/// The springs of a mesh, the highest particles (y is up) held, under gravity.
inline Scene<3> garment(const taut::MeshSprings<double>& mesh) {
    auto net = mesh.system;
    const auto y = net.initial_state().x.row(1).eval();
    const double least = y.maxCoeff() - 0.01 * (y.maxCoeff() - y.minCoeff());
    for (Index i = 0; i < net.size(); ++i) {
        if (y[i] >= least) net.pin(i);
    }
    net.set_gravity({0, -9.81, 0});
    return {std::move(net), mesh.stretch_springs};
}

// ---- laws: how each makes a system of a scene ----

struct AllHookean {
    static constexpr const char* name = "Hookean";
    static constexpr double weight = 1;  // of the runs
    template <int Dim>
    using System = taut::SpringSystem<double, Dim>;
    template <class System, class Spring>
    static void add(System& system, const Spring& spring, bool) {
        system.add_spring(spring);
    }
};

struct AllTensionOnly {
    static constexpr const char* name = "tension-only";
    static constexpr double weight = 1;
    template <int Dim>
    using System = taut::SpringSystem<double, Dim, taut::TensionOnly>;
    template <class System, class Spring>
    static void add(System& system, const Spring& spring, bool) {
        const auto& [a, b, parameters, L, damping] = spring;
        system.add_spring(taut::Spring<double, taut::TensionOnly>{a, b, parameters, L, damping});
    }
};

struct AllBuckling {
    static constexpr const char* name = "buckling";
    static constexpr double weight = 0.25;
    template <int Dim>
    using System = taut::SpringSystem<double, Dim, taut::Buckling>;
    template <class System, class Spring>
    static void add(System& system, const Spring& spring, bool) {
        const auto& [a, b, parameters, L, damping] = spring;
        const double k = parameters.stiffness;
        system.add_spring(
            taut::Spring<double, taut::Buckling>{a, b, {k, 0.01 * k * L * L * L, k}, L, damping});
    }
};

/// Springs of Choi and Ko: what stretches only pulls, what bends buckles.
struct ChoiKo {
    static constexpr const char* name = "Choi and Ko";
    static constexpr double weight = 0.25;
    template <int Dim>
    using System = taut::SpringSystem<double, Dim, taut::TensionOnly, taut::Buckling>;
    template <class System, class Spring>
    static void add(System& system, const Spring& spring, bool bends) {
        bends ? AllBuckling::add(system, spring, true) : AllTensionOnly::add(system, spring, false);
    }
};

template <class Law, int Dim>
typename Law::template System<Dim> with_law(const Scene<Dim>& scene) {
    using System = typename Law::template System<Dim>;
    return taut::with_springs<System>(
        scene.net, [&](System& system, const taut::Spring<double, taut::Hookean>& spring, Index s) {
            Law::add(system, spring, s >= scene.bends_from);
        });
}

/// Under gravity one start in eight is the scene as it was built. The others are disturbed by a
/// factor between 0.03 and 5, log-uniform: of the mean length of the springs for positions, and of
/// that length times √(Σk/m) of the particle for velocities, each in a cube. At 2 many springs
/// are turned round.
template <int Dim>
taut::State<double, Dim> random_start(const Scene<Dim>& scene, Random& random) {
    const auto& net = scene.net;
    const auto& springs = net.springs();
    auto state = net.initial_state();
    const bool quiet = random.uniform(0, 8) < 1;
    if (quiet && net.gravity().norm() > 0) return state;
    const double violence = random.power(-1.5, 0.7);
    taut::VectorX<double> stiffness = taut::VectorX<double>::Zero(net.size());
    double length = 0;
    for (Index s = 0; s < springs.size(); ++s) {
        const auto at = static_cast<std::size_t>(s);
        stiffness[springs.a[at]] += springs.parameters[at].stiffness;
        stiffness[springs.b[at]] += springs.parameters[at].stiffness;
        length += springs.rest_length[at] / static_cast<double>(springs.size());
    }
    for (Index i = 0; i < net.size(); ++i) {
        if (net.is_pinned(i)) continue;
        state.x.col(i) += violence * length * random.cube<Dim>();
        state.v.col(i) =
            violence * length * std::sqrt(stiffness[i] / net.mass(i)) * random.cube<Dim>();
    }
    return state;
}

}  // namespace bench::survival
