// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "../conditions/mode.hpp"
#include "detail/arnoldi.hpp"
#include "../proof/pencil_matrix.hpp"

namespace taut {
/// An estimate, s, of the largest stable step of explicit Euler under any damping, for systems too
/// large for DenseAnalysis: min of −2 Re λ/|λ|² [T18] over the eigenvalues λ of C at both ends of
/// its spectrum, by Arnoldi on C and on (C − σI)⁻¹ with a tiny σ > 0 (one sparse factorisation).
/// An eigenvalue that neither run finds is missed, so this is no bound: nothing may be called safe
/// by it. Zero modes do not count. Infinity without any other; NaN when K is indefinite.
/// @param k_max  a bound on the largest eigenvalue of K', 1/s²
template <class Real = double>  // a template: only its callers compile the eigensolver
Real explicit_estimate(const Pencil& pencil, Real k_max) {
    constexpr Index steps = 80;
    constexpr double good = 0.1;   // residual over |λ| of the vectors that count
    constexpr double zero = 1e-5;  // |λ| of zero modes over √k_max
    const Index N = pencil.size();
    const VectorX<Real> root = pencil.mass().cwiseSqrt();
    const double omega = std::sqrt(k_max);
    const double sigma = 0.1 * zero * omega;
    // y = (ωx; v) in the coordinates √M x: C = [[0, ω], [−K'/ω, −D']].
    const auto times = [&](const Combination& c, const VectorX<Real>& x) {
        VectorX<Real> y(N);
        pencil.multiply(c, x.cwiseQuotient(root), y);
        return VectorX<Real>(y.cwiseQuotient(root));
    };
    const auto forwards = [&](const VectorX<Real>& y) {
        VectorX<Real> Cy(2 * N);
        Cy << omega * y.tail(N),
            -times(1 / omega * matrices::K, y.head(N)) - times(matrices::D, y.tail(N));
        return Cy;
    };
    const Eigen::SimplicialLLT<SparseMatrix<Real>> shifted(
        pencil.assemble(sigma * sigma * matrices::M + sigma * matrices::D + matrices::K));
    if (shifted.info() != Eigen::Success) return std::numeric_limits<double>::quiet_NaN();
    const auto backwards = [&](const VectorX<Real>& y) {
        // (σ²M + σD + K)x = −(r + (D + σM)a) with v = a + σx, for (C − σ)(ωx; v) = (ωa; r).
        const VectorX<Real> a = y.head(N) / omega;
        const VectorX<Real> load = -y.tail(N) - times(sigma * matrices::M + matrices::D, a);
        const VectorX<Real> x =
            root.cwiseProduct(shifted.solve(VectorX<Real>(root.cwiseProduct(load))));
        VectorX<Real> solution(2 * N);
        solution << omega * x, a + sigma * x;
        return solution;
    };
    double h = std::numeric_limits<double>::infinity();
    const auto lower = [&](const proof_detail::ComplexRitzPairs<Real>& pairs, auto&& eigenvalue) {
        for (Index j = 0; j < pairs.value.size(); ++j) {
            const std::complex<Real> lambda = eigenvalue(pairs.value[j]);
            if (!((std::abs)(lambda) > zero * omega)) continue;
            if (pairs.residual[j] > good * (std::abs)(pairs.value[j])) continue;
            // The quotients of the vector are better than the real part of its value: they err in
            // proportion to themselves.
            const VectorX<std::complex<Real>> x = pairs.vector(j).head(N);
            const auto form = [&](const Combination& c) {
                return pencil.quadratic(c, x.real().cwiseQuotient(root)).value +
                       pencil.quadratic(c, x.imag().cwiseQuotient(root)).value;
            };
            const double m = x.squaredNorm();
            h = (std::min)(h, critical_step(Method::explicit_euler, form(matrices::K) / m,
                                            form(matrices::D) / m));
        }
    };
    lower(proof_detail::arnoldi<Real>(forwards, 2 * N, steps),
          [](std::complex<Real> value) { return value; });
    lower(proof_detail::arnoldi<Real>(backwards, 2 * N, steps),
          [&](std::complex<Real> value) { return sigma + 1.0 / value; });
    return h;
}

}  // namespace taut
