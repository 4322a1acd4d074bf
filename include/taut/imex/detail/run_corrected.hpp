// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../step/sweep.hpp"

// What Sweep::run_corrected does: defined where it is used.

namespace taut::step_detail {

template <class Scalar, int Dim>
template <bool Ahead, class AnyState, class Correct>
bool Steps<Scalar, Dim>::run_corrected(const Forces& forces, AnyState& state, Scalar h, Index count,
                                       int threads, const Correct& correct) {
    const bool one_by_one = outside_.asks_for_state();
    if (one_by_one && !state_.finite()) return false;
    if (places_.empty()) places_ = forces.layout().places();
    for (Index i = 1; i <= count; ++i) {
        if (Ahead && i > 1) state_.look_ahead(h);
        outside_.ask(forces.layout(), state_.planes(), true);
        some_steps(forces, h, 1, threads,
                   &PlaceUpdate<Scalar>::template move<VerletUpdate<0, true>>);
        const StatePlanes<Scalar> planes = state_.planes();
        correct(PlaceVectors<Scalar, Dim>(forces.layout(), places_, planes.x),
                PlaceVectors<Scalar, Dim>(forces.layout(), places_, planes.v));
        const Register step(h);
        state_.for_each_register([&](Index k) {
            const Register a = Register::load(planes.x.first + k);
            const Register v = Register::load(planes.v.first + k) + step * a;
            v.store(planes.v.first + k);
            (Register::load(planes.new_x.first + k) + step * v).store(planes.x.first + k);
        });
        const bool check = one_by_one || i == count || i % steps_between_checks == 0;
        if (check && !state_.finite()) return false;
        outside_.pass(h);
    }
    store(forces.layout(), h, count, state);
    return true;
}

}  // namespace taut::step_detail
