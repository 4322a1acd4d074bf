// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "near.hpp"

namespace taut::contact_detail {

/// Contact of all particles with all bodies in one step, on the planes of a stepper.
template <class Scalar, int Dim>
class ContactStep {
public:
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Access = PlaneAccess<Scalar, Dim>;
    using Bodies = std::vector<std::unique_ptr<Body<Scalar, Dim>>>;

    Bodies bodies;
    NearList<Scalar, Dim> near;
    Penalty<Scalar> penalty{};
    Buffer<Scalar> mass;           // by place, kg; 0 if pinned; padded
    Buffer<Scalar> work;           // by place, J; padded
    Touching<Scalar> touching;     // at the end of the last step
    std::vector<KnownPair> known;  // at the start of the list
    Index lookups = 0;

    /// Takes a step that is there without contact, and finds those it pushes.
    void touch(const Moving<Scalar, Dim>& moving) {
        touching = {};
        touched_.clear();
        old_pairs_.clear();
        for (const auto& body : bodies) body->step(penalty, moving, touching);
        auto& shared = near.shared();
        for (std::size_t first = 0, end; first < shared.size(); first = end) {
            const int place = shared[first].place;
            for (end = first; end < shared.size() && shared[end].place == place;) ++end;
            if (near.away(moving.x, &shared[first], end - first)) {
                shared[first].old = true;
                continue;
            }
            touch_shared(moving, first, end);
        }
    }
    /// Whether those that were pushed have met no body that does not list them.
    bool pushed_in_reach(const Access& x) const {
        const Register zero(Scalar(0)), below(Scalar(-1));
        for (const auto& body : bodies) {
            const auto& hits = body->hits;
            Register worst = below;
            for (Index k = 0; k < hits.count; ++k) {
                const Register pushed = Register::load(hits.touched.data() + k * Register::width);
                const Index place = body->solo.first[hits.block[k]];
                worst = larger(worst, where_less(zero, pushed, near.beyond(x, place), below));
            }
            if (!(largest_lane(worst) < 0)) return false;
        }
        for (const auto& touched : touched_) {
            if (!near.holds_of(x, touched.place)) return false;
        }
        return true;
    }
    /// The step without contact again, and the lists as they were.
    void undo(const Moving<Scalar, Dim>& moving) {
        for (const auto& body : bodies) {
            const auto& hits = body->hits;
            for (Index k = 0; k < hits.count; ++k) {
                const Index from = k * Register::width, to = hits.block[k] * Register::width;
                const Index place = body->solo.first[hits.block[k]];
                for (int d = 0; d < Dim; ++d) {
                    const Register x = Register::load(hits.x[d].data() + from);
                    const Register v = Register::load(hits.v[d].data() + from);
                    moving.x.set_row(d, place, x);
                    moving.v.set_row(d, place, v);
                    if (penalty.ahead > 0)
                        moving.spring_x.set_row(d, place, x + Register(penalty.ahead) * v);
                }
                Register::load(hits.depth.data() + from).store(body->solo.depth.data() + to);
                Register::load(hits.cap.data() + from).store(body->solo.cap.data() + to);
            }
        }
        auto old = old_pairs_.begin();
        for (const auto& touched : touched_) {
            set(moving, touched.place, touched.x, touched.v);
            for (std::size_t k = touched.first; k < touched.end; ++k) near.shared()[k] = *old++;
        }
    }
    /// Books the work of the step.
    void book() {
        for (const auto& body : bodies) {
            const auto& hits = body->hits;
            for (Index k = 0; k < hits.count; ++k) {
                Scalar* on = work.data() + body->solo.first[hits.block[k]];
                (Register::load(on) + Register::load(hits.work.data() + k * Register::width))
                    .store(on);
            }
        }
        for (const auto& touched : touched_) work[touched.place] += touched.work;
    }
    /// Lists what is near where the step began, and before.
    void look_back(const step_detail::Layout<Scalar>& layout,
                   const step_detail::StatePlanes<Scalar>& planes, Scalar margin, Scalar push_time,
                   const Vector& drift, Scalar time) {
        const Index size = layout.planes() * layout.stride();
        old_.resize(size);
        for (Index i = 0; i < size; ++i)
            old_[i] = planes.x.first[i] - penalty.h * planes.v.first[i];
        for (const auto& body : bodies) std::swap(body->motion.now, body->motion.next);
        ++lookups;
        near.build(bodies, known, mass, Access(layout, {old_.data(), planes.x.stride}),
                   layout.size(), margin, push_time, drift, time - penalty.h);
        for (const auto& body : bodies) std::swap(body->motion.now, body->motion.next);
    }
    /// In the last half kick of velocity Verlet: what touches goes no further in.
    void stop(const Access& v) {
        each_touching([&](int place, std::size_t body, const Vector& x, const Vector& normal) {
            stop(v, place, *bodies[body], x, normal);
        });
    }
    /// visit(place, body, x, normal), of pairs with p > 0 at the end of the last step.
    template <class Visitor>
    void each_touching(Visitor&& visit) const {
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            const auto& solo = bodies[b]->solo;
            for (Index k = 0; k < solo.blocks * Register::width; ++k) {
                if (!(solo.depth[k] > 0)) continue;
                Vector x, normal;
                for (int d = 0; d < Dim; ++d) {
                    x[d] = solo.x[d][k];
                    normal[d] = solo.normal[d][k];
                }
                visit(solo.place(k), b, x, normal);
            }
        }
        for (const auto& pair : near.shared()) {
            if (pair.depth > 0)
                visit(pair.place, static_cast<std::size_t>(pair.body), pair.x, pair.normal);
        }
    }
    /// visit(place, φ), J, of these.
    template <class Visitor>
    void each_energy(Visitor&& visit) const {
        for (const auto& body : bodies) {
            const auto& solo = body->solo;
            for (Index k = 0; k < solo.blocks * Register::width; ++k) {
                if (solo.depth[k] > 0)
                    visit(solo.place(k), penalty.energy(solo.depth[k], solo.cap[k], solo.mass[k]));
            }
        }
        for (const auto& pair : near.shared()) {
            if (pair.depth > 0)
                visit(pair.place, penalty.energy(pair.depth, pair.cap, mass[pair.place]));
        }
    }

private:
    using Register = step_detail::VectorRegister<Scalar>;
    /// A particle of shared pairs that was pushed: what it was without contact.
    struct Touched {
        int place;
        Vector x, v;             // m, m/s
        Scalar work;             // that contact did, J
        std::size_t first, end;  // its pairs
    };

