// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "scene_on.hpp"

namespace taut_test {

template class SceneOn<Strings<float, 2>>;
template class SceneOn<Strings<float, 3>>;
template class SceneOn<Mixed<float, 2>>;
template class SceneOn<Mixed<float, 3>>;

}  // namespace taut_test
