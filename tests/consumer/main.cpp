// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <cstdio>

#include <taut/modal/modal_dynamics.hpp>
#include <taut/taut.hpp>

#ifdef CONSUMER_SUITESPARSE
#include <taut/suitesparse/cholmod.hpp>
#include <taut/suitesparse/umfpack.hpp>
#endif
#ifdef CONSUMER_MODAL
#include <taut/modal/modal_analysis.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#endif

int main() {
    taut::SpringSystem<double, 3> cloth = taut::hanging_cloth<double>({8, 8});
    auto state = cloth.initial_state();
    auto moving = taut::any_pose_limit(cloth);
    taut::SymplecticEuler stepper(cloth);
    for (int i = 0; i < 10; ++i) {
        if (auto report = stepper.step(state, 0.95 * moving.certified); !report) return 1;
    }
#ifdef CONSUMER_SUITESPARSE
    taut::ImplicitEuler<taut::SpringSystem<double, 3>, taut::Cholmod<>> implicit(cloth);
    if (auto report = implicit.step(state, 1e-3); !report) return 1;
#endif
#ifdef CONSUMER_MODAL
    taut::ModalBasis modes;
    if (auto report = taut::modal_analysis(taut::linearize(cloth, state), 4, modes); !report)
        return 1;
#endif
    std::printf("t = %g s, lowest z = %g m\n", state.time, state.x.row(2).minCoeff());
}
