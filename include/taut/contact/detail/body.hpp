// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "../../core/concepts.hpp"
#include "../obstacle.hpp"
#include "motion.hpp"

namespace taut {

/// How a body meets particles.
struct BodyOptions {
    double friction = 0;   ///< Coulomb's μ, ≥ 0
    double thickness = 0;  ///< kept between particles and the surface, m, ≥ 0
    double push_out = 1;   ///< how fast what begins inside is pushed out, m/s, > 0
};

namespace contact_detail {

/// Particles near one body and no other, at the start of a step: a register of places in a row for
/// each block, some lanes of which are near. The mass of the others is 0.
template <class Scalar, int Dim>
struct SoloPairs {
    Index blocks = 0;
    Buffer<int> first;     // place of each block
    Buffer<Scalar> depth;  // p, m; < 0 of other lanes
    Buffer<Scalar> cap;    // p₁, m
    Buffer<Scalar> mass;   // kg
    detail::Few<Buffer<Scalar>, Dim> x, normal;

    /// Of lane k.
    int place(Index k) const {
        constexpr Index width = step_detail::VectorRegister<Scalar>::width;
        return first[k / width] + static_cast<int>(k % width);
    }
};

/// Blocks that are touched in a step: what they were without contact, for undo.
template <class Scalar, int Dim>
struct Hits {
    Index count = 0;
    Buffer<int> block;
    Buffer<Scalar> depth, cap, touched, work;  // the last is h ū·f, J
    detail::Few<Buffer<Scalar>, Dim> x, v;
};

/// How many pairs touch, and the deepest, m.
template <class Scalar>
struct Touching {
    Index count = 0;
    Scalar deepest = 0;

    void see(Scalar depth, Index pairs = 1) {
        if (!(depth > 0)) return;
        count += pairs;
        deepest = (std::max)(deepest, depth);
    }
};

/// The planes that contact reads and writes.
template <class Scalar, int Dim>
struct Moving {
    PlaneAccess<Scalar, Dim> x, v, spring_x;
};

/// A convex body.
template <class Scalar, int Dim>
class Body {
public:
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Place = Pose<Scalar, Dim>;

    Body(const BodyOptions& how, const Place& pose) : options(how), begin(pose), end(pose) {
        motion.now = motion.next = pose;
    }
    virtual ~Body() = default;

    /// In the body's frame.
    virtual Surface<Scalar, Dim> surface(const Vector& y) const = 0;
    virtual Scalar extent() const = 0;
    virtual Scalar inner() const = 0;
    /// The depths of registers of places, m, at a pose. @param first  the first place of each
    virtual void depths(const PlaneAccess<Scalar, Dim>& x, const Buffer<int>& first,
                        const Place& pose, Scalar* depth) const = 0;
    /// A step of solo pairs: from what is at v, x without contact to what is with it.
    virtual void step(const Penalty<Scalar>& penalty, const Moving<Scalar, Dim>& moving,
                      Touching<Scalar>& touching) = 0;

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

    /// How far a point of it goes at most in the frame, beside a way of everything, m.
    Scalar far(const Vector& beside) const {
        const Scalar turned = (end.rotation - begin.rotation).norm();
        return (end.position - begin.position - beside).norm() +
               (turned > 0 ? turned * extent() : Scalar(0));
    }

    BodyOptions options;
    Place begin, end;      // of the frame
    Way<Scalar, Dim> way;  // from one to the other
    Motion<Scalar, Dim> motion;
    SoloPairs<Scalar, Dim> solo;
    Hits<Scalar, Dim> hits;
};

template <class Scalar, int Dim, class Obstacle>
class BodyOf final : public Body<Scalar, Dim> {
public:
    using Base = Body<Scalar, Dim>;
    using Vector = typename Base::Vector;
    using Place = typename Base::Place;

    BodyOf(Obstacle shape, const BodyOptions& how, const Place& pose)
        : Base(how, pose), shape_(std::move(shape)) {}

