// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <type_traits>
#include <vector>

#include "../core/types.hpp"
#include "../conditions/method.hpp"
#include "../network/damping.hpp"
#include "../proof/pencil.hpp"
#include "array_view.hpp"

// Limits of a scene that a program keeps in arrays of its own: no SpringSystem is built.

namespace taut {

/// Particles and springs as they lie in a program's memory, which is read during the call only.
///
/// A field takes a container of numbers, row after row; a pointer to its first number with a stride
/// in bytes, `{&body[0].x, sizeof(Body)}`; or one number for all rows.
/// @tparam Scalar  float, double or long double   @tparam Dim  1, 2 or 3
/// @tparam Int  of the particles' indices
template <class Scalar_, int Dim_ = 3, class Int = int>
struct SpringArrays {
    static_assert(std::is_floating_point_v<Scalar_>,
                  "taut::SpringArrays<Scalar, Dim>: Scalar must be float, double or long double");
    static_assert(Dim_ >= 1 && Dim_ <= 3, "taut::SpringArrays<Scalar, Dim>: Dim must be 1, 2 or 3");
    static_assert(std::is_integral_v<Int>, "taut::SpringArrays: Int must be an integer");
    using Scalar = Scalar_;
    static constexpr int Dim = Dim_;

    Index particles = 0;
    Index springs = 0;

    // A particle's. Give its mass or the inverse of it.
    ArrayView<Scalar, 1> mass;             ///< kg, finite and > 0 but for pinned particles
    ArrayView<Scalar, 1> inverse_mass;     ///< 1/kg, 0: pinned
    ArrayView<Scalar, Dim> position = {};  ///< m, Dim in a row; without, no pose is judged

    ArrayView<Int, 1> pinned;  ///< indices of particles, `pins` of them
    Index pins = 0;

    // A spring's. The limit at any pose needs no rest length; 0 is safe for symplectic Euler.
    ArrayView<Int, 2> ends;            ///< two particles in a row
    ArrayView<Scalar, 1> stiffness;    ///< N/m, ≥ 0
    ArrayView<Scalar, 1> rest_length;  ///< m, ≥ 0
    ArrayView<Scalar, 1> damping;      ///< N·s/m, ≥ 0, on the relative velocity along the spring
    ArrayView<Scalar, 1> whole_damping;  ///< N·s/m, ≥ 0, on the whole relative velocity

    /// Drag, 1/s, and stiffness-proportional damping, s.
    RayleighDamping rayleigh;
    /// What each step of symplectic Euler or position Verlet multiplies the velocity by, 0 … 1:
    /// x⁺ = x + f·(x − x⁻) + h²a, a drag of (1 − f)/h. It belongs to h: with n substeps in place of
    /// one step the same drag is f^(1/n), and the answer for that is another.
    Scalar velocity_factor = 1;
};

/// What check_step shall answer.
struct StepCheckOptions {
    double frame = 0;      ///< s, cut into substeps; 0: the step itself
    double safety = 0.95;  ///< of the certified step, in (0, 1]
    Index to_blame = 3;    ///< springs named; 0 saves the search
};

/// Whether a step is safe, and what to do.
template <class Scalar>
struct StepAnswer {
    bool safe = false;        ///< the step is at most safety·limit.certified
    Index substeps = 0;       ///< as few equal steps of the frame as are safe; 0: none are
    StepLimit<Scalar> limit;  ///< by bounds alone: `refuted` is not looked for
    /// Springs that hold most of the vibration that sets the limit, the first one most: of its
    /// elastic energy, or of what damping takes from it where that is the cause.
    std::vector<SpringShare> to_blame;
};

/// At any pose, and at that of the positions.
template <class Scalar>
struct StepCheck : StepAnswer<Scalar> {
    /// Nothing without positions, and for energy-stable Euler, which is proved at any pose.
    std::optional<StepAnswer<Scalar>> at_pose;
};

/// Judges step h, s, of a program's own springs, which are Hookean: as any_pose_limit(system,
/// method) does, at any pose, and as Stability does where there are positions. For explicit Euler
/// the latter is all: nothing of it is proved at every pose.
/// A spring that only pulls may be given as well. While it stays taut or slack the answer holds for
/// it; where it turns from one to the other, small vibrations may grow at a step that is safe here.
/// With energy_stable_euler the answer holds for such springs, too [T42].
///
/// Fails by name when a number is out of its range, a container too short, an index that of no
/// particle, a spring joins a particle to itself, or velocity_factor is not 1 with another method.
/// Cost: O(springs) for each of a few passes [T26], and a Lanczos iteration for the springs named.
template <class Scalar, int Dim, class Int>
StepCheck<Scalar> check_step(const SpringArrays<Scalar, Dim, Int>& arrays, Method method, double h,
                             const StepCheckOptions& options = {});

}  // namespace taut

#include "detail/check_step.ipp"
