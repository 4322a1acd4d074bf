// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once
// Needs the module contact.

#include "convex_hull.hpp"
#include "solid_mesh.hpp"
