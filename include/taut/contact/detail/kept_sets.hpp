// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "push.hpp"

namespace taut::contact_detail {

/// What a particle is kept in: how it lies in a frame's begin and end.
template <class Scalar, int Dim>
struct KeptSet {
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;

    Index particle;
    Scalar radius;                                    // m
    Vector begin = Vector::Zero(), end = begin;       // its place, m
    Vector begin_normal = begin, end_normal = begin;  // unit, where it has one
    Scalar behind = 0;                                // of its place, against the normal, m
    Index anchor = -1;                                // a pin, where that is the place

    Vector place(Scalar share) const { return begin + share * (end - begin); }
    Vector normal(Scalar share) const {
        const Vector between = begin_normal + share * (end_normal - begin_normal);
        const Scalar length = between.norm();
        return length > Scalar(0.001) ? Vector(between / length) : end_normal;
    }
};

/// Sets that single particles are kept in, of one kind, at most one each [T40]. They are asked like
/// bodies, by the share of the frame that has passed.
template <class Scalar, int Dim>
class KeptSets : public Body<Scalar, Dim> {
public:
    using Base = Body<Scalar, Dim>;
    using typename Base::Access;
    using typename Base::Vector;
    using Set = KeptSet<Scalar, Dim>;

    /// @param size  of the system
    KeptSets(const BodyOptions& how, bool is_convex, Index size) : Base(how, is_convex) {
        this->of_particles = true;
        index_.assign(size, -1);
    }
    virtual Scalar depth_of(const Set& set, const Vector& x, Scalar share,
                            Vector& normal) const = 0;

    const std::vector<Set>& sets() const { return sets_; }
    std::vector<Set>& sets() { return sets_; }
    /// The set of a particle, or null.
    const Set* of(Index particle) const {
        // The system may have more particles by now.
        const int k = particle < static_cast<Index>(index_.size()) ? index_[particle] : -1;
        return k < 0 ? nullptr : &sets_[static_cast<std::size_t>(k)];
    }
    /// Gives a particle a set, in the place of the one that it has.
    void put(const Set& set) {
        if (const Set* old = of(set.particle)) {
            sets_[static_cast<std::size_t>(old - sets_.data())] = set;
            return;
        }
        index_[set.particle] = static_cast<int>(sets_.size());
        sets_.push_back(set);
    }
    void remove(Index particle) {
        const int k = index_[particle];
        if (k < 0) return;
        sets_[static_cast<std::size_t>(k)] = sets_.back();
        index_[sets_.back().particle] = k;
        index_[particle] = -1;
        sets_.pop_back();
    }

