// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "held_once.hpp"

namespace taut {
TAUT_TEST_ALL_HELD(template)
}  // namespace taut
