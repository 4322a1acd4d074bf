// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>

#include "planner.hpp"

namespace taut::step_detail {

inline Buffer<int> numbers(std::size_t count) {
    Buffer<int> result(count);
    for (std::size_t i = 0; i < count; ++i) result[i] = static_cast<int>(i);
    return result;
}

inline void sort_by(const Buffer<int>& key, Buffer<int>& items) {
    int most = -1;
    for (const int item : items) most = (std::max)(most, key[item]);
    Buffer<int> next(most + 2, 0);
    for (const int item : items) ++next[key[item] + 1];
    for (int i = 0; i <= most; ++i) next[i + 1] += next[i];
    Buffer<int> sorted(items.size());
    for (const int item : items) sorted[next[key[item]]++] = item;
    items = std::move(sorted);
}

inline SortedSprings::SortedSprings(const SpringEnds& ends, const Buffer<int>& place) {
    const std::size_t count = ends.count;
    Buffer<int> a(count), offset(count);
    for (std::size_t s = 0; s < count; ++s) {
        const int p = place.empty() ? ends.a[s] : place[ends.a[s]];
        const int q = place.empty() ? ends.b[s] : place[ends.b[s]];
        a[s] = (std::min)(p, q);
        offset[s] = (std::max)(p, q) - a[s];
    }
    Buffer<int> order = numbers(count);
    sort_by(a, order);
    sort_by(offset, order);
    springs_.reserve(count);
    for (const int s : order) springs_.push_back({a[s], a[s] + offset[s], s});
    find_runs();
}

inline void SortedSprings::find_runs() {
    const int count = static_cast<int>(springs_.size());
    for (Run run{0, 0}; run.begin < count; run.begin = run.end) {
        run.end = run.begin + 1;
        while (run.end < count && goes_on(springs_[run.end - 1], springs_[run.end])) ++run.end;
        const int length = run.end - run.begin;
        const int places = springs_[run.end - 1].a - springs_[run.begin].a;
        if (length >= shortest_run && 2 * length > places) {
            runs_.push_back(run);
        } else {
            for (int s = run.begin; s < run.end; ++s) scattered_.push_back(s);
        }
    }
}

inline Buffer<HubSpring> choose_hubs(const Buffer<PlacedSpring>& springs, int places) {
    // By lower ends, and so the springs from each place by their other ends.
    Buffer<int> a(springs.size());
    for (std::size_t s = 0; s < springs.size(); ++s) a[s] = springs[s].a;
    Buffer<int> later = numbers(springs.size());
    sort_by(a, later);
    Buffer<HubSpring> result;
    result.reserve(springs.size());
    Buffer<int> handed(places, -1);          // the last to each
    Buffer<int> before(springs.size(), -1);  // the one handed there before
    const int count = static_cast<int>(springs.size());
    for (int p = 0, first = 0; p < places; ++p) {
        int last = first;
        while (last < count && springs[later[last]].a == p) ++last;
        const std::size_t mine = result.size();
        for (int s = handed[p]; s != -1; s = before[s]) {
            result.push_back({p, springs[s].a, springs[s].index});
        }
        std::reverse(result.begin() + static_cast<std::ptrdiff_t>(mine), result.end());
        const int own = last - first;
        const int surplus = (own + static_cast<int>(result.size() - mine)) % star_size;
        for (const int kept = first + (surplus <= own ? surplus : 0); first != kept; ++first) {
            const int s = later[first];
            before[s] = std::exchange(handed[springs[s].b], s);
        }
        for (; first != last; ++first) {
            const auto& spring = springs[later[first]];
            result.push_back({p, spring.b, spring.index});
        }
    }
    return result;
}

inline Buffer<PlannedStar> plan_stars(const Buffer<HubSpring>& by_hub, const Blocks& blocks) {
    Buffer<PlannedStar> stars;
    const int springs = static_cast<int>(by_hub.size());
    const auto spring = [&](int s) { return by_hub[s]; };
    for (int s = 0; s < springs;) {
        const int hub = spring(s).hub;
        Few<int, star_size + 1> places{};  // ascending, like the tips of a hub
        int count = 0;
        for (; count < star_size && s + count < springs && spring(s + count).hub == hub; ++count) {
            places[count] = spring(s + count).tip;
        }
        int at = count;
        for (; at > 0 && places[at - 1] > hub; --at) places[at] = places[at - 1];
        places[at] = hub;
        const bool outer = blocks.of(places[0]) != blocks.of(places[count]);
        for (int i = 0; i <= count; ++i) {
            const int block = blocks.of(places[i]);
            if (i > 0 && block == blocks.of(places[i - 1])) continue;
            const int tile = outer ? blocks.first_tile(block) : places[i] / tile_size;
            stars.push_back({tile, outer, s, count});
        }
        s += count;
    }
    // A star goes no later than those after it, so that springs are read in order.
    int tile = blocks.tiles();
    for (std::size_t i = stars.size(); i-- > 0;) {
        if (!stars[i].outer) tile = stars[i].tile = (std::min)(tile, stars[i].tile);
    }
    Buffer<int> key(stars.size()), order = numbers(stars.size());
    for (std::size_t i = 0; i < key.size(); ++i) key[i] = 2 * stars[i].tile + !stars[i].outer;
    sort_by(key, order);
    Buffer<PlannedStar> sorted;
    sorted.reserve(stars.size());
    for (const int i : order) sorted.push_back(stars[i]);
    return sorted;
}

/// Scattered springs tile by tile, one for each block of an end. In a tile, neighbours have
/// different ends: first one of each a, then another of each. To add to the force just stored would
/// be to wait for the store.
struct SpreadSprings {
    Buffer<int> spring;  // which of all sorted ones
    Buffer<int> tile;

