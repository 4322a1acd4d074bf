// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "scene_on.hpp"

namespace taut_test {

template class SceneOn<Strings<double, 2>>;
template class SceneOn<Strings<double, 3>>;
template class SceneOn<Mixed<double, 2>>;
template class SceneOn<Mixed<double, 3>>;

}  // namespace taut_test
