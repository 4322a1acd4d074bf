// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../../network/state.hpp"
#include "near_pairs.hpp"

namespace taut {

/// How a body meets particles.
struct BodyOptions {
    double friction = 0;   ///< Coulomb's μ, ≥ 0
    double thickness = 0;  ///< kept between particles and the surface, m, ≥ 0
    double push_out = 1;   ///< how fast what begins inside is pushed out, m/s, > 0
};

namespace contact_detail {

/// What particles are kept out of, a rigid body, or sets that single ones are kept in. It moves in
/// a frame by the share of that which has passed; motion is from step to step.
template <class Scalar, int Dim>
class Body {
public:
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Place = Pose<Scalar, Dim>;
    using Access = PlaneAccess<Scalar, Dim>;

    Body(const BodyOptions& how, bool is_convex) : options(how), convex(is_convex) {}
    virtual ~Body() = default;

    /// p of the particle at a place, m, where a step begins, or ends. @param normal  gets n
    virtual Scalar depth(int place, const Vector& x, bool end, Vector& normal) const = 0;
    /// p, m, and n of `count` points, in whole registers, where a step ends.
    /// @param place  of the particle at each of them   @param x, normal  planes side by side
    virtual void query(const int* place, const Access& x, Index count, Scalar* depth,
                       const Access& normal) const = 0;
    /// φ of a particle at x that begins there, where a frame begins, or ends, J.
    virtual double energy(const Penalty<Scalar>& penalty, Scalar push_time, Index particle,
                          const Vector& x, Scalar mass, bool end) const = 0;
    /// Where the motion of the step carries what is at x and at rest in the body; or whence.
    /// @param normal  n, gets n′
    virtual Vector carry(int place, const Vector& x, Vector& normal, bool back) const = 0;
    /// Whether a particle meets it on its way in the step; never of a way in it that is not longer
    /// than quick().
    /// @param from, to  in the world, where the step begins and ends, m
    virtual bool meets(int place, const Vector& from, const Vector& to) const = 0;
    virtual Scalar quick() const = 0;
    /// How far it goes in the step, without turning, m.
    virtual Vector gone() const = 0;
    /// Pushes those that it alone touches.
    virtual void push(const Penalty<Scalar>& penalty) = 0;

    /// A frame is to begin so.
    virtual void open(const State<Scalar, Dim>&) {}
    /// At which place each particle is.
    virtual void know(const Buffer<int>&) {}
    /// It does, s, perhaps once more; how far it goes, without turning, m.
    virtual Vector start(Scalar frame) = 0;
    virtual void go_to(Scalar share) = 0;
    /// From the end of a step to its beginning, or the other way.
    virtual void swap() = 0;
    virtual void settle() = 0;
    /// The list is of where it now is.
    virtual void list() = 0;
    /// How far a point of it has gone at most since then, beside a way of everything, m.
    virtual Scalar reach(const Vector& beside) const = 0;
    /// The same of the whole frame.
    virtual Scalar frame_reach(const Vector& beside) const = 0;

    /// p₁ of what begins inside, m.
    Scalar cap(Scalar push_time) const { return push_time * static_cast<Scalar>(options.push_out); }

    BodyOptions options;
    bool convex;                // whether what is forbidden is: planes support it [T39]; else [T40]
    bool of_particles = false;  // whether it is for single ones
    NearPairs<Scalar, Dim> near_pairs;
    Touching<Scalar, Dim> touching;
};

}  // namespace contact_detail
}  // namespace taut
