// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Compiled without exceptions, with TAUT_USER_CONFIG: what Taut has to say reaches the engine's own
// handlers, and nothing is written or aborted behind their back.

#include <taut/network/spring_system.hpp>

#include <csetjmp>
#include <cstring>

namespace {

std::jmp_buf way_out;
char heard[256];
int broken = 0;

}  // namespace

void engine_assert(bool holds, const char*) { broken += holds ? 0 : 1; }
void engine_fail(const char* message) {
    std::strncpy(heard, message, sizeof heard - 1);
    std::longjmp(way_out, 1);
}

int main() {
    TAUT_ASSERT(1 + 1 == 2, "holds");
    if (broken != 0) return 1;
    TAUT_ASSERT(1 + 1 == 3, "does not hold");
    if (broken != 1) return 2;

    static taut::SpringSystem<float, 3> system;  // outlives the jump
    if (setjmp(way_out) == 0) {
        system.add_particle({0, 0, 0}, -1);
        return 3;  // wrong input was taken
    }
    return std::strstr(heard, "the mass of particle 0 is -1") != nullptr ? 0 : 4;
}
