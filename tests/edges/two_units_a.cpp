// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <taut/taut.hpp>

int particles();

int main() { return particles() == 16 && taut::hanging_cloth<double>({4, 4}).size() == 16 ? 0 : 1; }
