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

/// Particles near one body and no other, at the start of a step: arrays padded by a register.
template <class Scalar, int Dim>
struct SoloPairs {
    Index count = 0;
    Buffer<int> place;
    Buffer<Scalar> depth;  // p, m
    Buffer<Scalar> cap;    // p₁, m
    Buffer<Scalar> mass;   // kg
    detail::Few<Buffer<Scalar>, Dim> x, normal;

    void resize(Index size) {
        count = size;
        const Index padded = size + step_detail::max_width;
        place.resize(padded);
        for (auto* of : {&depth, &cap, &mass}) of->resize(padded);
        for (int d = 0; d < Dim; ++d) {
            x[d].resize(padded);
            normal[d].resize(padded);
        }
    }
};

/// What a step's contacts sum up to, and what they were without it.
template <class Scalar, int Dim>
struct Tally {
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    /// A particle that was touched.
    struct Touched {
        int place;
        Vector x, v;  // without contact, m, m/s
        double work;  // h ū·f, J
    };
    /// A pair that touches at either end: its depth and cap at the start.
    struct Old {
        Scalar* depth;
        Scalar* cap;
        Scalar old_depth, old_cap;
    };

    std::vector<Touched> touched;
    std::vector<Old> pairs;
    Index touching = 0;
    Scalar deepest = 0;  // m

