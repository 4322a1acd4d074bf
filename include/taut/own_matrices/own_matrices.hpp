// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// Needs the module tight.

// Systems that are given as matrices M, D, K.

#include "linear_system.hpp"
#include "matrix_pencil.hpp"
