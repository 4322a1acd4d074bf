// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "modules.hpp"

namespace taut {
TAUT_TIGHT_EIGENVALUES(template)
}  // namespace taut
