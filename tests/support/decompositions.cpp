// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "support/decompositions.hpp"

#include <Eigen/Dense>

namespace taut_test {

RealVector eigenvalues(const RealMatrix& A) {
    return Eigen::SelfAdjointEigenSolver<RealMatrix>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

Modes<RealMatrix> modes(const RealMatrix& A) {
    const Eigen::SelfAdjointEigenSolver<RealMatrix> solver(A);
    return {solver.eigenvalues(), solver.eigenvectors()};
}

ComplexVector general_eigenvalues(const RealMatrix& A) {
    return Eigen::EigenSolver<RealMatrix>(A, false).eigenvalues();
}

Modes<ComplexMatrix> general_modes(const RealMatrix& A) {
    const Eigen::EigenSolver<RealMatrix> solver(A);
    return {solver.eigenvalues(), solver.eigenvectors()};
}

RealMatrix solve(const RealMatrix& A, const RealMatrix& B) { return A.fullPivLu().solve(B); }

RealMatrix orthogonal(const RealMatrix& A) {
    return Eigen::HouseholderQR<RealMatrix>(A).householderQ();
}

}  // namespace taut_test
