// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// SuiteSparse's direct solvers, for ImplicitEuler. Link Taut::SuiteSparse.

#include "cholmod.hpp"
#include "umfpack.hpp"
