// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "proof/bracket.hpp"

// What the library Taut::Compiled holds of proof/bracket.hpp: as compiled.hpp, for who includes
// that.

#define TAUT_COMPILED_PENCILS(KIND)                                                         \
    KIND RitzPair largest_ritz_pair<double>(const Pencil&, const Combination&,              \
                                            const LanczosOptions&, const Eigen::VectorXd&); \
    KIND RitzPair leading_pair<double>(const Pencil&, const Combination&, const Eigen::VectorXd&);

namespace taut {
#if defined(TAUT_COMPILED)
TAUT_COMPILED_PENCILS(extern template)
#endif
}  // namespace taut
