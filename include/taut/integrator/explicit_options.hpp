// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

namespace taut {

/// Of the explicit steppers.
struct ExplicitOptions {
    /// For the springs of a SpringSystem, with OpenMP (-fopenmp) only. The result has the same bits
    /// for any number; scenes below some thousands of particles are stepped by one.
    int threads = 1;
};

}  // namespace taut
