// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/bdf2/bdf2.hpp>
#include <taut/integrator/explicit_euler.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/projective/projective.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/stability/any_pose.hpp>
#include <taut/own_matrices/own_matrices.hpp>

#include "../support/catch.hpp"

namespace taut_test::assigned_system_test {

// A scene that is assigned another one, built by as many calls, must not be taken for the old one.

namespace {

using Cloth = taut::SpringSystem<double, 3>;

Cloth cloth_of(double stiffness) {
    taut::ClothOptions options;
    options.rows = options.columns = 6;
    options.stretch = stiffness;
    return taut::hanging_cloth<double>(options);
}

template <class Stepper, class System>
void check_follows(System system, const System& other, double h) {
    Stepper stepper(system);
    auto state = system.initial_state();
    state.v.row(0).setLinSpaced(-0.1, 0.1);
    auto fresh = state;
    auto warm_up = state;
    REQUIRE(stepper.step(warm_up, h, 2));
    system = other;
    Stepper anew(system);
    REQUIRE(stepper.step(state, h, 3));
    REQUIRE(anew.step(fresh, h, 3));
    CHECK((state.x - fresh.x).norm() <= 1e-12);
    CHECK((state.v - fresh.v).norm() <= 1e-9);
}

}  // namespace

TEST_CASE("assigned system: every stepper follows", "[integrator]") {
    const Cloth soft = cloth_of(100);
    const Cloth stiff = cloth_of(1000);
    check_follows<taut::SymplecticEuler<Cloth>>(soft, stiff, 1e-4);
    check_follows<taut::ExplicitEuler<Cloth>>(soft, stiff, 1e-5);
    check_follows<taut::ImplicitEuler<Cloth>>(soft, stiff, 1e-2);
    check_follows<taut::ProjectiveDynamics<Cloth>>(soft, stiff, 1e-2);
    const auto soft_matrices = taut::linearize(soft, soft.initial_state());
    const auto stiff_matrices = taut::linearize(stiff, stiff.initial_state());
    using Linear = taut::LinearSystem<double>;
    check_follows<taut::ImplicitEuler<Linear>>(soft_matrices, stiff_matrices, 1e-2);
    check_follows<taut::Bdf2<Linear>>(soft_matrices, stiff_matrices, 1e-2);
}

TEST_CASE("assigned system: a limit of the old one is refused", "[integrator]") {
    Cloth cloth = cloth_of(100);
    const auto limit = taut::any_pose_limit(cloth);
    REQUIRE(limit.step_for(cloth, 0.9).has_value());
    cloth = cloth_of(1000);
    CHECK_FALSE(limit.step_for(cloth, 0.9).has_value());
}

}  // namespace taut_test::assigned_system_test
