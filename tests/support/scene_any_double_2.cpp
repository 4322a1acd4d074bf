// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "scene_on.hpp"

TAUT_TEST_ANY_SCENE(template, double, 2)
