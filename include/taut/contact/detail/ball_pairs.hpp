// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "../../core/buffer.hpp"
#include "../../core/detail/finite.hpp"
#include "../../core/types.hpp"

namespace taut::contact_detail {

/// Two balls that may touch.
struct BallPair {
    int a, b;
};

/// Balls around particles, and which of them are near each other: by a hash of cells as wide as
/// two balls may be apart.
template <class Scalar, int Dim>
class BallPairs {
public:
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;

    Buffer<Scalar> radius;        ///< m
    Buffer<Scalar> inverse_mass;  ///< 1/kg, 0 if pinned

    /// Makes room, so that lists as long as one of `pairs` a ball need no memory of their own.
    void reserve(Index pairs) {
        const Index count = static_cast<Index>(radius.size());
        pairs_.reserve(static_cast<std::size_t>(count * pairs));
        for (table_ = 16; table_ < 2 * count;) table_ *= 2;
        begin_.resize(table_ + 1);
        items_.resize(count);
        cell_.resize(count);
        load_.resize(count);
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
    const Buffer<BallPair>& pairs() const { return pairs_; }
    /// max_i Σ_j κ_ij/m_i for κ_ij of 1 N/m a kg of the lighter one.
    Scalar heaviest_load() const { return heaviest_; }

    /// Lists the pairs that are less than `margin` from touching. @param x  x(i), m, finite
    template <class Positions>
    void build(const Positions& x, Scalar margin) {
        const Index count = static_cast<Index>(radius.size());
        pairs_.clear();
        heaviest_ = 0;
        if (count == 0) return;
        sort_into_cells(x, widest() + margin);
        load_.assign(count, Scalar(0));
        for (int i = 0; i < static_cast<int>(count); ++i) {
            const Vector at = x(i);
            for_each_cell(cell_[i], [&](const Cell& cell, bool own) {
                const std::size_t slot = slot_of(cell);
                for (int k = begin_[slot]; k < begin_[slot + 1]; ++k) {
                    const int j = items_[k];
                    if ((own && j <= i) || !(cell_[j] == cell)) continue;
                    const Scalar reach = radius[i] + radius[j] + margin;
                    if ((x(j) - at).squaredNorm() < reach * reach) add(i, j);
                }
            });
        }
        for (const Scalar load : load_) heaviest_ = (std::max)(heaviest_, load);
    }

private:
    struct Cell {
        std::array<int, static_cast<std::size_t>(Dim)> at;
        bool operator==(const Cell& other) const { return at == other.at; }
    };

    void add(int i, int j) {
        const Scalar w = (std::max)(inverse_mass[i], inverse_mass[j]);
        const int a = (std::min)(i, j), b = (std::max)(i, j);
        if (!(w > 0)) return;
        for (int k = first_joined_[a]; k < first_joined_[a + 1]; ++k) {
            if (joined_[k] == b) return;
        }
        pairs_.push_back({a, b});
        load_[a] += inverse_mass[a] / w;
        load_[b] += inverse_mass[b] / w;
    }
    std::size_t slot_of(const Cell& cell) const {
        std::uint64_t hash = 0;
        for (const int c : cell.at)
            hash = (hash ^ static_cast<std::uint32_t>(c)) * 0x9E3779B97F4A7C15u;
        return static_cast<std::size_t>((hash >> 32) & static_cast<std::uint64_t>(table_ - 1));
    }
    template <class Positions>
    void sort_into_cells(const Positions& x, Scalar width) {
        const Index count = static_cast<Index>(radius.size());
        const Vector origin = x(0);
        // What is farther shares the last cells, in order, so none of its neighbours is lost.
        const Scalar most = Scalar(1 << 28);
        begin_.assign(table_ + 1, 0);
        for (Index i = 0; i < count; ++i) {
            const Vector at = (x(i) - origin) / width;
            for (int d = 0; d < Dim; ++d) {
                const Scalar c = std::floor((std::min)((std::max)(at[d], -most), most));
                cell_[i].at[static_cast<std::size_t>(d)] = static_cast<int>(c);
            }
            ++begin_[slot_of(cell_[i]) + 1];
        }
        for (Index s = 0; s < table_; ++s) begin_[s + 1] += begin_[s];
        for (Index i = 0; i < count; ++i) items_[begin_[slot_of(cell_[i])]++] = static_cast<int>(i);
        for (Index s = table_; s > 0; --s) begin_[s] = begin_[s - 1];
        begin_[0] = 0;
    }
    /// visit(cell, own) for a cell and half of those around it: the others visit it.
    template <class Visitor>
    static void for_each_cell(const Cell& cell, const Visitor& visit) {
        int all = 1;
        for (int d = 0; d < Dim; ++d) all *= 3;
        for (int k = all / 2; k < all; ++k) {
            Cell near = cell;
            for (int d = 0, rest = k; d < Dim; ++d, rest /= 3)
                near.at[static_cast<std::size_t>(d)] += rest % 3 - 1;
            visit(near, k == all / 2);
        }
    }

    Scalar largest_ = 0;                 // radius, m
    Index table_ = 16;                   // slots of the hash, a power of two
    Buffer<int> begin_;                  // of each slot in items_
    Buffer<int> items_;                  // balls by slot
    Buffer<Cell> cell_;                  // of each ball
    Buffer<int> first_joined_, joined_;  // springs' higher ends by their lower ones
    Buffer<BallPair> pairs_;
    Buffer<Scalar> load_;  // of each ball
    Scalar heaviest_ = 0;
};

}  // namespace taut::contact_detail
