// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A program's own floating-point modes: rounding in another direction, subnormal numbers taken for
// zero. What is certified is true, steps are right, and what diverges is found.

#include <taut/guard/guard.hpp>
#include <taut/integrator/implicit_euler.hpp>

#include <cfenv>
#include <cstdio>

#include "limits.hpp"
#include "steppers.hpp"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace {

using referee::check;
using taut::Method;

const char* enter(int mode) {
    std::fesetenv(FE_DFL_ENV);
    switch (mode) {
        case 0: return "as usual";
        case 1: std::fesetround(FE_UPWARD); return "upward";
        case 2: std::fesetround(FE_DOWNWARD); return "downward";
        case 3: std::fesetround(FE_TOWARDZERO); return "toward zero";
        default: break;
    }
#if defined(__SSE2__)
    if (mode == 4) _mm_setcsr(_mm_getcsr() | 0x8040);
    if (mode == 4) return "no subnormal numbers";
#endif
    return nullptr;
}

template <class Stepper, class System>
void judge_stepper(const char* name, const System& system, double step, int mode) {
    using Scalar = typename System::Scalar;
    const auto h = static_cast<Scalar>(step);
    auto moved = [&](int in) {
        enter(in);
        auto state = system.initial_state();
        state.v.row(0).setConstant(Scalar(0.1));
        Stepper stepper(system);
        check(bool(stepper.step(state, h, 100)), name, in);
        return state;
    };
    const auto expected = moved(0);
    const auto state = moved(mode);
    const auto far = (state.x - expected.x).cwiseAbs().maxCoeff();
    check(far < (sizeof(Scalar) == 4 ? Scalar(1e-4) : Scalar(1e-7)), name, mode);
}

template <class Scalar>
void judge_steps(int mode) {
    using System = taut::SpringSystem<Scalar, 3>;
    System cloth = taut::hanging_cloth<Scalar>({6, 6});
    cloth.set_rayleigh({0.1, 1e-5});
    enter(mode);
    const auto h = static_cast<double>(taut::any_pose_limit(cloth).certified);
    const auto energy = static_cast<double>(taut::energy_limit(cloth).certified);
    edges::each_explicit<System>([&](auto kind) {
        using taut::method::AnyPose;
        if (kind.any_pose == AnyPose::no_step) return;  // unstable, it magnifies rounding
        const double step = kind.any_pose == AnyPose::proved ? energy : 0.5 * h;
        judge_stepper<typename decltype(kind)::Type>(kind.name, cloth, step, mode);
    });
    judge_stepper<taut::ImplicitEuler<System>>("ImplicitEuler", cloth, h, mode);
    enter(mode);
    auto state = cloth.initial_state();
    state.v.setRandom();
    taut::SymplecticEuler<System> stepper(cloth);
    const auto report = stepper.step(state, static_cast<Scalar>(10 * h), 3000);
    // Toward zero nothing overflows to infinity, and what diverges stays at the largest number.
    check(mode == 3 || report.status == taut::Status::diverged, "divergence", mode);
    state = cloth.initial_state();
    taut::Guarded guard(cloth);
    for (int frame = 0; frame < 10; ++frame) {
        check(bool(guard.advance(state, Scalar(1) / 60)), "Guarded", mode);
    }
}

}  // namespace

int main() {
    for (int mode = 0; const char* name = enter(mode); ++mode) {
        const int before = referee::failures();
        limits::judge(80);
        judge_steps<float>(mode);
        judge_steps<double>(mode);
        if (referee::failures() != before) std::fprintf(stderr, "in the mode: %s\n", name);
    }
    return referee::failures() == 0 ? 0 : 1;
}
