// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "body.hpp"

namespace taut::contact_detail {

/// A particle and a body near it, at the start of a step.
template <class Scalar, int Dim>
struct SharedPair {
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;

    int place;
    int body;
    Vector x;       // of the particle, m
    Vector normal;  // n
    Scalar depth;   // p, m
    Scalar cap;     // p₁, m
};

/// Contact of one particle with several bodies in one step: rounds of one block, m I + ½h²κ n′n′ᵀ
/// of every pair that pushes, until no other is touched [T39].
template <class Scalar, int Dim>
class ParticleSolve {
public:
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Matrix = Eigen::Matrix<Scalar, Dim, Dim>;
    using Bodies = std::vector<std::unique_ptr<Body<Scalar, Dim>>>;
    using Pair = SharedPair<Scalar, Dim>;

    /// @param pairs  `count` of one particle   @param speed  without contact, then with it, m/s
    /// @param x      the place that follows from it, m   @param work  gets Σ h ū·f/m
    /// @returns whether anything was touched
    bool operator()(const Bodies& bodies, const Pair* pairs, std::size_t count,
                    const Penalty<Scalar>& penalty, Vector& x, Vector& speed, Scalar& work) {
        bool nearby = false;
        for (std::size_t j = 0; j < count && !nearby; ++j)
            nearby = pairs[j].depth > 0 || meets(bodies, pairs[j], pairs[0].x, x, Scalar(0));
        if (!nearby) return false;
        start(bodies, pairs, count, penalty.h);
        // As the first body sees it: the velocity of what is held is a difference from that body's,
        // and its force many times as much.
        const Vector frame = active_.front().speed;
        for (Active& a : active_) a.speed -= frame;
        const Vector before = speed - frame;
        Vector w = before;
        for (int round = 0; round < 64; ++round) {
            w = solve(penalty, before);
            bool added = false;
            for (std::size_t j = 0; j < count; ++j) {
                Active& a = active_[j];
                if (a.in) continue;
                const Scalar may = (std::max)(pairs[j].depth, Scalar(0));
                const Vector to = pairs[0].x + penalty.h * (frame + w);
                if (!meets(bodies, pairs[j], pairs[0].x, to, may)) continue;
                a.in = a.stays = added = true;
            }
            if (!added) break;
        }
        work = frame.dot(w - before);  // of all forces
        const bool one_pushes = alone();
        for (const Active& a : active_) {
            if (!a.in) continue;
            const Vector relative = w - a.speed;
            const Vector along = relative - a.normal.dot(relative) * a.normal;
            const Vector f = one_pushes ? Vector((w - before) / penalty.h)
                                        : Vector(force(penalty, a, w) * a.normal - a.drag * along);
            work += penalty.h * a.speed.dot(f);
        }
        speed = frame + w;
        x = pairs[0].x + penalty.h * speed;
        return true;
    }

private:
    /// A pair in this step; forces are those on 1 kg.
    struct Active {
        Vector normal;    // n′
        Vector speed;     // ū, m/s, beside that of the first
        Scalar push;      // φ′(p)/κ, m
        Scalar share;     // of it that acts
        Scalar friction;  // μ
        Scalar drag;      // c/m, 1/s
        bool in;          // whether it pushes
        bool stays;       // whether it was added again
    };