    Scalar depth(int place, const Vector& x, bool end, Vector& normal) const final {
        return depth_of(at(place), x, end ? next_ : now_, normal);
    }
    void query(const int* place, const Access& x, Index count, Scalar* depth,
               const Access& normal) const final {
        for (Index k = 0; k < count; ++k) {
            Vector n = Vector::Zero();
            const bool has = place[k] < static_cast<Index>(at_.size()) && at_[place[k]] >= 0;
            depth[k] = has ? listed_depth(at(place[k]), x.vector(k), n)
                           : -std::numeric_limits<Scalar>::infinity();
            normal.set(k, n);
        }
    }
    double energy(const Penalty<Scalar>& penalty, Scalar push_time, Index particle, const Vector& x,
                  Scalar mass, bool end) const final {
        const Set* set = of(particle);
        if (!set) return 0;
        Vector normal;
        const Scalar depth = depth_of(*set, x, Scalar(end), normal);
        return penalty.energy(depth, this->cap(push_time), mass);
    }
    void push(const Penalty<Scalar>& penalty) final {
        using Register = step_detail::VectorRegister<Scalar>;
        using Vectors = detail::Few<Register, Dim>;
        auto& pairs = this->near_pairs;
        detail::Few<detail::Few<Scalar, Register::width>, Dim> lanes, normals;
        const auto carry = [&](Index at, Vectors& x, Vectors& n) {
            for (int lane = 0; lane < Register::width; ++lane) {
                Vector normal = pairs.now.normal().vector(at + lane);
                Vector to = pairs.now.x().vector(at + lane);
                if (pairs.mass[at + lane] > 0) {
                    to = this->carry(pairs.place[at + lane], to, normal, false);
                }
                for (int d = 0; d < Dim; ++d) {
                    lanes[d][lane] = to[d];
                    normals[d][lane] = normal[d];
                }
            }
            for (int d = 0; d < Dim; ++d) {
                x[d] = Register::load(lanes[d].data());
                n[d] = Register::load(normals[d].data());
            }
        };
        contact_detail::push<Scalar, Dim>(*this, carry, penalty);
    }
    void know(const Buffer<int>& places) final {
        at_.assign(static_cast<Index>(places.size()), -1);
        for (std::size_t k = 0; k < sets_.size(); ++k)
            at_[places[sets_[k].particle]] = static_cast<int>(k);
    }
    Vector start(Scalar frame) final {
        now_ = next_ = 0;
        prepare(frame);
        drift_ = Vector::Zero();
        for (const Set& set : sets_)
            drift_ += (set.end - set.begin) / static_cast<Scalar>(sets_.size());
        spread_ = 0;
        for (const Set& set : sets_)
            spread_ = (std::max)(spread_, (set.end - set.begin - drift_).norm());
        return drift_;
    }
    void go_to(Scalar share) final {
        now_ = next_;
        next_ = share;
    }
    void swap() final { std::swap(now_, next_); }
    void settle() final {
        for (Set& set : sets_) {
            set.begin = set.end;
            set.begin_normal = set.end_normal;
        }
    }
    void list() final { listed_ = next_; }
    Scalar reach(const Vector& beside) const final { return moved(next_ - listed_, beside); }
    Scalar frame_reach(const Vector& beside) const final { return moved(1, beside); }
    Vector gone() const final { return (next_ - now_) * drift_; }

protected:
    /// Before it is asked for ways in a frame, s.
    virtual void prepare(Scalar) {}
    /// At most what reach() bounds goes into that.
    virtual Scalar listed_depth(const Set& set, const Vector& x, Vector& normal) const {
        return depth_of(set, x, next_, normal);
    }
    /// How far the sets go at most in a share of the frame, beside a way of everything, m.
    virtual Scalar moved(Scalar share, const Vector& beside) const {
        return (share * drift_ - beside).norm() + spread_ * (std::abs)(share);
    }
    const Set& at(int place) const { return sets_[static_cast<std::size_t>(at_[place])]; }

    Scalar now_ = 0, next_ = 0;  // shares of the frame, where the step begins and ends

private:
    std::vector<Set> sets_;
    Buffer<int> index_;  // of particles' sets
    Buffer<int> at_;     // of those at places
    Scalar listed_ = 0;
    Vector drift_ = Vector::Zero();  // in the frame, m
    Scalar spread_ = 0;              // beside it, m
};

/// Balls around places, or around pins.
template <class Scalar, int Dim>
class KeptInBalls : public KeptSets<Scalar, Dim> {
public:
    using Base = KeptSets<Scalar, Dim>;
    using typename Base::Set;
    using typename Base::Vector;

    explicit KeptInBalls(Index size) : Base({}, false, size) {}

    Scalar depth_of(const Set& set, const Vector& x, Scalar share, Vector& normal) const override {
        const Vector out = x - set.place(share);
        const Scalar length = out.norm();
        normal = length > 0 ? Vector(-out / length) : Vector(Vector::Unit(Dim - 1));
        return length - set.radius;
    }
    Vector carry(int place, const Vector& x, Vector&, bool back) const override {
        const Set& set = this->at(place);
        const Vector way = set.place(this->next_) - set.place(this->now_);
        return back ? Vector(x - way) : Vector(x + way);
    }
    bool meets(int, const Vector&, const Vector&) const override { return false; }
    Scalar quick() const override { return std::numeric_limits<Scalar>::infinity(); }
    void open(const State<Scalar, Dim>& state) override {
        for (Set& set : this->sets()) {
            if (set.anchor < 0 || set.anchor >= state.x.cols()) continue;
            set.begin = state.x.col(set.anchor);
            set.end_normal = state.v.col(set.anchor);
        }
    }

protected:
    void prepare(Scalar frame) override {
        for (Set& set : this->sets()) {
            if (set.anchor >= 0) set.end = set.begin + frame * set.end_normal;
        }
    }
};

/// All but balls behind a skin, or all before planes there.
template <class Scalar, int Dim>
class KeptBefore final : public KeptSets<Scalar, Dim> {
public:
    using Base = KeptSets<Scalar, Dim>;
    using typename Base::Set;
    using typename Base::Vector;

