// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <taut/taut.hpp>

// X11's macros, as a program sees them that includes Xlib.h behind.
#define Status int
#define Success 0

int particles();

int main() { return particles() == 16 && taut::hanging_cloth<double>({4, 4}).size() == 16 ? 0 : 1; }