    /// Whether it ends deeper than that, m, or meets the body on the way.
    static bool meets(const Bodies& bodies, const Pair& pair, const Vector& from, const Vector& to,
                      Scalar depth) {
        Vector normal;
        const Body<Scalar, Dim>& body = *bodies[static_cast<std::size_t>(pair.body)];
        if (body.depth(to, body.motion.next, normal) > depth) return true;
        return !(pair.depth > 0) && body.meets(from, to);
    }
    void start(const Bodies& bodies, const Pair* pairs, std::size_t count, Scalar h) {
        active_.clear();
        for (std::size_t j = 0; j < count; ++j) {
            const Pair& pair = pairs[j];
            const Body<Scalar, Dim>& body = *bodies[static_cast<std::size_t>(pair.body)];
            const Vector carried = body.motion.turn * pair.x + body.motion.shift;
            active_.push_back({body.motion.turn * pair.normal, (carried - pair.x) / h,
                               (std::min)((std::max)(pair.depth, Scalar(0)), pair.cap), 1,
                               static_cast<Scalar>(body.options.friction), 0, pair.depth > 0,
                               false});
        }
    }
    /// Whether one pair pushes, and no other.
    bool alone() const {
        return std::count_if(active_.begin(), active_.end(),
                             [](const Active& a) { return a.in; }) == 1;
    }
    static Scalar force(const Penalty<Scalar>& penalty, const Active& a, const Vector& v) {
        return penalty.by_mass * (a.share * a.push - penalty.h / 2 * a.normal.dot(v - a.speed));
    }
    Vector solved(const Penalty<Scalar>& penalty, const Vector& before) const {
        if (alone()) {  // along n′ and across it
            const auto only =
                std::find_if(active_.begin(), active_.end(), [](const Active& a) { return a.in; });
            const Vector w = before - only->speed;
            const Scalar into = only->normal.dot(w);
            const Scalar push = penalty.h * penalty.by_mass * only->share * only->push;
            const Scalar out = (into + push) / (1 + penalty.block());
            return only->speed + out * only->normal +
                   (w - into * only->normal) / (1 + penalty.h * only->drag);
        }
        Matrix A = Matrix::Identity();
        Vector b = before;
        for (const Active& a : active_) {
            if (!a.in) continue;
            const Matrix nn = a.normal * a.normal.transpose();
            const Matrix block =
                penalty.block() * nn + penalty.h * a.drag * (Matrix::Identity() - nn);
            A += block;
            b += penalty.h * penalty.by_mass * a.share * a.push * a.normal + block * a.speed;
        }
        return A.inverse() * b;
    }
    /// As rest(): half of φ′ where a pair goes out by it, and more where it goes in.
    Vector settled(const Penalty<Scalar>& penalty, const Vector& before) {
        for (;;) {
            const Vector v = solved(penalty, before);
            bool more = false;
            for (Active& a : active_) {
                if (!a.in || !(a.push > 0) || !(a.share < 1)) continue;
                if (!(a.normal.dot(v - a.speed) < 0)) continue;
                const Scalar into = a.normal.dot(before - a.speed);
                const Scalar all = penalty.h * penalty.by_mass * a.push;
                const Scalar enough = alone() ? (std::min)(-into / all, Scalar(1)) : Scalar(1);
                more = more || enough > a.share;
                a.share = enough;
            }
            if (!more) return v;
        }
    }
    /// The velocity for the pairs that push now: normal forces first, then friction by them.
    Vector solve(const Penalty<Scalar>& penalty, const Vector& before) {
        for (Active& a : active_) {
            a.drag = 0;
            a.share = Scalar(0.5);
        }
        Vector v = settled(penalty, before);
        bool pulled = false;
        for (Active& a : active_) {
            if (!a.in || a.stays || !(a.push > 0) || !(force(penalty, a, v) < 0)) continue;
            a.in = false;
            pulled = true;
        }
        if (pulled) v = settled(penalty, before);
        bool slides = false;
        for (Active& a : active_) {
            const Scalar push = a.in ? force(penalty, a, v) : Scalar(0);
            if (!(push > 0) || !(a.friction > 0)) continue;
            const Vector w = before - a.speed;
            const Scalar sliding = (w - a.normal.dot(w) * a.normal).norm();
            const Scalar rest = sliding - penalty.h * a.friction * push;
            const Scalar most = 1 / penalty.h / std::sqrt(std::numeric_limits<Scalar>::epsilon());
            a.drag = rest > 0 ? (std::min)(most, a.friction * push / rest) : most;
            slides = true;
        }
        return slides ? settled(penalty, before) : v;
    }

    std::vector<Active> active_;
};

}  // namespace taut::contact_detail
