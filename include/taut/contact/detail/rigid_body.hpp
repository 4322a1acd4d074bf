// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>
#include <utility>

#include "../../core/concepts.hpp"
#include "../obstacle.hpp"
#include "push.hpp"

namespace taut::contact_detail {

/// A body that is carried rigidly.
template <class Scalar, int Dim>
class RigidBody : public Body<Scalar, Dim> {
public:
    using Base = Body<Scalar, Dim>;
    using typename Base::Access;
    using typename Base::Place;
    using typename Base::Vector;

    RigidBody(const BodyOptions& how, bool is_convex, const Place& pose)
        : Base(how, is_convex), begin(pose), end(pose) {
        motion.now = motion.next = pose;
    }

    /// In the body's frame.
    virtual Surface<Scalar, Dim> surface(const Vector& y) const = 0;
    virtual Scalar extent() const = 0;
    virtual Scalar inner() const = 0;

    Scalar thickness() const { return static_cast<Scalar>(this->options.thickness); }
    Scalar depth(const Vector& x, const Place& pose, Vector& normal) const {
        const Surface<Scalar, Dim> found = surface(pose.inside(x));
        normal = pose.rotation * found.normal;
        return thickness() - found.distance;
    }
    Scalar depth(int, const Vector& x, bool at_end, Vector& normal) const final {
        return depth(x, at_end ? motion.next : motion.now, normal);
    }
    double energy(const Penalty<Scalar>& penalty, Scalar push_time, Index, const Vector& x,
                  Scalar mass, bool at_end) const final {
        Vector normal;
        return penalty.energy(depth(x, at_end ? end : begin, normal), this->cap(push_time), mass);
    }
    Vector carry(int, const Vector& x, Vector& normal, bool back) const final {
        if (back) return motion.now(motion.next.inside(x));
        normal = motion.turn * normal;
        return motion.turn * x + motion.shift;
    }
    bool meets(int, const Vector& from, const Vector& to) const final {
        Vector a = motion.now.inside(from), b = motion.next.inside(to);
        Scalar length = (b - a).norm();
        if (!(length > short_way())) return false;
        // The distance changes no faster than the way goes.
        const auto away = [&](const Vector& y) { return surface(y).distance - thickness(); };
        if (!this->convex) {
            for (Scalar gone = 0; gone < 1;) {
                const Surface<Scalar, Dim> found = surface(a + gone * (b - a));
                const Scalar room = (found.distance - thickness()) / length;
                const Scalar inwards = -found.normal.dot(b - a) / length;
                const bool steep = inwards > Scalar(0.05);
                // A thin wall is not stepped over where the way goes into it.
                // What begins on the surface may leave it.
                const bool leaves = gone == 0 && room == 0 && !steep;
                if ((!(room > 0) && !leaves) ||
                    (steep && room < Scalar(0.001) && room < (1 - gone) * inwards)) {
                    return true;
                }
                gone += (std::max)(room, steep ? Scalar(0.001) : Scalar(0.004));
            }
            return !(away(b) > 0);
        }
        // And is convex along it. What begins on the surface may leave it.
        Scalar at_a = away(a), at_b = away(b);
        while (at_a >= 0 && at_b > 0 && at_a + at_b < length) {
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
        return !(at_a >= 0) || !(at_b > 0);
    }
    Scalar quick() const final {
        const Scalar turned = (motion.turn - Place::Rotation::Identity()).norm();
        const Scalar by_turn = turned > 0 ? 2 * turned * extent() : Scalar(0);
        return (std::max)(short_way() - by_turn, Scalar(0));
    }
    Vector gone() const final { return motion.next.position - motion.now.position; }
    void push(const Penalty<Scalar>& penalty) final {
        using Register = step_detail::VectorRegister<Scalar>;
        using Vectors = detail::Few<Register, Dim>;
        contact_detail::push<Scalar, Dim>(
            *this,
            [this](Index, Vectors& x, Vectors& n) {
                n = times(motion.turn, n);
                x = times(motion.turn, x);
                for (int d = 0; d < Dim; ++d) x[d] = x[d] + Register(motion.shift[d]);
            },
            penalty);
    }

    Vector start(Scalar) final {
        motion.go_to(begin);
        way_ = {begin, end};
        return end.position - begin.position;
    }
    void go_to(Scalar share) final { motion.go_to(way_(share)); }
    void swap() final { std::swap(motion.now, motion.next); }
    void settle() final { begin = end; }
    void list() final { listed_ = motion.next; }
    Scalar reach(const Vector& beside) const final { return reach(listed_, motion.next, beside); }
    Scalar frame_reach(const Vector& beside) const final { return reach(begin, end, beside); }

    Place begin, end;  // of the frame
    Motion<Scalar, Dim> motion;

private:
    /// A way in a step, in the body's frame, that is not longer cannot go through the body unseen:
    /// at most a 32nd of its smallest radius is cut off, m.
    Scalar short_way() const { return (inner() + thickness()) / 2; }
    Scalar reach(const Place& from, const Place& to, const Vector& beside) const {
        const Scalar turned = (to.rotation - from.rotation).norm();
        return (to.position - from.position - beside).norm() +
               (turned > 0 ? turned * extent() : Scalar(0));
    }

    Way<Scalar, Dim> way_;  // from begin to end
    Place listed_;
};

template <class Scalar, int Dim, class Obstacle>
class BodyOf final : public RigidBody<Scalar, Dim> {
public:
    using Base = RigidBody<Scalar, Dim>;
    using Vector = typename Base::Vector;
    using Place = typename Base::Place;
    using Access = typename Base::Access;

