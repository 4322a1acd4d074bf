// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "sorted_springs.hpp"
#include "spring_table.hpp"
#include "tile.hpp"

namespace taut::integrator_detail::sweep {

/// Orders springs so that neighbours have different ends: first one of each a, then another of
/// each. To add to the force just stored would be to wait for the store.
inline void spread(std::vector<PlacedSpring>& springs) {
    std::sort(springs.begin(), springs.end(), [](const auto& s, const auto& t) {
        return std::tuple(s.a, s.b, s.index) < std::tuple(t.a, t.b, t.index);
    });
    std::vector<std::pair<int, PlacedSpring>> ranked;
    for (const auto& spring : springs) {
        const bool another = !ranked.empty() && ranked.back().second.a == spring.a;
        ranked.emplace_back(another ? ranked.back().first + 1 : 0, spring);
    }
    std::stable_sort(ranked.begin(), ranked.end(),
                     [](const auto& s, const auto& t) { return s.first < t.first; });
    for (std::size_t i = 0; i < springs.size(); ++i) springs[i] = ranked[i].second;
}

/// The scattered springs of one law, in batches, and the forces of these.
template <class Scalar, int Dim, class Law>
class BatchPlan {
    using Set = SpringSet<Scalar, Law>;
    using Table = SpringTable<Scalar, Law>;
    using Register = VectorRegister<Scalar>;

public:
    BatchPlan() = default;
    /// @param table  takes the springs' values
    BatchPlan(const Set& set, const std::vector<PlacedSpring>& scattered, const Blocks& blocks,
              Table& table);

    /// Adds the forces of the tile's batches.
    /// @tparam Both  whether a spring takes its positions ahead and as they are [T42]
    template <bool Dampers, bool Rayleigh, bool Both>
    void add_forces(const Table& table, const TileView<Scalar>& view) const {
        const auto tile = static_cast<std::size_t>(view.tile);
        for (std::size_t s = tile == 0 ? 0 : batch_end_[tile - 1]; s < batch_end_[tile]; ++s) {
            add_batch<Dampers, Rayleigh, Both>(table, view, batches_[s]);
        }
    }

private:
    struct Batch {
        std::size_t first_spring;  // in ends_
        int springs = 0;
        std::size_t first_gathered;  // in gathered_
        int gathered = 0;
        typename Table::Columns columns{};
    };
    /// The ends of a spring, among the gathered places of its batch.
    struct Ends {
        std::uint16_t a, b;
    };
    /// One vector, in memory as registers like it.
    using Vector = Eigen::Array<Scalar, Dim == 3 ? 4 : Dim, 1>;
    /// As many copies stay in the first cache.
    static constexpr int most_gathered = 512;

    using Springs = std::vector<PlacedSpring>::const_iterator;
    Springs append_batch(const Set& set, Springs next, Springs end, Table& table);
    template <bool Dampers, bool Rayleigh, bool Both>
    void add_batch(const Table& table, const TileView<Scalar>& view, const Batch& batch) const;

