// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "../core/buffer.hpp"
#include "detail/small_spectrum.hpp"
#include "pencil.hpp"

namespace taut {

/// What a search for a Ritz pair may cost.
struct LanczosOptions {
    int basis = 16;           ///< vectors kept at most: the memory is basis × N doubles
    int restarts = 8;         ///< at most; each keeps the best third of the basis
    double tolerance = 2e-2;  ///< stop when residual ≤ tolerance·|value| …
    double settled = 0;       ///< … or when a restart raised the value by less than this share
};

/// An approximate eigenpair of M⁻¹S.
struct RitzPair {
    double value = 0;        ///< 1/s² for K, 1/s for D; never above the largest eigenvalue
    double residual = 0;     ///< ‖M⁻½(S − value·M)u‖ for the vector of unit M-norm
    Eigen::VectorXd vector;  ///< u, N, with uᵀM u = 1
    int products = 0;        ///< multiplications by S spent
};

namespace proof_detail {

/// A fixed pseudo-random vector: the same on every machine, with a component along every mode.
inline Eigen::VectorXd scattered_vector(Index N, Index seed = 0) {
    Eigen::VectorXd q(N);
    std::uint64_t word = 0x9e3779b97f4a7c15u + static_cast<std::uint64_t>(seed);
    for (Index i = 0; i < N; ++i) {
        word ^= word << 13;
        word ^= word >> 7;
        word ^= word << 17;
        q[i] = static_cast<double>(word >> 11) * 0x1p-53 - 0.5;
    }
    return q;
}

/// aᵀb. With add_scaled() the whole of a search's arithmetic on long vectors, so that Eigen's
/// expressions are compiled once.
template <class Real>
Real dot(const Real* a, const Real* b, Index n) {
    using Map = Eigen::Map<const VectorX<Real>>;
    return Map(a, n).dot(Map(b, n));
}
/// ‖a‖
template <class Real>
Real norm(const Real* a, Index n) {
    return std::sqrt(dot(a, a, n));
}

/// y ← y + factor·x
template <class Real>
void add_scaled(Real* y, Real factor, const Real* x, Index n) {
    Eigen::Map<VectorX<Real>>(y, n) += factor * Eigen::Map<const VectorX<Real>>(x, n);
}

/// The residual of the largest Ritz value over its size, where H, m × m, is tridiagonal.
/// @param beta  what the last of its `used` columns leaves
inline double tridiagonal_residual(const Buffer<double>& H, Index m, Index used, double beta) {
    std::vector<double> d, e;
    for (Index j = 0; j < used; ++j) {
        d.push_back(H[j * m + j]);
        if (j + 1 < used) e.push_back(H[j * m + j + 1]);
    }
    std::vector<double> last_row(d.size(), 0);
    last_row.back() = 1;
    const auto ritz = tridiagonal_spectrum(std::move(d), std::move(e), std::move(last_row));
    return beta * (std::abs)(*ritz.vector(used - 1)) / (std::abs)(ritz.values.back());
}

/// Vectors of N numbers, side by side.
template <class Real>
class Basis {
public:
    Basis(Index N, Index most) : size_(N), numbers_(N * most) {}

