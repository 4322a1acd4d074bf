// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <taut/model/spring_system.hpp>
#include <vector>

#include "dense.hpp"
#include "laws.hpp"
#include "random.hpp"

namespace taut_test {

/// The matrices of graph inertia, n × n over all particles, pins included: written from [T33] and
/// [T35] with nothing of the library's assembly in it.
struct GraphMatrices {
    Eigen::MatrixXd M;
    Eigen::MatrixXd K, C;        ///< L_k, and L_c without d0
    Eigen::MatrixXd damped;      ///< Σ s·½hc/θ L_e
    Eigen::MatrixXd elastic;     ///< Σ s·¼h²k/θ L_e
    Eigen::MatrixXd unassisted;  ///< Σ (1 − s)(2hc + h²k)L_e

    Eigen::MatrixXd heavy() const { return M + damped + elastic; }  ///< M̃
};

template <class System>
GraphMatrices graph_matrices(const System& system, const std::vector<double>& shares, double theta,
                             double h) {
    const Index n = system.size();
    const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(n, n);
    GraphMatrices g{zero, zero, zero, zero, zero, zero};
    for (Index i = 0; i < n; ++i) g.M(i, i) = static_cast<double>(system.mass(i));
    const double alpha = system.rayleigh().stiffness_proportional + system.graph_damping();
    std::size_t index = 0;
    system.for_each_set([&](const auto& set) {
        using Law = typename std::decay_t<decltype(set)>::Law;
        for (std::size_t e = 0; e < set.a.size(); ++e) {
            const double k = Law::stiffness_bound(set.parameters[e].template cast<double>(),
                                                  static_cast<double>(set.rest_length[e]));
            const double c = static_cast<double>(set.damping_of(e)) + alpha * k;
            const double s = shares[index++];
            const auto add = [&, a = set.a[e], b = set.b[e]](Eigen::MatrixXd& A, double weight) {
                A(a, a) += weight;
                A(b, b) += weight;
                A(a, b) -= weight;
                A(b, a) -= weight;
            };
            add(g.K, k);
            add(g.C, c);
            add(g.damped, s / theta * h * c / 2);
            add(g.elastic, s / theta * h * h * k / 4);
            add(g.unassisted, (1 - s) * (2 * h * c + h * h * k));
        }
    });
    return g;
}

template <class System>
std::vector<Index> free_particles(const System& system) {
    std::vector<Index> free;
    for (Index i = 0; i < system.size(); ++i) {
        if (!system.is_pinned(i)) free.push_back(i);
    }
    return free;
}
template <class System>
Eigen::MatrixXd free_block(const System& system, const Eigen::MatrixXd& A) {
    const auto free = free_particles(system);
    return A(free, free);
}
/// A ⊗ I over degrees of freedom, a particle's one below the other.
template <int Dim>
Eigen::MatrixXd for_each_axis(const Eigen::MatrixXd& A) {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(Dim * A.rows(), Dim * A.cols());
    for (Index i = 0; i < A.rows(); ++i) {
        for (Index j = 0; j < A.cols(); ++j) {
            for (int d = 0; d < Dim; ++d) all(Dim * i + d, Dim * j + d) = A(i, j);
        }
    }
    return all;
}

/// Springs of zero rest length, at random, with masses over two and stiffnesses over `decades`
/// decades: K = L_k ⊗ I at every pose. Often some pins, sometimes parts that nothing joins.
template <class System>
System linear_network(Random& random, double decades) {
    using Scalar = typename System::Scalar;
    constexpr int Dim = System::Dim;
    System system;
    const Index particles = 2 + random.below(8);
    for (Index i = 0; i < particles; ++i) {
        const auto mass = static_cast<Scalar>(log_uniform(random, 0.1, 10));
        system.add_particle(random.vector<Scalar, Dim>(-1, 1), mass);
    }
    const double side = std::pow(10, decades / 2);
    for (Index s = 1 + random.below(2 * particles); s > 0; --s) {
        const Index a = random.below(particles);
        const Index b = (a + 1 + random.below(particles - 1)) % particles;
        const auto k = static_cast<Scalar>(log_uniform(random, 1 / side, side));
        system.add_spring(taut::Spring<Scalar, taut::Hookean>{a, b, {k}, Scalar(0)});
    }
    for (Index pins = random.below(3); pins > 0; --pins) system.pin(random.below(particles));
    return system;
}

/// A cloth of rows × columns in its plane, unit masses and springs, two corners pinned; the springs
/// of the last row are `hem` times as stiff.
template <class Scalar, int Dim>
taut::SpringSystem<Scalar, Dim> hemmed_cloth(Index rows, Index columns, double hem) {
    taut::SpringSystem<Scalar, Dim> system;
    for (Index i = 0; i < rows * columns; ++i) {
        Eigen::Matrix<Scalar, Dim, 1> place = Eigen::Matrix<Scalar, Dim, 1>::Zero();
        place[0] = static_cast<Scalar>(i % columns);
        if (Dim > 1) place[Dim - 1] = static_cast<Scalar>(-(i / columns));
        system.add_particle(place, Scalar(1));
    }
    for (Index r = 0; r < rows; ++r) {
        for (Index c = 0; c < columns; ++c) {
            const Index i = r * columns + c;
            const double k = r + 1 == rows ? hem : 1;
            const auto join = [&](Index j, double stiffness) {
                system.add_spring(taut::Spring<Scalar, taut::Hookean>{
                    i, j, {static_cast<Scalar>(stiffness)}, Scalar(1)});
            };
            if (c + 1 < columns) join(i + 1, k);
            if (r + 1 < rows) join(i + columns, 1);
        }
    }
    system.pin(0);
    system.pin(columns - 1);
    return system;
}

}  // namespace taut_test
