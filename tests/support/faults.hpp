// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cfenv>

namespace taut_test {

/// The flags of what is invalid, a division by zero or an overflow, if a call raises them: with
/// traps on (tests/edges/traps.cpp), it would end the program.
template <class Call>
int faults_of(const Call& call) {
    std::feclearexcept(FE_ALL_EXCEPT);
    call();
#if defined(FE_INVALID) && defined(FE_DIVBYZERO) && defined(FE_OVERFLOW)
    return std::fetestexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
#else
    return 0;  // WebAssembly has no flags
#endif
}

}  // namespace taut_test
