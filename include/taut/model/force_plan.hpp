// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

#include "detail/cache_order.hpp"
#include "detail/spring_plan.hpp"
#include "spring_system.hpp"

namespace taut {

/// The spring forces of a SpringSystem as a sweep over memory in order, for steppers.
///
/// Springs of one offset b − a and consecutive a become a run: no indices, no gather; a grid is a
/// handful of them. Where most springs fit no run, particles get a cache-friendly numbering, seen
/// only in the planes (one array a coordinate) that this class reads and writes.
template <class System>
class ForcePlan {
public:
    using Scalar = typename System::Scalar;
    static constexpr int Dim = System::Dim;
    using Planes = detail::Planes<Scalar>;
    using Sweep = detail::BlockSweep<Scalar>;

    /// Brings the plan up to date with particles, springs and pins. @returns whether it changed
    bool update(const System& system);

    /// n, the number of particles.
    Index size() const { return size_; }
    /// Scalars from one plane to the next: size() and what a whole register may touch beyond it.
    Index stride() const { return stride_; }
    /// Blocks of particles that a sweep goes through one by one.
    int blocks() const {
        return static_cast<int>((size_ + detail::block_size - 1) / detail::block_size);
    }

    /// Whether a spring has a damper of its own.
    bool damped() const {
        return std::apply([](const auto&... plan) { return (plan.damped() || ...); }, plans_);
    }

    /// Planes ← points, Dim × size(), converted where they hold another number type.
    template <class Matrix>
    void to_planes(const Matrix& points, const Planes& planes) const {
        for_each_place([&](Index i, Index place) {
            for (int d = 0; d < points.rows(); ++d)
                planes[d][place] = static_cast<Scalar>(points(d, i));
        });
    }
    /// Points ← planes.
    template <class Matrix>
    void from_planes(const Planes& planes, Matrix& points) const {
        for_each_place([&](Index i, Index place) {
            for (int d = 0; d < points.rows(); ++d) {
                points(d, i) = static_cast<typename Matrix::Scalar>(planes[d][place]);
            }
        });
    }

    /// Adds the forces of springs and of all their damping that the sweep's tile brings to its
    /// block.
    void add_forces(const Sweep& sweep) const {
        std::apply(
            [&](const auto&... plan) {
                const auto add = [&](auto kind) {
                    (plan.template add_forces<decltype(kind)::value>(sweep), ...);
                };
                using detail::Proportional;
                if (sweep.damping.projected > 0) {
                    add(std::integral_constant<Proportional, Proportional::projected>{});
                } else if (sweep.damping.graph > 0) {
                    add(std::integral_constant<Proportional, Proportional::graph>{});
                } else {
                    add(std::integral_constant<Proportional, Proportional::none>{});
                }
            },
            plans_);
    }

private:
    template <class Set>
    struct PlanOf;
    template <class Law>
    struct PlanOf<SpringSet<Scalar, Law>> {
        using type = detail::SpringPlan<Scalar, Dim, Law>;
    };
    template <class Sets>
    struct PlansOf;
    template <class... Sets>
    struct PlansOf<std::tuple<Sets...>> {
        using type = std::tuple<typename PlanOf<Sets>::type...>;
    };

    template <class Visitor>
    void for_each_place(Visitor&& visit) const {
        if (order_.empty()) {
            for (Index i = 0; i < size_; ++i) visit(i, i);
        } else {
            for (Index place = 0; place < size_; ++place) visit(order_[place], place);
        }
    }
    template <class Number>
    std::vector<detail::SpringRuns> runs(const System& system, const Number& number) const;

    typename PlansOf<typename System::SpringSets>::type plans_;
    std::vector<int> order_;  // particle at each place; empty: particle i at place i
    Index size_ = 0;
    Index stride_ = 0;
    std::uint64_t springs_ = 0;  // the system's spring_revision()
    bool built_ = false;
};

template <class System>
template <class Number>
std::vector<detail::SpringRuns> ForcePlan<System>::runs(const System& system,
                                                        const Number& number) const {
    std::vector<detail::SpringRuns> runs;
    system.for_each_set([&](const auto& set) { runs.emplace_back(set, number); });
    return runs;
}

template <class System>
bool ForcePlan<System>::update(const System& system) {
    if (built_ && springs_ == system.spring_revision()) return false;
    springs_ = system.spring_revision();
    built_ = true;
    size_ = system.size();
    // No two of a particle's planes begin at the same place of a page: a store to one would hold up
    // loads of the other.
    const Index page = static_cast<Index>(4096 / sizeof(Scalar));
    stride_ = (size_ + 2 * detail::most_lanes + page - 1) / page * page + page / 8;

    auto springs = runs(system, [](int i) { return i; });
    std::size_t in_rest = 0;
    for (const auto& set : springs) in_rest += set.rest().size();
    order_.clear();
    if (2 * in_rest > static_cast<std::size_t>(system.spring_count())) {
        std::vector<detail::Joint> joints;
        system.for_each_spring([&](Index a, Index b) {
            joints.emplace_back(static_cast<int>(a), static_cast<int>(b));
        });
        order_ = detail::cache_order(static_cast<int>(size_), joints);
        std::vector<int> place(order_.size());
        for (std::size_t i = 0; i < order_.size(); ++i) place[order_[i]] = static_cast<int>(i);
        springs = runs(system, [&](int i) { return place[i]; });
    }
    system.for_each_set([&, next = springs.cbegin()](const auto& set) mutable {
        using Plan = typename PlanOf<std::decay_t<decltype(set)>>::type;
        std::get<Plan>(plans_) =
            Plan(set, *next++, blocks() * (detail::block_size / detail::tile_size));
    });
    return true;
}

}  // namespace taut
