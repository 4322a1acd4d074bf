// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "../../core/types.hpp"

namespace taut::scene_detail {

/// The particles of a system, and the springs between them with their lengths in a pose.
class SpringGraph {
public:
    struct Neighbour {
        int particle;
        double length;  // m
    };

    /// @param x  m, Dim × n
    template <class System, class Positions>
    SpringGraph(const System& system, const Positions& x)
        : first_(static_cast<std::size_t>(system.size()) + 1, 0) {
        system.for_each_spring([&](Index a, Index b) {
            ++first_[a + 1];
            ++first_[b + 1];
        });
        for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
        neighbours_.resize(first_.back());
        std::vector<std::size_t> end(first_.begin(), first_.end() - 1);
        system.for_each_spring([&](Index a, Index b) {
            const auto length = static_cast<double>((x.col(b) - x.col(a)).norm());
            neighbours_[end[a]++] = {static_cast<int>(b), length};
            neighbours_[end[b]++] = {static_cast<int>(a), length};
        });
    }

    int size() const { return static_cast<int>(first_.size()) - 1; }
    template <class Visitor>
    void for_each_neighbour(int i, Visitor&& visit) const {
        for (std::size_t k = first_[i]; k < first_[i + 1]; ++k) visit(neighbours_[k]);
    }

private:
    std::vector<std::size_t> first_;  // of particle i in neighbours_
    std::vector<Neighbour> neighbours_;
};

/// Seeds, and for each particle the seed that is nearest to it along the springs.
struct Clusters {
    std::vector<int> seeds;      // particles
    std::vector<int> of;         // particle → index in seeds; −1: no spring leads to a seed
    std::vector<double> length;  // m, along the springs from its seed

    bool is_seed(int particle) const {
        return of[particle] >= 0 && seeds[of[particle]] == particle;
    }
};

/// Takes in a seed: the particles that are nearer to it than to their own become its cluster
/// (Dijkstra, stopped where another seed is as near).
inline void add_seed(const SpringGraph& graph, int seed, Clusters& clusters) {
    using Reached = std::pair<double, int>;
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
    const auto own = static_cast<int>(clusters.seeds.size());
    clusters.seeds.push_back(seed);
    const auto reach = [&](int particle, double length) {
        if (!(length < clusters.length[particle])) return;
        clusters.length[particle] = length;
        clusters.of[particle] = own;
        front.emplace(length, particle);
    };
    clusters.length[seed] = std::numeric_limits<double>::infinity();
    reach(seed, 0);
    while (!front.empty()) {
        const auto [length, particle] = front.top();
        front.pop();
        if (length > clusters.length[particle]) continue;
        graph.for_each_neighbour(particle, [&, from = length](const auto& next) {
            reach(next.particle, from + next.length);
        });
    }
}

/// `count` seeds: the given ones, then always the particle that is farthest from all so far, of
/// equals the first; a part of the graph without a seed is farther than all. The seeds of a smaller
/// count come first among those of a larger one.
/// @param given  particles, each once, at most `count`   @param count  at most graph.size()
inline Clusters farthest_seeds(const SpringGraph& graph, const std::vector<int>& given, int count) {
    Clusters clusters;
    clusters.of.assign(static_cast<std::size_t>(graph.size()), -1);
    clusters.length.assign(clusters.of.size(), std::numeric_limits<double>::infinity());
    for (const int seed : given) add_seed(graph, seed, clusters);
    // Lengths only shrink: one in the heap is the particle's own, or an earlier and larger one.
    std::vector<std::pair<double, int>> far;
    for (int i = 0; i < graph.size(); ++i) far.emplace_back(clusters.length[i], -i);
    std::make_heap(far.begin(), far.end());
    while (static_cast<int>(clusters.seeds.size()) < count) {
        std::pop_heap(far.begin(), far.end());
        const int particle = -far.back().second;
        if (far.back().first > clusters.length[particle]) {
            far.back().first = clusters.length[particle];
            std::push_heap(far.begin(), far.end());
            continue;
        }
        far.pop_back();
        if (!clusters.is_seed(particle)) add_seed(graph, particle, clusters);
    }
    return clusters;
}

}  // namespace taut::scene_detail
