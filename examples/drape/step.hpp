// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <taut/guard/report.hpp>
#include <taut/taut.hpp>
#include <taut/network/buckling.hpp>
#include <taut/network/tension_only.hpp>

namespace drape {

/// One type for all laws: each keeps its own springs, and a scene pays for those that it has.
using Cloth = taut::SpringSystem<double, 3, taut::Hookean, taut::TensionOnly, taut::Buckling>;
using State = Cloth::State;

/// Takes `count` steps of h, s. Any stepper is one type so, and loop and guard are compiled once.
using Step = std::function<taut::Report(State& state, double h, taut::Index count)>;

/// Of energy_stable, symplectic, verlet or explicit; the cloth must outlive it.
Step explicit_step(const Cloth& cloth, const std::string& integrator);
/// Of implicit, newton, bdf2 or projective; the cloth must outlive it.
/// @param tolerance  of conjugate gradients
Step implicit_step(const Cloth& cloth, const std::string& integrator, const std::string& solver,
                   std::optional<double> tolerance);

/// Advances by a frame, s, with contacts where `respond` is a call.
using Guard = std::function<taut::GuardedReport<double>(
    State& state, double frame, const std::function<void(State&)>& respond)>;

/// Of a step whose method promises what `like` does; the cloth must outlive it.
Guard guarded(const Cloth& cloth, const Step& step, taut::Method like, double max_step);

}  // namespace drape
