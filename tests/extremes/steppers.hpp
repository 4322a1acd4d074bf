// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../support/scene.hpp"

namespace taut_test {

/// Of plain scenes in two dimensions.
std::unique_ptr<AnyStepper> bdf2(const Scene& scene);
std::unique_ptr<AnyStepper> projective_dynamics(const Scene& scene);

}  // namespace taut_test
