// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Random scenes and matrices against the referee of bench/soundness. Prints the seed of each claim
// that is false.
//
// Usage: soundness --seconds 60 [--seed 1] [--springs | --linear]; or --count 1000

#include "../bench/soundness/search.hpp"

int main(int argc, char** argv) { return soundness::search_main(argc, argv); }
