// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "scene_on.hpp"

namespace taut_test {

template class SceneOn<AnyLaw<double, 1>>;

}  // namespace taut_test
