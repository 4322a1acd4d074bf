// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "../integrator/detail/last_state.hpp"
#include "../integrator/detail/step_loop.hpp"
#include "../integrator/energy_stable_euler.hpp"
#include "../integrator/velocity_verlet.hpp"
#include "../proof/any_pose.hpp"
#include "../proof/energy_limit.hpp"
#include "../proof/sharp_limit.hpp"
#include "detail/stepper.hpp"
#include "detail/trim.hpp"
#include "detail/work.hpp"
#include "report.hpp"

namespace taut {

/// Advances whole frames of a SpringSystem and never gives up [T43]: it tries a frame by a fast
/// step, keeps the books of its energy, trims the end velocities where the frame gained a little,
/// and takes it again by EnergyStableEuler, which cannot gain, where that is not enough.
///
/// What it promises. Of each part, the free particles that springs join, let E be the kinetic
/// energy with that of springs and gravity, K the kinetic energy (about the centre of mass, unless
/// a spring ties the part to a pin), W the work of outside forces, moving pins, constraints and
/// `respond`, and d its balance. Between any two frames m < n, edits between frames apart,
///
///     E_n ≤ E_m + 0.1 K_m + σ_m + Σ W + d_n,   d_n ≤ ρ_n + σ_n where the trial stands,
///
/// with ρ what rounding may hide, and σ, 0 without forces given as code, what these hold back of
/// their work within a step. A frame that is taken again raises d by rounding, and by what such
/// forces change within its steps. No frame is refused as long as states, forces and velocities of
/// pins are finite and no law exceeds its stiffness_bound; the report names a spring that does.
///
/// W of forces given as code is by the trapezoid of every step. A step does not follow them where
/// their change times half of the way is more than a quarter of the part's kinetic energy in it: a
/// spring of stiffness k from h²k/m = 1/4 on, a drag c from hc/m = 1/2. Then the frame is taken in
/// shorter steps, to 1/16 of the proved one or of the frame, and if that does not help, the part is
/// stopped and the force named (Taken::frozen); where a force made a state that is not finite, all
/// parts are. Declare stiff forces as springs, dampers and drag.
///
/// Not promised: accuracy, and anything inside a frame. A frame that is taken again does not know
/// what a trial's constraints hold: pin what must stay. What `respond` or a trial throws leaves the
/// state as it was.
///
/// The trial takes steps of at most 0.95 of any_pose_limit [T23], an implicit one the whole frame,
/// and the rest steps of energy_limit [T42]. Both are sharpened [T45] at the first frame; when the
/// system's revision() has moved on they are asked again, and sharpened after 60 frames without an
/// edit. Positions far from the origin make a float guard blind: see
/// GuardedReport::blind.
///
///     taut::Guarded stepper(cloth);
///     stepper.advance(state, 1.0 / 60);
/// @tparam Stepper  VelocityVerlet unless named; SymplecticEuler, ImplicitEuler, Bdf2,
///                  ProjectiveDynamics, or a call step(state, h) that takes one step of h, s, and
///                  returns nothing or whether it could
template <class Stepper, class System = typename guard_detail::stepped_system<Stepper>::type>
class Guarded {
public:
    using Scalar = typename System::Scalar;
    using State = typename System::State;
    using Options = GuardedOptions<Scalar>;
    static constexpr method::AnyPose any_pose = guard_detail::any_pose_of<Stepper>();
    static_assert(any_pose != method::AnyPose::no_step,
                  "taut::Guarded: the stepper's method, like explicit Euler, has no limit that "
                  "holds at every pose; guard SymplecticEuler, which costs the same");
    static_assert(!detail::is_detected_v<guard_detail::added_kinetic_of, Stepper>,
                  "taut::Guarded: ImexEuler needs no guard, for no step of it gains energy; step "
                  "by it alone");

