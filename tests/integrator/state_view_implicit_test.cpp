// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/bdf2/bdf2.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/projective/projective.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/taut.hpp>

#include "../support/compiled_once.hpp"
#include "arrays.hpp"

namespace taut_test::state_view_test {

TEST_CASE("state_view: implicit steps on arrays are those on a State", "[integrator]") {
    const auto narrow = taut::hanging_cloth<float>({6, 5});
    auto state = narrow.initial_state();
    state.v = Random(31).points<float, 3>(narrow.size(), -1, 1);
    check_view<float, taut::ImplicitEuler<Cloth<float>>>(narrow, state, 1e-2);
    check_view<double, taut::ImplicitEuler<Cloth<float>>>(narrow, state, 1e-2);

    const auto wide = taut::hanging_cloth<double>({6, 5});
    const taut::State<double, 3> start{state.x.cast<double>(), state.v.cast<double>()};
    check_view<double, taut::ImplicitEuler<Cloth<double>>>(wide, start, 1e-2);
    check_view<float, taut::ImplicitEuler<Cloth<double>>>(wide, start, 1e-2);
    check_view<double, taut::ProjectiveDynamics<Cloth<double>>>(wide, start, 1e-2);

    const auto linear = taut::linearize(wide, wide.initial_state());
    auto small = linear.initial_state();
    small.v.setLinSpaced(-1, 1);
    check_view<double, taut::Bdf2<taut::LinearSystem<double>>>(linear, small, 1e-2);
}

TEST_CASE("state_view: an implicit step refuses what the system's float cannot hold",
          "[integrator]") {
    const auto narrow = taut::hanging_cloth<float>({6, 6});
    Arrays<double, 3> wide(narrow.size(), 3, 3);
    auto wide_view = wide.view();
    wide_view.copy_from(narrow.initial_state());
    wide_view.v(1, 20) = 1e300;  // too large for the float of the system
    taut::ImplicitEuler implicit(narrow);
    const auto report = implicit.step(wide_view, 1e-2f);
    CHECK(report.status == taut::Status::invalid_state);
    CHECK(report.where == 20);
}

}  // namespace taut_test::state_view_test
