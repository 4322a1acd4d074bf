// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>

#include "../core/detail/fits.hpp"
#include "../network/spring_system.hpp"
#include "detail/symplectic_limit.hpp"
#include "rayleigh.hpp"

namespace taut {

/// How large may the step be, and how do you know? Analysis of one pose of a SpringSystem, in
/// double whatever Scalar is: what rounding to Scalar may do to a step counts, and masses,
/// stiffnesses, dampings and lengths whose squares double does not hold (below 3e-151 or above
/// 3e150) are refused by name. It keeps a copy of what it needs: later changes of the system do not
/// reach it (see StepLimit::revision).
///
///     taut::Stability<double> stability(cloth, state);
///     auto limit = stability.max_step(taut::Method::symplectic_euler);
///
/// Where springs are compressed, K⁺ stands for K in every answer and the growth of the physics is
/// given apart [T27]. A certified step holds on both sides of a law's kink that lies within
/// rounding of a spring's length; what refutes takes the stiffer side. Zero modes never count as
/// unstable. BDF2, of which nothing is proved beside compressed springs, is refused by name.
///
/// All answers are by bounds alone, O(springs) for each of a few passes [T26]. What refutes and
/// what names a mode searches for vectors, proof/bracket.hpp: `bracket(stability, method)`,
/// `stiffness_spectrum`, `limiting_mode`, `limiting_springs`. What factorises, or solves a whole
/// eigenvalue problem, is one more header away, tight/tight.hpp: `max_step(stability, method,
/// tightness)`, `certify`, the eigenvalues of the matrix of a step under any damping
/// (`spectral_radius`, the limit of explicit Euler), `count_zero_modes`. Systems of your own
/// matrices are by own_matrices/own_matrices.hpp.
template <class Scalar>
class Stability {
public:
    /// For a system of the same Scalar with a function make_pencil(system), as a LinearSystem.
    template <class System, class = decltype(make_pencil(std::declval<const System&>())),
              class = std::enable_if_t<std::is_same_v<typename System::Scalar, Scalar>>>
    explicit Stability(const System& system)
        : pencil_(make_pencil(system)), revision_(system.revision()) {
        pencil_->require_range("Stability");
    }

    /// @param state  the pose; its velocity is taken as zero. Fails unless it is finite and fits.
    template <class Own = Scalar, int Dim, class... Laws>
    Stability(const SpringSystem<Own, Dim, Laws...>& system, const State<Own, Dim>& state)
        : revision_(system.revision()) {
        static_assert(std::is_same_v<Own, Scalar>,
                      "taut::Stability<Scalar>: needs a system of the same Scalar");
        detail::require_fits("Stability", state, system.size());
        if (!detail::all_finite(state.x)) {
            const State<Own, Dim> still{state.x, State<Own, Dim>::zero(system.size()), 0};
            fail("Stability: the position of particle ", still.first_not_finite(),
                 " is not finite");
        }
        pencil_ = std::make_shared<const Pencil>(
            Pencil::at_pose(system, state.x.template cast<TangentReal<Scalar>>()));
        pencil_->require_range("Stability");
    }

    /// The largest step that is proved stable, s. `refuted` and growth_rate are not looked for.
    StepLimit<Scalar> max_step(Method method) const;
    /// The same of a method or condition of your own.
    /// @param certified  double certified(const Pencil&), s: what its bounds prove; 0: nothing;
    ///                   infinity: every step
    template <class Condition, class = std::enable_if_t<
                                   std::is_invocable_r_v<double, const Condition&, const Pencil&>>>
    StepLimit<Scalar> max_step(const Condition& certified) const {
        using namespace proof_detail;
        UnroundedLimit limit{infinity, infinity, Cause::nothing_to_limit};
        const double h = size() > 0 ? certified(*pencil_) : infinity;
        if (h != infinity) {
            limit = {h > 0 ? h : 0, infinity, Cause::stiffness};
            forget_unheld<Scalar>(limit);
            add_compression(*pencil_, limit);
        }
        return rounded<Scalar>(limit, revision_);
    }
    /// The α, s, that make step h stable with D = d0·M + αK⁺ in place of the system's own damping:
    /// proved, since it takes k_max from above and k_min as 0 [T14]–[T16].
    AlphaWindow rayleigh_window(Method method, double h, double d0 = 0) const;
    /// The largest factor on all stiffness (αK⁺ included) for which step h, s, is still certified
    /// by the bound, to nine digits; 0 if none is, infinity if every one is, of those that double
    /// holds.
    double max_stiffness_scale(Method method, double h) const;
    /// The least factor on all masses (d0·M included) for which step h, s, is certified by the
    /// bound, to nine digits; infinity if none is, 0 if every one is.
    double min_mass_scale(Method method, double h) const;

    /// The system's when this was made, see StepLimit.
    std::uint64_t revision() const { return revision_; }
    /// Free degrees of freedom.
    Index size() const { return pencil_->size(); }
    /// What all answers are computed from.
    const Pencil& pencil() const { return *pencil_; }

private:
    std::shared_ptr<const Pencil> pencil_;  // immutable, so copies may share it
    std::uint64_t revision_ = 0;
};

/// Stability(system, state) is of the system's Scalar.
template <class Scalar, int Dim, class... Laws>
Stability(const SpringSystem<Scalar, Dim, Laws...>&, const State<Scalar, Dim>&)
    -> Stability<Scalar>;

}  // namespace taut

#if !defined(TAUT_COMPILED)
#include "stability-inl.hpp"
#endif
