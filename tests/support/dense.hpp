// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <taut/network/spring_system.hpp>
#include <vector>

#include "scene_dense.hpp"

// scene_dense.hpp for systems by their type.

namespace taut_test {

template <class System>
DenseMatrices dense_matrices(const System& system, const typename System::State& state) {
    constexpr int Dim = System::Dim;
    const Index N = Dim * system.size();
    DenseMatrices m{Eigen::MatrixXd::Zero(N, N), Eigen::MatrixXd::Zero(N, N),
                    Eigen::MatrixXd::Zero(N, N), Eigen::MatrixXd::Zero(N, N)};
    for (Index i = 0; i < N; ++i) m.M(i, i) = static_cast<double>(system.mass(i / Dim));
    const Eigen::MatrixXd x = state.x.template cast<double>();
    const auto add = [](Eigen::MatrixXd& A, Index a, Index b, const Eigen::MatrixXd& block) {
        A.block(Dim * a, Dim * a, Dim, Dim) += block;
        A.block(Dim * b, Dim * b, Dim, Dim) += block;
        A.block(Dim * a, Dim * b, Dim, Dim) -= block;
        A.block(Dim * b, Dim * a, Dim, Dim) -= block;
    };
    const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(Dim, Dim);
    system.for_each_set([&](const auto& set) {
        using Law = typename std::decay_t<decltype(set)>::Law;
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            const auto p = set.parameters[s].template cast<double>();
            const auto L = static_cast<double>(set.rest_length[s]);
            const Eigen::VectorXd dx = x.col(set.b[s]) - x.col(set.a[s]);
            const double l = dx.norm();
            if (l == 0) {
                add(m.K, set.a[s], set.b[s], Law::stiffness_bound(p, L) * one);
                add(m.K_plus, set.a[s], set.b[s], Law::stiffness_bound(p, L) * one);
                continue;
            }
            const Eigen::MatrixXd along = dx * dx.transpose() / (l * l);
            const double slope = Law::tension_slope(p, L, l);
            const double across = Law::tension(p, L, l) / l;
            add(m.K, set.a[s], set.b[s], slope * along + across * (one - along));
            add(m.K_plus, set.a[s], set.b[s],
                std::max(slope, 0.0) * along + std::max(across, 0.0) * (one - along));
            if (!set.damping.empty()) {
                add(m.D, set.a[s], set.b[s], static_cast<double>(set.damping[s]) * along);
            }
        }
    });
    m.D += system.rayleigh().mass_proportional * m.M +
           system.rayleigh().stiffness_proportional * m.K_plus;
    return m;
}

/// The degrees of freedom of the free particles, ascending.
template <class System>
std::vector<Index> free_dofs(const System& system) {
    std::vector<Index> dofs;
    for (Index i = 0; i < system.size(); ++i) {
        for (int d = 0; d < System::Dim && !system.is_pinned(i); ++d)
            dofs.push_back(System::Dim * i + d);
    }
    return dofs;
}

/// The columns of a Dim × n matrix one below the other, in double.
template <class Points>
Eigen::VectorXd flat(const Points& points) {
    const Eigen::MatrixXd copy = points.template cast<double>();
    return Eigen::Map<const Eigen::VectorXd>(copy.data(), copy.size());
}

/// Total force on every particle, one below the other, in double.
template <class System>
Eigen::VectorXd flat_force(const System& system, const typename System::State& state) {
    decltype(state.x) f;
    system.force(state, f);
    return flat(f);
}

/// −∂f/∂x (or −∂f/∂v) over all degrees of freedom by central differences of step h.
template <class System>
Eigen::MatrixXd difference_quotient(const System& system, typename System::State state,
                                    bool of_velocity, double h) {
    using Scalar = typename System::Scalar;
    auto& moved = of_velocity ? state.v : state.x;
    Eigen::MatrixXd J(moved.size(), moved.size());
    for (Index j = 0; j < moved.size(); ++j) {
        Scalar& entry = moved.data()[j];
        const Scalar before = entry;
        entry = before + static_cast<Scalar>(h);
        const Eigen::VectorXd up = flat_force(system, state);
        entry = before - static_cast<Scalar>(h);
        const Eigen::VectorXd down = flat_force(system, state);
        entry = before;
        J.col(j) = (down - up) / (2 * h);
    }
    return J;
}

}  // namespace taut_test
