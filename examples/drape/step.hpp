// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <taut/taut.hpp>

namespace drape {

/// One type for all laws: each keeps its own springs, and a scene pays for those that it has.
using Cloth = taut::SpringSystem<double, 3, taut::Hookean, taut::TensionOnly, taut::Buckling>;
using State = Cloth::State;

/// Takes `count` steps of h, s. Any stepper is one type so, and loop and guard are compiled once.
using Step = std::function<taut::Report(State& state, double h, taut::Index count)>;

/// Of implicit, newton, bdf2 or projective; the cloth must outlive it.
/// @param tolerance  of conjugate gradients
Step implicit_step(const Cloth& cloth, const std::string& integrator, const std::string& solver,
                   std::optional<double> tolerance);

}  // namespace drape
