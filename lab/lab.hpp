// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#ifdef __EMSCRIPTEN__
#include <emscripten/emscripten.h>
#define LAB_CALL EMSCRIPTEN_KEEPALIVE
#else
#define LAB_CALL
#endif

// One cloth for a page, or for a native program, to play with. Methods count as in taut::Method:
// explicit Euler, symplectic Euler, velocity Verlet, implicit Euler, BDF2, graph inertia.

extern "C" {

/// What lab_analyse() finds; all of it double, so that a page reads it as one array.
struct LabLimits {
    double any_pose;     ///< s; certified at any pose, linearised (0: not, infinity: every step)
    double certified;    ///< s; at the pose in which the cloth starts
    double refuted;      ///< s; at that pose; infinity: none is
    double alpha_lower;  ///< s; the stiffness-proportional damping that makes step h stable …
    double alpha_upper;  ///< s; … is above the one and below the other; both 0: none does
};

/// One of the plans that lab_recommend() compared, the cheapest first.
struct LabPlan {
    double method;
    double gradients;  ///< 1: its linear systems are solved by conjugate gradients
    double substeps;   ///< of a frame of 1/60 s
    double h;          ///< s
    double cost;       ///< s a frame, as measured here
};

/// A cloth of side × side particles, flat and at rest. @param side ≥ 2
/// @param stiffness  of the weave, N/m; bending springs take a tenth   @param mass  in all, kg
/// @param alpha  stiffness-proportional damping, s   @param drag  mass-proportional, 1/s
LAB_CALL void lab_start(int side, double stiffness, double mass, double alpha, double drag);
/// Other springs, masses and damping for the cloth as it hangs and moves.
LAB_CALL void lab_change(double stiffness, double mass, double alpha, double drag);
LAB_CALL int lab_size();
LAB_CALL int lab_springs();

/// Takes `count` ≥ 1 steps of h, s. @returns a taut::Status; unless ok, the state is as it was
LAB_CALL int lab_step(int method, double h, int count);
/// s, since lab_start.
LAB_CALL double lab_time();
/// 3 × n, m.
LAB_CALL const double* lab_positions();
/// The same, as a graphics card takes it.
LAB_CALL const float* lab_drawn_positions();
/// n; m: how far each particle swings from step to step, h|v⁺ − v|/4 over the last step taken. A
/// mode with the multiplier −1 has this amplitude; slow motion has next to none.
LAB_CALL const float* lab_ringing();

/// Limits of `method`, which is not BDF2, for the cloth as it was laid out, whatever its pose now;
/// h, s, is the step that the window of alpha is about.
LAB_CALL const LabLimits* lab_analyse(int method, double h);
/// The cause of the last analysis, as one sentence.
LAB_CALL const char* lab_cause();
/// Largest |multiplier| of the limiting mode last analysed, at step h, s.
LAB_CALL double lab_growth(int method, double h);

/// Times symplectic and implicit Euler, and graph inertia where few springs hold the step down, on
/// this machine, for frames of 1/60 s and `seconds` each.
/// @returns one sentence; lab_plan(i) for i < lab_plan_count() has its numbers
LAB_CALL const char* lab_recommend(double seconds);
LAB_CALL int lab_plan_count();
LAB_CALL const LabPlan* lab_plan(int i);
}
