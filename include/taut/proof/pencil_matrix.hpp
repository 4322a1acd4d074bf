// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "pencil.hpp"

// A Pencil as a sparse matrix, and what the rounding of that comes to: Pencil::assemble,
// assemble_least and assembly_error, for who calls them.

#if !defined(TAUT_COMPILED)
#include "pencil_matrix-inl.hpp"
#endif
