// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "near.hpp"
#include "push.hpp"
#include "shared.hpp"

namespace taut::contact_detail {

/// Contact of all particles with all bodies in one step, on the planes of a stepper.
template <class Scalar, int Dim>
class ContactStep {
public:
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Access = PlaneAccess<Scalar, Dim>;
    using Bodies = std::vector<std::unique_ptr<Body<Scalar, Dim>>>;

    Bodies bodies;
    NearList<Scalar, Dim> nearby;
    Penalty<Scalar> penalty{};
    Buffer<Scalar> mass;           // by place, kg; 0 if pinned
    Buffer<Scalar> work;           // by place, J
    std::vector<KnownPair> known;  // at the start of the list
    Index lookups = 0;

    /// Takes a step that is there without contact. Those that one body touches are pushed in
    /// registers; a particle that meets another one then, or at once, is solved by itself.
    void touch(const Moving<Scalar, Dim>& moving) {
        solved_.clear();
        meets_.assign(nearby.several(), 0);
        pushed_by_.assign(nearby.several(), Link{-1, -1});
        queue_.clear();
        for (const auto& body : bodies) look(*body, moving);
        for (int b = 0; b < static_cast<int>(bodies.size()); ++b) push_alone(b, moving);
        for (const auto& body : bodies) look_again(*body, moving);
        for (const int i : queue_) solve(i, moving);
    }
    /// The step without contact again.
    void undo(const Moving<Scalar, Dim>& moving) {
        for (const auto& body : bodies) {
            auto& touching = body->touching;
            touching.each_pushed([&](Index j, Index row) {
                moving.set(touching.place[j], touching.x().vector(row), touching.v().vector(row));
            });
        }
        for (const auto& one : solved_) moving.set(one.place, one.x, one.v);
    }
    /// The step is over: books its work.
    void accept() {
        for (const auto& body : bodies) {
            auto& touching = body->touching;
            touching.each_pushed(
                [&](Index j, Index row) { work[touching.place[j]] += touching.work()[row]; });
            std::swap(body->near_pairs.now, body->near_pairs.next);
        }
        for (const auto& one : solved_) work[one.place] += one.work;
    }
    /// Lists what is near where the step began, and before.
    void look_back(const step_detail::Layout<Scalar>& layout,
                   const step_detail::StatePlanes<Scalar>& planes, Scalar margin, Scalar push_time,
                   const Vector& drift, Scalar time) {
        const Index size = layout.planes() * layout.stride();
        old_.resize(size);
        for (Index i = 0; i < size; ++i)
            old_[i] = planes.x.first[i] - penalty.h * planes.v.first[i];
        for (const auto& body : bodies) body->swap();
        ++lookups;
        nearby.build(bodies, known, mass, Access(layout, {old_.data(), planes.x.stride}),
                     layout.size(), margin, push_time, drift, time - penalty.h);
        for (const auto& body : bodies) body->swap();
    }
    /// In the last half kick of velocity Verlet: what touches goes no further in.
    void stop(const Access& v) {
        nearby.each_touching(bodies, [&](const SharedPair<Scalar, Dim>& pair) { stop(v, pair); });
    }

private:
    using Register = step_detail::VectorRegister<Scalar>;
    /// A particle that was solved by itself: what it was without contact.
    struct Solved {
        int place;
        Vector x, v;  // m, m/s
        Scalar work;  // that contact did, J
    };

