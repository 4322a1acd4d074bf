// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../pencil.hpp"

// Explicit Euler: D − hK⁺ ≻ 0 and 4M − 2hD + h²K ≻ 0, or mode by mode where M, D and K commute.

namespace taut::stability_detail {

/// Whether the two sufficient conditions of explicit Euler hold at h by the bound [T17]:
/// D − hK⁺ ≻ 0 and 4M − 2hD + h²K ≻ 0. The second one needs the true K, since K ⪯ K⁺.
bool certifies_explicit(const Pencil& pencil, double h);

/// The limit of explicit Euler on one mode [T9], from below and from above.
struct ModeLimit {
    double lower = 0;
    double upper = infinity;
};

/// @param k, d  1/s², 1/s, each as computed. Near critical damping, d² = 4k, the limit moves by the
///              root of what their rounding moves d² − 4k by: 1e-8.
ModeLimit explicit_mode_limit(double k, double d);

/// The largest step that proved bounds k on k_max and d on the largest eigenvalue of D' certify for
/// explicit Euler, or else the bound at each step tried; 0: none.
double certified_explicit(const Pencil& pencil, double k, double d);

/// What the answer of explicit Euler is set by. @param k  a bound on k_max, 1/s²
Cause explicit_cause(const UnroundedLimit& limit, double k);

/// The certified step by bounds alone; no vector is looked for that refutes.
/// @param k, d  bounds on k_max, 1/s², and on the largest eigenvalue of D', 1/s
UnroundedLimit explicit_by_bounds(const Pencil& pencil, double k, double d);

}  // namespace taut::stability_detail

#if !defined(TAUT_COMPILED)
#include "explicit_limit-inl.hpp"
#endif
