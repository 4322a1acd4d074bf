// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "motion.hpp"

namespace taut::contact_detail {

/// How far particles have gone from each other since a time. By strips of the places: two strips
/// that were far apart may go far, and within a strip particles go much the same way.
template <class Scalar, int Dim>
class Spread {
public:
    using Layout = step_detail::Layout<Scalar>;

    /// Starts at x, planes, m. @param widest  what touches is less than that apart, m
    void start(const Layout& layout, const Scalar* x, Scalar widest) {
        from_.resize(layout.planes() * layout.stride());
        std::copy_n(x, from_.size(), from_.data());
        none_.assign(from_.size(), Scalar(0));
        look(layout, x, none_.data());
        for (int a = 0, k = 0; a < used_; ++a) {
            for (int b = a; b < used_; ++b, ++k) {
                Scalar gap2 = 0;
                for (int d = 0; d < Dim; ++d) {
                    const Scalar gap = (std::max)(
                        {least_[d][b] - most_[d][a], least_[d][a] - most_[d][b], Scalar(0)});
                    gap2 += gap * gap;
                }
                gap_[k] = std::sqrt(gap2) - widest;
            }
        }
    }
    /// Looks where particles are now, planes, m.
    /// @param skin  what is farther apart is not of interest, as long as it does not touch, m
    void operator()(const Layout& layout, const Scalar* x, Scalar skin) {
        look(layout, x, from_.data());
        gone_ = 0;
        room_ = std::numeric_limits<Scalar>::infinity();
        for (int a = 0, k = 0; a < used_; ++a) {
            for (int b = a; b < used_; ++b, ++k) {
                Scalar way2 = 0;
                for (int d = 0; d < Dim; ++d) {
                    const Scalar way = (std::max)(most_[d][a], most_[d][b]) -
                                       (std::min)(least_[d][a], least_[d][b]);
                    way2 += way * way;
                }
                const Scalar way = std::sqrt(way2) / Scalar(0.98);
                if (gap_[k] < skin) {
                    gone_ = way > gone_ ? way : gone_;
                } else if (!(gap_[k] - way >= room_)) {
                    room_ = gap_[k] - way;
                }
            }
        }
    }
    /// How much nearer to each other any two may be that the skin is for, m.
    Scalar gone() const { return gone_; }
    /// How much nearer any others may still come before they touch, m.
    Scalar room() const { return room_; }

private:
    using Register = step_detail::VectorRegister<Scalar>;
    static constexpr int strips = 8;
    /// Registers side by side: a whole number of points where planes have these.
    static constexpr int at_once = 4;
    static constexpr int group = at_once * Register::width;

    /// The box of the ways from one to the other of each strip.
    void look(const Layout& layout, const Scalar* to, const Scalar* from) {
        const Index all = layout.size() * layout.grain();
        const Index size = (all + strips * group - 1) / (strips * group) * group;
        const Scalar infinity = std::numeric_limits<Scalar>::infinity();
        for (int d = 0; d < Dim; ++d) {
            least_[d].fill(infinity);
            most_[d].fill(-infinity);
        }
        used_ = 0;
        for (int strip = 0; strip * size < all; strip = ++used_) {
            for (int plane = 0; plane < layout.planes(); ++plane) {
                const Index first = plane * layout.stride() + strip * size;
                const Index count = (std::min)(size, all - strip * size);
                look(layout.has_stars() ? -1 : plane, strip, to + first, from + first, count);
            }
        }
    }
    /// @param axis  of the plane, or −1 of points
    void look(int axis, int strip, const Scalar* to, const Scalar* from, Index count) {
        detail::Few<Register, at_once> most, back;  // the other way
        most.fill(Register(-std::numeric_limits<Scalar>::infinity()));
        back = most;
        Index i = 0;
        for (; i + group <= count; i += group) {
            for (int k = 0; k < at_once; ++k) {
                const Register now = Register::load(to + i + k * Register::width);
                const Register then = Register::load(from + i + k * Register::width);
                most[k] = larger(most[k], now - then);
                back[k] = larger(back[k], then - now);
            }
        }
        for (; i < count; ++i) see(axis < 0 ? int(i % 4) : axis, strip, to[i] - from[i]);
        if (count < group) return;
        if (axis >= 0) {
            for (int k = 1; k < at_once; ++k) {
                most[0] = larger(most[0], most[k]);
                back[0] = larger(back[0], back[k]);
            }
            see(axis, strip, largest_lane(most[0]));
            see(axis, strip, -largest_lane(back[0]));
            return;
        }
        for (int k = 0; k < at_once; ++k) {
            detail::Few<Scalar, Register::width> high, low;
            most[k].store(high.data());
            (-back[k]).store(low.data());
            for (int lane = 0; lane < Register::width; ++lane) {
                see((k * Register::width + lane) % 4, strip, high[lane]);
                see((k * Register::width + lane) % 4, strip, low[lane]);
            }
        }
    }
    void see(int d, int strip, Scalar way) {
        if (d >= Dim) return;
        least_[d][strip] = (std::min)(least_[d][strip], way);
        most_[d][strip] = (std::max)(most_[d][strip], way);
    }

    Buffer<Scalar> from_, none_;                                  // planes, m; of zeros
    detail::Few<detail::Few<Scalar, strips>, Dim> least_, most_;  // of ways, m
    detail::Few<Scalar, strips*(strips + 1) / 2> gap_;            // between strips at the start, m
    int used_ = 0;                                                // strips with places
    Scalar gone_ = 0, room_ = 0;
};

}  // namespace taut::contact_detail
