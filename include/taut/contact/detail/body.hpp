// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>
#include <utility>

#include "../../core/concepts.hpp"
#include "../obstacle.hpp"
#include "near_pairs.hpp"

namespace taut {

/// How a body meets particles.
struct BodyOptions {
    double friction = 0;   ///< Coulomb's μ, ≥ 0
    double thickness = 0;  ///< kept between particles and the surface, m, ≥ 0
    double push_out = 1;   ///< how fast what begins inside is pushed out, m/s, > 0
};

namespace contact_detail {

/// A convex body.
template <class Scalar, int Dim>
class Body {
public:
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Place = Pose<Scalar, Dim>;
    using Access = PlaneAccess<Scalar, Dim>;

    Body(const BodyOptions& how, const Place& pose) : options(how), begin(pose), end(pose) {
        motion.now = motion.next = pose;
    }
    virtual ~Body() = default;

    /// In the body's frame.
    virtual Surface<Scalar, Dim> surface(const Vector& y) const = 0;
    virtual Scalar extent() const = 0;
    virtual Scalar inner() const = 0;
    /// p, m, and n in the world of `count` points, in whole registers, at a pose.
    /// @param x, normal  planes side by side
    virtual void query(const Access& x, Index count, const Place& pose, Scalar* depth,
                       const Access& normal) const = 0;

    Scalar thickness() const { return static_cast<Scalar>(options.thickness); }
    /// p, m. @param normal  in the world
    Scalar depth(const Vector& x, const Place& pose, Vector& normal) const {
        const Surface<Scalar, Dim> found = surface(pose.inside(x));
        normal = pose.rotation * found.normal;
        return thickness() - found.distance;
    }

    /// A way in a step, in the body's frame, that is not longer cannot go through the body unseen:
    /// at most a 32nd of its smallest radius is cut off, m.
    Scalar short_way() const { return (inner() + thickness()) / 2; }
    /// The same beside the body's position: what is farther away turns with it, m.
    Scalar quick() const {
        if (!detail::is_finite(short_way())) return short_way();
        const Scalar turned = (motion.turn - Place::Rotation::Identity()).norm();
        const Scalar by_turn = turned > 0 ? 2 * turned * extent() : Scalar(0);
        return (std::max)(short_way() - by_turn, Scalar(0));
    }
    /// Whether the way of a particle in the step meets the body; never of a short way.
    /// @param from, to  in the world, where the step begins and ends, m
    bool meets(const Vector& from, const Vector& to) const {
        Vector a = motion.now.inside(from), b = motion.next.inside(to);
        Scalar length = (b - a).norm();
        if (!(length > short_way())) return false;
        // The distance is convex along the way, and changes no faster than that goes.
        const auto away = [&](const Vector& y) { return surface(y).distance - thickness(); };
        Scalar at_a = away(a), at_b = away(b);
        while (at_a > 0 && at_b > 0 && at_a + at_b < length) {
            const Vector left = a + (b - a) * Scalar(0.45), right = a + (b - a) * Scalar(0.55);
            const Scalar at_left = away(left), at_right = away(right);
            if (!(at_left > 0) || !(at_right > 0)) return true;
            if (at_left < at_right) {
                b = right;
                at_b = at_right;
            } else {
                a = left;
                at_a = at_left;
            }
            if (!((b - a).norm() < length)) return false;
            length = (b - a).norm();
        }
        return !(at_a > 0) || !(at_b > 0);
    }

    /// How far a point of it goes at most between two poses, beside a way of everything, m.
    Scalar reach(const Place& from, const Place& to, const Vector& beside) const {
        const Scalar turned = (to.rotation - from.rotation).norm();
        return (to.position - from.position - beside).norm() +
               (turned > 0 ? turned * extent() : Scalar(0));
    }

    BodyOptions options;
    Place begin, end;      // of the frame
    Way<Scalar, Dim> way;  // from one to the other
    Motion<Scalar, Dim> motion;
    NearPairs<Scalar, Dim> near_pairs;
    Touching<Scalar, Dim> touching;
};

template <class Scalar, int Dim, class Obstacle>
class BodyOf final : public Body<Scalar, Dim> {
public:
    using Base = Body<Scalar, Dim>;
    using Vector = typename Base::Vector;
    using Place = typename Base::Place;
    using Access = typename Base::Access;

    BodyOf(Obstacle shape, const BodyOptions& how, const Place& pose)
        : Base(how, pose), shape_(std::move(shape)) {}

    Surface<Scalar, Dim> surface(const Vector& y) const override {
        const auto found = shape_.surface(y);
        return {found.distance, found.normal};
    }
    Scalar extent() const override {
        if constexpr (in_registers) return shape_.extent();
        return std::numeric_limits<Scalar>::infinity();
    }
    Scalar inner() const override {
        if constexpr (in_registers) return shape_.inner();
        return 0;
    }
    void query(const Access& x, Index count, const Place& pose, Scalar* depth,
               const Access& normal) const override {
        if constexpr (in_registers) {
            const Register thickness(this->thickness());
            for (Index k = 0; k < count; k += Register::width) {
                Vectors from, out;
                for (int d = 0; d < Dim; ++d) from[d] = x.row(d, k) - Register(pose.position[d]);
                from = times(pose.rotation.transpose(), from);
                const Register distance = shape_.template query<Register>(from, out);
                out = times(pose.rotation, out);
                (thickness - distance).store(depth + k);
                for (int d = 0; d < Dim; ++d) out[d].store(&normal(d, k));
            }
        } else {
            for (Index k = 0; k < count; ++k) {
                Vector out;
                depth[k] = this->depth(x.vector(k), pose, out);
                normal.set(k, out);
            }
        }
    }

private:
    using Register = step_detail::VectorRegister<Scalar>;
    using Vectors = detail::Few<Register, Dim>;

    template <class Shape>
    using query_of = decltype(std::declval<const Shape&>().template query<Register>(
        std::declval<const Vectors&>(), std::declval<Vectors&>()));
    static constexpr bool in_registers = detail::is_detected_v<query_of, Obstacle>;

    Obstacle shape_;
};

}  // namespace contact_detail
}  // namespace taut
