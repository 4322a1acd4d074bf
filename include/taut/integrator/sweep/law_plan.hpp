// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "batch_plan.hpp"
#include "run_plan.hpp"

namespace taut::integrator_detail::sweep {

/// The springs of one law: runs, and batches of those that fit none.
template <class Scalar, int Dim, class Law>
class LawPlan {
public:
    LawPlan() = default;
    LawPlan(const SpringSet<Scalar, Law>& set, const SortedSprings& springs, int tiles)
        : runs_(set, springs.runs(), tiles, table_),
          batches_(set, springs.scattered(), tiles, table_),
          damped_(!set.damping.empty()) {
        table_.finish();
    }

    /// Whether a spring has a damper of its own.
    bool damped() const { return damped_; }
    /// Adds the forces of the tile's springs on the places of its block.
    template <Proportional Kind>
    void add_forces(const TileView<Scalar>& view) const {
        damped_ ? add_forces<true, Kind>(view) : add_forces<false, Kind>(view);
    }

private:
    template <bool Dampers, Proportional Kind>
    void add_forces(const TileView<Scalar>& view) const {
        runs_.template add_forces<Dampers, Kind>(table_, view);
        batches_.template add_forces<Dampers, Kind>(table_, view);
    }

    SpringTable<Scalar, Law> table_;  // before those that fill it
    RunPlan<Scalar, Dim, Law> runs_;
    BatchPlan<Scalar, Dim, Law> batches_;
    bool damped_ = false;
};

}  // namespace taut::integrator_detail::sweep
