// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Compiled with OpenMP: any number of threads gives the same bits.

#include <taut/taut.hpp>

#include <cstdio>

#ifndef _OPENMP
#error "this unit must be compiled with OpenMP: the flag was lost"
#endif

namespace {

template <template <class...> class Stepper, class System>
bool same_bits(const System& system) {
    using Scalar = typename System::Scalar;
    auto expected = system.initial_state();
    expected.v.setRandom();
    const auto start = expected;
    Stepper one(system);
    if (!one.step(expected, Scalar(1e-5), 70)) return false;
    for (const int threads : {2, 3, 8}) {
        auto state = start;
        Stepper many(system, {threads});
        if (!many.step(state, Scalar(1e-5), 70)) return false;
        if (state.x != expected.x || state.v != expected.v) {
            std::fprintf(stderr, "%d threads give other bits than one\n", threads);
            return false;
        }
    }
    return true;
}

template <class Scalar>
bool same_bits() {
    auto cloth = taut::hanging_cloth<Scalar>({110, 90});
    if (!same_bits<taut::SymplecticEuler>(cloth)) return false;
    for (taut::Index i = 0; i < 4000; i += 3)
        cloth.add_spring(i, 9899 - i, Scalar(5), Scalar(0.01));
    cloth.set_rayleigh({0.1, 1e-6});
    return same_bits<taut::SymplecticEuler>(cloth) && same_bits<taut::ExplicitEuler>(cloth);
}

}  // namespace

int main() { return same_bits<float>() && same_bits<double>() ? 0 : 1; }