    Surface<Scalar, Dim> surface(const Vector& y) const override { return shape_.surface(y); }
    Scalar extent() const override { return shape_.extent(); }
    Scalar inner() const override { return shape_.inner(); }
    void depths(const PlaneAccess<Scalar, Dim>& x, const Buffer<int>& first, const Place& pose,
                Scalar* depth) const override {
        for (const int place : first) {
            Vectors at, normal;
            for (int d = 0; d < Dim; ++d) at[d] = x.row(d, place);
            query(at, pose, normal).store(depth);
            depth += Register::width;
        }
    }
    void step(const Penalty<Scalar>& penalty, const Moving<Scalar, Dim>& moving,
              Touching<Scalar>& touching) override {
        SoloPairs<Scalar, Dim>& pairs = this->solo;
        const Register zero(Scalar(0)), one(Scalar(1));
        Register count = zero, deepest = zero;
        make_room();
        const Motion<Scalar, Dim>& moved = this->motion;
        const Vector gone = moved.next.position - moved.now.position;
        const Scalar turned = (moved.turn - Place::Rotation::Identity()).norm();
        const Scalar by_turn = turned > 0 ? 2 * turned * extent() : Scalar(0);
        const Scalar quick = (std::max)(this->short_way() - by_turn, Scalar(0));
        const Register quick2(quick * quick);
        for (Index block = 0; block < pairs.blocks; ++block) {
            const Index at = block * Register::width;
            const Register mass = Register::load(pairs.mass.data() + at);
            const Register before = Register::load(pairs.depth.data() + at);
            Vectors x, normal;
            Register way2 = zero;
            for (int d = 0; d < Dim; ++d) {
                x[d] = moving.x.row(d, pairs.first[block]);
                const Register went =
                    x[d] - Register(gone[d]) - Register::load(pairs.x[d].data() + at);
                way2 += went * went;
            }
            Register depth = query(x, moved.next, normal);
            depth = where_less(zero, mass, depth, -one);
            Register meets = larger(before, depth);
            if (largest_lane(way2 - quick2) > 0) look_along(pairs, at, x, meets);
            if (largest_lane(meets) > 0) {
                resolve(block, penalty, moving, before, meets, x, depth, normal);
                count += where_less(zero, depth, one, zero);
                deepest = larger(deepest, depth);
            }
            depth.store(pairs.depth.data() + at);
            for (int d = 0; d < Dim; ++d) {
                x[d].store(pairs.x[d].data() + at);
                normal[d].store(pairs.normal[d].data() + at);
            }
        }
        touching.see(largest_lane(deepest), static_cast<Index>(sum_of_lanes(count)));
    }

private:
    using Register = step_detail::VectorRegister<Scalar>;
    using Vectors = detail::Few<Register, Dim>;

