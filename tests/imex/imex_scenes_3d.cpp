// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "imex_on.hpp"

namespace taut_test {

std::unique_ptr<AnyImex> imex_in_3d(const Scene& scene, const taut::ImexOptions& options) {
    std::unique_ptr<AnyImex> made;
    visit_system<Mixed<double, 3>, Strings<float, 3>>(scene, [&](const auto& system) {
        made = std::make_unique<ImexOn<std::decay_t<decltype(system)>>>(system, options);
    });
    return made;
}

}  // namespace taut_test
