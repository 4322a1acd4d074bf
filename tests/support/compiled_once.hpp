// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/own_matrices/own_matrices.hpp>

#include "../../compiled/modules.hpp"

// What the tests use beyond Taut::Compiled and the modules that the programs share: bare matrices,
// and float. It would take a compiler half a minute in every test.

#define TAUT_TEST_ONCE(KIND)                                                 \
    KIND class GeneralLinearSystem<float>;                                   \
    KIND class GeneralLinearSystem<double>;                                  \
    KIND class LinearSystem<float>;                                          \
    KIND class LinearSystem<double>;                                         \
    KIND class MatrixPencil<float>;                                          \
    KIND class MatrixPencil<double>;                                         \
    KIND Stability<float>::Stability(const LinearSystem<float>&);            \
    KIND Stability<double>::Stability(const LinearSystem<double>&);          \
    KIND StepLimit<float> max_step(const Stability<float>&, Method, double); \
    KIND Certificate certify(const Stability<float>&, Method, double);       \
    KIND Index count_zero_modes(const Stability<float>&);                    \
    KIND Index count_zero_modes(const Stability<double>&);                   \
    KIND double spectral_radius(const Stability<float>&, Method, double);    \
    KIND double proved_deficit<double>(Prover&, const Pencil&, const Combination&, double);

namespace taut {
TAUT_TEST_ONCE(extern template)
}  // namespace taut
