// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>

#include "detail/outside_force.hpp"
#include "state.hpp"

namespace taut {

/// What acts on the particles of a SpringSystem beside springs and gravity.
template <class Scalar, int Dim>
struct ExternalForces {
    /// See SpringSystem::ExternalForce.
    std::function<void(const State<Scalar, Dim>&, Points<Scalar, Dim>&)> whole;
    Points<Scalar, Dim> constant;  ///< N, Dim × n, or 0 columns for none
    Index constants = 0;           ///< those that are not 0
    /// A module's; null for none.
    std::shared_ptr<const network_detail::OutsideForce<Scalar, Dim>> outside;

    /// Whether there is any.
    bool any() const { return whole || constant.cols() > 0 || outside; }
    /// f ← f + all of them at a state, N, Dim × n.
    void add(const State<Scalar, Dim>& state, Points<Scalar, Dim>& f) const {
        if (constant.cols() > 0) f.leftCols(constant.cols()) += constant;
        if (outside) outside->add(state, f);
        if (whole) whole(state, f);
    }
};

}  // namespace taut
