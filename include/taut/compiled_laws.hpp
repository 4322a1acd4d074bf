// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "compiled.hpp"
#include "network/buckling.hpp"
#include "network/tension_only.hpp"

// What the library Taut::Compiled holds of springs by TensionOnly, and by Hookean with Buckling: as
// compiled.hpp, for who includes one of these laws.

#define TAUT_COMPILED_OTHER_LAWS(KIND, SCALAR)           \
    KIND struct SpringSet<SCALAR, TensionOnly>;          \
    KIND struct SpringSet<SCALAR, Buckling>;             \
    namespace step_detail {                              \
    TAUT_COMPILED_LAW(KIND, SCALAR, 2, TensionOnly)      \
    TAUT_COMPILED_LAW(KIND, SCALAR, 3, TensionOnly)      \
    TAUT_COMPILED_PUSHING_LAW(KIND, SCALAR, 2, Buckling) \
    TAUT_COMPILED_PUSHING_LAW(KIND, SCALAR, 3, Buckling) \
    }

#define TAUT_COMPILED_OTHER_SYSTEMS(KIND, SCALAR, DIM)                \
    TAUT_COMPILED_SYSTEM(KIND, SCALAR, DIM, SCALAR, DIM, TensionOnly) \
    TAUT_COMPILED_SYSTEM(KIND, SCALAR, DIM, SCALAR, DIM, Hookean, Buckling)

namespace taut {
#if defined(TAUT_COMPILED)
TAUT_COMPILED_OTHER_LAWS(extern template, float)
TAUT_COMPILED_OTHER_LAWS(extern template, double)
TAUT_COMPILED_OTHER_SYSTEMS(extern template, float, 2)
TAUT_COMPILED_OTHER_SYSTEMS(extern template, float, 3)
TAUT_COMPILED_OTHER_SYSTEMS(extern template, double, 2)
TAUT_COMPILED_OTHER_SYSTEMS(extern template, double, 3)
#endif
}  // namespace taut
