// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <cstdio>
#include <taut/taut.hpp>

#ifdef CONSUMER_SUITESPARSE
#include <taut/suitesparse/suitesparse.hpp>
#endif
#ifdef CONSUMER_MODAL
#include <Spectra/Util/Version.h>  // modal_analysis.hpp takes as long as all the rest
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
    taut::SparseMatrix<double> A(2, 2);
    A.setIdentity();
    taut::Cholmod<> cholmod;
    cholmod.analyzePattern(A);
    cholmod.factorize(A);
    taut::Umfpack<> umfpack;
    umfpack.analyzePattern(A);
    umfpack.factorize(A);
    if (cholmod.info() != Eigen::Success || umfpack.info() != Eigen::Success) return 1;
#endif
#ifdef CONSUMER_MODAL
    static_assert(SPECTRA_MAJOR_VERSION >= 1);
#endif
    std::printf("t = %g s, lowest z = %g m\n", state.time, state.x.row(2).minCoeff());
}
