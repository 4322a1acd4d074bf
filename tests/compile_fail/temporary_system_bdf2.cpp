// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: deleted

#include <taut/bdf2/bdf2.hpp>
#include <taut/scene/cloth.hpp>

void step() { taut::Bdf2 stepper(taut::hanging_cloth<double>({4, 4})); }
