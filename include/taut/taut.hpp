// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// Everything that needs Eigen alone. Opt-in headers: solver/cholmod.hpp, solver/umfpack.hpp,
// solver/cholmod_simplicial.hpp; solver/modal_analysis.hpp, which needs Spectra.

#include "core/version.hpp"
#include "integrator/adaptive.hpp"
#include "integrator/bdf2.hpp"
#include "integrator/explicit_euler.hpp"
#include "integrator/explicit_options.hpp"
#include "integrator/graph_contacts.hpp"
#include "integrator/graph_inertia.hpp"
#include "integrator/guarded.hpp"
#include "integrator/implicit_euler.hpp"
#include "integrator/modal_dynamics.hpp"
#include "integrator/projective_dynamics.hpp"
#include "integrator/symplectic_euler.hpp"
#include "integrator/velocity_verlet.hpp"
#include "io/obj.hpp"
#include "io/pc2.hpp"
#include "io/ply.hpp"
#include "io/vtk.hpp"
#include "model/buckling.hpp"
#include "model/energy_guarantee.hpp"
#include "model/particle_constraints.hpp"
#include "model/state_view.hpp"
#include "model/tension_only.hpp"
#include "scene/chain.hpp"
#include "scene/cloth.hpp"
#include "scene/coarsen.hpp"
#include "scene/contact.hpp"
#include "scene/mesh.hpp"
#include "scene/obstacle.hpp"
#include "scene/weld.hpp"
#include "scene/with_law.hpp"
#include "solver/conjugate_gradient.hpp"
#include "solver/interleaved_llt.hpp"
#include "solver/static_equilibrium.hpp"
#include "stability/any_pose.hpp"
#include "stability/energy_limit.hpp"
#include "stability/graph_inertia_limit.hpp"
#include "stability/inertia_price.hpp"
#include "stability/mass_scaling.hpp"
#include "stability/rayleigh_design.hpp"
#include "stability/stability.hpp"
#include "tradeoff/measure.hpp"
#include "tradeoff/recommend.hpp"
#include "tradeoff/resolve.hpp"

#if defined(TAUT_COMPILED)
#include "compiled.hpp"
#endif
