// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: Absent

#include <taut/conditions/bdf2.hpp>

taut::StepQuadratic four_multipliers() { return taut::method::Bdf2::step_quadratic(1, 0, 0.01); }
