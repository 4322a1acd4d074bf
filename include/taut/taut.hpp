// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// Everything that needs Eigen alone. Opt-in headers: solver/cholmod.hpp, solver/umfpack.hpp,
// solver/cholmod_simplicial.hpp.

#include "core/version.hpp"
#include "integrator/explicit_euler.hpp"
#include "integrator/implicit_euler.hpp"
#include "integrator/projective_dynamics.hpp"
#include "integrator/symplectic_euler.hpp"
#include "integrator/velocity_verlet.hpp"
#include "io/obj.hpp"
#include "scene/chain.hpp"
#include "scene/cloth.hpp"
#include "scene/mesh.hpp"
#include "solver/conjugate_gradient.hpp"
#include "solver/interleaved_llt.hpp"
#include "solver/static_equilibrium.hpp"
#include "stability/any_pose.hpp"
#include "stability/mass_scaling.hpp"
#include "stability/rayleigh_design.hpp"
#include "stability/stability.hpp"
