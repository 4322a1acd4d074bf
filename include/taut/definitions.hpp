// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// What Taut::Compiled defines for float and double, and its users do not see: for a program of
// theirs with another scalar, long double say. Without Taut::Compiled there is nothing to include.

#include "step/law_plan-inl.hpp"
#include "step/planner-inl.hpp"
#include "step/spring_table-inl.hpp"
#include "step/steps-inl.hpp"
#include "proof/stability-inl.hpp"
