// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "../core/buffer.hpp"
#include "../core/detail/fits.hpp"
#include "../core/error.hpp"
#include "../network/spring_system.hpp"
#include "detail/coarse_springs.hpp"
#include "detail/lift.hpp"
#include "detail/spring_graph.hpp"

namespace taut {

/// A network of fewer particles in place of another (coarsen): the way there and back.
template <class System_>
class Coarsening {
public:
    using System = System_;
    using Scalar = typename System::Scalar;
    static constexpr int Dim = System::Dim;
    using State = typename System::State;

    System system;             ///< the coarse network; the pins come first
    std::vector<int> seeds;    ///< coarse particle → the fine one where it lies
    std::vector<int> cluster;  ///< fine particle → the coarse one that has its mass

    /// As coarsen() makes it. @param mass_of  kg, of the fine particles
    Coarsening(System coarse, std::vector<int> seeds_of, std::vector<int> cluster_of,
               VectorX<Scalar> mass_of, scene_detail::Lift lift)
        : system(std::move(coarse)),
          seeds(std::move(seeds_of)),
          cluster(std::move(cluster_of)),
          mass_(std::move(mass_of)),
          lift_(std::move(lift)) {}

    /// The coarse state for a fine one: seeds where they are, each with the mean velocity of its
    /// cluster, which keeps momentum; a pin with its own.
    /// @param fine  Dim × n
    State restricted(const State& fine) const {
        detail::require_fits("Coarsening::restricted", fine, mass_.size(), "the fine system has");
        State coarse = system.initial_state();
        coarse.time = fine.time;
        coarse.v.setZero();
        for (Index i = 0; i < mass_.size(); ++i) {
            const Index c = detail::at(cluster, i);
            if (!system.is_pinned(c)) coarse.v.col(c) += mass_[i] / system.mass(c) * fine.v.col(i);
        }
        for (Index c = 0; c < system.size(); ++c) {
            const Index seed = detail::at(seeds, c);
            coarse.x.col(c) = fine.x.col(seed);
            if (system.is_pinned(c)) coarse.v.col(c) = fine.v.col(seed);
        }
        return coarse;
    }
    /// Fine displacements (or velocities) for coarse ones: of each particle the weighted mean of
    /// the four nearest seeds', continuous as they move on. A seed, and so a pin, has its own.
    /// @param displacement  m (or m/s), Dim × system.size()   @returns Dim × n
    Points<Scalar, Dim> lifted(const Points<Scalar, Dim>& displacement) const {
        if (displacement.cols() != system.size())
            fail("Coarsening::lifted: the displacement has ", displacement.cols(),
                 " columns; the coarse system has ", system.size(), " particles");
        Points<Scalar, Dim> fine(Dim, mass_.size());
        for (Index i = 0; i < fine.cols(); ++i) fine.col(i) = lifted(displacement, i);
        return fine;
    }
    /// Of one fine particle. Unchecked: 0 ≤ i < n.
    Eigen::Matrix<Scalar, Dim, 1> lifted(const Points<Scalar, Dim>& displacement, Index i) const {
        const auto& row = lift_.rows[static_cast<std::size_t>(i)];
        Eigen::Matrix<Scalar, Dim, 1> sum = Eigen::Matrix<Scalar, Dim, 1>::Zero();
        for (std::size_t k = 0; k < row.count; ++k)
            sum += static_cast<Scalar>(row.weight[k]) * displacement.col(row.coarse[k]);
        return sum;
    }

private:
    VectorX<Scalar> mass_;  // kg, of the fine particles
    scene_detail::Lift lift_;
};

namespace scene_detail {

template <class System>
void require_coarsenable(const System& system, Index count) {
    if (system.size() == 0) fail("coarsen: the system has no particles");
    if (count < 1 || count > system.size())
        fail("coarsen: count is ", count, "; the system has ", system.size(), " particles");
    if (count < system.pinned_count())
        fail("coarsen: count is ", count, "; all ", system.pinned_count(), " pins stay");
    const auto& external = system.external_forces();
    const char* cannot = ": what a coarse particle would feel of it is not known; end it first";
    if (external.whole) fail("coarsen: set_external_force", cannot);
    if (external.outside) fail("coarsen: ", external.outside->name(), cannot);
}

template <class System>
std::vector<int> pins_of(const System& system) {
    std::vector<int> pins;
    for (Index i = 0; i < system.size(); ++i)
        if (system.is_pinned(i)) pins.push_back(static_cast<int>(i));
    return pins;
}
/// The fewest seeds that every particle is joined to: those given, and one for each part without.
inline Index least_seeds(const SpringGraph& graph, Clusters clusters) {
    for (int i = 0; i < graph.size(); ++i)
        if (clusters.of[i] < 0) add_seed(graph, i, clusters);
    return static_cast<Index>(clusters.seeds.size());
}

}  // namespace scene_detail

/// The smallest count that coarsen() takes: the pins, and one for each part without a pin.
template <class System>
Index least_count(const System& system) {
    const scene_detail::SpringGraph graph(system, system.initial_state().x);
    const std::vector<int> pins = scene_detail::pins_of(system);
    return scene_detail::least_seeds(
        graph, scene_detail::farthest_seeds(graph, pins, static_cast<int>(pins.size())));
}

/// A network of `count` particles that moves as the system does, as far as so few can.
///
/// The particles that stay, the seeds, are the pins and then always the particle farthest from all
/// so far along the springs (farthest-point sampling); those of a smaller count come first among
/// those of a larger one. Ways are measured in mean spring lengths of their part of the scene, and
/// soft springs count as longer, so that clusters end where a scene gives way. Each takes the mass
/// of the particles nearest to it and the constant forces on them. Springs between two such
/// clusters become one: k_AB = Σ k l |cos θ|³/L_AB, which stores the same energy under a stretch
/// along AB; rest lengths keep the mean strain, of slack and taut springs apart. Lengths and angles
/// are those of initial_state(). Gravity and damping factors are carried over.
///
/// What is lost: wrinkles finer than a cluster, and what a spring across AB does. resolve() says
/// how much that matters.
/// @param count  at least least_count(system), at most system.size()
/// @throws (fail) where the count is not in that range; where a spring with a rest length has no
///         length in initial_state(); and by name for forces that cannot be carried over:
///         set_external_force, set_wind
template <class Scalar, int Dim, class... Laws>
Coarsening<SpringSystem<Scalar, Dim, Laws...>> coarsen(
    const SpringSystem<Scalar, Dim, Laws...>& system, Index count) {
    using System = SpringSystem<Scalar, Dim, Laws...>;
    scene_detail::require_coarsenable(system, count);
    const auto x = system.initial_state().x;
    const std::vector<int> pins = scene_detail::pins_of(system);
    const scene_detail::SpringGraph graph(system, x);
    auto clusters = scene_detail::farthest_seeds(graph, pins, static_cast<int>(count));
    if (const Index least = scene_detail::least_seeds(graph, clusters); count < least)
        fail("coarsen: count is ", count, "; pins, and one particle of each part that no spring ",
             "joins to them, are at least ", least);

    Buffer<double> mass(clusters.seeds.size(), 0);
    VectorX<Scalar> fine_mass(system.size());
    Eigen::Matrix<double, Dim, Eigen::Dynamic> force(Dim, count);
    force.setZero();
    const auto& constant = system.external_forces().constant;
    for (Index i = 0; i < system.size(); ++i) {
        fine_mass[i] = system.mass(i);
        mass[clusters.of[i]] += static_cast<double>(system.mass(i));
        if (i < constant.cols())
            force.col(clusters.of[i]) += constant.col(i).template cast<double>();
    }
    System coarse;
    for (Index c = 0; c < count; ++c) {
        coarse.add_particle(x.col(clusters.seeds[c]), static_cast<Scalar>(mass[c]));
        if (c < static_cast<Index>(pins.size())) coarse.pin(c);
    }
    for (Index c = 0; c < count; ++c)
        if (!force.col(c).isZero(0))
            coarse.set_constant_force(c, force.col(c).template cast<Scalar>());
    coarse.set_gravity(system.gravity());
    coarse.set_rayleigh(system.rayleigh());

    std::vector<scene_detail::ClusterPair> pairs;
    system.for_each_set([&](const auto& set) {
        scene_detail::add_coarse_springs(set, x, clusters, coarse, pairs);
    });
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    auto lift = scene_detail::make_lift(x, clusters, pairs);
    return {std::move(coarse),
            {clusters.seeds.begin(), clusters.seeds.end()},
            {clusters.of.begin(), clusters.of.end()},
            std::move(fine_mass),
            std::move(lift)};
}

}  // namespace taut
