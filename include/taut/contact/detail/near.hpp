// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "body.hpp"
#include "shared.hpp"

namespace taut::contact_detail {

/// A pair that touches and did not begin inside, or did so and has been out since.
struct KnownPair {
    int at, body;  // a place, or between frames a particle

    bool operator<(const KnownPair& other) const {
        return at != other.at ? at < other.at : body < other.body;
    }
};

/// Which particles are near which bodies, and for how long that holds: a list is of those within a
/// margin, and every other one knows how far it was from the nearest body that does not list it.
template <class Scalar, int Dim>
class NearList {
public:
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Bodies = std::vector<std::unique_ptr<Body<Scalar, Dim>>>;
    using Pair = SharedPair<Scalar, Dim>;
    using Access = PlaneAccess<Scalar, Dim>;

    using Register = step_detail::VectorRegister<Scalar>;

    std::vector<Pair>& shared() { return shared_; }
    const std::vector<Pair>& shared() const { return shared_; }
    void clear() { built_ = false; }
    bool built() const { return built_; }

    /// The pairs that touch and need not be pushed out gently, in order.
    void remember(const Bodies& bodies, std::vector<KnownPair>& known) const {
        known.clear();
        if (!built_) return;
        const auto add = [&](int place, std::size_t body, Scalar depth, Scalar cap) {
            if (depth > 0 && !detail::is_finite(cap))
                known.push_back({place, static_cast<int>(body)});
        };
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            const auto& solo = bodies[b]->solo;
            for (Index k = 0; k < solo.blocks * Register::width; ++k) {
                add(solo.place(k), b, solo.depth[k], solo.cap[k]);
            }
        }
        for (const Pair& pair : shared_)
            add(pair.place, static_cast<std::size_t>(pair.body), pair.depth, pair.cap);
        std::sort(known.begin(), known.end());
    }
    /// Lists what is near bodies at motion.next.
    /// @param known      of what touches there
    /// @param mass       by place, 0 if pinned   @param x  positions
    /// @param push_time  s, p₁ of what begins inside over the speed at which it is to be pushed out
    /// @param drift      m/s, of what counts as at rest   @param time  s
    void build(const Bodies& bodies, const std::vector<KnownPair>& known,
               const Buffer<Scalar>& mass, const Access& x, Index count, Scalar margin,
               Scalar push_time, const Vector& drift, Scalar time) {
        const Index padded = count + step_detail::max_width;
        const Scalar infinity = std::numeric_limits<Scalar>::infinity();
        slack_.assign(padded, infinity);
        near_.assign(count, 0);
        found_.resize(bodies.size());
        cluster(x, count);
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            found_[b].clear();
            look_at_clusters(*bodies[b], 2 * margin);
            depth_.resize(static_cast<Index>(close_.size()) * Register::width);
            bodies[b]->depths(x, close_, bodies[b]->motion.next, depth_.data());
            const Scalar* depth = depth_.data();
            for (const int i : close_) {
                const Register away = -Register::load(depth);
                const Register slack = Register::load(slack_.data() + i);
                const Register room = where_less(away, Register(margin), Register(infinity), away);
                where_less(room, slack, room, slack).store(slack_.data() + i);
                const Index end = (std::min)(count - i, Index(Register::width));
                if (!(largest_lane(-away) > -margin)) {
                    depth += Register::width;
                    continue;
                }
                for (Index k = 0; k < end; ++k) {
                    if (!(-depth[k] < margin) || !(mass[i + k] > 0)) continue;
                    found_[b].push_back(i + static_cast<int>(k));
                    ++near_[i + k];
                }
                depth += Register::width;
            }
        }
        for (Index i = 0; i < count; i += Register::width) {
            const Register slack = Register::load(slack_.data() + i);
            const Register all(cluster_slack_[i / Register::width]);
            where_less(all, slack, all, slack).store(slack_.data() + i);
        }
        shared_.clear();
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            Body<Scalar, Dim>& body = *bodies[b];
            int end = -1;  // of the last block
            body.solo.blocks = 0;
            for (const int place : found_[b]) {
                Pair pair{place, static_cast<int>(b), x.vector(place), {}, 0, infinity, 0, false};
                pair.depth = body.depth(pair.x, body.motion.next, pair.normal);
                pair.room = -pair.depth;
                if (pair.depth > 0 && !was_outside(known, pair)) {
                    pair.cap = push_time * static_cast<Scalar>(body.options.push_out);
                }
                if (near_[place] > 1) {
                    shared_.push_back(pair);
                    continue;
                }
                if (place >= end) {
                    const int first = place / Register::width * Register::width;
                    end = first + Register::width;
                    add_block(body.solo, first, x);
                }
                set(body.solo, body.solo.blocks * Register::width + place - end, pair, mass[place]);
            }
        }
        std::stable_sort(shared_.begin(), shared_.end(),
                         [](const Pair& a, const Pair& b) { return a.place < b.place; });
        for (int d = 0; d < Dim; ++d) {
            x_[d].resize(padded);
            for (Index i = 0; i < count; i += Register::width) x.row(d, i).store(x_[d].data() + i);
        }
        built_ = true;
        drift_ = drift;
        time_ = time;
        at_.clear();
        for (const auto& body : bodies) at_.push_back(body->motion.next);
    }

    /// The bodies are at motion.next, at that time, s: what holds() asks about.
    void go_to(const Bodies& bodies, Scalar time) {
        if (!built_) return;
        moved_ = 0;
        moves_.resize(bodies.size());
        gone_ = (time - time_) * drift_;
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            const Pose<Scalar, Dim>& pose = bodies[b]->motion.next;
            const Scalar turned = (pose.rotation - at_[b].rotation).norm();
            Scalar most = (pose.position - at_[b].position - gone_).norm();
            if (turned > 0) most += turned * bodies[b]->extent();
            moves_[b] = most;
            moved_ = (std::max)(moved_, most);
        }
        moved_ = (std::min)(moved_, (std::numeric_limits<Scalar>::max)());
    }
    /// Whether no particle can have met a body that does not list it, at places x.
    bool holds(const Access& x, Index count) const {
        if (!built_) return false;
        Register worst(-std::numeric_limits<Scalar>::infinity());
        for (Index i = 0; i < count; i += Register::width) worst = larger(worst, beyond(x, i));
        return largest_lane(worst) < 0;
    }
    /// ≥ 0 where that may be so, of a register of places.
    EIGEN_ALWAYS_INLINE Register beyond(const Access& x, Index i) const {
        const Register zero(Scalar(0));
        Register way2 = zero;
        for (int d = 0; d < Dim; ++d) {
            const Register way =
                x.row(d, i) - Register::load(x_[d].data() + i) - Register(gone_[d]);
            way2 += way * way;
        }
        const Register room = larger(Register::load(slack_.data() + i) - Register(moved_), zero);
        return way2 - room * room;
    }
    /// The same of one particle, by place.
    bool holds_of(const Access& x, int place) const {
        const Scalar room = (std::max)(slack_[place] - moved_, Scalar(0));
        return way2(x, place) < room * room;
    }
    /// Whether a particle has met none of the bodies that list it, by what was when they did.
    /// @param pairs  all of the particle
    bool away(const Access& x, const Pair* pairs, std::size_t count) const {
        const Scalar way = way2(x, pairs->place);
        for (std::size_t k = 0; k < count; ++k) {
            const Scalar room = pairs[k].room - moves_[static_cast<std::size_t>(pairs[k].body)];
            if (pairs[k].depth > 0 || !(room > 0) || !(way < room * room)) return false;
        }
        return true;
    }

