// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// The tables of guard_table, by their letters. Each prints Markdown and returns whether no frame
// was refused and no promise broken.

namespace guard_table {

bool ordinary();     // a: how often a frame is touched, and what is lost by it
bool attacks();      // b: whether the promise holds, and what the guard costs
bool minutes();      // c: what is left of an undamped minute
bool at_rest();      // d: a scene at rest, in float, far from the origin
bool damped();       // e: the driven scenes with damping
bool accuracy();     // f: the error beside that of the bare step
bool stiff_codes();  // g: stiff forces given as code

}  // namespace guard_table
