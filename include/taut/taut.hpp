// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// What most programs use of the core: springs, cloth, explicit steps and their limits. What else
// there is, by headers of their own and in modules: docs/modules.md.

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
