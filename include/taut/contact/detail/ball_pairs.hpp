// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "motion.hpp"

namespace taut::contact_detail {

/// Two balls that may touch.
template <class Scalar>
struct BallPair {
    int a, b;          // particles
    Scalar apart;      // R, the sum of the radii, m
    Scalar stiffness;  // κ, N/m
    Scalar room;       // between the balls when they were listed, m
};

/// Balls around particles, and which of them are near each other. Found once for a skin, m, and
/// counted only as far as particles have gone since: until then there is nothing to look at.
template <class Scalar, int Dim>
class BallPairs {
public:
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Pair = BallPair<Scalar>;

    Buffer<Scalar> radius;        ///< m
    Buffer<Scalar> inverse_mass;  ///< 1/kg, 0 if pinned
    Scalar by_mass = 0;           ///< κ of a pair over the mass of its lighter particle, 1/s²

    /// Makes room, so that lists as long as one of `pairs` a ball need no memory of their own.
    void reserve(Index pairs) {
        const auto count = static_cast<Index>(radius.size());
        for (auto* of : {&found_, &pairs_})
            of->reserve(static_cast<std::size_t>(count * (std::min)(pairs, count)));
        for (table_ = 64; table_ < 2 * count;) table_ *= 2;
        begin_.resize(table_ + 1);
        for (auto* of : {&items_, &slot_}) of->resize(count);
        for (int d = 0; d < Dim; ++d) x_[d].assign(count + step_detail::max_width, Scalar(0));
        largest_ = 0;
        for (const Scalar r : radius) largest_ = (std::max)(largest_, r);
    }
    /// The springs' ends, which make no pairs. @param for_each  calls visit(a, b) for each spring
    template <class ForEach>
    void exclude(const ForEach& for_each) {
        const auto count = radius.size();
        first_joined_.assign(count + 1, 0);
        for_each([&](Index a, Index b) { ++first_joined_[(std::min)(a, b) + 1]; });
        for (std::size_t i = 0; i < count; ++i) first_joined_[i + 1] += first_joined_[i];
        joined_.resize(first_joined_[count]);
        for_each([&](Index a, Index b) {
            joined_[first_joined_[(std::min)(a, b)]++] = static_cast<int>((std::max)(a, b));
        });
        for (std::size_t i = count; i > 0; --i) first_joined_[i] = first_joined_[i - 1];
        first_joined_[0] = 0;
    }

    /// The width of two of the largest balls, m.
    Scalar widest() const { return 2 * largest_; }
    /// Of the list, m: any other two are as far from touching, at least.
    Scalar skin() const { return skin_; }
    /// Of the pairs that count, m: any other two were as far from touching, at least.
    Scalar reach() const { return reach_; }
    /// Those that count.
    const Pair* begin() const { return pairs_.begin(); }
    const Pair* end() const { return pairs_.begin() + shell_[counted_]; }
    /// max_i Σ_j κ_ij/m_i over by_mass.
    Scalar heaviest_load() const { return heaviest_; }

    /// Lists the pairs that are less than `skin` from touching; none of them counts yet.
    /// @param x  Dim × n, m, finite
    void build(const Points<Scalar, Dim>& x, Scalar skin) {
        found_.clear();
        counted_ = 0;
        skin_ = skin;
        reach_ = std::numeric_limits<Scalar>::lowest();
        load_.assign(radius.size(), Scalar(0));
        heaviest_ = 0;
        shell_.fill(0);
        if (x.cols() == 0) return;
        const Scalar within = widest() + skin;
        sort_into_cells(x, within * Scalar(1.01));
        each_row([&](int begin, int end, int others, int others_end) {
            for (int p = begin; p < end; ++p)
                find(p, others == begin ? p + 1 : others, others_end, within);
        });
        sort_by_room();
    }
    /// From now on pairs count that were less than that from touching, m, up to the skin.
    void count_within(Scalar reach) {
        for (; !(reach < reach_) && counted_ < shells; ++counted_) {
            reach_ = skin_ * static_cast<Scalar>(counted_ + 1) / static_cast<Scalar>(shells);
            for (int k = shell_[counted_]; k < shell_[counted_ + 1]; ++k) {
                for (const int i : {pairs_[k].a, pairs_[k].b}) {
                    load_[i] += pairs_[k].stiffness * inverse_mass[i] / by_mass;
                    heaviest_ = (std::max)(heaviest_, load_[i]);
                }
            }
        }
    }

private:
    using Register = step_detail::VectorRegister<Scalar, 8>;  // there are few to look at
    static constexpr int shells = 16;

