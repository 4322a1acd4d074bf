// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The headers alone, nothing called.

#include <taut/taut.hpp>
