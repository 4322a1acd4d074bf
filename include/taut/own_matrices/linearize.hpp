// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include "../network/spring_system.hpp"
#include "../network/tangent_matrix.hpp"
#include "linear_system.hpp"

namespace taut {

/// M, D, K and load of the free degrees of freedom of `system` about `state`: K = −∂f/∂x with every
/// damping velocity taken as 0, D = −∂f/∂v with Rayleigh on K⁺ [T2], [T28]. Fails when every
/// particle is pinned, or the state is not finite.
template <class Scalar, int Dim, class... Laws>
LinearSystem<Scalar> linearize(const SpringSystem<Scalar, Dim, Laws...>& system,
                               const State<Scalar, Dim>& state) {
    detail::require_fits("linearize", state, system.size());
    if (!state.finite()) {
        fail("linearize: particle ", state.first_not_finite(),
             " has a position or velocity that is not finite");
    }
    if (system.pinned_count() == system.size()) {
        fail("linearize: none of the ", system.size(), " particles is free");
    }
    const TangentMatrix<Scalar, Dim> tangent(system);
    auto K = tangent.zero();
    auto D = tangent.zero();
    tangent.assemble(system, state.x, matrices::K, K);
    tangent.assemble(system, state.x, matrices::D, D);

    State<Scalar, Dim> still = state;
    still.v.setZero();
    Points<Scalar, Dim> f;
    system.force(still, f);
    FreeMap<Scalar> map{Dim, tangent.free(), {}};
    map.free.gather(state.x, map.pose);
    VectorX<Scalar> mass, load;
    map.free.gather(f, load);
    for (Index i = 0; i < system.size(); ++i) f.col(i).setConstant(system.mass(i));
    map.free.gather(f, mass);
    LinearSystem<Scalar> linear(std::move(mass), std::move(D), std::move(K), std::move(load));
    linear.set_free_map(std::move(map));
    return linear;
}

}  // namespace taut
