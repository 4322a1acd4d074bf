// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCholesky>
#include <vector>

#include "outcome.hpp"

namespace bench {

/// The tutorials' step: triplets and a factorisation from nothing every time.
class TripletStep {
public:
    /// @param h        s
    /// @param project  leave the negative transverse stiffness out of the matrix
    TripletStep(const Net& cloth, double h, bool project)
        : cloth_(cloth), h_(h), project_(project) {
        for (taut::Index i = 0; i < cloth.size(); ++i) {
            row_.push_back(cloth.is_pinned(i) ? -1 : free_);
            if (!cloth.is_pinned(i)) ++free_;
        }
    }
    bool operator()(Net::State& state) {
        const double h = h_;
        std::vector<Eigen::Triplet<double>> triplets;
        Eigen::VectorXd b = Eigen::VectorXd::Zero(3 * free_);
        cloth_.force(state, f_);
        const auto add = [&](int i, int j, const Eigen::Matrix3d& block) {
            if (i < 0 || j < 0) return;
            for (int r = 0; r < 3; ++r) {
                for (int c = 0; c < 3; ++c)
                    triplets.emplace_back(3 * i + r, 3 * j + c, block(r, c));
            }
        };
        cloth_.for_each_tangent(state.x, [&](const taut::SpringTangent<double, 3>& raw) {
            const auto t = project_ ? raw.projected() : raw;
            const int i = row_[static_cast<std::size_t>(t.a)];
            const int j = row_[static_cast<std::size_t>(t.b)];
            const Eigen::Matrix3d K = t.transverse * Eigen::Matrix3d::Identity() +
                                      (t.axial - t.transverse) * t.d * t.d.transpose();
            const Eigen::Vector3d pull = h * h * K * (state.v.col(t.b) - state.v.col(t.a));
            add(i, i, h * h * K);
            add(j, j, h * h * K);
            add(i, j, -h * h * K);
            add(j, i, -h * h * K);
            if (i >= 0) b.segment<3>(3 * i) += pull;
            if (j >= 0) b.segment<3>(3 * j) -= pull;
        });
        for (taut::Index i = 0; i < cloth_.size(); ++i) {
            const int r = row_[static_cast<std::size_t>(i)];
            if (r < 0) continue;
            add(r, r, cloth_.mass(i) * Eigen::Matrix3d::Identity());
            b.segment<3>(3 * r) += h * f_.col(i);
        }
        taut::SparseMatrix<double> A(3 * free_, 3 * free_);
        A.setFromTriplets(triplets.begin(), triplets.end());
        Eigen::SimplicialLDLT<taut::SparseMatrix<double>> solver;
        solver.compute(A);
        const Eigen::VectorXd dv = solver.solve(b);
        for (taut::Index i = 0; i < cloth_.size(); ++i) {
            const int r = row_[static_cast<std::size_t>(i)];
            if (r >= 0) state.v.col(i) += dv.segment<3>(3 * r);
        }
        state.x += h * state.v;
        return solver.info() == Eigen::Success;
    }

private:
    const Net& cloth_;
    double h_;  // s
    bool project_;
    std::vector<int> row_;  // particle → free particle, or −1
    int free_ = 0;
    Eigen::Matrix3Xd f_;
};

}  // namespace bench
