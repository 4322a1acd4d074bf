// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <tuple>
#include <vector>

#include "../network/spring_system.hpp"
#include "law_plan.hpp"
#include "layout.hpp"
#include "planner.hpp"

namespace taut::step_detail {

/// What adds the forces of a tile.
template <class Scalar>
class TileForces {
public:
    /// The most blocks between places that a force ties together.
    int reach() const { return reach_; }
    const Layout<Scalar>& layout() const { return layout_; }
    /// Adds the forces of the tile's springs, of all their damping, and of the outside force, on
    /// the places of its block.
    virtual void add(const TileView<Scalar>& view) const = 0;

protected:
    TileForces(const Layout<Scalar>& layout, int reach) : layout_(layout), reach_(reach) {}
    ~TileForces() = default;

private:
    const Layout<Scalar>& layout_;
    int reach_;
};

/// All springs of a SpringSystem, law by law, and the places of its particles. Where too many
/// springs are scattered, particles get an order that brings ends together, and where too many
/// still are, all springs are in stars; only the planes that the layout reads and writes know of
/// either.
template <class System>
class ForcePlan {
    template <class... Sets>
    static constexpr bool some_law_pushes(std::tuple<Sets...>*) {
        return (!Sets::Law::convex || ...);
    }

public:
    using Scalar = typename System::Scalar;
    static constexpr int Dim = System::Dim;

    /// Whether some law may push.
    static constexpr bool pushes =
        some_law_pushes(static_cast<typename System::SpringSets*>(nullptr));

    /// Brings the plan up to date with particles, springs and the outside force. @returns whether
    /// it changed
    bool update(const System& system);

    const Layout<Scalar>& layout() const { return layout_; }
    /// Whether a spring has a damper of its own.
    bool damped() const {
        return std::apply([](const auto&... plan) { return (plan.damped() || ...); }, plans_);
    }
    /// Whether there is an outside force.
    bool has_outside() const { return outside_ != nullptr; }

    /// @tparam Ahead  whether springs that push do so along the old direction [T42]
    template <bool Ahead>
    class Forces final : public TileForces<Scalar> {
    public:
        explicit Forces(const ForcePlan& plan)
            : TileForces<Scalar>(plan.layout_, plan.reach()), plan_(plan) {}
        void add(const TileView<Scalar>& view) const override {
            if (plan_.outside_) plan_.outside_->add(*plan_.outside_plan_, view);
            std::apply([&](const auto&... plan) { (add(plan, view), ...); }, plan_.plans_);
        }

    private:
        template <class Law>
        static void add(const LawPlan<Scalar, Dim, Law>& plan, const TileView<Scalar>& view) {
            plan.template add_forces<Ahead && !Law::convex>(view);
        }

        const ForcePlan& plan_;
    };

private:
    template <class Set>
    struct PlanOf;
    template <class Law>
    struct PlanOf<SpringSet<Scalar, Law>> {
        using type = LawPlan<Scalar, Dim, Law>;
    };
    template <class Sets>
    struct PlansOf;
    template <class... Sets>
    struct PlansOf<std::tuple<Sets...>> {
        using type = std::tuple<typename PlanOf<Sets>::type...>;
    };

    int reach() const { return outside_ ? (std::max)(reach_, outside_plan_->reach()) : reach_; }
    TAUT_COLD void plan_springs(const System& system);

    typename PlansOf<typename System::SpringSets>::type plans_;
    Layout<Scalar> layout_;
    int reach_ = 0;              // of springs
    std::uint64_t springs_ = 0;  // the system's spring_revision()
    std::shared_ptr<const network_detail::OutsideForce<Scalar, Dim>> outside_;  // the system's
    std::shared_ptr<const TilePlan<Scalar>> outside_plan_;
    bool built_ = false;
};

template <class System>
bool ForcePlan<System>::update(const System& system) {
    const auto& outside = system.external_forces().outside;
    const bool same_springs = built_ && springs_ == system.spring_revision();
    const bool same_outside =
        outside == outside_ || (outside && outside_ && outside->shares_plan(*outside_));
    outside_ = outside;
    if (same_springs && same_outside) return false;
    if (!same_springs) plan_springs(system);
    springs_ = system.spring_revision();
    built_ = true;
    outside_plan_ = outside
                        ? outside->plan({layout_.places(), layout_.blocks(), layout_.has_stars()})
                        : nullptr;
    return true;
}

template <class System>
void ForcePlan<System>::plan_springs(const System& system) {
    Buffer<SpringEnds> ends;
    system.for_each_set([&](const auto& set) { ends.push_back({set.a, set.b}); });
    SpringOrder planned = Planner<Scalar>::order(ends, Blocks(system.size()), Dim > 1);
    reach_ = planned.reach;
    layout_ = {system.size(), Dim, std::move(planned.order), planned.stars};
    system.for_each_set([&, next = planned.laws.get()](const auto& set) mutable {
        using Plan = typename PlanOf<std::decay_t<decltype(set)>>::type;
        std::get<Plan>(plans_).renew(set, *next++, layout_.blocks(), planned.stars);
    });
}

}  // namespace taut::step_detail
