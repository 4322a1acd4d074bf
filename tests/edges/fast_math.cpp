// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Compiled with -ffast-math, and again with -Ofast: what is certified is true, by a referee that is
// compiled strictly; see fast_math_steps.cpp for the rest.

#include "limits.hpp"

#if !defined(__FAST_MATH__) && !defined(_M_FP_FAST)
#error "this unit must be compiled with fast math: the flag was lost"
#endif

void judge_steps();

int main() {
    limits::judge(160);
    judge_steps();
    return referee::failures() == 0 ? 0 : 1;
}
