// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <tuple>
#include <vector>

#include "../../model/spring_system.hpp"
#include "cache_order.hpp"
#include "law_plan.hpp"
#include "tile.hpp"

namespace taut::integrator_detail::sweep {

/// All springs of a SpringSystem, law by law, and the places of its particles. Where too many
/// springs are scattered, particles get an order that brings ends together, and where too many
/// still are, all springs are in stars; only the planes that this class reads and writes know of
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

    /// n, the number of particles and of places.
    Index size() const { return size_; }
    const Blocks& blocks() const { return blocks_; }
    /// The most blocks between places that a force ties together.
    int reach() const { return outside_ ? std::max(reach_, outside_plan_->reach()) : reach_; }
    /// Whether springs are in stars: then one plane holds points, x y z 0.
    bool has_stars() const { return stars_; }
    /// Of one vector.
    int planes() const { return stars_ ? 1 : Dim; }
    /// Scalars of a place in a plane.
    Index grain() const { return stars_ ? 4 : 1; }
    /// Scalars from one plane to the next: size()·grain() and the padding.
    Index stride() const { return stride_; }

    /// Whether a spring has a damper of its own.
    bool damped() const {
        return std::apply([](const auto&... plan) { return (plan.damped() || ...); }, plans_);
    }

    /// Whether there is an outside force.
    bool has_outside() const { return outside_ != nullptr; }

    /// Planes ← points, Dim × size(), converted where they hold another number type.
    template <class Matrix>
    void to_planes(const Matrix& points, const Planes<Scalar>& planes) const {
        for_each_place([&](Index i, Index place) {
            for (int d = 0; d < Dim; ++d) at(planes, d, place) = static_cast<Scalar>(points(d, i));
            for (int d = Dim; d < 4 && stars_; ++d) at(planes, d, place) = 0;
        });
    }
    /// Points ← planes.
    template <class Matrix>
    void from_planes(const Planes<Scalar>& planes, Matrix& points) const {
        for_each_place([&](Index i, Index place) {
            for (int d = 0; d < Dim; ++d) {
                points(d, i) = static_cast<typename Matrix::Scalar>(at(planes, d, place));
            }
        });
    }

    /// Plane ← values, one a particle; with stars, one for each scalar of its point.
    template <class Vector>
    void to_plane(const Vector& values, Scalar* plane) const {
        for_each_place([&](Index i, Index place) {
            std::fill_n(plane + grain() * place, grain(), static_cast<Scalar>(values[i]));
        });
    }

    /// Of each particle.
    std::vector<int> places() const {
        std::vector<int> result(static_cast<std::size_t>(size_));
        for_each_place([&](Index i, Index place) { result[i] = static_cast<int>(place); });
        return result;
    }
    /// The scalar of one axis at a place of planes.
    Scalar& at(const Planes<Scalar>& planes, int d, Index place) const {
        return planes.first[d * (stars_ ? 1 : planes.stride) + place * grain()];
    }

    /// Adds the forces of the tile's springs, of all their damping, and of the outside force, on
    /// the places of its block.
    /// @tparam Ahead  whether springs that push do so along the old direction [T42]
    template <bool Ahead>
    void add_forces(const TileView<Scalar>& view) const {
        if (outside_) outside_->add(*outside_plan_, view);
        std::apply(
            [&](const auto&... plan) {
                const auto add = [&](auto rayleigh) {
                    (plan.template add_forces<decltype(rayleigh)::value, Ahead>(view, stars_), ...);
                };
                if (view.alpha > 0) {
                    add(std::true_type{});
                } else {
                    add(std::false_type{});
                }
            },
            plans_);
    }

private:
    /// The share of scattered springs from which on stars were faster, on AMD's and Intel's
    /// processors: a scattered spring costs five springs of a run or more, one in a star two, but
    /// in registers of 16 bytes hardly more than one.
    static constexpr double most_scattered =
        VectorRegister<Scalar>::width * sizeof(Scalar) > 16 ? 0.25 : 0.05;

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

