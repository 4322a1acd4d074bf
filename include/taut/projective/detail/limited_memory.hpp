// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "../../core/types.hpp"

namespace taut::integrator_detail {

/// The two-loop recursion of L-BFGS about an initial matrix of the caller's (J. Nocedal,
/// "Updating quasi-Newton matrices with limited storage", Math. Comp. 35, 1980).
template <class Vector>
class LimitedMemory {
public:
    using Scalar = typename Vector::Scalar;

    explicit LimitedMemory(int window) : pairs_(static_cast<std::size_t>(window)) {}
    void clear() { count_ = 0; }
    bool empty() const { return count_ == 0; }
    /// Takes up a move and the change of the gradient over it, unless their product is not
    /// positive.
    void add(const Vector& move, const Vector& change) {
        if (pairs_.empty()) return;
        const Scalar product = move.cwiseProduct(change).sum();
        if (!(product > 0)) return;
        Pair& pair = pairs_[next_++ % pairs_.size()];
        pair.move = move;
        pair.change = change;
        pair.inverse_product = 1 / product;
        if (count_ < pairs_.size()) ++count_;
    }
    /// q ← H q, where solve(q) is q ← H₀ q.
    template <class Solve>
    void apply(Vector& q, Solve&& solve) {
        for (std::size_t i = 0; i < count_; ++i) {
            Pair& pair = newest(i);
            pair.share = pair.inverse_product * pair.move.cwiseProduct(q).sum();
            q -= pair.share * pair.change;
        }
        solve(q);
        for (std::size_t i = count_; i-- > 0;) {
            const Pair& pair = newest(i);
            const Scalar along = pair.inverse_product * pair.change.cwiseProduct(q).sum();
            q += (pair.share - along) * pair.move;
        }
    }

private:
    struct Pair {
        Vector move;
        Vector change;
        Scalar inverse_product = 0;
        Scalar share = 0;  // of q, between the two loops
    };
    Pair& newest(std::size_t i) { return pairs_[(next_ + pairs_.size() - 1 - i) % pairs_.size()]; }

    std::vector<Pair> pairs_;
    std::size_t next_ = 0;   // where the next pair goes, modulo the window
    std::size_t count_ = 0;  // pairs held
};

}  // namespace taut::integrator_detail
