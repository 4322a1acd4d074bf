// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <limits>

#include "ball_pairs.hpp"
#include "spread.hpp"

namespace taut::contact_detail {

/// The pairs of balls that may touch, as far as particles have gone since they were listed. A pair
/// that does not count touches neither where a step begins nor where it ends.
template <class Scalar, int Dim>
class BallList {
public:
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Layout = step_detail::Layout<Scalar>;
    using Memory = step_detail::StateMemory<Scalar>;

    BallPairs<Scalar, Dim> pairs;

    void forget() { listed_ = false; }
    /// How often pairs were listed.
    Index lookups() const { return lookups_; }
    Scalar load() const { return pairs.heaviest_load(); }

    /// Counts those that may touch before two particles at x, Dim × n, finite, m, have moved a
    /// quarter of the widest pair towards each other. @param seen  whether the last look was there
    void list(const Points<Scalar, Dim>& x, bool seen) {
        const Scalar within = pairs.widest() / 4;
        if (!(within > 0)) return;
        Scalar gone = spread_.gone();
        if (listed_ && !(seen && looked_)) {
            Vector least = x.col(0) - x_.col(0), most = least;
            for (Index i = 1; i < x.cols(); ++i) {
                const Vector way = x.col(i) - x_.col(i);
                least = least.cwiseMin(way);
                most = most.cwiseMax(way);
            }
            gone = (most - least).norm() / Scalar(0.98);
        }
        const bool stale = gone > within && pairs.begin() < pairs.end();
        if (!listed_ || stale || !(2 * gone < pairs.skin())) {
            x_ = x;
            build(pairs.widest());
            looked_ = false;
            gone = 0;
        }
        pairs.count_within(gone + within);
    }
    /// Before the first step of a try, of h, s: where it began its pairs must count, too.
    void start(const Layout& layout, const Memory& memory, Scalar h) {
        old_.resize(memory.whole());
        layout.to_planes(x_, old(memory), layout.all());
        spread_.start(layout, old_.data(), pairs.widest());
        go_back(memory, h);
        look(layout, old_.data());
        begun_ = spread_.room() > 0 ? spread_.gone() : pairs.skin();
    }
    /// Looks how far particles have gone. @param x  planes, after a step, m
    void look(const Layout& layout, const Scalar* x) {
        ++age_;
        looked_ = true;
        spread_(layout, x, pairs.skin());
    }
    /// Counts all that may touch if any two come nearer by `more`, m. @returns false where the list
    /// does not reach so far
    bool count(Scalar more) {
        const Scalar need = (std::max)(begun_, spread_.gone() + more);
        if (!(need < pairs.skin()) || !(more < spread_.room())) return false;
        pairs.count_within(need);
        return true;
    }
    /// Whether all of them count.
    bool covers(Scalar more) const {
        return spread_.gone() + more < pairs.reach() && more < spread_.room();
    }
    /// Whether another list would cost more than it is good for.
    bool is_young() const { return age_ < 16; }
    /// Lists pairs anew where the step began, to reach as far as that. @returns whether it is
    /// finite
    bool look_back(const Layout& layout, const Memory& memory, Scalar h, Scalar more) {
        go_back(memory, h);
        layout.from_planes(old(memory), x_, layout.all());
        spread_.start(layout, old_.data(), pairs.widest());
        const Scalar* x = memory.planes().x.first;
        spread_(layout, x, std::numeric_limits<Scalar>::infinity());
        const Scalar skin = (std::max)(pairs.widest(), 2 * (spread_.gone() + more));
        if (!detail::all_finite(x_) || !detail::is_finite(skin * skin)) return false;
        build(skin);
        spread_(layout, x, skin);
        begun_ = 0;
        return true;
    }

private:
    void build(Scalar skin) {
        ++lookups_;
        age_ = 0;
        pairs.build(x_, skin);
        listed_ = true;
    }
    /// To where the step began.
    void go_back(const Memory& memory, Scalar h) {
        const auto& planes = memory.planes();
        step_detail::add_scaled(planes.x.first, -h, planes.v.first, old_.data(), memory.whole());
    }
    step_detail::Planes<Scalar> old(const Memory& memory) {
        return {old_.data(), memory.planes().x.stride};
    }

    bool listed_ = false, looked_ = false;  // this list
    Points<Scalar, Dim> x_;                 // where particles were listed, m
    Spread<Scalar, Dim> spread_;
    Scalar begun_ = 0;             // of it where the try began
    Buffer<Scalar> old_;           // planes, m
    Index lookups_ = 0, age_ = 0;  // of the list, looks
};

}  // namespace taut::contact_detail
