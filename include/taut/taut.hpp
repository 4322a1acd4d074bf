// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// The core: springs, cloth, explicit and implicit steps, limits. All else is a module, a
// folder with a header of its name: docs/modules.md lists them.

#include "core/version.hpp"
#include "integrator/energy_stable_euler.hpp"
#include "integrator/explicit_euler.hpp"
#include "integrator/symplectic_euler.hpp"
#include "integrator/velocity_verlet.hpp"
#include "model/state_view.hpp"
#include "scene/cloth.hpp"
#include "stability/any_pose.hpp"
#include "stability/energy_limit.hpp"
#include "stability/rayleigh.hpp"
#include "stability/stability.hpp"

#if defined(TAUT_COMPILED)
#include "compiled.hpp"
#endif
