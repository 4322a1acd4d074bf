// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/scene/cloth.hpp>

#include "scene.hpp"

namespace taut_test {

/// hanging_cloth(), with springs of a law.
Scene cloth_scene(const Kind& kind, const taut::ClothOptions& options, LawOf law = LawOf::hookean);

}  // namespace taut_test
