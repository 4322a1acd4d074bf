// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/network/buckling.hpp>
#include <taut/network/tension_only.hpp>

#include "convex_on.hpp"

namespace taut_test {

static_assert(taut::energy_never_rises_v<Convex<float, 1>>);
static_assert(taut::energy_never_rises_v<taut::SpringSystem<float, 2, TensionOnly>>);
static_assert(taut::energy_never_rises_v<const taut::SpringSystem<double, 3, TensionOnly>>);
static_assert(!taut::energy_never_rises_v<Plain<double, 3>>, "no law named is Hookean");
static_assert(!taut::energy_never_rises_v<AnyLaw<double, 3>>);
static_assert(!taut::energy_never_rises_v<taut::SpringSystem<double, 3, Buckling>>);
static_assert(!taut::energy_never_rises_v<taut::LinearSystem<double>>, "K may be indefinite");

LawAt law_at(const ConvexString& s, long double l) {
    const WideString::Parameters<long double> p{s.stiffness, s.width, s.pull};
    const long double L = s.rest_length;
    return {WideString::tension(p, L, l), WideString::tension_slope(p, L, l),
            WideString::energy(p, L, l), s.stiffness};
}

taut::Report convex_step(const ConvexScene& scene, double h, AnyState& state, double tolerance,
                         const Held* held) {
    if (scene.dim == 1) return step_in<1>(scene, h, state, tolerance, held);
    return scene.dim == 2 ? step_in_2d(scene, h, state, tolerance, held)
                          : step_in_3d(scene, h, state, tolerance, held);
}

}  // namespace taut_test
