// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// One that only asks for a limit.

#include <taut/taut.hpp>

int main() {
    taut::SpringSystem<float, 3> cloth = taut::hanging_cloth<float>({32, 32});
    return taut::any_pose_limit(cloth).certified > 0 ? 0 : 1;
}