    SpreadSprings(const SortedSprings& sorted, const Blocks& blocks) {
        Buffer<int> of, a, tiles;
        for (const int s : sorted.scattered()) {
            const auto& scattered = sorted.all()[s];
            const auto add = [&](int to) {
                of.push_back(s);
                a.push_back(scattered.a);
                tiles.push_back(to);
            };
            const int block_of_b = blocks.of(scattered.b);
            add(scattered.a / tile_size);
            if (block_of_b != blocks.of(scattered.a)) {
                add(blocks.first_tile(block_of_b));
            }
        }
        Buffer<int> order = numbers(of.size());
        sort_by(a, order);
        sort_by(tiles, order);
        Buffer<int> rank(of.size(), 0);
        for (std::size_t i = 1; i < order.size(); ++i) {
            const int s = order[i], before = order[i - 1];
            if (tiles[s] == tiles[before] && a[s] == a[before]) rank[s] = rank[before] + 1;
        }
        sort_by(rank, order);
        sort_by(tiles, order);
        for (const int s : order) {
            spring.push_back(of[s]);
            tile.push_back(tiles[s]);
        }
    }
};

inline Buffer<int> cache_order(int n, const Buffer<SpringEnds>& laws) {
    Buffer<int> degree(n, 0);
    const auto for_each_spring = [&](const auto& visit) {
        for (const auto& ends : laws) {
            for (std::size_t s = 0; s < ends.count; ++s) visit(ends.a[s], ends.b[s]);
        }
    };
    for_each_spring([&](int a, int b) { ++degree[a], ++degree[b]; });
    Buffer<int> first(n + 1, 0);
    for (int i = 0; i < n; ++i) first[i + 1] = first[i] + degree[i];
    Buffer<int> neighbour(first[n]);
    auto next = first;
    for_each_spring([&](int a, int b) {
        neighbour[next[a]++] = b;
        neighbour[next[b]++] = a;
    });

    Buffer<int> start = numbers(degree.size());
    sort_by(degree, start);
    // Those of each particle in the order of `start`, too.
    Buffer<int> sorted(neighbour.size());
    next = first;
    for (const int i : start) {
        for (int k = first[i]; k < first[i + 1]; ++k) sorted[next[neighbour[k]]++] = i;
    }
    Buffer<int> known(n, 0);
    Buffer<int> order;
    order.reserve(start.size());
    for (const int root : start) {
        if (known[root]) continue;
        known[root] = 1;
        order.push_back(root);
        for (std::size_t head = order.size() - 1; head < order.size(); ++head) {
            const int i = order[head];
            for (int k = first[i]; k < first[i + 1]; ++k) {
                if (std::exchange(known[sorted[k]], 1) == 0) order.push_back(sorted[k]);
            }
        }
    }
    std::reverse(order.begin(), order.end());
    return order;
}

/// The place of each particle of an order, which is not empty.
inline Buffer<int> places_of(const Buffer<int>& order) {
    Buffer<int> place(order.size());
    for (std::size_t p = 0; p < order.size(); ++p) place[order[p]] = static_cast<int>(p);
    return place;
}

template <class Scalar>
SpringOrder Planner<Scalar>::order(const Buffer<SpringEnds>& laws, const Blocks& blocks,
                                   bool may_have_stars) {
    // The share of scattered springs from which on stars were faster, on AMD's and Intel's
    // processors: a scattered spring costs five springs of a run or more, one in a star two, but in
    // registers of 16 bytes hardly more than one.
    double most_scattered = 0.25;
#if !defined(TAUT_SAME_BITS)  // or sums had another order
    if (planned_width(Scalar()) * static_cast<int>(sizeof(Scalar)) <= 16) most_scattered = 0.05;
#endif
    SpringOrder result;
    result.laws.reset(new SortedSprings[laws.size()]);
    const auto sort = [&](const Buffer<int>& place) {
        std::size_t all = 0, scattered = 0;
        for (std::size_t law = 0; law < laws.size(); ++law) {
            result.laws[law] = SortedSprings(laws[law], place);
            all += laws[law].count;
            scattered += result.laws[law].scattered().size();
        }
        return static_cast<double>(scattered) > most_scattered * static_cast<double>(all);
    };
    if (sort({})) {
        result.order = cache_order(blocks.places(), laws);
        result.stars = sort(places_of(result.order)) && may_have_stars;
    }
    for (std::size_t law = 0; law < laws.size(); ++law) {
        for (const auto& spring : result.laws[law].all()) {
            const int reach = blocks.of(spring.b) - blocks.of(spring.a);
            result.reach = (std::max)(result.reach, reach);
        }
    }
    return result;
}

template <class Scalar>
PlannedRuns Planner<Scalar>::runs(const SortedSprings& sorted, const Blocks& blocks,
                                  Buffer<int>& index) {
    const int width = planned_width(Scalar());
    PlannedRuns plan;
    const auto tiles = static_cast<std::size_t>(blocks.tiles());
    Buffer<Segment> segments;    // run by run
    Buffer<int> tile_of;         // of each of these
    Buffer<int> last(tiles, 0);  // behind the last one of each tile
    const auto append = [&](int tile, const Segment& segment) {
        if (tile >= blocks.tiles()) return;  // gaps beyond the last place
        Segment* before = last[tile] == 0 ? nullptr : &segments[last[tile] - 1];
        if (before && before->run == segment.run && before->writes_a == segment.writes_a &&
            before->writes_b == segment.writes_b &&
            before->first_a + before->count == segment.first_a) {
            before->count += width;
        } else {
            segments.push_back(segment);
            tile_of.push_back(tile);
            last[tile] = static_cast<int>(segments.size());
        }
    };
    for (const auto& run : sorted.runs()) {
        const PlacedSpring* next = &sorted.all()[run.begin];
        const PlacedSpring* back = &sorted.all()[run.end - 1];
        const int offset = next->offset();
        const int begin = next->a / width * width;
        const int end = (back->a / width + 1) * width;
        for (int a = begin; a < end; ++a) {
            const bool there = next <= back && next->a == a;
            const int neighbour = next > back ? back->index : next->index;
            index.push_back(there ? neighbour : gap(neighbour));
            if (there) ++next;
        }
        const int number = static_cast<int>(plan.runs.size());
        plan.runs.push_back({begin, offset, end - begin});
        for (int a = begin; a < end; a += width) {
            const int block = blocks.of(a);
            const int first_block_of_b = blocks.of(a + offset);
            const int last_block_of_b = blocks.of(a + offset + width - 1);
            append(a / tile_size, {number, a, width, true, block == first_block_of_b});
            // Springs that come from an earlier block go with the first tile of this one.
            if (first_block_of_b != block) {
                append(blocks.first_tile(first_block_of_b), {number, a, width, false, true});
            }
            if (last_block_of_b != first_block_of_b) {
                append(blocks.first_tile(last_block_of_b), {number, a, width, false, true});
            }
        }
    }
    Buffer<int> order = numbers(segments.size());
    sort_by(tile_of, order);
    plan.segments.reserve(segments.size());
    for (const int s : order) plan.segments.push_back(segments[s]);
    plan.segment_end.assign(tiles, 0);
    for (const int tile : tile_of) ++plan.segment_end[tile];
    for (std::size_t t = 1; t < tiles; ++t) plan.segment_end[t] += plan.segment_end[t - 1];
    return plan;
}

template <class Scalar>
PlannedBatches Planner<Scalar>::batches(const SortedSprings& sorted, const Blocks& blocks,
                                        Buffer<int>& index) {
    const SpreadSprings spread(sorted, blocks);
    const std::size_t count = spread.spring.size();
    PlannedBatches plan;
    Buffer<int> number(count > 0 ? blocks.places() : 0, -1);  // of gathered places
    std::size_t next = 0, end = 0;
    for (int tile = 0; tile < blocks.tiles(); ++tile) {
        while (end < count && spread.tile[end] == tile) ++end;
        while (next < end) {
            Batch batch{static_cast<int>(plan.ends.size()), 0,
                        static_cast<int>(plan.gathered.size()), 0};
            const auto gather = [&](int place) {
                if (number[place] < 0) {
                    number[place] = batch.gathered++;
                    plan.gathered.push_back(place);
                }
                return static_cast<std::uint16_t>(number[place]);
            };
            for (; next < end && batch.gathered + 2 <= most_gathered; ++next, ++batch.springs) {
                const auto& spring = sorted.all()[spread.spring[next]];
                const auto a = gather(spring.a);
                plan.ends.push_back({a, gather(spring.b)});
                index.push_back(spring.index);
            }
            plan.batches.push_back(batch);
            for (std::size_t g = static_cast<std::size_t>(batch.first_gathered);
                 g < plan.gathered.size(); ++g) {
                number[plan.gathered[g]] = -1;
            }
        }
        plan.batch_end.push_back(static_cast<int>(plan.batches.size()));
    }
    return plan;
}

template <class Scalar>
StarGroups Planner<Scalar>::groups(const SortedSprings& sorted, const Blocks& blocks,
                                   Buffer<int>& index) {
    const auto by_hub = choose_hubs(sorted.all(), blocks.places());
    const auto stars = plan_stars(by_hub, blocks);
    StarGroups plan;
    const int lanes = (std::min)(planned_width(Scalar()), static_cast<int>(32 / sizeof(Scalar)));
    const int whole = (std::max)(1, lanes / star_size);
    const auto append = [&](const PlannedStar& star) {
        const auto* spring = &by_hub[star.first];
        const int block_begin = blocks.begin(blocks.block_of_tile(star.tile));
        Star result;
        result.hub = 4 * (spring->hub - block_begin);
        for (int k = 0; k < star_size; ++k) {
            const bool there = k < star.count;
            result.tips[k] = there ? 4 * (spring[k].tip - block_begin) : result.hub;
            index.push_back(there ? spring[k].index : gap(spring->index));
        }
        plan.stars.push_back(result);
    };
    auto next = stars.begin();
    const auto append_all = [&](int tile, bool outer) {
        for (; next != stars.end() && next->tile == tile && next->outer == outer; ++next) {
            append(*next);
        }
        const int count = (static_cast<int>(plan.stars.size()) + whole - 1) / whole * whole;
        plan.stars.resize(count, Star{});
        index.resize(plan.stars.size() * star_size, by_hub.empty() ? 0 : gap(by_hub[0].index));
        return count;
    };
    for (int tile = 0; tile < blocks.tiles(); ++tile) {
        const int outer = append_all(tile, true);
        plan.ends.push_back({outer, append_all(tile, false)});
    }
    return plan;
}

}  // namespace taut::step_detail
