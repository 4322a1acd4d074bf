// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include "body.hpp"

namespace taut::contact_detail {

/// A particle near several bodies, and one of these, at the start of a step.
template <class Scalar, int Dim>
struct SharedPair {
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;

    int place;
    int body;
    Vector x;       // of the particle, m
    Vector normal;  // n
    Scalar depth;   // p, m
    Scalar cap;     // p₁, m
    Scalar room;    // how far the body was when it was listed, m
    bool old;       // of a particle's first pair: x, normals and depths are of an earlier step
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
        bool near = false;
        for (std::size_t j = 0; j < count && !near; ++j)
            near = pairs[j].depth > 0 || meets(bodies, pairs[j], pairs[0].x, x, Scalar(0));
        if (!near) return false;
        start(bodies, pairs, count, penalty.h);
        Vector v = speed;
        for (int round = 0; round < 64; ++round) {
            v = solve(penalty, speed);
            bool added = false;
            for (std::size_t j = 0; j < count; ++j) {
                Active& a = active_[j];
                if (a.in) continue;
                const Scalar may = (std::max)(pairs[j].depth, Scalar(0));
                const Vector to = pairs[0].x + penalty.h * v;
                if (!meets(bodies, pairs[j], pairs[0].x, to, may)) continue;
                a.in = a.stays = added = true;
            }
            if (!added) break;
        }
        work = 0;
        Index pushing = 0;
        for (const Active& a : active_) pushing += a.in;
        for (const Active& a : active_) {
            if (!a.in) continue;
            const Vector w = v - a.speed;
            const Vector along = w - a.normal.dot(w) * a.normal;
            const Vector f = pushing == 1
                                 ? Vector((v - speed) / penalty.h)
                                 : Vector(force(penalty, a, v) * a.normal - a.drag * along);
            work += penalty.h * a.speed.dot(f);
        }
        speed = v;
        x = pairs[0].x + penalty.h * v;
        return true;
    }

private:
    /// A pair in this step; forces are those on 1 kg.
    struct Active {
        Vector normal;    // n′
        Vector speed;     // ū, m/s
        Scalar push;      // φ′(p)/κ, m
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
                               (std::min)((std::max)(pair.depth, Scalar(0)), pair.cap),
                               static_cast<Scalar>(body.options.friction), 0, pair.depth > 0,
                               false});
        }
    }
    static Scalar force(const Penalty<Scalar>& penalty, const Active& a, const Vector& v) {
        return penalty.by_mass * (a.push - penalty.h / 2 * a.normal.dot(v - a.speed));
    }
    Vector solved(const Penalty<Scalar>& penalty, const Vector& before) const {
        const Active* only = nullptr;
        int pushing = 0;
        for (const Active& a : active_) {
            if (!a.in) continue;
            only = &a;
            ++pushing;
        }
        if (pushing == 1) {  // along n′ and across it
            const Vector w = before - only->speed;
            const Scalar into = only->normal.dot(w);
            const Scalar out =
                (into + penalty.h * penalty.by_mass * only->push) / (1 + penalty.block());
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
            b += penalty.h * penalty.by_mass * a.push * a.normal + block * a.speed;
        }
        return A.inverse() * b;
    }
    /// The velocity for the pairs that push now: normal forces first, then friction by them.
    Vector solve(const Penalty<Scalar>& penalty, const Vector& before) {
        for (Active& a : active_) a.drag = 0;
        Vector v = solved(penalty, before);
        bool pulled = false;
        for (Active& a : active_) {
            if (!a.in || a.stays || !(a.push > 0) || !(force(penalty, a, v) < 0)) continue;
            a.in = false;
            pulled = true;
        }
        if (pulled) v = solved(penalty, before);
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
        return slides ? solved(penalty, before) : v;
    }

    std::vector<Active> active_;
};

}  // namespace taut::contact_detail