    template <class Visitor>
    void for_each_place(Visitor&& visit) const {
        if (order_.empty()) {
            for (Index i = 0; i < size_; ++i) visit(i, i);
        } else {
            for (Index place = 0; place < size_; ++place) visit(order_[place], place);
        }
    }
    void plan_springs(const System& system);
    /// The springs of each law.
    template <class PlaceOf>
    std::vector<SortedSprings> sort(const System& system, const PlaceOf& place_of) const;

    typename PlansOf<typename System::SpringSets>::type plans_;
    std::vector<int> order_;  // the particle at each place; empty: particle i at place i
    Index size_ = 0;
    Blocks blocks_;
    Index stride_ = 0;
    int reach_ = 0;              // of springs
    std::uint64_t springs_ = 0;  // the system's spring_revision()
    std::shared_ptr<const model_detail::OutsideForce<Scalar, Dim>> outside_;  // the system's
    std::shared_ptr<const TilePlan<Scalar>> outside_plan_;
    bool stars_ = false;
    bool built_ = false;
};

/// The vectors of planes by particle.
template <class System>
class PlaceVectors {
public:
    using Vector = typename System::Vector;

    PlaceVectors(const ForcePlan<System>& plan, const std::vector<int>& places,
                 const Planes<typename System::Scalar>& planes)
        : plan_(plan), places_(places), planes_(planes) {}

    Vector operator()(Index i) const {
        Vector vector;
        for (int d = 0; d < System::Dim; ++d) vector[d] = plan_.at(planes_, d, places_[i]);
        return vector;
    }
    void set(Index i, const Vector& vector) const {
        for (int d = 0; d < System::Dim; ++d) plan_.at(planes_, d, places_[i]) = vector[d];
    }

private:
    const ForcePlan<System>& plan_;
    const std::vector<int>& places_;
    Planes<typename System::Scalar> planes_;
};

template <class System>
template <class PlaceOf>
std::vector<SortedSprings> ForcePlan<System>::sort(const System& system,
                                                   const PlaceOf& place_of) const {
    std::vector<SortedSprings> springs;
    system.for_each_set([&](const auto& set) { springs.emplace_back(set, place_of); });
    return springs;
}

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
    outside_plan_ = outside ? outside->plan({places(), blocks_, stars_}) : nullptr;
    return true;
}

template <class System>
void ForcePlan<System>::plan_springs(const System& system) {
    size_ = system.size();
    blocks_ = Blocks(size_);
    auto springs = sort(system, [](int i) { return i; });
    const auto too_scattered = [&] {
        std::size_t scattered = 0;
        for (const auto& of_law : springs) scattered += of_law.scattered().size();
        return static_cast<double>(scattered) >
               most_scattered * static_cast<double>(system.spring_count());
    };
    order_.clear();
    stars_ = false;
    if (too_scattered()) {
        std::vector<Edge> edges;
        system.for_each_spring([&](Index a, Index b) {
            edges.emplace_back(static_cast<int>(a), static_cast<int>(b));
        });
        order_ = cache_order(static_cast<int>(size_), edges);
        springs = sort(system, [place_of = places()](int i) { return place_of[i]; });
        stars_ = Dim > 1 && too_scattered();
    }
    reach_ = 0;
    for (const auto& of_law : springs) {
        for (const auto& spring : of_law.all()) {
            reach_ = std::max(reach_, blocks_.of(spring.b) - blocks_.of(spring.a));
        }
    }
    // No two planes of one vector begin at the same byte of a page: a store to one would hold up
    // loads of the other.
    const Index page = static_cast<Index>(4096 / sizeof(Scalar));
    stride_ = (size_ * grain() + 2 * max_width + page - 1) / page * page + page / 8;

    system.for_each_set([&, next = springs.cbegin()](const auto& set) mutable {
        using Plan = typename PlanOf<std::decay_t<decltype(set)>>::type;
        std::get<Plan>(plans_) = Plan(set, *next++, blocks_, stars_);
    });
}

}  // namespace taut::integrator_detail::sweep
