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
#include "network/state_view.hpp"
#include "scene/cloth.hpp"
#include "proof/any_pose.hpp"
#include "proof/energy_limit.hpp"
#include "proof/rayleigh.hpp"
#include "proof/stability.hpp"

#if defined(TAUT_COMPILED)
#include "compiled.hpp"
#endif
