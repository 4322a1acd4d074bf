// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "../../core/buffer.hpp"
#include "../../core/types.hpp"

namespace taut::scene_detail {

/// The particles of a system, and the springs between them with how far they lead: the length in a
/// pose, over the mean of the springs' part of the scene, so that a small part is not left out
/// beside a large one. A spring that is softer than most leads farther by √(k l of the median over
/// its own), so that clusters end where a scene gives way.
class SpringGraph {
public:
    struct Neighbour {
        int particle;
        double length;
    };

    /// @param x  m, Dim × n
    template <class System, class Positions>
    SpringGraph(const System& system, const Positions& x) : first_(system.size() + 1, 0) {
        system.for_each_spring([&](Index a, Index b) {
            ++first_[a + 1];
            ++first_[b + 1];
        });
        for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
        neighbours_.resize(first_.back());
        Buffer<std::size_t> end = first_;
        const std::vector<double> lengths = lengths_of(system, x);
        std::size_t spring = 0;
        system.for_each_spring([&](Index a, Index b) {
            neighbours_[end[a]++] = {static_cast<int>(b), lengths[spring]};
            neighbours_[end[b]++] = {static_cast<int>(a), lengths[spring++]};
        });
        measure_by_parts();
    }

    int size() const { return static_cast<int>(first_.size()) - 1; }
    template <class Visitor>
    void for_each_neighbour(int i, Visitor&& visit) const {
        for (std::size_t k = first_[i]; k < first_[i + 1]; ++k) visit(neighbours_[k]);
    }

private:
    /// Of each spring, m, longer where it is softer than most.
    template <class System, class Positions>
    static std::vector<double> lengths_of(const System& system, const Positions& x) {
        constexpr double most = 1e3;
        std::vector<double> lengths, strengths;
        system.visit_springs([&](const auto& spring) {
            const auto l = static_cast<double>((x.col(spring.b) - x.col(spring.a)).norm());
            lengths.push_back(l);
            strengths.push_back(l * static_cast<double>(spring.stiffness_bound()));
        });
        std::vector<double> sorted = strengths;
        const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
        if (!sorted.empty()) std::nth_element(sorted.begin(), middle, sorted.end());
        for (std::size_t s = 0; s < lengths.size(); ++s) {
            if (lengths[s] > 0 && strengths[s] < *middle)
                lengths[s] *= (std::min)(most, std::sqrt(*middle / strengths[s]));
        }
        return lengths;
    }
    /// Divides the lengths of each part by their mean.
    void measure_by_parts() {
        Buffer<bool> seen(first_.size() - 1, false);
        std::vector<int> part;
        for (int start = 0; start < size(); ++start) {
            if (seen[start]) continue;
            part.assign(1, start);
            seen[start] = true;
            double sum = 0, count = 0;
            for (std::size_t at = 0; at < part.size(); ++at) {
                for_each_neighbour(part[at], [&](const Neighbour& next) {
                    sum += next.length;
                    ++count;
                    if (seen[next.particle]) return;
                    seen[next.particle] = true;
                    part.push_back(next.particle);
                });
            }
            if (!(sum > 0)) continue;
            for (const int i : part)
                for (std::size_t k = first_[i]; k < first_[i + 1]; ++k)
                    neighbours_[k].length *= count / sum;
        }
    }

    Buffer<std::size_t> first_;  // of particle i in neighbours_
    Buffer<Neighbour> neighbours_;
};

/// Seeds, and for each particle the seed that is nearest to it along the springs.
struct Clusters {
    Buffer<int> seeds;      // particles
    Buffer<int> of;         // particle → index in seeds; −1: no spring leads to a seed
    Buffer<double> length;  // along the springs from its seed, as of SpringGraph

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
    clusters.of.assign(graph.size(), -1);
    clusters.length.assign(graph.size(), std::numeric_limits<double>::infinity());
    for (const int seed : given) add_seed(graph, seed, clusters);
    // Lengths only shrink: one in the heap is the particle's own, or an earlier and larger one.
    std::vector<std::pair<double, int>> farthest;
    for (int i = 0; i < graph.size(); ++i) farthest.emplace_back(clusters.length[i], -i);
    std::make_heap(farthest.begin(), farthest.end());
    while (static_cast<int>(clusters.seeds.size()) < count) {
        std::pop_heap(farthest.begin(), farthest.end());
        const int particle = -farthest.back().second;
        if (farthest.back().first > clusters.length[particle]) {
            farthest.back().first = clusters.length[particle];
            std::push_heap(farthest.begin(), farthest.end());
            continue;
        }
        farthest.pop_back();
        if (!clusters.is_seed(particle)) add_seed(graph, particle, clusters);
    }
    return clusters;
}

}  // namespace taut::scene_detail
