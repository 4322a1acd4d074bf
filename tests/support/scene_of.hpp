// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "scene_on.hpp"

namespace taut_test {

/// A scene that is a copy of the system.
template <class Scalar, int Dim, class... Laws_>
Scene scene_of(const taut::SpringSystem<Scalar, Dim, Laws_...>& system) {
    using System = taut::SpringSystem<Scalar, Dim, Laws_...>;
    const Laws laws = std::is_same_v<System, Plain<Scalar, Dim>>     ? Laws::hookean
                      : std::is_same_v<System, Strings<Scalar, Dim>> ? Laws::strings
                      : std::is_same_v<System, Mixed<Scalar, Dim>>   ? Laws::mixed
                                                                     : Laws::any;
    Scene scene({std::is_same_v<Scalar, float>, Dim, laws});
    dynamic_cast<SceneOn<System>&>(scene.base()).system = system;
    return scene;
}

}  // namespace taut_test
