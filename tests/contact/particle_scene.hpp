// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <taut/contact/contact.hpp>
#include <utility>

#include "../support/tolerance.hpp"
#include "bodies.hpp"
#include "particle_referee.hpp"

namespace taut_test {

/// A convex body of an engine: a ball about the origin, or all that lies behind some planes.
template <class Scalar, int Dim>
struct Form {
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;

    Scalar radius = 0;  // of the ball, m; or 0
    std::vector<Vector> normals;
    std::vector<Scalar> offsets;  // n·y of each plane, m

    /// The distance of y and the way out, in the numbers of y.
    template <class Real>
    Real distance(const Eigen::Matrix<Real, Dim, 1>& y, Eigen::Matrix<Real, Dim, 1>& out) const {
        if (radius > 0) {
            const Real length = y.norm();
            out.setZero();
            out[Dim - 1] = 1;
            if (length > 0) out = y / length;
            return length - static_cast<Real>(radius);
        }
        Real most = -std::numeric_limits<Real>::infinity();
        for (std::size_t k = 0; k < normals.size(); ++k) {
            const Eigen::Matrix<Real, Dim, 1> n = normals[k].template cast<Real>();
            const Real beyond = n.dot(y) - static_cast<Real>(offsets[k]);
            if (beyond > most) {
                most = beyond;
                out = n;
            }
        }
        return most;
    }
    taut::Surface<Scalar, Dim> surface(const Vector& y) const {
        Vector out;
        const Scalar away = distance(y, out);
        return {away, out};
    }
};

/// A particle of 1 kg before a step, and bodies that move in it.
template <class Scalar, int Dim>
struct OneParticle {
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Place = taut::Pose<Scalar, Dim>;
    using Shape = Form<Scalar, Dim>;
    using Own = taut::contact_detail::BodyOf<Scalar, Dim, Shape>;
    using Pair = taut::contact_detail::SharedPair<Scalar, Dim>;

    taut::contact_detail::Penalty<Scalar> penalty{};
    Scalar spread;     // of places, m
    Scalar size = 1;   // of speeds, m/s
    Vector x, v, end;  // where it begins; its speed, and where it ends, without contact
    std::vector<std::unique_ptr<taut::contact_detail::Body<Scalar, Dim>>> bodies;
    std::vector<Shape> shapes;
    std::vector<Pair> pairs;

    const Own& body(std::size_t j) const { return static_cast<const Own&>(*bodies[j]); }

