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

/// A pair of a body's near_pairs.
struct Link {
    int body, pair;
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

    void clear() { built_ = false; }
    bool built() const { return built_; }

    /// The pairs that touch and need not be pushed out gently, in order.
    void remember(const Bodies& bodies, std::vector<KnownPair>& known) const {
        known.clear();
        if (!built_) return;
        each_touching(bodies, [&](const Pair& pair) {
            if (!detail::is_finite(pair.cap)) known.push_back({pair.place, pair.body});
        });
        std::sort(known.begin(), known.end());
    }
    /// visit(pair) for every listed pair with p > 0, by the end of the last step.
    template <class Visitor>
    void each_touching(const Bodies& bodies, Visitor&& visit) const {
        for (int b = 0; b < static_cast<int>(bodies.size()); ++b) {
            auto& pairs = bodies[static_cast<std::size_t>(b)]->near_pairs;
            for (int k = 0; k < static_cast<int>(pairs.count); ++k) {
                if (pairs.now.depth()[k] > 0) visit(pair(bodies, {b, k}));
            }
        }
    }
    Pair pair(const Bodies& bodies, const Link& link) const {
        auto& pairs = bodies[static_cast<std::size_t>(link.body)]->near_pairs;
        return {pairs.place[link.pair],          link.body,
                pairs.now.x().vector(link.pair), pairs.now.normal().vector(link.pair),
                pairs.now.depth()[link.pair],    pairs.now.cap()[link.pair]};
    }
    /// Particles that are near several bodies.
    Index several() const { return several_; }
    /// visit(link) for each pair of one of them, by body.
    template <class Visitor>
    void each_link(int several, Visitor&& visit) const {
        for (int l = first_link_[several]; l < first_link_[several + 1]; ++l) visit(links_[l]);
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
            look_closely(*bodies[b], x);
            const Scalar* depth = rows_.depth();
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
                    near_[i + k] += bodies[b]->convex ? 1 : 1 + by_itself;
                }
                depth += Register::width;
            }
        }
        for (Index i = 0; i < count; i += Register::width) {
            const Register slack = Register::load(slack_.data() + i);
            const Register all(cluster_slack_[i / Register::width]);
            where_less(all, slack, all, slack).store(slack_.data() + i);
        }
        list_several(count);
        for (std::size_t b = 0; b < bodies.size(); ++b)
            fill(*bodies[b], static_cast<int>(b), known, mass, x, push_time);
        for (int d = 0; d < Dim; ++d) {
            x_[d].resize(padded);
            for (Index i = 0; i < count; i += Register::width) x.row(d, i).store(x_[d].data() + i);
        }
        built_ = true;
        drift_ = drift;
        time_ = time;
        for (const auto& body : bodies) body->list();
    }

    /// The bodies are at motion.next, at that time, s: what holds() asks about.
    void go_to(const Bodies& bodies, Scalar time) {
        if (!built_) return;
        moved_ = 0;
        gone_ = (time - time_) * drift_;
        for (std::size_t b = 0; b < bodies.size(); ++b) {
            moved_ = (std::max)(moved_, bodies[b]->reach(gone_));
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

private:
    /// Of a body whose push may not hold, and then is solved; more than bodies can be.
    static constexpr int by_itself = 1 << 16;

    /// Numbers those that are near several bodies, or are to be solved by themselves, in the place
    /// of how many.
    void list_several(Index count) {
        several_ = 0;
        first_link_.clear();
        int links = 0;
        for (Index i = 0; i < count; ++i) {
            const int bodies = near_[i] % by_itself;
            const bool solo = near_[i] < 2;
            near_[i] = -1;
            if (solo) continue;
            first_link_.push_back(links);
            near_[i] = static_cast<int>(several_++);
            links += bodies;
        }
        first_link_.push_back(links);
        links_.resize(links);
        filled_.assign(several_, 0);
    }
    void fill(Body<Scalar, Dim>& body, int b, const std::vector<KnownPair>& known,
              const Buffer<Scalar>& mass, const Access& x, Scalar push_time) {
        NearPairs<Scalar, Dim>& pairs = body.near_pairs;
        const Buffer<int>& found = found_[static_cast<std::size_t>(b)];
        pairs.begin(static_cast<Index>(found.size()));
        for (int k = 0; k < static_cast<int>(pairs.count); ++k) {
            const int place = pairs.place[k] = found[k], several = near_[place];
            pairs.mass[k] = mass[place];
            pairs.several[k] = several;
            if (several < 0) continue;
            pairs.mixed[k / Register::width] = 1;
            links_[first_link_[several] + filled_[several]++] = {b, k};
        }
        x.gather(pairs.place.data(), pairs.size, pairs.now.x());
        body.query(pairs.place.data(), pairs.now.x(), pairs.size, pairs.now.depth(),
                   pairs.now.normal());
        for (Index k = 0; k < pairs.size; ++k) {
            Scalar& depth = pairs.now.depth()[k];
            if (!(pairs.mass[k] > 0)) depth = -1;
            const bool gently = depth > 0 && !std::binary_search(known.begin(), known.end(),
                                                                 KnownPair{pairs.place[k], b});
            pairs.now.cap()[k] =
                gently ? body.cap(push_time) : std::numeric_limits<Scalar>::infinity();
        }
    }

    /// A ball around each register's worth of places.
    void cluster(const Access& x, Index count) {
        clusters_ = (count + Register::width - 1) / Register::width;
        stride_ = (clusters_ + 2 * step_detail::max_width) / Register::width * Register::width;
        centre_.assign(Dim * stride_, 0);
        radius_.assign(stride_, 0);
        cluster_slack_.assign(stride_, std::numeric_limits<Scalar>::infinity());
        cluster_depth_.resize(stride_);
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
    /// Lists the clusters that may be within `reach` of a body, m, and how far the others are.
    void look_at_clusters(const Body<Scalar, Dim>& body, Scalar reach) {
        close_.clear();
        if (body.of_particles) {
            for (Index c = 0; c < clusters_; ++c)
                close_.push_back(static_cast<int>(c * Register::width));
            return;
        }
        rows_.resize(stride_);
        const Index whole = whole_registers<Scalar>(clusters_);
        body.query(nullptr, Access(centre_.data(), stride_), whole, cluster_depth_.data(),
                   rows_.normal());
        for (Index c = 0; c < clusters_; c += Register::width) {
            const Register away =
                -(Register::load(cluster_depth_.data() + c) + Register::load(radius_.data() + c));
            away.store(cluster_depth_.data() + c);
            const Register slack = Register::load(cluster_slack_.data() + c);
            const Register room = where_less(Register(reach), away, away, slack);
            where_less(room, slack, room, slack).store(cluster_slack_.data() + c);
            if (!(largest_lane(-away) >= -reach)) continue;
            const Index end = (std::min)(clusters_, c + Register::width);
            for (Index k = c; k < end; ++k) {
                if (reach < cluster_depth_[k]) continue;
                close_.push_back(static_cast<int>(k * Register::width));
            }
        }
    }

    /// How deep the places of close clusters are.
    void look_closely(const Body<Scalar, Dim>& body, const Access& x) {
        const Index size = static_cast<Index>(close_.size()) * Register::width;
        rows_.resize(size);
        places_.resize(size);
        const Access at = rows_.x();
        for (Index k = 0; k < size; k += Register::width) {
            const int first = close_[k / Register::width];
            for (int d = 0; d < Dim; ++d) x.row(d, first).store(&at(d, k));
            for (int lane = 0; lane < Register::width; ++lane) places_[k + lane] = first + lane;
        }
        body.query(places_.data(), at, size, rows_.depth(), rows_.normal());
    }

    std::vector<Buffer<int>> found_;   // of each body
    Buffer<Scalar> slack_;             // of each place, m
    PairTable<Scalar, Dim> rows_;      // of what is looked at
    Buffer<int> near_;                 // bodies that list a place, then its index among several_
    Index several_ = 0;                // particles near several bodies
    Buffer<int> first_link_, filled_;  // of each of them: its links; how many are there
    Buffer<Link> links_;
    Index clusters_ = 0, stride_ = 0;
    Buffer<Scalar> centre_;               // planes, m
    Buffer<Scalar> radius_;               // m
    Buffer<Scalar> cluster_slack_;        // m
    Buffer<Scalar> cluster_depth_;        // of one body, m
    Buffer<int> places_;                  // of rows_
    Buffer<int> close_;                   // first places of clusters
    detail::Few<Buffer<Scalar>, Dim> x_;  // where they were, m
    Vector drift_ = Vector::Zero();
    Scalar time_ = 0;
    Scalar moved_ = 0;  // how far a body's points have gone at most, beside the drift, m
    Vector gone_ = Vector::Zero();  // and that, m
    bool built_ = false;
};

}  // namespace taut::contact_detail
