// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/own_matrices/own_matrices.hpp>
#include <taut/taut.hpp>
#include <taut/tight/tight.hpp>

// What the tests use beyond Taut::Compiled, declared here and compiled by compiled_once.cpp and
// compiled_dense.cpp alone: bare
// matrices, factorisations and dense eigensolvers, which take a compiler 15 s.

#define TAUT_TEST_MATRICES(KIND)                                  \
    KIND class GeneralLinearSystem<float>;                        \
    KIND class GeneralLinearSystem<double>;                       \
    KIND class LinearSystem<float>;                               \
    KIND class LinearSystem<double>;                              \
    KIND class MatrixPencil<float>;                               \
    KIND class MatrixPencil<double>;                              \
    KIND Stability<float>::Stability(const LinearSystem<float>&); \
    KIND Stability<double>::Stability(const LinearSystem<double>&);

#define TAUT_TEST_TIGHT(KIND)                                                             \
    KIND class stability_detail::Factorisations<double>;                                  \
    KIND StepLimit<float> max_step(const Stability<float>&, Method, double);              \
    KIND StepLimit<double> max_step(const Stability<double>&, Method, double);            \
    KIND Certificate certify(const Stability<float>&, Method, double);                    \
    KIND Certificate certify(const Stability<double>&, Method, double);                   \
    KIND Index count_zero_modes(const Stability<float>&);                                 \
    KIND Index count_zero_modes(const Stability<double>&);                                \
    KIND DefinitenessProof proves_positive_definite<double>(const SparseMatrix<double>&); \
    KIND DefinitenessProof prove<double>(Prover&, const Pencil&, const Combination&);     \
    KIND double proved_deficit<double>(Prover&, const Pencil&, const Combination&, double);

#define TAUT_TEST_DENSE(KIND)                                              \
    KIND class DenseAnalysis<double>;                                      \
    KIND double spectral_radius(const Stability<float>&, Method, double);  \
    KIND double spectral_radius(const Stability<double>&, Method, double); \
    KIND double explicit_estimate<double>(const Pencil&, double);

namespace taut {
TAUT_TEST_MATRICES(extern template)
TAUT_TEST_TIGHT(extern template)
TAUT_TEST_DENSE(extern template)
}  // namespace taut
