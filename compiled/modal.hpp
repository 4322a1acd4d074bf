// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/modal/modal_analysis.hpp>

// As modules.hpp, of the module modal, which needs Spectra.

#define TAUT_MODAL(KIND)                                                                   \
    KIND Report solver_detail::lowest_modes<double>(const SparseMatrix<double>&, Index,    \
                                                    const ModalOptions&, VectorX<double>&, \
                                                    MatrixX<double>&);

namespace taut {
TAUT_MODAL(extern template)
}  // namespace taut
