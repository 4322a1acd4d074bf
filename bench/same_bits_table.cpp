// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What TAUT_SAME_BITS costs: steps of one program in which the library is compiled without it and
// with it. Prints Markdown; no arguments.

#include <cstdio>

#include "measure.hpp"
#include "same_bits/steps.hpp"

namespace {

template <class Scalar>
void row(int side, const char* scalar) {
    const auto plain = bench::plain_steps<Scalar>(side);
    const auto same_bits = bench::same_bits_steps<Scalar>(side);
    const int count = static_cast<int>(4e7 / plain->springs());
    bench::Turns builds(1e-6 * count * plain->springs());
    builds.run(
        11, [&] { plain->take(count); }, [&] { same_bits->take(count); });
    std::printf("| %d × %d, %s | %s |\n", side, side, scalar, builds.cells().c_str());
}

}  // namespace

int main(int argc, char**) {
    if (argc > 1) {
        std::fprintf(stderr, "same_bits_table takes no arguments\n");
        return 2;
    }
    std::printf(
        "## A step of SymplecticEuler by a build with TAUT_SAME_BITS beside one without\n\n"
        "ns a spring and step, n steps together; processor time of one thread, least of 11 turns "
        "(median).\n\n"
        "| cloth | without | with | ratio |\n|---|---|---|---|\n");
    for (const int side : {16, 32, 64, 100}) {
        row<float>(side, "float");
        row<double>(side, "double");
    }
}
