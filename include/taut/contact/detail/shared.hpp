// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
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
/// of every pair that pushes, until no other is touched [T39]. What is not convex is held across
/// n′, too, as far as its energy asks [T40].
template <class Scalar, int Dim>
class ParticleSolve {
public:
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Against = Body<Scalar, Dim>;
    using Bodies = std::vector<std::unique_ptr<Against>>;
    using Pair = SharedPair<Scalar, Dim>;

    /// @param pairs  `count` of one particle   @param speed  without contact, then with it, m/s
    /// @param x      the place that follows from it, m   @param work  gets Σ h ū·f/m
    /// @returns whether anything was touched
    bool operator()(const Bodies& bodies, const Pair* pairs, std::size_t count,
                    const Penalty<Scalar>& penalty, Vector& x, Vector& speed, Scalar& work) {
        const auto of = [&](const Pair& pair) -> const Against& {
            return *bodies[static_cast<std::size_t>(pair.body)];
        };
        const Pair* const first = std::find_if(pairs, pairs + count, [&](const Pair& pair) {
            return pair.depth > 0 || meets(of(pair), pair, x, Scalar(0));
        });
        if (first == pairs + count) return false;
        start(of, pairs, count, penalty.h);
        // As the first body that it touches sees it: the velocity of what is held is a difference
        // from that body's, and its force many times as much.
        const Vector frame = active_[static_cast<std::size_t>(first - pairs)].speed;
        for (Active& a : active_) a.speed -= frame;
        const Vector before = speed - frame;
        Vector w = before;
        bool more = true;
        for (int round = 0; more && round < 64; ++round) {
            w = solve(penalty, before);
            more = false;
            const Vector to = pairs[0].x + penalty.h * (frame + w);
            for (std::size_t j = 0; j < count; ++j) {
                Active& a = active_[j];
                const Scalar may = (std::max)(pairs[j].depth, Scalar(0));
                if (a.in) {
                    if (holds(of(pairs[j]), penalty, pairs[j], to, w, a)) continue;
                    if (a.raised == stuck && stuck_ < 0) stuck_ = static_cast<int>(j);
                } else if (meets(of(pairs[j]), pairs[j], to, may)) {
                    a.in = a.stays = true;
                } else {
                    continue;
                }
                more = true;
            }
        }
        speed = frame + w;
        x = pairs[0].x + penalty.h * speed;
        work = frame.dot(w - before);  // of all forces
        Vector rest = (w - before) / penalty.h;
        // What holds most has what is left of all forces: its own is the least known.
        const Active* last = stuck_ >= 0 ? &stuck_pair() : nullptr;
        for (const Active& a : active_) {
            if (stuck_ < 0 && a.in && (!last || a.drag > last->drag)) last = &a;
        }
        for (std::size_t j = 0; j < count; ++j) {
            const Active& a = active_[j];
            if (!a.in || &a == last) continue;
            const Vector f = a.raised == stuck ? against(of(pairs[j]), penalty, pairs[j], x, w, a)
                                               : force_of(penalty, a, w);
            work += penalty.h * a.speed.dot(f);
            rest -= f;
        }
        if (last) work += penalty.h * last->speed.dot(rest);
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
        Scalar stick;     // c/m at least, 1/s [T40]
        int raised;       // how often that was
        Scalar asked;     // m/s, at which what begins inside is to leave, else infinity

        bool gently() const { return detail::is_finite(asked); }
    };
    static constexpr int whole = 5, stuck = 6;  // raised to ½hκ/m; beyond

