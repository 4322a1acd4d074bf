// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "../../network/spring_system.hpp"
#include "../coarse_law.hpp"
#include "spring_graph.hpp"

namespace taut::scene_detail {

/// A pair of clusters, the smaller index first, as one number that sorts.
using ClusterPair = std::uint64_t;
inline ClusterPair pair_of(int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    return static_cast<ClusterPair>(low) << 32U | static_cast<ClusterPair>(high);
}
inline int low_of(ClusterPair pair) { return static_cast<int>(pair >> 32U); }
inline int high_of(ClusterPair pair) { return static_cast<int>(pair & 0xffffffffU); }

/// Adds to `coarse` one spring for each pair of clusters that springs of `set` join: under a
/// stretch along AB it stores what they do, so that k_AB = Σ k l |cos θ|³/L_AB with θ between a
/// spring and AB. Dampers likewise. Its rest length keeps their mean strain. Those that are slack,
/// taut and at rest in the pose become one each: a law may answer them in different ways.
/// @param x      m, Dim × n, the pose
/// @param pairs  of clusters that springs join; appended to
template <class Coarse, class Set, class Positions>
void add_coarse_springs(const Set& set, const Positions& x, const Clusters& clusters,
                        Coarse& coarse, std::vector<ClusterPair>& pairs) {
    using Scalar = typename Coarse::Scalar;
    using Law = typename Set::Law;
    using Rule = CoarseLaw<Law>;
    static_assert(Rule::known,
                  "taut::coarsen: specialise taut::CoarseLaw for a law with parameters of its own");
    const auto strengths_of = [](const auto& spring, double l) {
        return Rule::strengths(spring.parameters.template cast<double>(),
                               static_cast<double>(spring.rest_length), l);
    };
    struct Sum {
        ClusterPair pair;
        int strain;                                     // 1 taut, 0 at rest, -1 slack in the pose
        decltype(strengths_of(set[0], 1.0)) strengths;  // N
        double damping;                                 // N·s
        double weight;                                  // N
        double stretched;                               // N, weight times rest length over length
    };
    std::vector<Sum> sums;
    for (const auto spring : set) {
        const int a = clusters.of[spring.a], b = clusters.of[spring.b];
        if (a == b) continue;
        const auto d = (x.col(spring.b) - x.col(spring.a)).template cast<double>().eval();
        const auto D =
            (x.col(clusters.seeds[b]) - x.col(clusters.seeds[a])).template cast<double>().eval();
        const double l = d.norm(), L = D.norm();
        pairs.push_back(pair_of(a, b));
        if (!(l > 0) && spring.rest_length > 0 && spring.stiffness_bound() > 0)
            fail(
                "coarsen: particles ", spring.a, " and ", spring.b,
                " lie on each other in initial_state(), where lengths and angles are measured, but "
                "the rest length of their spring is ",
                spring.rest_length, " m");
        if (!(l > 0) || !(L > 0)) {
            // No stretch to compare by. Between two seeds the spring itself is the coarse one.
            if (clusters.is_seed(static_cast<int>(spring.a)) &&
                clusters.is_seed(static_cast<int>(spring.b)))
                coarse.add_spring(Spring<Scalar, Law>{a, b, spring.parameters, spring.rest_length,
                                                      spring.damping});
            continue;
        }
        const double cosine = (std::abs)(d.dot(D) / (l * L));
        const double share = cosine * cosine * cosine;
        const double weight = share * l * static_cast<double>(spring.stiffness_bound());
        auto strengths = strengths_of(spring, l);
        for (double& strength : strengths) strength *= share;
        const double ratio = static_cast<double>(spring.rest_length) / l;
        const int strain = (ratio < 1 - 1e-6) - (ratio > 1 + 1e-6);
        sums.push_back({pair_of(a, b), strain, strengths,
                        share * l * static_cast<double>(spring.damping), weight,
                        weight * static_cast<double>(spring.rest_length) / l});
    }
    const auto kind = [](const Sum& sum) { return std::make_pair(sum.pair, sum.strain); };
    std::stable_sort(sums.begin(), sums.end(),
                     [&](const Sum& one, const Sum& other) { return kind(one) < kind(other); });
    for (auto at = sums.begin(); at != sums.end();) {
        Sum sum = *at++;
        for (; at != sums.end() && kind(*at) == kind(sum); ++at) {
            for (std::size_t i = 0; i < sum.strengths.size(); ++i)
                sum.strengths[i] += at->strengths[i];
            sum.damping += at->damping;
            sum.weight += at->weight;
            sum.stretched += at->stretched;
        }
        if (!(sum.weight > 0) && !(sum.damping > 0)) continue;
        const int a = low_of(sum.pair), b = high_of(sum.pair);
        const double l =
            static_cast<double>((x.col(clusters.seeds[b]) - x.col(clusters.seeds[a])).norm());
        const double rest = sum.weight > 0 ? l * sum.stretched / sum.weight : l;
        coarse.add_spring(Spring<Scalar, Law>{
            a, b, Rule::parameters(sum.strengths, rest, l).template cast<Scalar>(),
            static_cast<Scalar>(rest), static_cast<Scalar>(sum.damping / l)});
    }
}

}  // namespace taut::scene_detail
