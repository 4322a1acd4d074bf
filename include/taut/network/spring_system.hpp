// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "../core/detail/fits.hpp"
#include "../core/error.hpp"
#include "../core/revision.hpp"
#include "damping.hpp"
#include "detail/law_check.hpp"
#include "external_forces.hpp"
#include "hookean.hpp"
#include "spring_set.hpp"
#include "state.hpp"

namespace taut {
namespace network_detail {

template <class... Types>
inline constexpr bool all_different = true;
template <class First, class... Rest>
inline constexpr bool all_different<First, Rest...> =
    !(std::is_same_v<First, Rest> || ...) && all_different<Rest...>;

}  // namespace network_detail

/// Particles joined by springs: M ẍ = f(x, v) [T1] with gravity, pins, dampers and Rayleigh
/// damping.
///
/// Each law of `Laws` (none means Hookean) keeps its own springs. Spring indices count the laws in
/// the order they are named, and within one law the order of adding. A pinned particle ignores
/// forces and moves with the velocity that the state gives it (zero unless you set it).
template <class Scalar_, int Dim_, class... Laws>
class SpringSystem {
    static_assert(std::is_floating_point_v<Scalar_>,
                  "taut::SpringSystem<Scalar, Dim>: Scalar must be float, double or long double");
    static_assert(Dim_ >= 1 && Dim_ <= 3, "taut::SpringSystem<Scalar, Dim>: Dim must be 1, 2 or 3");
    static_assert(network_detail::all_different<Laws...>,
                  "taut::SpringSystem<Scalar, Dim, Laws...>: each law is named once");
    static_assert((require_law<Laws, Scalar_>(), ..., true));

public:
    using Scalar = Scalar_;
    static constexpr int Dim = Dim_;
    using State = taut::State<Scalar, Dim>;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    using Force = Points<Scalar, Dim>;
    /// Adds forces, N, to its second argument (Dim × n), which may hold other forces already. Taken
    /// as constant over a step. Where an explicit call diverges, it is asked again from the start.
    using ExternalForce = std::function<void(const State&, Force&)>;
    using SpringSets =
        std::conditional_t<sizeof...(Laws) == 0, std::tuple<SpringSet<Scalar, Hookean>>,
                           std::tuple<network_detail::SetOf<Scalar, Laws>...>>;
    using FirstLaw = std::tuple_element_t<0, std::tuple<Laws..., Hookean>>;

    // ---- building; every call is checked, wrong values go to fail() ----

    /// @param position  m, finite   @param mass  kg, finite and > 0   @returns its index
    Index add_particle(const Vector& position, Scalar mass);
    /// A Hookean spring at rest where its ends are now. @param stiffness N/m @param damping N·s/m
    Index add_spring(Index a, Index b, Scalar stiffness, Scalar damping = 0);
    /// A spring of any law of the system, at rest where its ends are now.
    template <class Law>
    Index add_spring(Index a, Index b,
                     const network_detail::usable_parameters<Law, Scalar>& parameters,
                     Scalar damping = 0);
    /// A spring with its rest length given. A debug build fails if the law exceeds its own
    /// stiffness_bound at one of some lengths. @returns its index within its law
    template <class Law>
    Index add_spring(const Spring<Scalar, Law>& spring);

    // Edits between steps. Each raises revision(): ask any_pose_limit again, as Guarded does by
    // itself. The next step renews what it keeps of the springs: an explicit one sorts them anew,
    // an implicit one analyses the pattern anew after springs have come or gone.

    /// Removes spring s of the law; the law's last spring takes its index. Cost: O(1).
    template <class Law = FirstLaw>
    void remove_spring(Index s);
    /// Removes every spring s of the law with goes(s); the others keep their order. One pass, and
    /// one change of the revision if any went.
    /// @returns how many went
    template <class Law = FirstLaw, class Predicate>
    Index remove_springs(Predicate&& goes);
    /// Of spring s of the law; rest length and damping stay. Cost: O(1).
    template <class Law = FirstLaw>
    void set_parameters(Index s, const network_detail::usable_parameters<Law, Scalar>& parameters);
    /// Of a Hookean spring. @param stiffness N/m
    void set_stiffness(Index s, Scalar stiffness) { set_parameters<Hookean>(s, {stiffness}); }

    /// From now on forces do not move particle i. Never lowers a limit.
    void pin(Index i) { set_pinned(i, true); }
    /// Frees particle i, with the mass that it had.
    void unpin(Index i) { set_pinned(i, false); }
    /// @param mass  kg, finite and > 0; a pinned particle has it once it is free
    void set_mass(Index i, Scalar mass);
    /// @param gravity  acceleration, m/s²
    void set_gravity(const Vector& gravity);
    /// @param rayleigh  both factors ≥ 0 and finite in Scalar; acts through K⁺ [T28]
    void set_rayleigh(const RayleighDamping& rayleigh);

    // External forces add up. Step limits and certificates hold for the scene without them. A
    // strong drag on light particles can make an explicit step unstable.

    /// A force of the whole state. An empty function ends it.
    void set_external_force(ExternalForce force) {
        external_.whole = std::move(force);
        ++force_revision_;
    }
    /// A constant force on particle i in place of the last one. @param force  N, finite; 0 ends it
    void set_constant_force(Index i, const Vector& force);
    /// For modules: the force of one, in place of the last one; null ends it.
    void set_outside_force(std::shared_ptr<const network_detail::OutsideForce<Scalar, Dim>> force) {
        external_.outside = std::move(force);
        ++force_revision_;
    }

    // ---- queries ----

