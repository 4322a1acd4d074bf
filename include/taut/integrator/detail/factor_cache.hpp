// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "../../core/types.hpp"

namespace taut::integrator_detail {

/// Factors of one matrix pattern for the last two time steps h, so that an h that returns costs no
/// factorisation.
template <class Solver, class Scalar>
class FactorCache {
public:
    /// Forgets the pattern, and so all values.
    void forget_pattern() {
        for (Slot& slot : slots_) slot.analyzed = slot.factorized = false;
    }
    void forget_values() {
        for (Slot& slot : slots_) slot.factorized = false;
    }
    /// change(solver) for every solver kept.
    template <class Change>
    void configure(Change&& change) {
        for (Slot& slot : slots_) change(slot.solver);
    }
    /// The solver that was used last.
    Solver& solver() { return slots_[current_].solver; }
    const Solver& solver() const { return slots_[current_].solver; }
    /// Makes the factors for h current if there are any.
    bool find(Scalar h) {
        for (int i = 0; i < 2; ++i) {
            if (!slots_[i].factorized || slots_[i].h != h) continue;
            current_ = i;
            return true;
        }
        return false;
    }
    /// Factorises A = A(h), in place of the factors that were not used last.
    /// @returns whether the solver reports success
    bool factorize(const SparseMatrix<Scalar>& A, Scalar h);
    /// Factorisations so far.
    std::int64_t count() const { return count_; }

private:
    struct Slot {
        Solver solver;
        Scalar h = 0;             // s
        bool analyzed = false;    // solver knows the pattern
        bool factorized = false;  // and holds the factors for h
    };
    Slot slots_[2];
    int current_ = 0;
    std::int64_t count_ = 0;
};

template <class Solver, class Scalar>
bool FactorCache<Solver, Scalar>::factorize(const SparseMatrix<Scalar>& A, Scalar h) {
    if (slots_[current_].factorized && slots_[current_].h != h) current_ = 1 - current_;
    Slot& slot = slots_[current_];
    if (!slot.analyzed) slot.solver.analyzePattern(A);
    slot.solver.factorize(A);
    ++count_;
    slot.analyzed = true;
    slot.factorized = slot.solver.info() == Eigen::Success;
    slot.h = h;
    return slot.factorized;
}

}  // namespace taut::integrator_detail