    void clear() {
        touched.clear();
        pairs.clear();
        touching = 0;
        deepest = 0;
    }
    void see(Scalar depth) {
        if (!(depth > 0)) return;
        ++touching;
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

    Body(const BodyOptions& options, const Place& pose) : options(options), begin(pose), end(pose) {
        motion.now = motion.next = pose;
    }
    virtual ~Body() = default;

    /// In the body's frame.
    virtual Surface<Scalar, Dim> surface(const Vector& y) const = 0;
    virtual Scalar extent() const = 0;
    /// The depths of registers of places, m, at a pose. @param first  the first place of each
    virtual void depths(const PlaneAccess<Scalar, Dim>& x, const Buffer<int>& first,
                        const Place& pose, Scalar* depth) const = 0;
    /// A step of solo pairs: from what is at v, x without contact to what is with it.
    virtual void step(SoloPairs<Scalar, Dim>& pairs, const Penalty<Scalar>& penalty,
                      const Moving<Scalar, Dim>& moving, Tally<Scalar, Dim>& tally) const = 0;

    Scalar thickness() const { return static_cast<Scalar>(options.thickness); }
    /// p, m. @param normal  in the world
    Scalar depth(const Vector& x, const Place& pose, Vector& normal) const {
        const Surface<Scalar, Dim> found = surface(pose.inside(x));
        normal = pose.rotation * found.normal;
        return thickness() - found.distance;
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
};

template <class Scalar, int Dim, class Obstacle>
class BodyOf final : public Body<Scalar, Dim> {
public:
    using Base = Body<Scalar, Dim>;
    using Vector = typename Base::Vector;
    using Place = typename Base::Place;

    BodyOf(Obstacle shape, const BodyOptions& options, const Place& pose)
        : Base(options, pose), shape_(std::move(shape)) {}

    Surface<Scalar, Dim> surface(const Vector& y) const override { return shape_.surface(y); }
    Scalar extent() const override { return shape_.extent(); }
    void depths(const PlaneAccess<Scalar, Dim>& x, const Buffer<int>& first, const Place& pose,
                Scalar* depth) const override {
        for (const int place : first) {
            Vectors at, normal;
            for (int d = 0; d < Dim; ++d) at[d] = x.row(d, place);
            query(at, pose, normal).store(depth);
            depth += Register::width;
        }
    }
    void step(SoloPairs<Scalar, Dim>& pairs, const Penalty<Scalar>& penalty,
              const Moving<Scalar, Dim>& moving, Tally<Scalar, Dim>& tally) const override {
        const Register zero(Scalar(0));
        for (Index i = 0; i < pairs.count; i += Register::width) {
            const int* places = pairs.place.data() + i;
            Vectors x, normal;
            for (int d = 0; d < Dim; ++d) x[d] = moving.x.gather(d, places);
            const Register before = Register::load(pairs.depth.data() + i);
            Register depth = query(x, this->motion.next, normal);
            if (largest_lane(larger(before, depth)) > 0) {
                const Index lanes = (std::min)(Index(Register::width), pairs.count - i);
                resolve(pairs, i, lanes, penalty, moving, tally, before, x, depth, normal);
            }
            depth.store(pairs.depth.data() + i);
            for (int d = 0; d < Dim; ++d) {
                x[d].store(pairs.x[d].data() + i);
                normal[d].store(pairs.normal[d].data() + i);
            }
        }
    }

private:
    using Register = step_detail::VectorRegister<Scalar>;
    using Vectors = detail::Few<Register, Dim>;

    /// p, and n in the world, of a lane each.
    EIGEN_ALWAYS_INLINE Register query(const Vectors& x, const Place& pose, Vectors& normal) const {
        Vectors from;
        for (int d = 0; d < Dim; ++d) from[d] = x[d] - Register(pose.position[d]);
        const typename Pose<Scalar, Dim>::Rotation back = pose.rotation.transpose();
        const Register distance = shape_.template query<Register>(times(back, from), normal);
        normal = times(pose.rotation, normal);
        return Register(this->thickness()) - distance;
    }
    /// Of pairs some of which touch: x, depth and normal after contact.
    void resolve(SoloPairs<Scalar, Dim>& pairs, Index i, Index lanes,
                 const Penalty<Scalar>& penalty, const Moving<Scalar, Dim>& moving,
                 Tally<Scalar, Dim>& tally, const Register& before, Vectors& x, Register& depth,
                 Vectors& normal) const {
        const Register zero(Scalar(0)), one(Scalar(1)), h(penalty.h);
        const Motion<Scalar, Dim>& motion = this->motion;
        const int* places = pairs.place.data() + i;
        Vectors from, n, v, u, w;
        for (int d = 0; d < Dim; ++d) {
            from[d] = Register::load(pairs.x[d].data() + i);
            n[d] = Register::load(pairs.normal[d].data() + i);
            v[d] = moving.v.gather(d, places);
        }
        n = times(motion.turn, n);
        const Vectors carried = times(motion.turn, from);
        for (int d = 0; d < Dim; ++d) {
            u[d] = (carried[d] + Register(motion.shift[d]) - from[d]) * Register(1 / penalty.h);
            w[d] = v[d] - u[d];
        }
        Register cap = Register::load(pairs.cap.data() + i);
        const Register deep = larger(before, zero);
        const Register push = Register(penalty.by_mass) * where_less(deep, cap, deep, cap);
        const Register into = dot(w, n);
        const Register out = (into + h * push) * Register(1 / (1 + penalty.block()));
        const Register impulse = out - into;  // hλ/m
        // A pair that would pull is left out if it goes no deeper so.
        Register touches = where_less(zero, larger(before, depth), one, zero);
        const Register pulls = where_less(impulse, zero, where_less(zero, before, one, zero), zero);
        touches = where_less(zero, pulls, where_less(before, depth, touches, zero), touches);
        Vectors along;
        for (int d = 0; d < Dim; ++d) along[d] = w[d] - into * n[d];
        const Register by_sliding = reciprocal_sqrt(
            larger(dot(along, along), Register((std::numeric_limits<Scalar>::min)())));
        const Register keep =
            larger(zero, one - Register(static_cast<Scalar>(this->options.friction)) *
                                   larger(impulse, zero) * by_sliding);
        Vectors to, after;
        Register work = zero;
        const Register mass = Register::load(pairs.mass.data() + i);
        for (int d = 0; d < Dim; ++d) {
            after[d] = u[d] + out * n[d] + keep * along[d];
            work += mass * u[d] * (after[d] - v[d]);
            to[d] = where_less(zero, touches, from[d] + h * after[d], x[d]);
        }
        x = to;
        depth = query(x, motion.next, normal);
        cap = where_less(zero, depth, cap, Register(std::numeric_limits<Scalar>::infinity()));
        detail::Few<Scalar, Register::width> touched, done, depths;
        detail::Few<detail::Few<Scalar, Register::width>, Dim> new_x, new_v;
        touches.store(touched.data());
        work.store(done.data());
        depth.store(depths.data());
        for (int d = 0; d < Dim; ++d) {
            x[d].store(new_x[d].data());
            after[d].store(new_v[d].data());
        }
        for (int k = 0; k < lanes; ++k) {
            Scalar& old = pairs.depth[i + k];
            if (old > 0 || depths[k] > 0)
                tally.pairs.push_back({&old, &pairs.cap[i + k], old, pairs.cap[i + k]});
            tally.see(depths[k]);
            if (!(touched[k] > 0)) continue;
            tally.touched.push_back({places[k], moving.x.vector(places[k]),
                                     moving.v.vector(places[k]), static_cast<double>(done[k])});
            for (int d = 0; d < Dim; ++d) {
                moving.x(d, places[k]) = new_x[d][k];
                moving.v(d, places[k]) = new_v[d][k];
                if (penalty.ahead > 0)
                    moving.spring_x(d, places[k]) = new_x[d][k] + penalty.ahead * new_v[d][k];
            }
        }
        cap.store(pairs.cap.data() + i);
    }

    Obstacle shape_;
};

}  // namespace contact_detail
}  // namespace taut
