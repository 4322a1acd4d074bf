// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The positions after a hundred steps of each method, one coordinate a line: what
// check_same.mjs compares the WebAssembly with.

#include <cstdio>

#include "lab.hpp"

int main() {
    for (int method = 0; method < 6; ++method) {
        lab_start(16, 1000, 0.3, 2e-4, 0.5);
        if (lab_step(method, 2e-4, 100) != 0) return 1;
        const double* x = lab_positions();
        for (int i = 0; i < 3 * lab_size(); ++i) std::printf("%.17g\n", x[i]);
    }
}
