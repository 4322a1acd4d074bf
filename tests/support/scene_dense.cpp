// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "scene_dense.hpp"

#include <algorithm>

namespace taut_test {

DenseMatrices dense_matrices(const Scene& scene, const AnyState& state) {
    const Index dim = scene.dim();
    const Index N = dim * scene.size();
    const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(N, N);
    DenseMatrices m{none, none, none, none};
    for (Index i = 0; i < N; ++i) m.M(i, i) = scene.mass(i / dim);
    const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(dim, dim);
    for (const AnySpring& spring : scene.springs()) {
        const auto add = [&](Eigen::MatrixXd& A, const Eigen::MatrixXd& block) {
            const Index a = dim * spring.a;
            const Index b = dim * spring.b;
            A.block(a, a, dim, dim) += block;
            A.block(b, b, dim, dim) += block;
            A.block(a, b, dim, dim) -= block;
            A.block(b, a, dim, dim) -= block;
        };
        const Eigen::VectorXd dx = state.x.col(spring.b) - state.x.col(spring.a);
        const double l = dx.norm();
        const LawAt law = law_at(spring, l);
        if (l == 0) {
            add(m.K, static_cast<double>(law.bound) * one);
            add(m.K_plus, static_cast<double>(law.bound) * one);
            continue;
        }
        const Eigen::MatrixXd along = dx * dx.transpose() / (l * l);
        const auto slope = static_cast<double>(law.slope);
        const auto across = static_cast<double>(law.tension) / l;
        add(m.K, slope * along + across * (one - along));
        add(m.K_plus, std::max(slope, 0.0) * along + std::max(across, 0.0) * (one - along));
        add(m.D, spring.damping * along);
    }
    m.D += scene.mass_proportional() * m.M + scene.stiffness_proportional() * m.K_plus;
    return m;
}

std::vector<Index> free_dofs(const Scene& scene) {
    std::vector<Index> dofs;
    for (Index i = 0; i < scene.size(); ++i) {
        for (int d = 0; d < scene.dim() && !scene.is_pinned(i); ++d)
            dofs.push_back(scene.dim() * i + d);
    }
    return dofs;
}

Eigen::VectorXd flat(const Eigen::MatrixXd& points) {
    return Eigen::Map<const Eigen::VectorXd>(points.data(), points.size());
}

Eigen::VectorXd flat_force(const Scene& scene, const AnyState& state) {
    return flat(scene.force(state));
}

Eigen::MatrixXd difference_quotient(const Scene& scene, AnyState state, bool of_velocity,
                                    double h) {
    auto& moved = of_velocity ? state.v : state.x;
    Eigen::MatrixXd J(moved.size(), moved.size());
    for (Index j = 0; j < moved.size(); ++j) {
        double& entry = moved.data()[j];
        const double before = entry;
        entry = before + h;
        const Eigen::VectorXd up = flat_force(scene, state);
        entry = before - h;
        const Eigen::VectorXd down = flat_force(scene, state);
        entry = before;
        J.col(j) = (down - up) / (2 * h);
    }
    return J;
}

}  // namespace taut_test
