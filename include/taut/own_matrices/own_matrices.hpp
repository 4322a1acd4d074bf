// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// Needs the module tight.

// Systems that are given as matrices M, D, K, and springs as such matrices.

#include "linear_system.hpp"
#include "linearize.hpp"
#include "matrix_pencil.hpp"
