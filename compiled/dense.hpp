// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Eigenvalues>

// Eigen's dense eigenvalues in double, which the modules below and tests use: five seconds of a
// compiler each.

#define TAUT_DENSE(KIND)                                                                    \
    KIND Eigen::EigenSolver<Eigen::MatrixXd>& Eigen::EigenSolver<Eigen::MatrixXd>::compute( \
        const Eigen::EigenBase<Eigen::MatrixXd>&, bool);                                    \
    KIND Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>&                                    \
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>::compute(                                \
        const Eigen::EigenBase<Eigen::MatrixXd>&, int);                                     \
    KIND Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>&                         \
    Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>::compute(                     \
        const Eigen::MatrixXd&, const Eigen::MatrixXd&, int);

TAUT_DENSE(extern template)
