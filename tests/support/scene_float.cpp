// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "scene_on.hpp"

namespace taut_test {

template class SceneOn<taut::SpringSystem<float, 1>>;
template class SceneOn<taut::SpringSystem<float, 2>>;
template class SceneOn<taut::SpringSystem<float, 3>>;

}  // namespace taut_test
