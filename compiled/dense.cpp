// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "dense.hpp"

TAUT_DENSE(template)
