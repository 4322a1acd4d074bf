// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "energy_guarantee.hpp"

#include <taut/own_matrices/own_matrices.hpp>

namespace taut_test::energy_guarantee_test {

using taut::energy_never_rises_v;

static_assert(energy_never_rises_v<taut::SpringSystem<float, 2, TensionOnly>>);
static_assert(energy_never_rises_v<const taut::SpringSystem<double, 3, TensionOnly>>);
static_assert(!energy_never_rises_v<taut::SpringSystem<double, 3>>, "no law named is Hookean");
static_assert(!energy_never_rises_v<taut::SpringSystem<double, 3, TensionOnly, taut::Hookean>>);
static_assert(!energy_never_rises_v<taut::SpringSystem<double, 3, Buckling>>);
static_assert(!energy_never_rises_v<taut::LinearSystem<double>>, "K may be indefinite");

TEMPLATE_TEST_CASE("energy_guarantee: a converged implicit step keeps the promise of [T24]",
                   "[model][slow]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>)) {
    check_promise<TestType>();
}

}  // namespace taut_test::energy_guarantee_test
