// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <cstdio>

#include <taut/core/version.hpp>
#include <taut/network/state.hpp>

int main() {
    const taut::State<float, 3> state{};
    std::printf("%d.%d.%d\n", TAUT_VERSION_MAJOR, TAUT_VERSION_MINOR, TAUT_VERSION_PATCH);
    return state.x.size() == 0 ? 0 : 1;
}
