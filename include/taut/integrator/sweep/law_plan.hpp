// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "batch_plan.hpp"
#include "run_plan.hpp"
#include "star_plan.hpp"

namespace taut::integrator_detail::sweep {

/// The springs of one law: runs, and batches of those that fit none; or all of them in stars.
template <class Scalar, int Dim, class Law>
class LawPlan {
public:
    LawPlan() = default;
    LawPlan(const SpringSet<Scalar, Law>& set, const SortedSprings& springs, const Blocks& blocks,
            bool stars)
        : damped_(!set.damping.empty()) {
        if (stars) {
            stars_ = {set, springs.all(), blocks};
        } else {
            runs_ = {set, springs.runs(), blocks, table_};
            batches_ = {set, springs.scattered(), blocks, table_};
            table_.finish();
        }
    }

    /// Whether a spring has a damper of its own.
    bool damped() const { return damped_; }
    /// Adds the forces of the tile's springs on the places of its block.
    /// @tparam Ahead  whether springs that push do so along the old direction [T42]
    template <bool Rayleigh, bool Ahead>
    void add_forces(const TileView<Scalar>& view, bool stars) const {
        constexpr bool both = Ahead && !Law::convex;
        damped_ ? add_forces<true, Rayleigh, both>(view, stars)
                : add_forces<false, Rayleigh, both>(view, stars);
    }

private:
    template <bool Dampers, bool Rayleigh, bool Both>
    void add_forces(const TileView<Scalar>& view, bool stars) const {
        if constexpr (Dim > 1) {
            if (stars) return stars_.template add_forces<Dampers, Rayleigh, Both>(view);
        }
        runs_.template add_forces<Dampers, Rayleigh, Both>(table_, view);
        batches_.template add_forces<Dampers, Rayleigh, Both>(table_, view);
    }

    SpringTable<Scalar, Law> table_;  // of runs and batches
    RunPlan<Scalar, Dim, Law> runs_;
    BatchPlan<Scalar, Dim, Law> batches_;
    StarPlan<Scalar, Law> stars_;
    bool damped_ = false;
};

}  // namespace taut::integrator_detail::sweep
