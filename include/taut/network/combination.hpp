// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

namespace taut {

/// A sum of a scene's matrices with a factor before each, written as in the theory:
///
///     using namespace taut::matrices;
///     pencil.assemble(4 * M - 2 * h * D - h * h * K_plus);
///
/// D holds K⁺ in its Rayleigh part, whichever of K and K⁺ stands beside it [T28].
class Combination {
public:
    /// M alone.
    static constexpr Combination of_mass() { return {1, 0, 0, 0}; }
    /// D alone.
    static constexpr Combination of_damping() { return {0, 1, 0, 0}; }
    /// K alone.
    static constexpr Combination of_stiffness() { return {0, 0, 1, 0}; }
    /// K⁺ alone.
    static constexpr Combination of_projected() { return {0, 0, 0, 1}; }

    /// The factor of M.
    constexpr double mass() const { return mass_; }
    /// The factor of D.
    constexpr double damping() const { return damping_; }
    /// The factor of K.
    constexpr double stiffness() const { return stiffness_; }
    /// The factor of K⁺.
    constexpr double projected() const { return projected_; }

    /// Adds two sums.
    friend constexpr Combination operator+(const Combination& a, const Combination& b) {
        return {a.mass_ + b.mass_, a.damping_ + b.damping_, a.stiffness_ + b.stiffness_,
                a.projected_ + b.projected_};
    }
    /// Subtracts a sum from another.
    friend constexpr Combination operator-(const Combination& a, const Combination& b) {
        return {a.mass_ - b.mass_, a.damping_ - b.damping_, a.stiffness_ - b.stiffness_,
                a.projected_ - b.projected_};
    }
    /// Turns the sign of every factor.
    friend constexpr Combination operator-(const Combination& a) {
        return {0 - a.mass_, 0 - a.damping_, 0 - a.stiffness_, 0 - a.projected_};
    }
    /// Multiplies every factor. What the sum leaves out stays out, whatever `factor` is.
    friend constexpr Combination operator*(double factor, const Combination& a) {
        return {times(factor, a.mass_), times(factor, a.damping_), times(factor, a.stiffness_),
                times(factor, a.projected_)};
    }

private:
    // 0 times infinity is no number.
    static constexpr double times(double factor, double a) { return a == 0 ? 0 : factor * a; }

    constexpr Combination(double mass, double damping, double stiffness, double projected)
        : mass_(mass), damping_(damping), stiffness_(stiffness), projected_(projected) {}

    double mass_;
    double damping_;
    double stiffness_;
    double projected_;
};

/// The matrices of a Combination.
namespace matrices {

/// The masses, kg.
inline constexpr Combination M = Combination::of_mass();
/// The damping matrix, N·s/m.
inline constexpr Combination D = Combination::of_damping();
/// The stiffness matrix, N/m.
inline constexpr Combination K = Combination::of_stiffness();
/// K without the negative stiffness of compressed springs, N/m [T27]; K itself for bare matrices.
inline constexpr Combination K_plus = Combination::of_projected();

}  // namespace matrices
}  // namespace taut