    std::vector<Batch> batches_;          // tile by tile
    std::vector<std::size_t> batch_end_;  // of each tile
    std::vector<Ends> ends_;              // of the springs, batch by batch
    std::vector<int> gathered_;           // places, batch by batch
};

template <class Scalar, int Dim, class Law>
BatchPlan<Scalar, Dim, Law>::BatchPlan(const Set& set, const std::vector<PlacedSpring>& scattered,
                                       const Blocks& blocks, Table& table) {
    std::vector<std::vector<PlacedSpring>> springs(static_cast<std::size_t>(blocks.tiles()));
    for (const auto& spring : scattered) {
        const int block_of_b = blocks.of(spring.b);
        springs[spring.a / tile_size].push_back(spring);
        if (block_of_b != blocks.of(spring.a)) {
            springs[blocks.first_tile(block_of_b)].push_back(spring);
        }
    }
    for (auto& of_tile : springs) {
        spread(of_tile);
        for (auto next = of_tile.cbegin(); next != of_tile.cend();) {
            next = append_batch(set, next, of_tile.cend(), table);
        }
        batch_end_.push_back(batches_.size());
    }
}

/// A batch of as many springs as touch few enough places. @returns the first of the others
template <class Scalar, int Dim, class Law>
auto BatchPlan<Scalar, Dim, Law>::append_batch(const Set& set, Springs next, Springs end,
                                               Table& table) -> Springs {
    Batch batch{ends_.size(), 0, gathered_.size()};
    std::unordered_map<int, std::uint16_t> number;
    const auto gather = [&](int place) {
        const auto [at, is_new] =
            number.try_emplace(place, static_cast<std::uint16_t>(number.size()));
        if (is_new) gathered_.push_back(place);
        return at->second;
    };
    std::vector<int> index;
    for (; next != end && number.size() + 2 <= most_gathered; ++next) {
        const auto a = gather(next->a);
        ends_.push_back({a, gather(next->b)});
        index.push_back(next->index);
    }
    batch.springs = static_cast<int>(index.size());
    batch.gathered = static_cast<int>(number.size());
    batch.columns = table.add(set, index);
    batches_.push_back(batch);
    return next;
}

template <class Scalar, int Dim, class Law>
template <bool Dampers, bool Rayleigh, bool Both>
void BatchPlan<Scalar, Dim, Law>::add_batch(const Table& table, const TileView<Scalar>& view,
                                            const Batch& batch) const {
    constexpr bool velocities = Dampers || Rayleigh;
    constexpr int chunk = 64;  // springs; all that is known of them stays in the first cache
    static_assert(chunk % max_width == 0);
    alignas(64) Vector x[most_gathered];
    alignas(64) Vector here[Both ? most_gathered : 1];
    alignas(64) Vector v[velocities ? most_gathered : 1];
    alignas(64) Vector f[most_gathered];
    const int* places = gathered_.data() + batch.first_gathered;
    for (int g = 0; g < batch.gathered; ++g) {
        x[g].setZero();
        f[g].setZero();
        for (int d = 0; d < Dim; ++d) x[g][d] = view.x[d][places[g]];
        if constexpr (Both) {
            here[g].setZero();
            for (int d = 0; d < Dim; ++d) here[g][d] = view.at[d][places[g]];
        }
        if constexpr (velocities) {
            v[g].setZero();
            for (int d = 0; d < Dim; ++d) v[g][d] = view.v[d][places[g]];
        }
    }
    alignas(64) Vector dx[chunk];
    alignas(64) Vector old_dx[Both ? chunk : 1];
    alignas(64) Vector dv[velocities ? chunk : 1];
    // Coefficients overwrite the products that they are made of.
    alignas(64) Scalar l2[chunk] = {};
    alignas(64) Scalar dx_dv[chunk] = {};
    alignas(64) Scalar old_l2[Both ? chunk : 1] = {};
    typename Table::Reader springs(table, batch.columns, 0);
    for (int done = 0; done < batch.springs; done += chunk) {
        const Ends* ends = ends_.data() + batch.first_spring + done;
        const int count = std::min(chunk, batch.springs - done);
        for (int s = 0; s < count; ++s) {
            dx[s] = x[ends[s].b] - x[ends[s].a];
            l2[s] = dx[s].square().sum();
            if constexpr (Both) {
                old_dx[s] = here[ends[s].b] - here[ends[s].a];
                old_l2[s] = old_dx[s].square().sum();
            }
            if constexpr (velocities) {
                dv[s] = v[ends[s].b] - v[ends[s].a];
                dx_dv[s] = (dx[s] * dv[s]).sum();
            }
        }
        for (int s = 0; s < count; s += Register::width, springs.next()) {
            const Register square = Register::load(l2 + s);
            const Register product = Register::load(dx_dv + s);
            const auto keep = [&](const auto& pull) {
                pull.of_dx.store(l2 + s);
                pull.of_dv.store(dx_dv + s);
            };
            if constexpr (Both) {
                const auto pull = springs.template pull_ahead<Dampers, Rayleigh>(
                    view.alpha, square, product, Register::load(old_l2 + s));
                keep(pull);
                pull.of_here.store(old_l2 + s);
            } else {
                keep(springs.template pull<Dampers, Rayleigh>(view.alpha, square, product));
            }
        }
        for (int s = 0; s < count; ++s) {
            Vector force = l2[s] * dx[s];
            if constexpr (Both) force -= old_l2[s] * old_dx[s];
            if constexpr (Rayleigh) force += dx_dv[s] * dv[s];
            f[ends[s].a] += force;
            f[ends[s].b] -= force;
        }
    }
    for (int g = 0; g < batch.gathered; ++g) {
        const int i = places[g] - view.begin;
        if (i < 0 || i >= view.size) continue;  // another block sees to it
        for (int d = 0; d < Dim; ++d) view.force_a[d][i] += f[g][d];
    }
}

}  // namespace taut::integrator_detail::sweep