    Body<Scalar, Dim>& body_of(int b) { return *bodies[static_cast<std::size_t>(b)]; }
    /// Where near particles go without contact, and which of them touch.
    void look(Body<Scalar, Dim>& body, const Moving<Scalar, Dim>& moving) {
        auto& pairs = body.near_pairs;
        auto& touching = body.touching;
        touching.begin(pairs.size);
        pairs.again.clear();
        const Access x = pairs.next.x(), old = pairs.now.x();
        moving.x.gather(pairs.place.data(), pairs.size, x);
        body.query(pairs.place.data(), x, pairs.size, pairs.next.depth(), pairs.next.normal());
        const Vector gone = body.gone();
        const Scalar quick = body.quick();
        const Register zero(Scalar(0)), one(Scalar(1)), quick2(quick * quick);
        for (Index at = 0; at < pairs.size; at += Register::width) {
            Register::load(pairs.now.cap() + at).store(pairs.next.cap() + at);
            const Register depth =
                where_less(zero, Register::load(pairs.mass.data() + at),
                           Register::load(pairs.next.depth() + at), Register(Scalar(-1)));
            depth.store(pairs.next.depth() + at);
            Register way2 = zero;
            for (int d = 0; d < Dim; ++d) {
                const Register went = x.row(d, at) - Register(gone[d]) - old.row(d, at);
                way2 += went * went;
            }
            Register meets = larger(Register::load(pairs.now.depth() + at), depth);
            if (largest_lane(way2 - quick2) > 0) meets = along(body, at, meets);
            if (!(largest_lane(meets) > 0)) continue;
            const Index k = touching.count * Register::width;
            touching.first[touching.count++] = static_cast<int>(at);
            where_less(zero, meets, one, zero).store(touching.pushed() + k);
            if (pairs.mixed[at / Register::width] == 0) continue;
            for (int lane = 0; lane < Register::width; ++lane) {
                const int several = pairs.several[at + lane];
                if (several < 0 || !(touching.pushed()[k + lane] > 0)) continue;
                const int others = meets_[several];
                ++meets_[several];
                if (others < 2 && meets_[several] > 1) queue_.push_back(several);
            }
        }
    }
    /// > 0 where a register of pairs touches, on its way, too.
    static Register along(Body<Scalar, Dim>& body, Index at, const Register& meets) {
        auto& pairs = body.near_pairs;
        detail::Few<Scalar, Register::width> lanes;
        meets.store(lanes.data());
        for (int lane = 0; lane < Register::width; ++lane) {
            const Index k = at + lane;
            if (lanes[lane] > 0 || !(pairs.mass[k] > 0)) continue;
            if (body.meets(pairs.place[k], pairs.now.x().vector(k), pairs.next.x().vector(k)))
                lanes[lane] = 1;
        }
        return Register::load(lanes.data());
    }
    /// Those that this body alone touches.
    void push_alone(int b, const Moving<Scalar, Dim>& moving) {
        Body<Scalar, Dim>& body = body_of(b);
        auto& pairs = body.near_pairs;
        auto& touching = body.touching;
        if (touching.count == 0) return;
        Index several = 0;  // registers with such
        for (Index t = 0; t < touching.count; ++t) {
            const Index k = t * Register::width, at = touching.first[t];
            for (int lane = 0; lane < Register::width; ++lane)
                touching.v().set(k + lane, moving.v.vector(pairs.place[at + lane]));
            for (int d = 0; d < Dim; ++d) pairs.next.x().row(d, at).store(&touching.x()(d, k));
            if (pairs.mixed[at / Register::width] == 0) continue;
            ++several;
            for (int lane = 0; lane < Register::width; ++lane) {
                const int particle = pairs.several[at + lane];
                if (particle >= 0 && meets_[particle] > 1) touching.pushed()[k + lane] = 0;
            }
        }
        body.push(penalty);
        const Index rows = touching.count * Register::width;
        if (body.of_particles) {
            places_.resize(rows);
            for (Index row = 0; row < rows; ++row) places_[row] = pairs.place[touching.pair(row)];
        }
        body.query(places_.data(), touching.end(), rows, touching.depth(), touching.normal());
        for (Index row = 0; row < rows && !body.convex; ++row) {
            if (!(touching.pushed()[row] > 0) || holds(body, row)) continue;
            touching.pushed()[row] = 0;
            queue_.push_back(pairs.several[touching.pair(row)]);
        }
        for (Index t = 0; t < touching.count; ++t) {
            settle(pairs, touching, t);
        }
        touching.list_pushed(pairs.place);
        moving.scatter(touching);
        for (Index j = 0; several > 0 && j < touching.pushed_count; ++j) {
            const int particle = pairs.several[touching.pair(touching.row[j])];
            if (particle < 0) continue;
            pushed_by_[particle] = {b, touching.row[j]};
            nearby.each_link(particle, [&](const Link& link) {
                if (link.body != b) body_of(link.body).near_pairs.again.push_back(link.pair);
            });
        }
    }
    /// Whether φ⁺ − φ + h f·(v⁺ − ū) ≤ 0 of what was pushed, and it is on the side where it was
    /// [T40].
    bool holds(Body<Scalar, Dim>& body, Index row) const {
        using Doubles = Eigen::Matrix<double, Dim, 1>;
        constexpr double unit = static_cast<double>(std::numeric_limits<Scalar>::epsilon());
        auto& pairs = body.near_pairs;
        auto& touching = body.touching;
        const Index pair = touching.pair(row);
        const Vector from = pairs.now.x().vector(pair), to = touching.end().vector(row);
        Vector normal = pairs.now.normal().vector(pair);
        const int place = pairs.place[pair];
        const Doubles speed =
            (body.carry(place, from, normal, false) - from).template cast<double>() /
            static_cast<double>(penalty.h);
        const Doubles after = touching.speed().vector(row).template cast<double>();
        const Doubles before = touching.v().vector(row).template cast<double>();
        const auto begin = static_cast<double>(pairs.now.depth()[pair]);
        const auto end = static_cast<double>(touching.depth()[row]);
        const Scalar cap = pairs.now.cap()[pair];
        const double given = (after - before).dot(after - speed);
        const double gain =
            penalty.energy_by_mass(end, cap) - penalty.energy_by_mass(begin, cap) + given;
        const double rounding = 4 * unit * (after - before).norm() * (after.norm() + speed.norm());
        if (gain > rounding) return false;
        if (touching.normal().vector(row).dot(normal) < 0) return false;
        return begin > 0 || end > 0 || !body.meets(place, from, to);
    }
    /// A register of pairs at the end of the step.
    static void settle(NearPairs<Scalar, Dim>& pairs, Touching<Scalar, Dim>& touching, Index t) {
        const Index k = t * Register::width, at = touching.first[t];
        const Register zero(Scalar(0)), pushed = Register::load(touching.pushed() + k);
        const auto take = [&](const Scalar* from, Scalar* to) {
            where_less(zero, pushed, Register::load(from), Register::load(to)).store(to);
        };
        for (int d = 0; d < Dim; ++d) {
            take(&touching.end()(d, k), &pairs.next.x()(d, at));
            take(&touching.normal()(d, k), &pairs.next.normal()(d, at));
        }
        take(touching.depth() + k, pairs.next.depth() + at);
        const Register cap = Register::load(pairs.next.cap() + at);
        const Register infinity(std::numeric_limits<Scalar>::infinity());
        // φ does not change by that: it is the same on this side of p₁.
        where_less(cap * Register(Scalar(1) / 16), Register::load(pairs.next.depth() + at), cap,
                   where_less(zero, pushed, infinity, cap))
            .store(pairs.next.cap() + at);
    }
    /// A pair at the end of the step.
    static void settle(NearPairs<Scalar, Dim>& pairs, int pair, const Vector& x,
                       const Vector& normal, Scalar depth) {
        pairs.next.x().set(pair, x);
        pairs.next.normal().set(pair, normal);
        pairs.next.depth()[pair] = depth;
        const Scalar cap = pairs.now.cap()[pair];
        pairs.next.cap()[pair] = depth > cap / 16 ? cap : std::numeric_limits<Scalar>::infinity();
    }
    /// Pairs whose particle another body has pushed: where they are now.
    void look_again(Body<Scalar, Dim>& body, const Moving<Scalar, Dim>& moving) {
        auto& pairs = body.near_pairs;
        const auto count = static_cast<Index>(pairs.again.size());
        if (count == 0) return;
        const Index size = whole_registers<Scalar>(count);
        pairs.again.resize(size, pairs.again[0]);
        again_.resize(size);
        places_.resize(size);
        for (Index k = 0; k < size; ++k) places_[k] = pairs.place[pairs.again[k]];
        moving.x.gather(places_.data(), size, again_.x());
        body.query(places_.data(), again_.x(), size, again_.depth(), again_.normal());
        const Scalar quick = body.quick();
        const Vector gone = body.gone();
        for (Index k = 0; k < count; ++k) {
            const int pair = pairs.again[k];
            const Vector x = again_.x().vector(k), from = pairs.now.x().vector(pair);
            settle(pairs, pair, x, again_.normal().vector(k), again_.depth()[k]);
            const bool fast = (x - from - gone).squaredNorm() > quick * quick;
            if (again_.depth()[k] > 0 || (fast && body.meets(pairs.place[pair], from, x)))
                queue_.push_back(pairs.several[pair]);
        }
    }
    /// One that several bodies touch.
    void solve(int several, const Moving<Scalar, Dim>& moving) {
        if (std::exchange(meets_[several], -1) < 0) return;
        pairs_.clear();
        nearby.each_link(several,
                         [&](const Link& link) { pairs_.push_back(nearby.pair(bodies, link)); });
        const int place = pairs_.front().place;
        Solved solved{place, moving.x.vector(place), moving.v.vector(place), 0};
        const Link by = pushed_by_[several];
        if (by.body >= 0) {
            auto& touching = body_of(by.body).touching;
            touching.pushed()[by.pair] = 0;
            solved.x = touching.x().vector(by.pair);
            solved.v = touching.v().vector(by.pair);
        }
        Vector x = solved.x, v = solved.v;
        solve_(bodies, pairs_.data(), pairs_.size(), penalty, x, v, solved.work);
        moving.set(place, x, v);
        solved.work *= mass[place];
        solved_.push_back(solved);
        nearby.each_link(several, [&](const Link& link) {
            auto& body = body_of(link.body);
            Vector normal;
            const Scalar depth = body.depth(place, x, true, normal);
            settle(body.near_pairs, link.pair, x, normal, depth);
        });
    }
    void stop(const Access& v, const SharedPair<Scalar, Dim>& pair) {
        const auto& body = *bodies[static_cast<std::size_t>(pair.body)];
        Vector normal = pair.normal;
        const Vector u = (pair.x - body.carry(pair.place, pair.x, normal, true)) / penalty.h;
        const Vector before = v.vector(pair.place), w = before - u;
        const Scalar into = -pair.normal.dot(w);
        if (!(into > 0)) return;
        const Vector along = w + into * pair.normal;
        const Scalar sliding = along.norm();
        const auto friction = static_cast<Scalar>(body.options.friction);
        const Scalar keep = sliding > friction * into ? 1 - friction * into / sliding : Scalar(0);
        const Vector after = u + (friction > 0 ? Vector(keep * along) : along);
        v.set(pair.place, after);
        work[pair.place] += mass[pair.place] * u.dot(after - before);
    }

    ParticleSolve<Scalar, Dim> solve_;
    Buffer<Scalar> old_;  // planes, m
    // Of a step; of particles near several bodies:
    Buffer<int> meets_;       // how many they meet without contact, or −1: they are solved
    Buffer<Link> pushed_by_;  // a pair of a body's touching, if one pushed it
    Buffer<int> queue_;       // to be solved by themselves
    PairTable<Scalar, Dim> again_;
    Buffer<int> places_;  // of these
    std::vector<SharedPair<Scalar, Dim>> pairs_;
    std::vector<Solved> solved_;
};

}  // namespace taut::contact_detail