    /// Whether it ends deeper than that, m, or meets the body on the way.
    static bool meets(const Against& body, const Pair& pair, const Vector& to, Scalar depth) {
        Vector normal;
        if (body.depth(pair.place, to, true, normal) > depth) return true;
        return !(pair.depth > 0) && body.meets(pair.place, pair.x, to);
    }
    template <class Of>
    void start(const Of& of, const Pair* pairs, std::size_t count, Scalar h) {
        active_.clear();
        stuck_ = -1;
        for (std::size_t j = 0; j < count; ++j) {
            const Pair& pair = pairs[j];
            const Against& body = of(pair);
            Vector normal = pair.normal;
            const Vector carried = body.carry(pair.place, pair.x, normal, false);
            active_.push_back({normal, (carried - pair.x) / h,
                               (std::min)((std::max)(pair.depth, Scalar(0)), pair.cap), 1,
                               static_cast<Scalar>(body.options.friction), 0, pair.depth > 0, false,
                               0, 0, asked(body, pair, h)});
        }
    }
    /// Whether φ⁺ − φ + h f·(v⁺ − ū) ≤ 0 for a pair; if not, it sticks more: by ½hκ that is so.
    /// Where x + pn is no nearest point, as in a corner of what has a thickness, it is stuck:
    /// carried by the body φ⁺ = φ.
    /// @param to  where v ends   @param v  velocity, as a.speed
    bool holds(const Against& body, const Penalty<Scalar>& penalty, const Pair& pair,
               const Vector& to, const Vector& v, Active& a) const {
        if (body.convex || a.raised == stuck) return true;
        using Doubles = Eigen::Matrix<double, Dim, 1>;
        constexpr double unit = static_cast<double>(std::numeric_limits<Scalar>::epsilon());
        const auto h = static_cast<double>(penalty.h), k = static_cast<double>(penalty.by_mass);
        Vector out;
        auto end = static_cast<double>(body.depth(pair.place, to, true, out));
        const auto begin = static_cast<double>(pair.depth);
        const Doubles n = a.normal.template cast<double>();
        const Doubles way = h * (v - a.speed).template cast<double>();
        const double z = n.dot(way);
        const Doubles along = way - z * n;
        // The normals say more of how it ends than rounding leaves of that.
        const double by_normals = begin - (z + out.template cast<double>().dot(way)) / 2;
        const auto size = static_cast<double>(to.cwiseAbs().maxCoeff()) + (std::abs)(end);
        if ((std::abs)(by_normals - end) < 8 * unit * size) end = by_normals;
        const double rise =
            penalty.energy_by_mass(end, pair.cap) - penalty.energy_by_mass(begin, pair.cap);
        const double given = k * (static_cast<double>(a.share * a.push) * z - z * z / 2);
        const double across = along.squaredNorm();
        const auto drag = static_cast<double>(a.drag);
        const double gain = rise + given - drag / h * across;
        const double rounding = 4 * unit * k * way.norm() *
                                ((std::max)(begin, 0.0) + (std::max)(end, 0.0) + (std::abs)(z));
        // It has come out on another side.
        const bool through = a.raised < whole &&
                             (out.dot(a.normal) < 0 ||
                              (!(begin > 0) && !(end > 0) && body.meets(pair.place, pair.x, to)));
        if (!(gain > rounding) && !through) return true;
        const double most = h * k / 2, enough = drag + 1.25 * gain * h / across;
        if (through || (a.raised < whole && !(enough < most))) a.raised = whole - 1;
        ++a.raised;
        a.stick = static_cast<Scalar>(a.raised < whole ? enough : most);
        return false;
    }
    /// What a body pushes back with that another one carries the particle into: against the way,
    /// by what φ gains on it. That is sound, as p changes by no more than the way.
    Vector against(const Against& body, const Penalty<Scalar>& penalty, const Pair& pair,
                   const Vector& to, const Vector& v, const Active& a) const {
        Vector normal;
        const Vector w = v - a.speed;
        const Scalar end = body.depth(pair.place, to, true, normal);
        const double gain =
            penalty.energy_by_mass(end, pair.cap) - penalty.energy_by_mass(pair.depth, pair.cap);
        const Scalar w2 = w.squaredNorm();
        if (!(gain > 0) || !(w2 > 0)) return Vector::Zero();
        return -static_cast<Scalar>(gain) / (penalty.h * w2) * w;
    }
    /// Whether one pair pushes, and no other.
    bool alone() const {
        return std::count_if(active_.begin(), active_.end(),
                             [](const Active& a) { return a.in; }) == 1;
    }
    const Active& only() const {
        return *std::find_if(active_.begin(), active_.end(), [](const Active& a) { return a.in; });
    }
    const Active& stuck_pair() const { return active_[static_cast<std::size_t>(stuck_)]; }
    static Scalar force(const Penalty<Scalar>& penalty, const Active& a, const Vector& v) {
        return penalty.by_mass * (a.share * a.push - penalty.h / 2 * a.normal.dot(v - a.speed));
    }
    /// f of a pair that pushes.
    template <class Number>
    static Eigen::Matrix<Number, Dim, 1> force_of(const Penalty<Scalar>& penalty, const Active& a,
                                                  const Eigen::Matrix<Number, Dim, 1>& v) {
        const Eigen::Matrix<Number, Dim, 1> n = a.normal.template cast<Number>();
        const Eigen::Matrix<Number, Dim, 1> w = v - a.speed.template cast<Number>();
        const Number into = n.dot(w);
        // Rounding leaves nothing along n′ of what is across: a drag would make much of it.
        Eigen::Matrix<Number, Dim, 1> along = w - into * n;
        along -= n.dot(along) * n;
        const Number push =
            static_cast<Number>(a.share * a.push) - static_cast<Number>(penalty.h) / 2 * into;
        return static_cast<Number>(penalty.by_mass) * push * n -
               static_cast<Number>(a.drag) * along;
    }
    Vector solved(const Penalty<Scalar>& penalty, const Vector& before) const {
        if (stuck_ >= 0) return stuck_pair().speed;
        if (alone()) {  // along n′ and across it
            const Active* only = &this->only();
            const Vector w = before - only->speed;
            const Scalar into = only->normal.dot(w);
            const Scalar push = penalty.h * penalty.by_mass * only->share * only->push;
            const Scalar out = (into + push) / (1 + penalty.block());
            return only->speed + out * only->normal +
                   (w - into * only->normal) / (1 + penalty.h * only->drag);
        }
        // In double, where A of parallel normals is far from singular.
        using Exact = Eigen::Matrix<double, Dim, Dim>;
        using Exacts = Eigen::Matrix<double, Dim, 1>;
        const auto h = static_cast<double>(penalty.h);
        const double block = h * h * static_cast<double>(penalty.by_mass) / 2;
        const Exacts start = before.template cast<double>();
        Exact A = Exact::Identity();
        Exacts b = Exacts::Zero();
        double sum = 1;
        for (const Active& a : active_) {
            if (!a.in) continue;
            const Exacts n = a.normal.template cast<double>();
            const double drag = h * static_cast<double>(a.drag);
            A += (block - drag) * n * n.transpose() + drag * Exact::Identity();
            b += h * force_of(penalty, a, start);
            sum += block + drag;
        }
        const Eigen::LLT<Exact> factor(A);
        Exacts w = start + factor.solve(b);
        constexpr double unit = std::numeric_limits<double>::epsilon();
        for (int i = 0; i < 3 && sum * unit > 1e-13; ++i) {
            Exacts rest = start - w;
            for (const Active& a : active_) {
                if (a.in) rest += h * force_of(penalty, a, w);
            }
            w += factor.solve(rest);
        }
        return w.template cast<Scalar>();
    }
    /// Whether what began inside several bodies leaves faster than it is asked to, as from a wedge.
    /// Then these hold it across n′, too.
    bool thrown(const Vector& before, const Vector& v) const {
        return !alone() && std::any_of(active_.begin(), active_.end(), [&](const Active& a) {
            const Scalar may = (std::max)(a.asked, (before - a.speed).norm());
            return a.in && a.gently() && (v - a.speed).norm() > Scalar(1.01) * may;
        });
    }
    /// No faster than is asked, and to rest at the surface.
    static Scalar asked(const Against& body, const Pair& pair, Scalar h) {
        if (!detail::is_finite(pair.cap)) return pair.cap;
        const Scalar depth = (std::max)(pair.depth, Scalar(0));
        return (std::min)(static_cast<Scalar>(body.options.push_out), depth / (2 * h));
    }
    /// As rest(): half of φ′ where a pair goes out by it, and more where it goes in.
    Vector settled(const Penalty<Scalar>& penalty, const Vector& before) {
        const auto count = static_cast<Scalar>(active_.size());
        for (int round = 0;; ++round) {
            const Vector v = solved(penalty, before);
            bool more = false;
            for (Active& a : active_) {
                if (!a.in || !(a.push > 0) || !(a.share < 1)) continue;
                const Scalar still = a.normal.dot(v - a.speed);
                const Scalar rounding = 8 * std::numeric_limits<Scalar>::epsilon() *
                                        (v.norm() + a.speed.norm() + before.norm());
                if (!(still < (a.gently() && !alone() ? -rounding : Scalar(0)))) continue;
                const Scalar into = a.normal.dot(before - a.speed);
                const Scalar all = penalty.h * penalty.by_mass * a.push;
                Scalar enough = 1;
                if (alone()) {
                    enough = -into / all;
                } else if (a.gently() && round < 16) {
                    enough = a.share - Scalar(1.01) * still * (1 + count * penalty.block()) / all;
                }
                enough = (std::min)(enough, Scalar(1));
                more = more || enough > a.share;
                a.share = enough;
            }
            if (!more) return v;
        }
    }
    /// The velocity for the pairs that push now: normal forces first, then friction by them.
    Vector solve(const Penalty<Scalar>& penalty, const Vector& before) {
        for (Active& a : active_) {
            a.drag = a.stick;
            a.share = Scalar(0.5);
            if (a.push > 0) a.share = (std::min)(a.share, a.asked * penalty.h / (2 * a.push));
        }
        Vector v = settled(penalty, before);
        if (thrown(before, v)) {
            for (Active& a : active_) {
                if (a.gently()) a.drag = (std::max)(a.stick, penalty.h * penalty.by_mass / 2);
            }
            v = settled(penalty, before);
        }
        bool pulled = false;
        for (Active& a : active_) {
            if (stuck_ >= 0 || !a.in || a.stays || !(a.push > 0) || !(force(penalty, a, v) < 0))
                continue;
            a.in = false;
            pulled = true;
        }
        if (pulled) v = settled(penalty, before);
        bool slides = false;
        for (Active& a : active_) {
            const Scalar push = a.in ? force(penalty, a, v) : Scalar(0);
            if (!(push > 0) || !(a.friction > 0) || a.gently()) continue;
            const Vector w = before - a.speed;
            const Scalar sliding = (w - a.normal.dot(w) * a.normal).norm();
            const Scalar rest = sliding - penalty.h * a.friction * push;
            const Scalar most = 1 / penalty.h / std::sqrt(std::numeric_limits<Scalar>::epsilon());
            const Scalar coulomb = rest > 0 ? a.friction * push / rest : most;
            a.drag = (std::max)(a.stick, (std::min)(most, coulomb));
            slides = true;
        }
        return slides ? settled(penalty, before) : v;
    }

    std::vector<Active> active_;
    int stuck_ = -1;  // the pair that carries the particle
};

}  // namespace taut::contact_detail
