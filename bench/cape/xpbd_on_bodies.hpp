// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "../xpbd.hpp"
#include "frames.hpp"

namespace bench {

/// XPBD with small steps, in float, on bodies that move: after each pass over the springs a
/// particle inside is put on the surface, and what it went along the surface, beside the body, is
/// taken back by at most friction times what it was put out (Macklin et al., "Unified particle
/// physics for real-time applications", 2014). What is near is looked up once a frame.
class XpbdOnBodies {
public:
    /// @param steps  a frame of so many seconds
    template <class System>
    XpbdOnBodies(const System& system, taut::Index steps, std::vector<Round> bodies,
                 const Touch& touch = {}, float seconds = frame)
        : xpbd_(system, seconds / float(steps)),
          steps_(steps),
          seconds_(seconds),
          bodies_(std::move(bodies)),
          touch_(touch) {
        for (taut::Index i = 0; i < system.size(); ++i) free_.push_back(!system.is_pinned(i));
    }
    void advance(const Places& from, const Places& to, const std::vector<PinAt>& pins = {}) {
        for (const PinAt& pin : pins) {
            const auto& x = xpbd_.places()[std::size_t(pin.particle)];
            xpbd_.move_pin(pin.particle, (pin.x - x.head<3>()) / seconds_);
        }
        look_up(from, to);
        places_ = from;
        xpbd_.step(steps_, [&](taut::Index step) {
            const float share = float(step + 1) / float(steps_);
            for (std::size_t k = 0; k < bodies_.size(); ++k) {
                const Place next = ways_[k](share);
                touch(k, next);
                places_[k] = next;
            }
        });
    }
    const taut::State<float, 3>& state() { return xpbd_.state(); }

private:
    using Vector = Eigen::Vector4f;  // its last coordinate is 0

    static Vector four(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z(), 0}; }
    /// A body's segment in the world, m.
    struct Segment {
        Vector a, axis;
        float by_length2;  // 1/m²

        Segment(const Round& body, const Place& place)
            : a(four(place(body.a))), axis(four(place(body.b)) - a) {
            const float length2 = axis.squaredNorm();
            by_length2 = length2 > 0 ? 1 / length2 : 0.0f;
        }
        /// From the nearest point of it to x.
        Vector out(const Vector& x) const {
            const Vector from_a = x - a;
            const float along = std::clamp(from_a.dot(axis) * by_length2, 0.0f, 1.0f);
            return from_a - along * axis;
        }
    };
    /// Of each body the particles that may meet it within a frame: those that come near as fast as
    /// they go now, with 2 cm to spare.
    void look_up(const Places& from, const Places& to) {
        near_.assign(bodies_.size(), {});
        ways_.clear();
        for (std::size_t k = 0; k < bodies_.size(); ++k) {
            ways_.emplace_back(from[k], to[k]);
            const Segment now(bodies_[k], from[k]), then(bodies_[k], to[k]);
            const Vector end = now.a + now.axis, end_then = then.a + then.axis;
            const Vector gone = (then.a - now.a + end_then - end) / 2;
            const float turned = (then.a - now.a - gone).norm();
            const float reach = bodies_[k].radius + touch_.thickness + turned + 0.02f;
            for (std::size_t i = 0; i < free_.size(); ++i) {
                if (!free_[i]) continue;
                const Vector& x = xpbd_.places()[i];
                const Vector went = float(steps_) * (x - xpbd_.places_before()[i]) - gone;
                const float far = reach + went.norm();
                if (now.out(x).squaredNorm() < far * far) near_[k].push_back(int(i));
            }
        }
    }
    void touch(std::size_t k, const Place& next) {
        const Segment segment(bodies_[k], next);
        const float kept = bodies_[k].radius + touch_.thickness;
        // A point of the body goes from x to x + shift + turn x.
        const Eigen::Matrix3f turn = next.rotation * places_[k].rotation.transpose();
        const auto& before = xpbd_.places_before();
        for (const int at : near_[k]) {
            Vector& x = xpbd_.places()[std::size_t(at)];
            const Vector out = segment.out(x);
            const float length2 = out.squaredNorm();
            if (!(length2 < kept * kept) || !(length2 > 0)) continue;
            const float length = std::sqrt(length2), in = kept - length;
            const Vector normal = out / length;
            x += in * normal;
            const Eigen::Vector3f arm = x.head<3>() - next.position;
            const Vector carried =
                four(next.position - places_[k].position + arm - turn.transpose() * arm);
            Vector along = x - before[std::size_t(at)] - carried;
            along -= along.dot(normal) * normal;
            const float slid = along.norm(), held = touch_.friction * in;
            x -= slid > held ? Vector(held / slid * along) : along;
        }
    }

    XpbdOf<float> xpbd_;
    taut::Index steps_;
    float seconds_;
    std::vector<Round> bodies_;
    Touch touch_;
    std::vector<bool> free_;
    std::vector<std::vector<int>> near_;  // of each body
    std::vector<taut::contact_detail::Way<float, 3>> ways_;
    Places places_;  // at the end of the last step
};

}  // namespace bench