    void set(const Moving<Scalar, Dim>& moving, int place, const Vector& x, const Vector& v) {
        moving.x.set(place, x);
        moving.v.set(place, v);
        if (penalty.ahead > 0) moving.spring_x.set(place, x + penalty.ahead * v);
    }
    void touch_shared(const Moving<Scalar, Dim>& moving, std::size_t first, std::size_t end) {
        auto& shared = near.shared();
        const int place = shared[first].place;
        Touched touched{place, moving.x.vector(place), moving.v.vector(place), 0, first, end};
        Vector x = touched.x, v = touched.v;
        if (std::exchange(shared[first].old, false)) {
            for (std::size_t k = first; k < end; ++k) {
                auto& pair = shared[k];
                const auto& body = *bodies[static_cast<std::size_t>(pair.body)];
                pair.x = x - penalty.h * v;
                pair.depth = body.depth(pair.x, body.motion.now, pair.normal);
            }
        }
        if (solve_(bodies, &shared[first], end - first, penalty, x, v, touched.work)) {
            set(moving, place, x, v);
            touched.work *= mass[place];
            for (std::size_t k = first; k < end; ++k) old_pairs_.push_back(shared[k]);
            touched_.push_back(touched);
        }
        for (std::size_t k = first; k < end; ++k) {
            auto& pair = shared[k];
            const auto& body = *bodies[static_cast<std::size_t>(pair.body)];
            pair.x = x;
            pair.depth = body.depth(x, body.motion.next, pair.normal);
            if (!(pair.depth > 0)) pair.cap = std::numeric_limits<Scalar>::infinity();
            touching.see(pair.depth);
        }
    }
    void stop(const Access& v, int place, const Body<Scalar, Dim>& body, const Vector& x,
              const Vector& normal) {
        const auto& motion = body.motion;  // which ends here
        const Vector u = (x - motion.now(motion.next.inside(x))) / penalty.h;
        const Vector before = v.vector(place), w = before - u;
        const Scalar into = -normal.dot(w);
        if (!(into > 0)) return;
        const Vector along = w + into * normal;
        const Scalar sliding = along.norm();
        const auto friction = static_cast<Scalar>(body.options.friction);
        const Scalar keep = sliding > friction * into ? 1 - friction * into / sliding : Scalar(0);
        const Vector after = u + (friction > 0 ? Vector(keep * along) : along);
        v.set(place, after);
        work[place] += mass[place] * u.dot(after - before);
    }

    ParticleSolve<Scalar, Dim> solve_;
    Buffer<Scalar> old_;  // planes, m
    std::vector<Touched> touched_;
    std::vector<SharedPair<Scalar, Dim>> old_pairs_;  // of these, without contact
};

}  // namespace taut::contact_detail
