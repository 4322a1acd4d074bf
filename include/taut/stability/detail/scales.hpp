// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "explicit_limit.hpp"
#include "symplectic_limit.hpp"

// What would make a step safe, by the bound alone.

namespace taut::stability_detail {

/// The step that the bound certifies by what limits the method, s.
double certified_by(method::LimitedByDamping, const Pencil& pencil);

double certified_by(method::LimitedByStiffness, const Pencil& pencil);

double certified_by(method::LimitedByIndefiniteness, const Pencil& pencil);

/// How well the two scales below are found, relative.
inline constexpr double scale_tolerance = 1e-9;

/// The step that the bound certifies after scaling, s.
double certified_when_scaled(Method method, const Pencil& pencil, double stiffness, double mass);

/// The largest factor on all stiffness that leaves step h, s, certified.
double max_stiffness_scale(Method method, const Pencil& pencil, double h);

/// The least factor on all masses that makes step h, s, certified.
double min_mass_scale(Method method, const Pencil& pencil, double h);

}  // namespace taut::stability_detail

#if !defined(TAUT_COMPILED)
#include "scales-inl.hpp"
#endif
