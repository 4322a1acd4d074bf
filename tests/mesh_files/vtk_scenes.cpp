// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "vtk_scenes.hpp"

#include <taut/mesh_files/vtk.hpp>

#include "../support/scene_on.hpp"

namespace taut_test {

taut::FileReport write_vtk(const std::string& path, const Scene& scene, const AnyState& state) {
    taut::FileReport report;
    visit_system<AnyLaw<double, 1>, AnyLaw<double, 2>, AnyLaw<double, 3>, AnyLaw<float, 3>,
                 Mixed<float, 2>>(scene, [&](const auto& system) {
        using State = typename std::decay_t<decltype(system)>::State;
        report = taut::write_vtk(path, system, from_any<State>(state));
    });
    return report;
}

}  // namespace taut_test
