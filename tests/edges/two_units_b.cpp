// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <taut/taut.hpp>

int particles() { return static_cast<int>(taut::hanging_cloth<double>({4, 4}).size()); }