    /// n, the number of particles, pinned ones included.
    Index size() const { return static_cast<Index>(mass_.size()); }
    /// Springs of all laws.
    Index spring_count() const;
    /// Particles that are pinned.
    Index pinned_count() const;
    /// Unchecked: 0 ≤ i < size().
    bool is_pinned(Index i) const { return inverse_mass_[i] == Scalar(0); }
    /// kg, of pinned particles too. Unchecked: 0 ≤ i < size().
    Scalar mass(Index i) const { return mass_[i]; }
    /// 1/kg for each particle, 0 for a pinned one.
    Eigen::Map<const VectorX<Scalar>> inverse_mass() const {
        return {inverse_mass_.data(), size()};
    }
    /// Both factors 0 unless set.
    const RayleighDamping& rayleigh() const { return rayleigh_; }
    /// m/s², 0 unless set.
    const Vector& gravity() const { return gravity_; }
    /// The springs of one law.
    template <class Law = FirstLaw>
    const network_detail::SetOf<Scalar, Law>& springs() const {
        return std::get<network_detail::SetOf<Scalar, Law>>(sets_);
    }
    /// Changes whenever springs, masses, pins or damping do: whatever a step limit depends on.
    std::uint64_t revision() const { return revision_; }
    /// Changes whenever the force may have: with revision(), gravity and external forces.
    std::uint64_t force_revision() const { return revision_ + force_revision_; }
    /// Changes whenever particles, springs or pins are added or removed, and so with the sparsity
    /// pattern of the free matrices.
    std::uint64_t topology_revision() const { return topology_revision_; }
    /// Changes whenever particles, springs, their parameters or pins do.
    std::uint64_t spring_revision() const { return topology_revision_ + parameter_revision_; }

    /// The positions given to add_particle, at rest.
    State initial_state() const;
    /// f ← total force on every particle, N, Dim × n; on a pinned one, what its pin has to bear.
    void force(const State& state, Force& f) const;
    /// The same for a step of h, s, of EnergyStableEuler: springs pull as [T42] says.
    void force_ahead(const State& state, Scalar h, Force& f) const;
    /// Whether any external force is set.
    bool has_external_force() const { return external_.any(); }
    /// All of them.
    const ExternalForces<Scalar, Dim>& external_forces() const { return external_; }
    /// f ← the sum of external forces alone, N, Dim × n.
    void external_force(const State& state, Force& f) const {
        f.setZero(Dim, size());
        external_.add(state, f);
    }
    /// Kinetic energy of the free particles, J.
    Scalar kinetic_energy(const State& state) const;
    /// Energy of springs and gravity, J; external forces have none.
    Scalar potential_energy(const State& state) const;
    /// Kinetic and potential energy, J.
    Scalar energy(const State& state) const {
        return kinetic_energy(state) + potential_energy(state);
    }

    // ---- loops for solvers and analysis ----

    /// visit(a, b) for every spring, in index order.
    template <class Visitor>
    void for_each_spring(Visitor&& visit) const {
        visit_springs([&](const auto& spring) { visit(spring.a, spring.b); });
    }
    /// visit(spring) for every Spring of whatever law, in index order.
    template <class Visitor>
    void visit_springs(Visitor&& visit) const {
        for_each_set([&](const auto& set) {
            for (const auto spring : set) visit(spring);
        });
    }
    /// visit(SpringTangent<Real, Dim>) for every spring at x, in the precision of x.
    template <class Real, class Visitor>
    void for_each_tangent(const Points<Real, Dim>& x, Visitor&& visit) const {
        for_each_set([&](const auto& set) {
            for (std::size_t s = 0; s < set.a.size(); ++s) visit(set.tangent(s, x));
        });
    }
    /// visit(set) for the SpringSet of every law.
    template <class Visitor>
    void for_each_set(Visitor&& visit) const {
        std::apply([&](const auto&... set) { (visit(set), ...); }, sets_);
    }

private:
    template <class Law>
    static constexpr bool has_law = (std::is_same_v<Law, Hookean> && sizeof...(Laws) == 0) ||
                                    (std::is_same_v<Law, Laws> || ...);

    /// f ← forces of which those of springs are pull(spring) on their ends a, and the opposite on
    /// b.
    template <class PullOf>
    void sum_forces(const State& state, Force& f, PullOf&& pull) const;
    void require_particle(const char* function, const char* argument, Index i) const;
    void require_mass(const char* function, Index i, Scalar mass) const;
    void set_pinned(Index i, bool pinned);
    template <class Law>
    network_detail::SetOf<Scalar, Law>& set_with(const char* function, Index s);

    Buffer<Scalar> position_;      // where add_particle put each particle, Dim numbers, m
    Buffer<Scalar> mass_;          // kg, of pinned particles too
    Buffer<Scalar> inverse_mass_;  // 1/kg, 0 if pinned
    SpringSets sets_;
    Vector gravity_ = Vector::Zero();  // m/s²
    RayleighDamping rayleigh_;
    ExternalForces<Scalar, Dim> external_;
    Revision revision_;
    Revision topology_revision_;
    Revision parameter_revision_;  // of springs that stayed
    Revision force_revision_;      // of gravity and external forces
};

namespace network_detail {

template <class System>
inline constexpr bool is_spring_system_v = false;
template <class Scalar, int Dim, class... Laws>
inline constexpr bool is_spring_system_v<SpringSystem<Scalar, Dim, Laws...>> = true;

}  // namespace network_detail
}  // namespace taut

#include "detail/spring_system_build.ipp"
#include "detail/spring_system_force.ipp"