    /// Keeps a reference: the system must outlive the guard, which makes a trial stepper of its
    /// own. Options out of range go to fail().
    /// @param arguments  further ones of the stepper's constructor, such as its Options
    template <class... Arguments>
    explicit Guarded(const System& system, const Options& options = {}, Arguments&&... arguments)
        : system_(&system),
          options_(options),
          trial_(std::in_place, system, std::forward<Arguments>(arguments)...),
          proved_(system) {
        options.require_valid();
    }
    template <class... Arguments>
    explicit Guarded(const System&&, const Options& = {}, Arguments&&...) = delete;
    /// Guards a stepper or a call of yours, as it is. Keeps references: both must outlive the
    /// guard.
    template <class Lent, class = std::enable_if_t<std::is_same_v<Lent, Stepper>>>
    Guarded(const System& system, Lent& stepper, const Options& options = {})
        : system_(&system), options_(options), trial_(stepper), proved_(system) {
        options.require_valid();
    }
    template <class Lent, class = std::enable_if_t<std::is_same_v<Lent, Stepper>>>
    Guarded(const System&&, Lent&, const Options& = {}) = delete;

    /// Advances by `frame`, s, finite and > 0. Refused, and then the state is as it was: a frame or
    /// a state that is not finite, no certified step (overflow: invalid_step), a force that is not
    /// finite, by name.
    /// @param respond  respond(state) after every step: contacts, for example. What it adds to the
    ///                 energy counts as work. Pins and the system it leaves as they are: move
    ///                 pins and tear between frames.
    template <class Respond = guard_detail::NoResponse>
    GuardedReport<Scalar> advance(State& state, Scalar frame, Respond&& respond = {});
    /// Advances an engine's own arrays by `frame`, s: copied back once a frame, and there if they
    /// are not what the last frame left.
    template <class Stored, class Respond = guard_detail::NoResponse>
    GuardedReport<Scalar> advance(StateView<Stored, System::Dim>& view, Scalar frame,
                                  Respond&& respond = {}) {
        return viewed_.advance(view, [&](State& state) { return advance(state, frame, respond); });
    }

    /// Takes these in place of its own until the system's revision() moves on: those with a
    /// tightness (tight/tight.hpp) cost factorisations and leave 1 % where the sharpened ones leave
    /// 3. Fails unless both are of the system's revision.
    ///
    ///     guard.set_limits(taut::any_pose_limit(cloth, 0.01), taut::energy_limit(cloth, 0.01));
    void set_limits(const StepLimit<Scalar>& limit, const StepLimit<Scalar>& energy) {
        if (limit.revision != system_->revision() || energy.revision != system_->revision()) {
            fail("Guarded::set_limits: the system has changed since a limit was asked");
        }
        any_pose_limit_ = limit;
        proved_limit_ = energy;
        frames_to_sharpen_ = 0;
    }

    /// The trial stepper, to set its solver.
    Stepper& stepper() { return trial_.get(); }
    /// The trial stepper, to ask it.
    const Stepper& stepper() const { return trial_.get(); }
    /// What the guard was made with.
    const Options& options() const { return options_; }
    /// The limit at any pose in force; nothing before the first frame.
    const std::optional<StepLimit<Scalar>>& limit() const { return any_pose_limit_; }
    /// That of the energy-stable step in force; nothing before the first frame.
    const std::optional<StepLimit<Scalar>>& proved_limit() const { return proved_limit_; }

private:
    static constexpr double unit = static_cast<double>(std::numeric_limits<Scalar>::epsilon()) / 2;
    static constexpr int most_halvings = 4;
    using Kind = typename guard_detail::WorkMeter<System>::Kind;
    struct Frame {
        Scalar h;
        Index steps;
    };
    void renew(bool touch);
    Scalar trial_step() const;
    Status open(const State& state, Scalar frame, Scalar longest, GuardedReport<Scalar>& report);
    static Frame cut(Scalar span, Scalar longest, Index most = (std::numeric_limits<Index>::max)());
    template <class By, class Take, class Respond>
    bool run(State& state, Frame frame, Kind kind, By& by, Take&& take, Respond& respond);
    template <class Respond>
    bool try_frame(State& state, Frame frame, Respond& respond);
    double gain(std::size_t part) const;
    bool holds(std::size_t part) const;
    void judge(State& state, bool tried);
    template <class Respond>
    bool take_again(State& state, Scalar span, bool tried, GuardedReport<Scalar>& report,
                    Respond& respond);
    bool stiff_by_code();
    bool resolved(std::size_t part) const;
    void settle_again(std::size_t part, GuardedReport<Scalar>& report);
    template <class Respond>
    void freeze(State& state, Respond& respond);
    Index strongest_spring(std::size_t part) const;
    const char* force_name() const;
    void close(const State& state, GuardedReport<Scalar>& report);
    bool any(Taken taken) const {
        return std::find(taken_.begin(), taken_.end(), taken) != taken_.end();
    }
    /// What became of the part of particle i; of a pin, Taken::again where no trial stands.
    Taken taken_of(Index i, bool tried) const {
        const Index part = parts_.of(i);
        if (part >= 0) return taken_[static_cast<std::size_t>(part)];
        return tried ? Taken::tried : Taken::again;
    }
    /// Whether contacts hold what they held when the last frame ended.
    bool held_as_before() const {
        if (!held_) return held_last_.size() == 0;
        return std::equal(held_->begin(), held_->end(), held_last_.begin(), held_last_.end());
    }
    void measure(const State& state, std::vector<guard_detail::Energy>& energies) {
        meter_.measure(*system_, state, parts_, shortest_, energies);
        for (Index i = 0; held_ && i < system_->size(); ++i) {
            if (parts_.of(i) < 0) continue;
            auto& energy = energies[static_cast<std::size_t>(parts_.of(i))];
            energy.total += (*held_)[i];
            energy.terms += (*held_)[i];
        }
    }