    /// p, and n in the world, of a lane each.
    EIGEN_ALWAYS_INLINE Register query(const Vectors& x, const Place& pose, Vectors& normal) const {
        Vectors from;
        for (int d = 0; d < Dim; ++d) from[d] = x[d] - Register(pose.position[d]);
        const Register distance =
            shape_.template query<Register>(times(pose.rotation.transpose(), from), normal);
        normal = times(pose.rotation, normal);
        return Register(this->thickness()) - distance;
    }
    void make_room() {
        Hits<Scalar, Dim>& met = this->hits;
        const Index size = this->solo.blocks * Register::width;
        met.count = 0;
        met.block.resize(this->solo.blocks);
        for (auto* of : {&met.depth, &met.cap, &met.touched, &met.work}) of->resize(size);
        for (auto* of : {&met.x, &met.v}) {
            for (int d = 0; d < Dim; ++d) (*of)[d].resize(size);
        }
    }
    /// Those that meet the body on the way of a step, meet it.
    void look_along(const SoloPairs<Scalar, Dim>& pairs, Index at, const Vectors& x,
                    Register& meets) const {
        detail::Few<Scalar, Register::width> lanes;
        detail::Few<detail::Few<Scalar, Register::width>, Dim> to;
        meets.store(lanes.data());
        for (int d = 0; d < Dim; ++d) x[d].store(to[d].data());
        for (int k = 0; k < Register::width; ++k) {
            if (lanes[k] > 0 || !(pairs.mass[at + k] > 0)) continue;
            Vector a, b;
            for (int d = 0; d < Dim; ++d) {
                a[d] = pairs.x[d][at + k];
                b[d] = to[d][k];
            }
            if (Base::meets(a, b)) lanes[k] = 1;
        }
        meets = Register::load(lanes.data());
    }
    /// Contact of a block: x, depth and normal with it, from those without.
    /// @param meets  > 0 where it touches
    void resolve(Index block, const Penalty<Scalar>& penalty, const Moving<Scalar, Dim>& moving,
                 const Register& before, const Register& meets, Vectors& x, Register& depth,
                 Vectors& normal) {
        SoloPairs<Scalar, Dim>& pairs = this->solo;
        Hits<Scalar, Dim>& met = this->hits;
        const Motion<Scalar, Dim>& moved = this->motion;
        const Register zero(Scalar(0)), one(Scalar(1)), h(penalty.h);
        const Index at = block * Register::width, place = pairs.first[block];
        const Index kept = met.count++ * Register::width;
        met.block[kept / Register::width] = static_cast<int>(block);
        Vectors from, n, v, u, w;
        for (int d = 0; d < Dim; ++d) {
            from[d] = Register::load(pairs.x[d].data() + at);
            n[d] = Register::load(pairs.normal[d].data() + at);
            v[d] = moving.v.row(d, place);
            x[d].store(met.x[d].data() + kept);
            v[d].store(met.v[d].data() + kept);
        }
        before.store(met.depth.data() + kept);
        Register cap = Register::load(pairs.cap.data() + at);
        cap.store(met.cap.data() + kept);
        n = times(moved.turn, n);
        const Vectors carried = times(moved.turn, from);
        for (int d = 0; d < Dim; ++d) {
            u[d] = (carried[d] + Register(moved.shift[d]) - from[d]) * Register(1 / penalty.h);
            w[d] = v[d] - u[d];
        }
        const Register deep = larger(before, zero);
        const Register push = Register(penalty.by_mass) * where_less(deep, cap, deep, cap);
        const Register into = dot(w, n);
        const Register out = (into + h * push) * Register(1 / (1 + penalty.block()));
        const Register impulse = out - into;  // hλ/m
        // A pair that would pull is left out if it goes no deeper so.
        Register touches = where_less(zero, meets, one, zero);
        const Register pulls = where_less(impulse, zero, deep, zero);
        touches = where_less(zero, pulls, where_less(before, depth, touches, zero), touches);
        touches.store(met.touched.data() + kept);
        Vectors along;
        for (int d = 0; d < Dim; ++d) along[d] = w[d] - into * n[d];
        const Register by_sliding = reciprocal_sqrt(
            larger(dot(along, along), Register((std::numeric_limits<Scalar>::min)())));
        const Register keep =
            larger(zero, one - Register(static_cast<Scalar>(this->options.friction)) *
                                   larger(impulse, zero) * by_sliding);
        Register work = zero;
        for (int d = 0; d < Dim; ++d) {
            const Register after = u[d] + out * n[d] + keep * along[d];
            work += u[d] * (after - v[d]);
            x[d] = where_less(zero, touches, from[d] + h * after, x[d]);
            v[d] = where_less(zero, touches, after, v[d]);
            moving.x.set_row(d, place, x[d]);
            moving.v.set_row(d, place, v[d]);
            if (penalty.ahead > 0) {
                const Register ahead = x[d] + Register(penalty.ahead) * v[d];
                moving.spring_x.set_row(
                    d, place, where_less(zero, touches, ahead, moving.spring_x.row(d, place)));
            }
        }
        const Register mass = Register::load(pairs.mass.data() + at);
        where_less(zero, touches, mass * work, zero).store(met.work.data() + kept);
        depth = query(x, moved.next, normal);
        depth = where_less(zero, mass, depth, -one);
        where_less(zero, depth, cap, Register(std::numeric_limits<Scalar>::infinity()))
            .store(pairs.cap.data() + at);
    }

    Obstacle shape_;
};

}  // namespace contact_detail
}  // namespace taut
