// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What check_same.mjs compares the WebAssembly with, one number a line.
//   lab figure     the positions of what a figure wears, after one frame of Guarded and after 90
//   lab            the positions after a hundred steps of each method
//   lab MESH.obj   the limits of a mesh, y up, by method, and its limiting vibration; how few
//                  particles will do for a tenth of a second within 5 %, and their error

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include "lab.hpp"

namespace {

int print_positions() {
    for (int method = 0; method < 7; ++method) {
        lab_open_cloth(16);
        lab_knobs(1000, 0.3, 2e-4, 0.5);
        if (lab_step(method, 2e-4, 100) != 0) return 1;
        const double* x = lab_positions();
        for (int i = 0; i < 3 * lab_size(); ++i) std::printf("%.17g\n", x[i]);
    }
    return 0;
}

int print_figure() {
    lab_open_figure();
    lab_knobs(1000, 0.4, 2e-5, 1);
    for (const int frames : {1, 89}) {
        if (lab_step(6, 1.0 / 60, frames) != 0) return 1;
        const double* x = lab_positions();
        for (int i = 0; i < 3 * lab_size(); ++i) std::printf("%.17g\n", x[i]);
    }
    return 0;
}

int print_limits(const char* path) {
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    text.copy(lab_text(static_cast<int>(text.size())), text.size());
    if (!lab_read() || !lab_open_mesh(1, 1, 0)) {
        std::fprintf(stderr, "%s\n", lab_words());
        return 1;
    }
    lab_knobs(1000, 0.3, 1e-4, 0.4);
    lab_analyse_any_pose();
    lab_analyse_pose();
    lab_analyse_mode();
    for (const int method : {0, 1, 2, 3, 5}) {
        const LabLimits* limits = lab_limits(method);
        std::printf("%.17g\n%.17g\n%.17g\n", limits->any_pose, limits->certified, limits->refuted);
    }
    const LabMode* mode = lab_mode();
    std::printf("%.17g\n%.17g\n%.17g\n", mode->k, mode->d, mode->k_max);
    lab_resolve(0.1, 0.05);
    const int chosen = static_cast<int>(lab_resolution()->chosen);
    if (chosen < 0) {
        std::fprintf(stderr, "%s\n", lab_resolution_words());
        return 1;
    }
    std::printf("%.17g\n%.17g\n", lab_level(chosen)->particles, lab_level(chosen)->error);
    return 0;
}

}  // namespace

void lab_resolving(int, int) {}

int main(int count, char** words) {
    if (count < 2) return print_positions();
    return std::string(words[1]) == "figure" ? print_figure() : print_limits(words[1]);
}