    /// Particles by cells of a torus: those that share a slot but not the place are far apart, and
    /// no two neighbours of a cell have the same slot, as there are four cells or more around.
    void sort_into_cells(const Points<Scalar, Dim>& x, Scalar width) {
        const Vector least = x.rowwise().minCoeff();
        // What is farther shares the last cells.
        const Scalar most = Scalar(1 << 14), over = 1 / width;
        const Vector size = ((x.rowwise().maxCoeff() - least) * over).cwiseMin(most);
        around_.fill(4);
        for (Index cells = Index(1) << (2 * Dim); cells < table_; cells *= 2) {
            int widest = 0;
            for (int d = 1; d < Dim; ++d) {
                if (size[d] * Scalar(around_[widest]) > size[widest] * Scalar(around_[d]))
                    widest = d;
            }
            if (!(size[widest] > Scalar(around_[widest]))) break;
            around_[widest] *= 2;
        }
        slots_ = 1;
        for (int d = 0; d < Dim; ++d) slots_ *= around_[d];
        begin_.assign(slots_ + 1, 0);
        for (Index i = 0; i < x.cols(); ++i) {
            int slot = 0;
            for (int d = Dim - 1; d >= 0; --d) {
                const Scalar at = (std::min)((x(d, i) - least[d]) * over, most);
                slot = slot * around_[d] + (static_cast<int>(at) & (around_[d] - 1));
            }
            slot_[i] = slot;
            ++begin_[slot + 1];
        }
        for (int s = 0; s < slots_; ++s) begin_[s + 1] += begin_[s];
        for (Index i = 0; i < x.cols(); ++i) {
            const int to = begin_[slot_[i]]++;
            items_[to] = static_cast<int>(i);
            for (int d = 0; d < Dim; ++d) x_[d][to] = x(d, i);
        }
        for (int s = slots_; s > 0; --s) begin_[s] = begin_[s - 1];
        begin_[0] = 0;
    }
    /// visit(begin, end, others, others_end): of each cell, with itself, what follows in its row
    /// and half of the rows around it; the others visit it.
    template <class Visitor>
    void each_row(const Visitor& visit) const {
        int all = 1;
        for (int d = 1; d < Dim; ++d) all *= 3;
        const int mask = around_[0] - 1;
        for (int slot = 0; slot < slots_; ++slot) {
            if (begin_[slot] == begin_[slot + 1]) continue;
            const int cell = slot & mask;
            for (int k = all / 2; k < all; ++k) {
                int row = 0;
                for (int d = 1, rest = k, at = slot / around_[0], stride = around_[0]; d < Dim;
                     ++d) {
                    row += stride * ((at + rest % 3 - 1) & (around_[d] - 1));
                    rest /= 3;
                    at /= around_[d];
                    stride *= around_[d];
                }
                const auto look = [&](int from, int to) {
                    const int others = begin_[row + from], others_end = begin_[row + to + 1];
                    if (others < others_end)
                        visit(begin_[slot], begin_[slot + 1], others, others_end);
                };
                const int from = cell - (k > all / 2), to = cell + 1;
                if (from >= 0 && to <= mask) {
                    look(from, to);
                } else {
                    for (int c = from; c <= to; ++c) look(c & mask, c & mask);
                }
            }
        }
    }
    /// Lists what is near item p among others.
    void find(int p, int begin, int end, Scalar within) {
        for (int q = begin; q < end; q += Register::width) {
            Register d2(Scalar(0));
            for (int d = 0; d < Dim; ++d) {
                const Register way = Register::load(x_[d].data() + q) - Register(x_[d][p]);
                d2 += way * way;
            }
            if (!(largest_lane(-d2) > -within * within)) continue;
            detail::Few<Scalar, Register::width> lanes;
            d2.store(lanes.data());
            const int count = (std::min)(end - q, int(Register::width));
            for (int k = 0; k < count; ++k) {
                if (lanes[k] < within * within) add(items_[p], items_[q + k], lanes[k]);
            }
        }
    }
    void add(int i, int j, Scalar d2) {
        const int a = (std::min)(i, j), b = (std::max)(i, j);
        bool joined = false;
        for (int k = first_joined_[a]; k < first_joined_[a + 1]; ++k) joined |= joined_[k] == b;
        if (joined) return;
        const Scalar w = (std::max)(inverse_mass[i], inverse_mass[j]);
        const Scalar apart = radius[i] + radius[j], room = std::sqrt(d2) - apart;
        if (w > 0 && room < skin_) found_.push_back({a, b, apart, by_mass / w, room});
    }
    int shell_of(const Pair& pair) const {
        const Scalar at = (std::max)(pair.room, Scalar(0)) * static_cast<Scalar>(shells) / skin_;
        return (std::min)(static_cast<int>(at), shells - 1);
    }
    void sort_by_room() {
        for (const Pair& pair : found_) ++shell_[shell_of(pair) + 1];
        for (int s = 0; s < shells; ++s) shell_[s + 1] += shell_[s];
        auto next = shell_;
        pairs_.resize(found_.size());
        for (const Pair& pair : found_) pairs_[next[shell_of(pair)]++] = pair;
    }

    Scalar largest_ = 0;                    // radius, m
    Index table_ = 64;                      // most cells, a power of two
    int slots_ = 0;                         // now
    detail::Few<int, Dim> around_{};        // of the torus, powers of two
    Buffer<int> begin_;                     // of each slot in items_
    Buffer<int> items_;                     // balls by slot
    Buffer<int> slot_;                      // of each ball
    detail::Few<Buffer<Scalar>, Dim> x_;    // of items_, m
    Buffer<int> first_joined_, joined_;     // springs' higher ends by their lower ones
    Buffer<Pair> found_, pairs_;            // in any order; by shells of room
    detail::Few<int, shells + 1> shell_{};  // where each begins in pairs_
    int counted_ = 0;                       // shells whose pairs count
    Scalar skin_ = 0, reach_ = 0;           // m
    Buffer<Scalar> load_;                   // of each ball
    Scalar heaviest_ = 0;
};

}  // namespace taut::contact_detail