    explicit KeptBefore(Index size) : Base({}, true, size) {}

    Scalar depth_of(const Set& set, const Vector& x, Scalar share, Vector& normal) const override {
        normal = set.normal(share);
        const Vector from = x - set.place(share) + set.behind * normal;
        if (!detail::is_finite(set.radius)) return -normal.dot(from);
        // A difference of squares: of large radii little would be left.
        const Vector out = from + set.radius * normal;
        const Scalar length = out.norm();
        const Scalar depth = -from.dot(from + 2 * set.radius * normal) / (length + set.radius);
        if (length > 0) normal = out / length;
        return depth;
    }
    Vector carry(int place, const Vector& x, Vector& normal, bool back) const override {
        const Set& set = this->at(place);
        const Scalar from = back ? this->next_ : this->now_, to = back ? this->now_ : this->next_;
        const Vector a = set.normal(from), b = set.normal(to);
        const Vector y = x - set.place(from) + set.behind * a;
        normal = turned(a, b, normal);
        return set.place(to) - set.behind * b + turned(a, b, y);
    }
    bool meets(int place, const Vector& from, const Vector& to) const override {
        const Set& set = this->at(place);
        if (!detail::is_finite(set.radius)) return false;
        // In the ball's frame.
        Vector unused = Vector::Zero();
        const Vector m = set.normal(this->now_);
        const Vector centre = set.place(this->now_) - (set.behind + set.radius) * m;
        const Vector a = from - centre, way = carry(place, to, unused, true) - from;
        const Scalar length2 = way.squaredNorm();
        if (!(length2 > 0)) return false;
        const Scalar share = (std::min)((std::max)(-a.dot(way) / length2, Scalar(0)), Scalar(1));
        return (a + share * way).norm() < set.radius;
    }
    Scalar quick() const override { return 0; }

protected:
    Scalar listed_depth(const Set& set, const Vector& x, Vector& normal) const override {
        const Scalar depth = depth_of(set, x, this->next_, normal);
        const Scalar beside = (x - set.place(this->next_)).norm();
        return (std::max)(depth, beside > far_off ? Scalar(0) : -clear);
    }
    Scalar moved(Scalar share, const Vector& beside) const override {
        return Base::moved(share, beside) +
               (std::min)(turn_ * (std::abs)(share), Scalar(2)) * span_;
    }
    void prepare(Scalar) override {
        turn_ = 0;
        span_ = far_off + 2 * clear;
        for (const Set& set : this->sets()) {
            const Scalar cosine = set.begin_normal.dot(set.end_normal);
            const Scalar least = std::sqrt((std::max)((1 + cosine) / 2, Scalar(1e-6)));
            turn_ = (std::max)(turn_, (set.end_normal - set.begin_normal).norm() / least);
            span_ = (std::max)(span_, far_off + 2 * clear + set.behind);
        }
    }

private:
    /// What is farther from its skin is always listed, m: a turn moves it much. And how far from
    /// what it is kept before a particle is that is not, m.
    static constexpr Scalar far_off = Scalar(0.25), clear = Scalar(0.1);

    /// By an isometry that takes a to b.
    static Vector turned(const Vector& a, const Vector& b, const Vector& y) {
        const Scalar cosine = a.dot(b);
        if (cosine < 0) {
            const Vector d = (b - a).normalized();
            return y - 2 * d.dot(y) * d;
        }
        return y - (a + b).dot(y) / (1 + cosine) * (a + b) + 2 * a.dot(y) * b;
    }

    Scalar turn_ = 0;  // of normals in the frame, at most
    Scalar span_ = 0;  // that a turn moves, m
};

}  // namespace taut::contact_detail