    const System* system_;
    Options options_;
    guard_detail::HeldStepper<Stepper> trial_;
    EnergyStableEuler<System> proved_;
    std::optional<StepLimit<Scalar>> any_pose_limit_, proved_limit_;
    int frames_to_sharpen_ = 0;  // both; 0: they are
    guard_detail::Parts parts_;
    guard_detail::EnergyMeter<System> meter_;
    guard_detail::WorkMeter<System> work_;
    integrator_detail::LastState<State> last_;          // that end_ belongs to
    State start_, again_, touched_;                     // of the frame; taken again; responses
    std::vector<guard_detail::Energy> begin_, end_;     // of each part, like all that follows
    std::vector<guard_detail::Energy> before_, after_;  // a response
    const Buffer<double>* held_ = nullptr;              // by contacts, of each particle, J
    Buffer<double> held_last_;                          // what they held at the end of end_
    const char* blamed_ = nullptr;                      // what the user gave that was not finite
    bool too_stiff_ = false;      // whether a code force asked for shorter steps
    Index where_ = -1;            // and of which particle
    bool edited_ = true;          // whether anything was since the last frame
    Scalar proved_step_ = 0;      // of proved_limit_, with what touches, s
    Scalar shortest_ = 0;         // step that a frame may take, s
    std::vector<double> slack_;   // ρ and σ, J
    std::vector<double> booked_;  // W, J
    std::vector<Taken> taken_;
    std::vector<guard_detail::Gain> gains_;
    guard_detail::ViewedState<State> viewed_;
};

namespace guard_detail {

template <class Stepper>
inline constexpr bool is_options_v = false;
template <class Scalar>
inline constexpr bool is_options_v<GuardedOptions<Scalar>> = true;

}  // namespace guard_detail

/// Guarded(system) tries velocity Verlet.
template <class Scalar, int Dim, class... Laws>
Guarded(const SpringSystem<Scalar, Dim, Laws...>&)
    -> Guarded<VelocityVerlet<SpringSystem<Scalar, Dim, Laws...>>>;
/// Guarded(system, options) does, too.
template <class Scalar, int Dim, class... Laws>
Guarded(const SpringSystem<Scalar, Dim, Laws...>&, const GuardedOptions<Scalar>&)
    -> Guarded<VelocityVerlet<SpringSystem<Scalar, Dim, Laws...>>>;
/// Guarded(system, stepper) tries that, a stepper or a call of yours.
template <class Scalar, int Dim, class... Laws, class Stepper, class... Options,
          class = std::enable_if_t<!guard_detail::is_options_v<Stepper>>>
Guarded(const SpringSystem<Scalar, Dim, Laws...>&, Stepper&, const Options&...)
    -> Guarded<Stepper, SpringSystem<Scalar, Dim, Laws...>>;

}  // namespace taut

#include "detail/guarded.ipp"
