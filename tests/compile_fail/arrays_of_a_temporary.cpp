// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::SpringArrays: a container without a name may be gone before it is read

#include <taut/arrays/arrays.hpp>
#include <vector>

void judge(taut::SpringArrays<float>& arrays) { arrays.inverse_mass = std::vector<float>(9, 2.0f); }