    BodyOf(Obstacle shape, const BodyOptions& how, const Place& pose)
        : Base(how, detail::is_convex<Obstacle>(), pose), shape_(std::move(shape)) {}

    Surface<Scalar, Dim> surface(const Vector& y) const override {
        const auto found = [&] {
            if constexpr (detail::is_detected_v<hinted_of, Obstacle>) {
                return shape_.surface(y, hint_);
            } else {
                return shape_.surface(y);
            }
        }();
        return {found.distance, found.normal};
    }
    Scalar extent() const override {
        if constexpr (detail::is_detected_v<extent_of, Obstacle>) return shape_.extent();
        return std::numeric_limits<Scalar>::infinity();
    }
    Scalar inner() const override {
        if constexpr (detail::is_detected_v<inner_of, Obstacle>) return shape_.inner();
        return 0;
    }
    void query(const int*, const Access& x, Index count, Scalar* depth,
               const Access& normal) const override {
        const Place& pose = this->motion.next;
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
                const Vector y = pose.inside(x.vector(k));
                const Surface<Scalar, Dim> found = surface(y);
                TAUT_ASSERT(!this->convex || supports(y, found),
                            "surface() is not of a convex body: say static constexpr bool convex "
                            "= false in its class");
                depth[k] = this->thickness() - found.distance;
                normal.set(k, pose.rotation * found.normal);
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
    template <class Shape>
    using hinted_of = decltype(std::declval<const Shape&>().surface(std::declval<const Vector&>(),
                                                                    std::declval<int&>()));
    template <class Shape>
    using extent_of = detail::number_of<decltype(std::declval<const Shape&>().extent()), Scalar>;
    template <class Shape>
    using inner_of = detail::number_of<decltype(std::declval<const Shape&>().inner()), Scalar>;

    /// Whether this query and the last one are of a convex function, as the distance from a convex
    /// body is.
    bool supports(const Vector& y, const Surface<Scalar, Dim>& found) const {
        const Vector way = y - std::exchange(last_y_, y);
        const Surface<Scalar, Dim> last = std::exchange(last_, found);
        if (last.normal.isZero(0)) return true;
        const Scalar rise = found.distance - last.distance;
        const Scalar allowed =
            Scalar(1e-3) * way.norm() + 64 * std::numeric_limits<Scalar>::epsilon() *
                                            (y.norm() + way.norm() + (std::abs)(found.distance));
        return !(last.normal.dot(way) - rise > allowed) &&
               !(rise - found.normal.dot(way) > allowed);
    }

    Obstacle shape_;
    mutable int hint_ = 0;
    mutable Vector last_y_ = Vector::Zero();
    mutable Surface<Scalar, Dim> last_{0, Vector::Zero()};
};

}  // namespace taut::contact_detail
