// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

namespace taut {

/// The integrators. Each stepper declares its own as `method`.
enum class Method {
    explicit_euler,
    symplectic_euler,
    position_verlet = symplectic_euler,  ///< x⁺ = 2x − x⁻ + h²a: the same step with v = (x − x⁻)/h
    velocity_verlet,
    implicit_euler,
    bdf2,
    energy_stable_euler,
    last = energy_stable_euler  ///< the last method above; move it when you add one, at the end
};

/// The characteristic polynomial μ² + b μ + c of one step on one mode.
struct StepQuadratic {
    double b;
    double c;
};

/// One descriptor a method, and what descriptors are made of.
namespace method {

/// In place of what a method does not have, or of what nobody has proved of it. It cannot be
/// called, and the public function that would need it refuses by the method's name.
struct Absent {};
template <class T>
inline constexpr bool is_absent_v = std::is_same_v<std::remove_cv_t<T>, Absent>;

// What holds a step down at one pose: a descriptor's `Limit`. Stability has one proof for each.

/// Explicit Euler's two conditions, D − hK ≻ 0 and 4M − 2hD + h²K ≻ 0 [T8], [T17]. Not those of
/// other explicit methods.
struct LimitedByDamping {};
/// 4M − 2hD − h²K ≻ 0 [T10], [T19].
struct LimitedByStiffness {};
/// Stable at every h where K is positive semi-definite [T20], [T21]. On springs K⁺ stands for K,
/// and K⁺ always is [T27].
struct LimitedByIndefiniteness {};

/// Which steps a moving scene may be given, linearised at each of its poses.
enum class AnyPose {
    no_step,    ///< none is certified: Guarded refuses the method, recommend() passes it over
    limited,    ///< those below any_pose_limit [T23]: symplectic Euler's, whatever `Limit` is, so
                ///< only of a method that no scene holds to a smaller step
    proved,     ///< those below energy_limit, and not linearised only [T42]
    every_step  ///< all, of an implicit method
};

}  // namespace method
}  // namespace taut
