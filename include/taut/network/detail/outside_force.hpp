// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "../state.hpp"

namespace taut {

namespace step_detail {

template <class Scalar>
struct TileView;
template <class Scalar>
class TilePlan;
struct PlacedParticles;

}  // namespace step_detail

namespace network_detail {

/// A force from outside of a kind that the core does not know: a module makes it, a SpringSystem
/// holds it. It never changes, so copies of a system share it.
template <class Scalar, int Dim>
class OutsideForce {
public:
    using Plan = step_detail::TilePlan<Scalar>;

    virtual ~OutsideForce() = default;
    /// What a user calls to set it.
    virtual const char* name() const = 0;
    /// f ← f + the force at a state, N, Dim × n.
    virtual void add(const State<Scalar, Dim>& state, Points<Scalar, Dim>& f) const = 0;
    /// Whether a plan that another force made serves this one.
    virtual bool shares_plan(const OutsideForce& other) const = 0;
    /// Made once for a scene: in steps nothing is to be allocated.
    virtual std::shared_ptr<const Plan> plan(
        const step_detail::PlacedParticles& particles) const = 0;
    /// Adds the force on the places of the view's block, tile by tile.
    virtual void add(const Plan& plan, const step_detail::TileView<Scalar>& view) const = 0;
};

}  // namespace network_detail
}  // namespace taut