private:
    /// The square of how far a particle has gone beside the drift, m².
    Scalar way2(const Access& x, int place) const {
        Scalar sum = 0;
        for (int d = 0; d < Dim; ++d) {
            const Scalar way = x(d, place) - x_[d][place] - gone_[d];
            sum += way * way;
        }
        return sum;
    }

    /// A ball around each register's worth of places.
    void cluster(const Access& x, Index count) {
        clusters_ = (count + Register::width - 1) / Register::width;
        stride_ = (clusters_ + 2 * step_detail::max_width) / Register::width * Register::width;
        centre_.assign(Dim * stride_, 0);
        radius_.assign(stride_, 0);
        cluster_slack_.assign(stride_, std::numeric_limits<Scalar>::infinity());
        cluster_depth_.resize(stride_);
        every_.clear();
        for (Index c = 0; c < clusters_; c += Register::width)
            every_.push_back(static_cast<int>(c));
        for (Index c = 0; c < clusters_; ++c) {
            const Index first = c * Register::width;
            const Index last = (std::min)(count, first + Register::width) - 1;
            Register radius2(Scalar(0));
            for (int d = 0; d < Dim; ++d) {
                const Scalar middle = (x(d, first) + x(d, last)) / 2;
                centre_[d * stride_ + c] = middle;
                const Register way = x.row(d, first) - Register(middle);
                radius2 += way * way;
            }
            radius_[c] = std::sqrt(largest_lane(radius2));
        }
    }
    /// Lists the clusters that may be within `far` of a body, m, and how far the others are.
    void look_at_clusters(const Body<Scalar, Dim>& body, Scalar far) {
        body.depths(Access(centre_.data(), stride_), every_, body.motion.next,
                    cluster_depth_.data());
        close_.clear();
        for (Index c = 0; c < clusters_; c += Register::width) {
            const Register away =
                -(Register::load(cluster_depth_.data() + c) + Register::load(radius_.data() + c));
            away.store(cluster_depth_.data() + c);
            const Register slack = Register::load(cluster_slack_.data() + c);
            const Register room = where_less(Register(far), away, away, slack);
            where_less(room, slack, room, slack).store(cluster_slack_.data() + c);
            if (!(largest_lane(-away) >= -far)) continue;
            const Index end = (std::min)(clusters_, c + Register::width);
            for (Index k = c; k < end; ++k) {
                if (far < cluster_depth_[k]) continue;
                close_.push_back(static_cast<int>(k * Register::width));
            }
        }
    }

    static bool was_outside(const std::vector<KnownPair>& known, const Pair& pair) {
        return std::binary_search(known.begin(), known.end(), KnownPair{pair.place, pair.body});
    }
    static void add_block(SoloPairs<Scalar, Dim>& solo, int first, const Access& x) {
        const Index at = solo.blocks++ * Register::width, size = at + Register::width;
        solo.first.resize(solo.blocks, first);
        solo.first[solo.blocks - 1] = first;
        for (auto* of : {&solo.depth, &solo.cap, &solo.mass}) of->resize(size, Scalar(0));
        Register(Scalar(-1)).store(solo.depth.data() + at);
        Register(std::numeric_limits<Scalar>::infinity()).store(solo.cap.data() + at);
        Register(Scalar(0)).store(solo.mass.data() + at);
        for (int d = 0; d < Dim; ++d) {
            solo.x[d].resize(size, Scalar(0));
            solo.normal[d].resize(size, Scalar(0));
            x.row(d, first).store(solo.x[d].data() + at);
            Register(Scalar(0)).store(solo.normal[d].data() + at);
        }
    }
    static void set(SoloPairs<Scalar, Dim>& solo, Index k, const Pair& pair, Scalar mass) {
        solo.depth[k] = pair.depth;
        solo.cap[k] = pair.cap;
        solo.mass[k] = mass;
        for (int d = 0; d < Dim; ++d) solo.normal[d][k] = pair.normal[d];
    }

    std::vector<Pair> shared_;        // by place
    std::vector<Buffer<int>> found_;  // of each body
    Buffer<Scalar> slack_;            // of each place, m
    Buffer<Scalar> depth_;            // of close_
    Index clusters_ = 0, stride_ = 0;
    Buffer<Scalar> centre_;               // planes, m
    Buffer<Scalar> radius_;               // m
    Buffer<Scalar> cluster_slack_;        // m
    Buffer<Scalar> cluster_depth_;        // of one body, m
    Buffer<int> every_, close_;           // first clusters of registers, first places of clusters
    Buffer<int> near_;                    // bodies that list it
    detail::Few<Buffer<Scalar>, Dim> x_;  // where they were, m
    std::vector<Pose<Scalar, Dim>> at_;
    Vector drift_ = Vector::Zero();
    Scalar time_ = 0;
    Scalar moved_ = 0;      // how far a body's points have gone at most, beside the drift, m
    Buffer<Scalar> moves_;  // of each body
    Vector gone_ = Vector::Zero();  // and that, m
    bool built_ = false;
};

}  // namespace taut::contact_detail
