// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "modal.hpp"

namespace taut {
TAUT_MODAL(template)
}  // namespace taut
