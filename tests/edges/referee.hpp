// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

// What judges units that are compiled with other flags: referee.cpp, which is compiled with none of
// them and knows nothing of Taut.

namespace referee {

struct Spring {
    int a, b;
    double k, L, c;
};

/// A scene of Hookean springs, as a stepper holds it.
struct Scene {
    int dim = 1;
    std::vector<double> inverse_mass;  // 0: pinned
    std::vector<double> x;             // dim numbers a particle
    std::vector<Spring> springs;
    double d0 = 0, alpha = 0;
};

enum class Matrices { pose, projected, any_pose };  // K, K⁺, or the graph Laplacians of the springs

/// The smallest eigenvalue of M⁻¹(on_M·M + on_D·D + on_K·K), in long double.
long double smallest(const Scene& scene, Matrices which, long double on_M, long double on_D,
                     long double on_K);
/// NaN for 0, infinity for 1, −infinity for 2.
double not_finite(int which);
bool is_finite(const double* numbers, long count);
bool is_finite(const float* numbers, long count);
/// Says so, and counts it, unless all is well. @returns well
bool check(bool well, const char* what, int number = 0);
int failures();

}  // namespace referee
