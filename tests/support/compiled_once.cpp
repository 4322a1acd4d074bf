// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "compiled_once.hpp"

namespace taut {
TAUT_TEST_ONCE(template)
}  // namespace taut