    /// @param most_block  ½h²κ/m at most   @param away  from the origin, m
    OneParticle(Random& random, double most_block, double away)
        : spread(static_cast<Scalar>(away)) {
        penalty.h = Scalar(0.001);
        const auto block = static_cast<Scalar>(log_uniform(random, 0.005, most_block));
        penalty.by_mass = 2 * block / (penalty.h * penalty.h);
        size = static_cast<Scalar>(log_uniform(random, 0.03, 10));
        x = spread * random.vector<Scalar, Dim>(-1, 1);
        v = size * random.vector<Scalar, Dim>(-1, 1);
        end = x + penalty.h * v;
    }
    /// One more body. @param friction, thickness  at most   @param inside  where it begins
    /// @param flush  with the first one, without friction
    void add(Random& random, double friction, double thickness, bool inside, bool flush) {
        const auto some = [&](double low, double high) {
            return static_cast<Scalar>(random.uniform(low, high));
        };
        taut::BodyOptions options;
        if (!flush && random.below(3) > 0) options.friction = random.uniform(0, friction);
        options.push_out = static_cast<double>(size) * random.uniform(0.3, 3);
        if (random.below(2) > 0) options.thickness = random.uniform(0, thickness);
        const auto thick = static_cast<Scalar>(options.thickness);
        Vector n = random.vector<Scalar, Dim>(-1, 1).stableNormalized();
        if (!(n.norm() > Scalar(0.5))) n = Vector::Unit(0);
        const Index like = pairs.empty() ? 9 : random.below(8);
        if (like < 3) n = (like == 1 ? -1 : 1) * pairs.back().normal;
        if (flush && !pairs.empty()) n = pairs.front().normal;
        if (like == 2 && !flush)
            n = (n + Scalar(0.001) * random.vector<Scalar, Dim>(-1, 1)).normalized();
        const Scalar reach = penalty.h * size;
        Scalar depth = reach * static_cast<Scalar>(log_uniform(random, 0.003, 3));
        if (!inside && random.below(2) > 0) depth *= Scalar(-0.3);

        Place from = turn<Scalar, Dim>(random, 3);
        Shape shape;
        if (random.below(3) == 0) {
            shape.radius = spread * some(0.01, 0.6);
            from.position = x - (shape.radius + thick - depth) * n;
        } else {
            from.position = spread * random.vector<Scalar, Dim>(-1, 1);
            const Vector y = from.inside(x);
            const auto plane = [&](const Vector& out, Scalar away) {
                shape.normals.push_back(from.rotation.transpose() * out);
                shape.offsets.push_back(shape.normals.back().dot(y) - away);
            };
            plane(n, thick - depth);
            for (Index more = random.below(3); more > 0; --more) {
                const Vector out = random.vector<Scalar, Dim>(-1, 1);
                if (out.norm() > Scalar(0.1))
                    plane(out.normalized(), thick - depth - reach * some(0.01, 2));
            }
        }
        const Scalar speed = size * static_cast<Scalar>(log_uniform(random, 0.03, 3));
        Place to = from;
        const Index moves = random.below(4);
        if (!pairs.empty() && (flush || moves == 1)) {
            const auto& last = body(pairs.size() - 1).motion;
            to.position += last.next.position - last.now.position;
        } else if (moves > 1 || flush) {
            to.position += penalty.h * speed * random.vector<Scalar, Dim>(-1, 1);
            const double most = flush ? 0 : static_cast<double>(penalty.h * speed);
            to.rotation = turn<Scalar, Dim>(random, most).rotation * from.rotation;
        }
        auto own = std::make_unique<Own>(shape, options, from);
        own->end = to;
        own->start(penalty.h);
        own->go_to(1);
        Pair pair{0, static_cast<int>(pairs.size()), x, n, 0, 0};
        pair.depth = own->depth(0, x, false, pair.normal);
        const bool gently = pair.depth > 0 && random.below(3) == 0;
        pair.cap =
            gently ? own->cap(penalty.h * some(1, 8)) : std::numeric_limits<Scalar>::infinity();
        pairs.push_back(pair);
        shapes.push_back(std::move(shape));
        bodies.push_back(std::move(own));
    }
};

template <class Vector>
Wide wide(const Vector& v) {
    Wide result = Wide::Zero();
    for (Index d = 0; d < v.size(); ++d) result[d] = static_cast<Real>(v[d]);
    return result;
}
template <class Matrix>
Wide turned(const Matrix& R, const Wide& y) {
    Wide result = Wide::Zero();
    for (Index i = 0; i < R.rows(); ++i) {
        for (Index j = 0; j < R.cols(); ++j) result[i] += static_cast<Real>(R(i, j)) * y[j];
    }
    return result;
}

template <class Scalar, int Dim>
PairReferee referee_of(const OneParticle<Scalar, Dim>& one, std::size_t j) {
    const auto& body = one.body(j);
    const auto &now = body.motion.now, &next = body.motion.next;
    const auto& shape = one.shapes[j];
    PairReferee r{};
    r.unit = std::numeric_limits<Scalar>::epsilon();
    r.h = static_cast<Real>(one.penalty.h);
    r.k = static_cast<Real>(one.penalty.by_mass);
    r.block = r.h * r.h * r.k / 2;
    r.begin = static_cast<Real>(one.pairs[j].depth);
    r.cap = static_cast<Real>(one.pairs[j].cap);
    r.friction = static_cast<Real>(body.options.friction);
    r.push_out = static_cast<Real>(body.options.push_out);
    r.thickness = static_cast<Real>(body.options.thickness);
    r.radius = static_cast<Real>(shape.radius);
    r.at = wide(next.position);
    for (std::size_t i = 0; i < shape.normals.size(); ++i) {
        r.planes.push_back(turned(next.rotation, wide(shape.normals[i])));
        r.offsets.push_back(static_cast<Real>(shape.offsets[i]));
    }
    const Wide x = wide(one.x);
    const Wide own = turned(now.rotation.transpose(), x - wide(now.position));
    const Wide there = r.at + turned(next.rotation, own);
    const Wide turns =
        turned(next.rotation, turned(now.rotation.transpose(), wide(one.pairs[j].normal)));
    auto n = one.pairs[j].normal;
    const Wide carried = wide(body.carry(0, one.x, n, false));
    r.normal = wide(n);
    r.speed = (carried - x) / r.h;
    r.reach = x.norm() + own.norm() + r.at.norm() + r.thickness;
    r.carries = (carried - there).norm() <= 8 * r.unit * r.reach &&
                (r.normal - turns).norm() <= 16 * r.unit;
    return r;
}

/// A step before contact.
template <class Scalar, int Dim>
Step begun(const OneParticle<Scalar, Dim>& one) {
    Step step;
    for (const auto& pair : one.pairs)
        step.pairs.push_back(referee_of(one, static_cast<std::size_t>(pair.body)));
    step.x = wide(one.x);
    step.before = step.after = wide(one.v);
    step.follows = true;
    return step;
}
/// Where contact lets it end, m, with that speed, m/s, by that work.
template <class Vector>
void end(Step& step, const Vector& x, const Vector& v, typename Vector::Scalar work) {
    step.after = wide(v);
    step.work = static_cast<Real>(work);
    step.follows = (wide(x) - step.end()).norm() <=
                   2 * step.pairs[0].unit * (step.x.norm() + step.end().norm());
}
template <class Scalar, int Dim>
Step solved(const OneParticle<Scalar, Dim>& one) {
    taut::contact_detail::ParticleSolve<Scalar, Dim> solve;
    Step step = begun(one);
    auto x = one.end, v = one.v;
    Scalar work = 0;
    step.touches = solve(one.bodies, one.pairs.data(), one.pairs.size(), one.penalty, x, v, work);
    end(step, x, v, work);
    return step;
}

/// The stiffest that Contacts takes: ½h²κ/m.
template <class Scalar>
double stiffest(bool stiff) {
    return stiff ? 0.5e-3 / Tolerance<Scalar>::epsilon : 100;
}

template <class Scalar, int Dim>
std::array<Step, 2> solved_steps(Random& random, const ParticleOptions& options) {
    OneParticle<Scalar, Dim> one(random, stiffest<Scalar>(options.stiff), 1);
    const bool inside = random.below(2) > 0;
    const double friction = random.below(2) > 0 ? 2 : 0;
    for (Index k = 0; k < options.bodies; ++k)
        one.add(random, friction, 0.05, inside, options.flush);
    const Step first = solved(one);
    for (std::size_t j = one.pairs.size(); j > 1; --j)
        std::swap(one.pairs[j - 1], one.pairs[static_cast<std::size_t>(random.below(Index(j)))]);
    return {first, solved(one)};
}

template <class Scalar, int Dim>
std::vector<std::array<Step, 2>> pushed_steps(Random& random, bool stiff) {
    constexpr Index width = taut::step_detail::VectorRegister<Scalar>::width;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    OneParticle<Scalar, Dim> one(random, stiffest<Scalar>(stiff), 0.01);
    one.add(random, 2, 0.001, true, false);
    auto& body = *one.bodies[0];
    auto& near_pairs = body.near_pairs;
    auto& touching = body.touching;
    near_pairs.begin(width);
    touching.begin(width);
    touching.count = 1;
    touching.first[0] = 0;
    const Scalar reach = one.penalty.h * one.size, cap = one.pairs[0].cap;
    const Vector at = one.x;
    std::vector<std::array<Step, 2>> steps;
    for (Index k = 0; k < width; ++k) {
        auto& pair = one.pairs[0];
        one.x = pair.x = at + reach * random.vector<Scalar, Dim>(-1, 1);
        one.v = one.size * random.vector<Scalar, Dim>(-1, 1);
        one.end = one.x + one.penalty.h * one.v;
        pair.depth = body.depth(0, one.x, false, pair.normal);
        pair.cap = pair.depth > 0 ? cap : std::numeric_limits<Scalar>::infinity();
        Vector normal;
        const Scalar depth = body.depth(0, one.end, true, normal);
        const bool meets = pair.depth > 0 || depth > 0 || body.meets(0, one.x, one.end);
        near_pairs.now.x().set(k, one.x);
        near_pairs.now.normal().set(k, pair.normal);
        near_pairs.now.depth()[k] = pair.depth;
        near_pairs.now.cap()[k] = pair.cap;
        near_pairs.next.depth()[k] = depth;
        near_pairs.mass[k] = 1;
        touching.x().set(k, one.end);
        touching.v().set(k, one.v);
        touching.pushed()[k] = meets ? Scalar(1) : Scalar(0);
        steps.push_back({begun(one), solved(one)});
        steps.back()[0].touches = meets;
        steps.back()[0].in_registers = true;
    }
    body.push(one.penalty);
    for (Index k = 0; k < width; ++k) {
        if (!(touching.pushed()[k] > 0)) continue;
        end(steps[static_cast<std::size_t>(k)][0], touching.end().vector(k),
            touching.speed().vector(k), touching.work()[k]);
    }
    return steps;
}

}  // namespace taut_test