    Real* operator[](Index j) { return numbers_.data() + j * size_; }
    void set(Index j, const VectorX<Real>& q) {
        std::copy_n(q.data(), size_, numbers_.data() + j * size_);
    }
    /// w ← w − QQᵀw with the vectors from `first` to `used`, which must be orthonormal.
    /// @returns  Qᵀw with zeros before
    Buffer<Real> remove_from(VectorX<Real>& w, Index first, Index used) {
        Buffer<Real> h(used, 0);
        for (Index j = first; j < used; ++j) h[j] = dot((*this)[j], w.data(), size_);
        for (Index j = first; j < used; ++j) add_scaled(w.data(), -h[j], (*this)[j], size_);
        return h;
    }
    /// Σ shares_j q_j of the first `used`.
    template <class Share>
    VectorX<Real> sum(const Share* shares, Index used) {
        VectorX<Real> q = VectorX<Real>::Zero(size_);
        for (Index j = 0; j < used; ++j)
            add_scaled(q.data(), static_cast<Real>(shares[j]), (*this)[j], size_);
        return q;
    }

private:
    Index size_;
    Buffer<Real> numbers_;
};

/// largest_ritz_pair, or a rough one: its first run is not reorthogonalised and stops early.
template <class Real>
RitzPair ritz_search(const Pencil& pencil, const Combination& c, const LanczosOptions& options,
                     const Eigen::VectorXd& start, bool rough) {
    const Index N = pencil.size();
    const Index m = std::min<Index>(options.basis, N);
    VectorX<Real> by_root(N);  // M⁻½
    for (Index i = 0; i < N; ++i) by_root[i] = 1 / std::sqrt(pencil.mass()[i]);
    Basis<Real> Q(N, m);         // orthonormal
    Buffer<double> H(m * m, 0);  // QᵀAQ with A = M⁻½SM⁻½
    VectorX<Real> u(N);
    VectorX<Real> w(N);
    VectorX<Real> q = scattered_vector(N);
    if (start.size() == N) {
        for (Index i = 0; i < N; ++i) q[i] = start[i] / by_root[i];
    }
    q /= norm(q.data(), N);
    RitzPair pair;
    Index kept = 0;
    for (int run = 0; run <= options.restarts; ++run) {
        Index used = kept;
        const bool plain = rough && run == 0;
        double beta = 0;
        bool early = false;
        while (used < m && !early) {
            const Index j = used++;
            Q.set(j, q);
            for (Index i = 0; i < N; ++i) u[i] = by_root[i] * q[i];
            pencil.multiply(c, u, w);
            ++pair.products;
            for (Index i = 0; i < N; ++i) w[i] *= by_root[i];
            const Buffer<double> h = Q.remove_from(w, plain && j > 0 ? j - 1 : 0, used);
            double norm = 0;
            for (Index i = 0; i < used; ++i) {
                H[j * m + i] = H[i * m + j] = h[i];
                norm = std::hypot(norm, h[i]);
            }
            beta = proof_detail::norm(w.data(), N);
            if (!rough || !(beta > 0.1 * norm)) {
                // Twice is enough (Parlett): the basis stays orthogonal to rounding.
                Q.remove_from(w, 0, used);
                beta = proof_detail::norm(w.data(), N);
            }
            if (!(beta > 1e-14 * norm)) {
                // An invariant subspace, maybe not that of the largest eigenvalue.
                beta = 0;
                w = scattered_vector(N, used);
                for (int pass = 0; pass < 2; ++pass) Q.remove_from(w, 0, used);
            }
            if (used < N) q = w / proof_detail::norm(w.data(), N);  // else none is left
            // H of the first run is tridiagonal, so that what its end will be is cheap to know.
            early = rough && run == 0 && used >= 8 && used % 2 == 0 &&
                    tridiagonal_residual(H, m, used, beta) <= options.tolerance;
        }
        std::vector<double> projected;
        for (Index j = 0; j < used; ++j) {
            projected.insert(projected.end(), H.begin() + j * m, H.begin() + j * m + used);
        }
        const auto ritz = small_spectrum(std::move(projected), static_cast<std::size_t>(used));
        const double earlier = pair.value;
        pair.value = ritz.values.back();
        pair.residual = beta * (std::abs)(ritz.vector(used - 1)[used - 1]);
        const bool settled =
            run > 0 && pair.value - earlier <= options.settled * (std::abs)(pair.value);
        const bool last = run == options.restarts || m == N || settled ||
                          pair.residual <= options.tolerance * (std::abs)(pair.value);
        kept = last ? 1 : std::max<Index>(1, used / 3);
        std::vector<VectorX<Real>> best;  // what a restart keeps
        for (Index j = 0; j < kept; ++j) best.push_back(Q.sum(ritz.vector(used - kept + j), used));
        for (Index j = 0; j < kept; ++j) Q.set(j, detail::at(best, j));
        if (last) break;
        for (Index j = 0; j < kept; ++j) {
            for (Index i = 0; i < kept; ++i) H[j * m + i] = 0;
            H[j * m + j] = detail::at(ritz.values, used - kept + j);
        }
    }
    const double* shape = Q[kept - 1];
    const double length = norm(shape, N);
    pair.vector.resize(N);
    for (Index i = 0; i < N; ++i) pair.vector[i] = by_root[i] * (shape[i] / length);
    return pair;
}

}  // namespace proof_detail

/// The largest eigenvalue of M⁻¹S from below: Lanczos with full reorthogonalisation and thick
/// restart (K. Wu and H. Simon, Thick-restart Lanczos method for large symmetric eigenvalue
/// problems, 2000). Negate the factors of `c` for the smallest one.
/// @param start  an approximate eigenvector to begin with, N; empty: a fixed scattered vector
template <class Real = double>  // a template: only its callers compile it
RitzPair largest_ritz_pair(const Pencil& pencil, const Combination& c,
                           const LanczosOptions& options = {}, const Eigen::VectorXd& start = {}) {
    return proof_detail::ritz_search<Real>(pencil, c, options, start, false);
}

/// The same for half of the time, where a vector near the leading one is enough. A search that
/// begins near some mode settles there first, and a small one is soon over: these are not cut
/// short.
template <class Real = double>
RitzPair leading_pair(const Pencil& pencil, const Combination& c,
                      const Eigen::VectorXd& start = {}) {
    constexpr Index few = 300;
    const bool rough = start.size() != pencil.size() && pencil.size() >= few;
    return proof_detail::ritz_search<Real>(pencil, c, {}, start, rough);
}

}  // namespace taut
