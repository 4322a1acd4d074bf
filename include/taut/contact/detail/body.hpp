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

/// Those solo pairs that touch at the start of a step or would at its end: what they were without
/// contact, and what it did. Arrays padded by a register.
template <class Scalar, int Dim>
struct Hits {
    Index count = 0;
    Buffer<int> pair, place;
    Buffer<Scalar> depth, cap, mass, work;  // at the start, m; kg; Σ h ū·f of the step, J
    detail::Few<Buffer<Scalar>, Dim> from, normal, x, v;

    void clear(Index most) {
        count = 0;
        const Index padded = most + step_detail::max_width;
        for (auto* of : {&pair, &place}) of->resize(padded);
        for (auto* of : {&depth, &cap, &mass, &work}) of->resize(padded);
        for (auto* of : {&from, &normal, &x, &v}) {
            for (int d = 0; d < Dim; ++d) (*of)[d].resize(padded);
        }
    }
};

/// How many pairs touch, and the deepest, m.
template <class Scalar>
struct Touching {
    Index count = 0;
    Scalar deepest = 0;

    void see(Scalar depth) {
        if (!(depth > 0)) return;
        ++count;
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
    /// depth(place) of `count` places, m, at a pose.
    virtual void depths(const PlaneAccess<Scalar, Dim>& x, Index count, const Place& pose,
                        Scalar* depth) const = 0;
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

    BodyOptions options;
    Place begin, end;  // of the frame
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

    BodyOf(Obstacle shape, const BodyOptions& options, const Place& pose)
        : Base(options, pose), shape_(std::move(shape)) {}

    Surface<Scalar, Dim> surface(const Vector& y) const override { return shape_.surface(y); }
    Scalar extent() const override { return shape_.extent(); }
    void depths(const PlaneAccess<Scalar, Dim>& x, Index count, const Place& pose,
                Scalar* depth) const override {
        for (Index i = 0; i < count; i += Register::width) {
            Vectors at, normal;
            for (int d = 0; d < Dim; ++d) at[d] = x.row(d, i);
            query(at, pose, normal).store(depth + i);
        }
    }
    void step(const Penalty<Scalar>& penalty, const Moving<Scalar, Dim>& moving,
              Touching<Scalar>& touching) override {
        SoloPairs<Scalar, Dim>& pairs = this->solo;
        this->hits.clear(pairs.count);
        for (Index i = 0; i < pairs.count; i += Register::width) {
            const int* places = pairs.place.data() + i;
            Vectors x, normal;
            for (int d = 0; d < Dim; ++d) x[d] = moving.x.gather(d, places);
            const Register before = Register::load(pairs.depth.data() + i);
            const Register depth = query(x, this->motion.next, normal);
            const Register deepest = larger(before, depth);
            if (largest_lane(deepest) > 0) keep(i, deepest);
            depth.store(pairs.depth.data() + i);
            for (int d = 0; d < Dim; ++d) {
                x[d].store(pairs.x[d].data() + i);
                normal[d].store(pairs.normal[d].data() + i);
            }
        }
        Hits<Scalar, Dim>& hits = this->hits;
        for (Index i = 0; hits.count > 0 && i < step_detail::max_width; ++i)
            copy(hits.count - 1, hits.count + i);
        for (Index i = 0; i < hits.count; i += Register::width)
            resolve(i, penalty, moving, touching);
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
    /// Of a register of pairs those lanes that touch, as they were at the start.
    void keep(Index i, const Register& deepest) {
        const SoloPairs<Scalar, Dim>& pairs = this->solo;
        Hits<Scalar, Dim>& hits = this->hits;
        detail::Few<Scalar, Register::width> lanes;
        deepest.store(lanes.data());
        const Index end = (std::min)(Index(Register::width), pairs.count - i);
        for (Index k = 0; k < end; ++k) {
            if (!(lanes[static_cast<int>(k)] > 0)) continue;
            const Index hit = hits.count++;
            hits.pair[hit] = static_cast<int>(i + k);
            hits.place[hit] = pairs.place[i + k];
            hits.depth[hit] = pairs.depth[i + k];
            hits.cap[hit] = pairs.cap[i + k];
            hits.mass[hit] = pairs.mass[i + k];
            for (int d = 0; d < Dim; ++d) {
                hits.from[d][hit] = pairs.x[d][i + k];
                hits.normal[d][hit] = pairs.normal[d][i + k];
            }
        }
    }
    void copy(Index from, Index to) {
        Hits<Scalar, Dim>& hits = this->hits;
        for (auto* of : {&hits.pair, &hits.place}) (*of)[to] = (*of)[from];
        for (auto* of : {&hits.depth, &hits.cap, &hits.mass}) (*of)[to] = (*of)[from];
        for (int d = 0; d < Dim; ++d) {
            hits.from[d][to] = hits.from[d][from];
            hits.normal[d][to] = hits.normal[d][from];
        }
    }
    /// Contact of a register of hits.
    void resolve(Index i, const Penalty<Scalar>& penalty, const Moving<Scalar, Dim>& moving,
                 Touching<Scalar>& touching) {
        Hits<Scalar, Dim>& hits = this->hits;
        const Register zero(Scalar(0)), one(Scalar(1)), h(penalty.h);
        const Motion<Scalar, Dim>& motion = this->motion;
        const int* places = hits.place.data() + i;
        const Register before = Register::load(hits.depth.data() + i);
        Vectors from, n, x, v, u, w;
        for (int d = 0; d < Dim; ++d) {
            from[d] = Register::load(hits.from[d].data() + i);
            n[d] = Register::load(hits.normal[d].data() + i);
            x[d] = moving.x.gather(d, places);
            v[d] = moving.v.gather(d, places);
            x[d].store(hits.x[d].data() + i);
            v[d].store(hits.v[d].data() + i);
        }
        Vectors normal;
        Register depth = query(x, motion.next, normal);
        n = times(motion.turn, n);
        const Vectors carried = times(motion.turn, from);
        for (int d = 0; d < Dim; ++d) {
            u[d] = (carried[d] + Register(motion.shift[d]) - from[d]) * Register(1 / penalty.h);
            w[d] = v[d] - u[d];
        }
        Register cap = Register::load(hits.cap.data() + i);
        const Register deep = larger(before, zero);
        const Register push = Register(penalty.by_mass) * where_less(deep, cap, deep, cap);
        const Register into = dot(w, n);
        const Register out = (into + h * push) * Register(1 / (1 + penalty.block()));
        const Register impulse = out - into;  // hλ/m
        // A pair that would pull is left out if it goes no deeper so.
        const Register pulls = where_less(impulse, zero, where_less(zero, before, one, zero), zero);
        const Register touches = where_less(zero, pulls, where_less(before, depth, one, zero), one);
        Vectors along;
        for (int d = 0; d < Dim; ++d) along[d] = w[d] - into * n[d];
        const Register by_sliding = reciprocal_sqrt(
            larger(dot(along, along), Register((std::numeric_limits<Scalar>::min)())));
        const Register keep =
            larger(zero, one - Register(static_cast<Scalar>(this->options.friction)) *
                                   larger(impulse, zero) * by_sliding);
        Register work = zero;
        const Register mass = Register::load(hits.mass.data() + i);
        for (int d = 0; d < Dim; ++d) {
            const Register after = u[d] + out * n[d] + keep * along[d];
            work += mass * u[d] * (after - v[d]);
            x[d] = where_less(zero, touches, from[d] + h * after, x[d]);
            v[d] = where_less(zero, touches, after, v[d]);
        }
        where_less(zero, touches, work, zero).store(hits.work.data() + i);
        depth = query(x, motion.next, normal);
        cap = where_less(zero, depth, cap, Register(std::numeric_limits<Scalar>::infinity()));
        put_back(i, penalty, moving, touching, x, v, depth, cap, normal);
    }
    /// Into the pairs and the planes.
    void put_back(Index i, const Penalty<Scalar>& penalty, const Moving<Scalar, Dim>& moving,
                  Touching<Scalar>& touching, const Vectors& x, const Vectors& v,
                  const Register& depth, const Register& cap, const Vectors& normal) {
        SoloPairs<Scalar, Dim>& pairs = this->solo;
        const Hits<Scalar, Dim>& hits = this->hits;
        using Lanes = detail::Few<Scalar, Register::width>;
        Lanes depths, caps;
        detail::Few<Lanes, Dim> xs, vs, ys, normals;
        depth.store(depths.data());
        cap.store(caps.data());
        for (int d = 0; d < Dim; ++d) {
            x[d].store(xs[d].data());
            v[d].store(vs[d].data());
            (x[d] + Register(penalty.ahead) * v[d]).store(ys[d].data());
            normal[d].store(normals[d].data());
        }
        const auto lanes = static_cast<int>((std::min)(Index(Register::width), hits.count - i));
        for (int k = 0; k < lanes; ++k) {
            const int pair = hits.pair[i + k], place = hits.place[i + k];
            touching.see(depths[k]);
            pairs.depth[pair] = depths[k];
            pairs.cap[pair] = caps[k];
            for (int d = 0; d < Dim; ++d) {
                pairs.x[d][pair] = xs[d][k];
                pairs.normal[d][pair] = normals[d][k];
                moving.x(d, place) = xs[d][k];
                moving.v(d, place) = vs[d][k];
            }
            if (penalty.ahead > 0) {
                for (int d = 0; d < Dim; ++d) moving.spring_x(d, place) = ys[d][k];
            }
        }
    }

    Obstacle shape_;
};

}  // namespace contact_detail
}  // namespace taut
