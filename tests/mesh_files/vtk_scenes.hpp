// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <taut/mesh_files/file_report.hpp>

#include "../support/scene.hpp"

namespace taut_test {

/// Of Laws::any, and of Laws::mixed by float in two dimensions.
taut::FileReport write_vtk(const std::string& path, const Scene& scene, const AnyState& state);

}  // namespace taut_test
