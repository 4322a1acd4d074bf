// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::SpringArrays: a pointer needs its stride in bytes

#include <taut/arrays/arrays.hpp>

struct Body {
    float x, y, z, inverse_mass;
};

void judge(const Body* bodies, taut::SpringArrays<float>& arrays) {
    arrays.inverse_mass = &bodies[0].inverse_mass;
}
