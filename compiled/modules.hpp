// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/integrator/implicit_euler.hpp>
#include <taut/mass_scaling/mass_scaling.hpp>
#include <taut/taut.hpp>
#include <taut/tight/tight.hpp>
#include <vector>

#include "dense.hpp"

// What the modules tight and mass_scaling do in double, of whatever system: many seconds to
// compile, and once for the programs and tests of this project, which parse this with taut.hpp.

#define TAUT_TIGHT_EIGENVALUES(KIND) KIND class DenseAnalysis<double>;

#define TAUT_TIGHT(KIND)                                                                  \
    KIND double explicit_estimate<double>(const Pencil&, double);                         \
    KIND DefinitenessProof prove<double>(Prover&, const Pencil&, const Combination&);     \
    KIND DefinitenessProof proves_positive_definite<double>(const SparseMatrix<double>&); \
    KIND class proof_detail::Factorisations<double>;                                      \
    KIND bool proof_detail::proves_symplectic<double>(const Pencil&, Prover&, double);    \
    KIND Index proof_detail::count_zero_modes<double>(const Pencil&, double);             \
    KIND StepLimit<double> max_step(const Stability<double>&, Method, double);            \
    KIND Certificate certify(const Stability<double>&, Method, double);                   \
    KIND double spectral_radius(const Stability<double>&, Method, double);

#define TAUT_MASS_SCALING(KIND)                                          \
    KIND MatrixX<double> proof_detail::low_modes<double>(const Pencil&); \
    KIND std::vector<double> proof_detail::frequency_changes<double>(const Pencil&, const Pencil&);

namespace taut {
TAUT_TIGHT_EIGENVALUES(extern template)
TAUT_TIGHT(extern template)
TAUT_MASS_SCALING(extern template)
}  // namespace taut
