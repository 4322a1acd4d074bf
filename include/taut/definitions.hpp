// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// What Taut::Compiled defines for float and double, and its users do not see: for a program of
// theirs with another scalar, long double say. Without Taut::Compiled there is nothing to include.

#include "integrator/sweep/law_plan-inl.hpp"
#include "integrator/sweep/planner-inl.hpp"
#include "integrator/sweep/spring_table-inl.hpp"
#include "integrator/sweep/steps-inl.hpp"
#include "stability/stability-inl.hpp"
