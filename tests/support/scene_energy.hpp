// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "referee.hpp"
#include "scene.hpp"

// Violent scenes, an exact account of their energy, and the energy-stable step [T42] written from
// the theory's formula, all in long double. Points are Dim × n.

namespace taut_test {

/// As the scene's scalar holds them.
Eigen::MatrixXd rounded(const Scene& scene, const Eigen::MatrixXd& points);
AnyState rounded(const Scene& scene, const AnyState& state);

/// Networks with masses and stiffnesses over `decades`, pins, springs of no rest length and
/// particles on one another.
/// @param dampers  whether every other spring has a damper, up to that of a stiff oscillator
Scene random_network(Random& random, const Kind& kind, double decades, bool dampers = false);

/// A crumpled pose thrown violently; some particles on one another, and pins at rest.
AnyState thrown(Random& random, const Scene& scene);

/// H, J.
Real total_energy(const Scene& scene, const AnyState& state);

/// What rounding may add to the energy in a step from `state`, J: of positions, by the forces
/// there, and of velocities.
double rounding(const Scene& scene, const AnyState& state, double h);

/// φ of the nonlinear implicit step of h from `start` that ends in `end`, kg·m²: dampers at the
/// start, gravity without a force from outside.
Real step_objective(const Scene& scene, const AnyState& start, const AnyState& end, double h);

/// M(v⁺ − v) − h(f(x⁺) − D(x)v⁺) of the free degrees of freedom, N·s: 0 after a step of nonlinear
/// implicit Euler.
Eigen::VectorXd open_impulse(const Scene& scene, const AnyState& before, const AnyState& after,
                             double h);

/// How many of `steps` raise the energy by more than rounding; all if one fails.
int rises(const Scene& scene, AnyStepper& stepper, AnyState state, double h, int steps);

/// One step as the theory writes it.
struct StepAhead {
    RealMatrix x, v;     ///< after the step
    RealMatrix springs;  ///< forces of springs and their damping on all particles, N
    RealVector noise;    ///< what rounding errors of the force on each are relative to, N
    Real size = 0;       ///< what rounding errors of the energy are relative to, J

    /// @param F  outside forces, N
    StepAhead(const Scene& scene, const AnyState& state, Real h, const RealMatrix& F);
};

/// The books of one step that the library took.
struct Books {
    Real gain = 0;     ///< of energy, beyond the work of forces and pins, J
    Real slack = 0;    ///< what rounding may make of it, J
    Real kinetic = 0;  ///< ½ΔᵀMΔ, J

    bool rises() const { return gain > slack; }
};

/// h Σ v·F of the free particles' new velocities, less what the springs do to pins, J.
Real work_of_step(const Scene& scene, const AnyState& after, Real h, const RealMatrix& springs,
                  const RealMatrix& F);

/// Takes a step and keeps the books: by the forces written out above. The state and h are rounded
/// to the scene's scalar first.
Books book_step(AnyStepper& stepper, const Scene& scene, AnyState& state, double h,
                const RealMatrix& F);

/// What may stand beside a line of springs.
enum class Beside { nothing, dampers, rayleigh, drag, forces, pins };
constexpr Beside everything[] = {Beside::nothing, Beside::dampers, Beside::rayleigh,
                                 Beside::drag,    Beside::forces,  Beside::pins};

/// Particles 1 m apart, springs of rest length 1 m between neighbours.
/// @param draw  a spring's law and parameters
/// @param most  of dampers, N·s/m, and of drag, 1/s: drawn from here down to a half or less
Scene line(Random& random, const Kind& kind, Index particles,
           const std::function<AnySpring()>& draw, Beside beside, double least, double most);

struct Climb {
    Real best = -std::numeric_limits<Real>::infinity();  ///< gain beyond slack, of ½ΔᵀMΔ
    bool rises = false;                                  ///< whether a step did; none after it
};

/// Hill climbing on the state near the initial one, and if `forced` on constant forces, for the
/// step that gains the most.
/// @param take  takes a step of h from the state given, under the forces given
Climb climb(Random& random, Scene& scene, double h, bool forced, int tries,
            const std::function<Books(AnyState&, const RealMatrix&)>& take);

}  // namespace taut_test
