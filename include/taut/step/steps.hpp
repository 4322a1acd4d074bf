// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>

#include "force_plan.hpp"
#include "place_update.hpp"

namespace taut::step_detail {

/// The external forces of a SpringSystem but a module's, which goes with the springs.
template <class Scalar, int Dim>
class Outside {
public:
    /// @param forces  the system's   @param time  at which steps begin, s
    void begin(const ExternalForces<Scalar, Dim>& forces, Scalar time) {
        forces_ = &forces;
        state_.time = time;
    }
    /// Lets h, s, pass between two steps.
    void pass(Scalar h) { state_.time += h; }

    /// s.
    Scalar time() const { return state_.time; }

    /// Whether a force asks for the whole state before every step.
    bool asks_for_state() const { return static_cast<bool>(forces_->whole); }
    /// Asks that force, where there is one, and adds the constant ones.
    /// @param first  whether planes may have changed since the last step
    void ask(const Layout<Scalar>& layout, const StatePlanes<Scalar>& planes, bool first);
    /// What ask() found on a tile's places, N; empty planes for nothing.
    /// @param room  for planes of a tile
    Planes<Scalar> on_tile(const Layout<Scalar>& layout, Places of,
                           const Planes<Scalar>& room) const {
        if (!by_tile_) return found_.first ? found_.at(of.first * layout.grain()) : found_;
        layout.to_planes(force_, room, of);
        return room;
    }
    /// Takes what the force sees next of a tile's places, while they are in the first cache.
    /// @returns whether that is known to be finite
    bool moved(const Layout<Scalar>& layout, Places of, const StatePlanes<Scalar>& planes) {
        if (!by_tile_) return false;
        layout.from_planes(planes.new_x.at(of.first), state_.x, of);
        layout.from_planes(planes.new_v.at(of.first), state_.v, of);
        return detail::all_finite(state_.x.data() + Dim * of.first, Dim * of.count) &&
               detail::all_finite(state_.v.data() + Dim * of.first, Dim * of.count);
    }

    /// What the force of the whole state was last asked at; null without one.
    const State<Scalar, Dim>* state() const { return asks_for_state() ? &state_ : nullptr; }
    /// All that ask() last found, N; null where a force is missing in it.
    const Points<Scalar, Dim>* force() const {
        return asks_for_state() && !forces_->outside ? &force_ : nullptr;
    }

private:
    const ExternalForces<Scalar, Dim>* forces_ = nullptr;  // the system's
    State<Scalar, Dim> state_;                             // what a force of the whole state sees
    Points<Scalar, Dim> force_;                            // N
    Buffer<Scalar> planes_;                                // N
    Planes<Scalar> found_;  // these, if there is something and not by_tile_
    bool by_tile_ = false;  // whether state_ and force_ have copies in planes tile by tile
};

/// Sees the states between the steps of a sweep, from the first to the last.
template <class Scalar, int Dim>
class StepWatch {
public:
    /// @param x, v   by particle; velocities are those that the forces there are taken at
    /// @param time   s
    /// @param state  the same, and @param force  all external forces there, N; each null if unknown
    virtual void see(const PlaceVectors<Scalar, Dim>& x, const PlaceVectors<Scalar, Dim>& v,
                     Scalar time, const State<Scalar, Dim>* state,
                     const Points<Scalar, Dim>* force) = 0;
    /// After a step: may change the planes. Of velocity Verlet after every drift, and after the
    /// last half kick, where accelerations are in the place of x.
    /// @param places  as of PlaceVectors   @param time, ahead  s   @returns whether to go on
    virtual bool passed(const Layout<Scalar>& layout, const Buffer<int>& places,
                        StateMemory<Scalar>& memory, Scalar time, Scalar ahead) = 0;

protected:
    ~StepWatch() = default;
};

/// Half kicks, v + ½h a: two where a step's end meets the next one's start, to the same bits as at
/// the end of one call and the start of the next. Then x + h v, or at the end the acceleration in
/// the place of x.
template <int half_kicks, bool end>
struct VerletUpdate {
    template <class Real>
    EIGEN_ALWAYS_INLINE void operator()(Real& x, Real& v, const Real& a, const Real& h) const {
        if constexpr (half_kicks > 0) v += Real(0.5) * h * a;
        if constexpr (half_kicks > 1) v += Real(0.5) * h * a;
        x = end ? a : x + h * v;
    }
};

/// What a step takes from a system beside its springs.
template <class Scalar, int Dim>
struct Surroundings {
    const Eigen::Matrix<Scalar, Dim, 1>& gravity;  // m/s²
    const RayleighDamping& rayleigh;
    const Scalar* inverse_mass;  // 1/kg
    std::uint64_t revision;      // of the masses
    const ExternalForces<Scalar, Dim>& external;
};

/// Steps of places by forces of whatever springs: see Sweep.
template <class Scalar, int Dim>
class Steps {
public:
    using Forces = TileForces<Scalar>;
    /// PlaceUpdate::move by some update.
    using Move = void (PlaceUpdate<Scalar>::*)(const Layout<Scalar>&, const TilePlaces<Scalar>&,
                                               Scalar) const;

    void watch(StepWatch<Scalar, Dim>* by) { watch_ = by; }
    /// Brings all members up to date: the first thing that a call does.
    /// @param new_plan  whether the layout, or what springs are where, has changed
    /// @param ahead     s, by which springs see x ahead
    template <class AnyState>
    void load(const Surroundings<Scalar, Dim>& surroundings, const Layout<Scalar>& layout,
              bool new_plan, const AnyState& state, Scalar ahead, const ReadAnywhere& read);
    /// Puts the state back after `count` steps.
    template <class AnyState>
    void store(const Layout<Scalar>& layout, Scalar h, Index count, AnyState& state) const {
        layout.from_planes(state_.planes().x, state.x, layout.all());
        layout.from_planes(state_.planes().v, state.v, layout.all());
        for (Index i = 0; i < count; ++i) state.time += h;
    }
    template <class AnyState>
    bool run(const Forces& forces, AnyState& state, Scalar h, Index count, int threads, Move move);
    template <class AnyState>
    bool run_verlet(const Forces& forces, AnyState& state, Scalar h, Index count, int threads,
                    bool go_on);
    /// In imex/detail/run_corrected.hpp.
    template <bool Ahead, class AnyState, class Correct>
    bool run_corrected(const Forces& forces, AnyState& state, Scalar h, Index count, int threads,
                       const Correct& correct);

private:
    /// Not finite is noticed after so many steps; until then they cost as much as others.
    static constexpr Index steps_between_checks = 64;
    /// A register may begin before its block or end behind it.
    static constexpr Index scratch_stride = most_of_block + most_of_block / 16;
    /// Three vectors of a block's places, and the external forces on those of a tile.
    static constexpr Index tile_stride = tile_size + 2 * max_width;
    static constexpr Index scratch_size = Dim * (3 * scratch_stride + tile_stride);

    void show(const Layout<Scalar>& layout, const State<Scalar, Dim>* state,
              const Points<Scalar, Dim>* force) {
        if (!watch_) return;
        watch_->see({layout, places_, state_.planes().x}, {layout, places_, state_.planes().v},
                    outside_.time(), state, force);
    }
    bool passed(const Layout<Scalar>& layout) {
        return !watch_ || watch_->passed(layout, places_, state_, outside_.time(), ahead_);
    }
    /// @returns whether all is finite
    bool steps(const Forces& forces, Scalar h, Index count, int threads, Move move);
    /// @returns whether the last state is known to be finite
    bool some_steps(const Forces& forces, Scalar h, Index count, int threads, Move move);
    bool step_block(const Forces& forces, const StatePlanes<Scalar>& planes, int block, Scalar h,
                    Scalar* scratch, Move move);

    StateMemory<Scalar> state_;
    PlaceUpdate<Scalar> update_;
    Outside<Scalar, Dim> outside_;
    Buffer<Scalar> scratch_;  // forces on one block for each thread, N; 0 between blocks
    Buffer<Scalar> end_v_;    // of run_verlet, planes, m/s
    Buffer<int> places_;      // of each particle, if known
    StepWatch<Scalar, Dim>* watch_ = nullptr;
    Buffer<Scalar> acceleration_;  // at the end of the last run_verlet, planes, m/s²
    Scalar last_h_ = 0;            // its step, s
    std::uint64_t masses_ = 0;     // the revision of those in update_
    Scalar alpha_ = 0;             // of Rayleigh damping, s
    Scalar ahead_ = 0;             // s, by which springs see x ahead
};

template <class Scalar, int Dim>
template <class AnyState>
void Steps<Scalar, Dim>::load(const Surroundings<Scalar, Dim>& surroundings,
                              const Layout<Scalar>& layout, bool new_plan, const AnyState& state,
                              Scalar ahead, const ReadAnywhere& read) {
    alpha_ = static_cast<Scalar>(surroundings.rayleigh.stiffness_proportional);
    if (new_plan) places_.clear();
    if (watch_ && places_.empty()) places_ = layout.places();
    // A new plan may have other places for what is discarded.
    if (new_plan) scratch_.assign(scratch_.size(), Scalar(0));
    state_.resize(layout.planes(), layout.size() * layout.grain(), layout.stride(), ahead > 0,
                  read);
    update_.load(surroundings.gravity.data(), Dim,
                 static_cast<Scalar>(surroundings.rayleigh.mass_proportional), ahead);
    if (new_plan || masses_ != surroundings.revision) {
        update_.load_masses(layout, surroundings.inverse_mass);
        masses_ = surroundings.revision;
    }
    layout.to_planes(state.x, state_.planes().x, layout.all());
    layout.to_planes(state.v, state_.planes().v, layout.all());
    ahead_ = ahead;
    if (ahead > 0) state_.look_ahead(ahead);
    outside_.begin(surroundings.external, static_cast<Scalar>(state.time));
}

template <class Scalar, int Dim>
template <class AnyState>
bool Steps<Scalar, Dim>::run(const Forces& forces, AnyState& state, Scalar h, Index count,
                             int threads, Move move) {
    if (!steps(forces, h, count, threads, move)) return false;
    show(forces.layout(), nullptr, nullptr);
    store(forces.layout(), h, count, state);
    return true;
}

template <class Scalar, int Dim>
template <class AnyState>
bool Steps<Scalar, Dim>::run_verlet(const Forces& forces, AnyState& state, Scalar h, Index count,
                                    int threads, bool go_on) {
    using Update = PlaceUpdate<Scalar>;
    if (go_on) {
        Scalar *x = state_.planes().x.first, *v = state_.planes().v.first;
        if (watch_) {  // the forces here were taken at the last step's v½
            end_v_.resize(static_cast<std::size_t>(state_.whole()));
            std::copy_n(v, state_.whole(), end_v_.data());
            add_scaled(v, -last_h_ / 2, acceleration_.data(), v, state_.whole());
            show(forces.layout(), nullptr, nullptr);
            std::copy_n(end_v_.data(), state_.whole(), v);
        }
        add_scaled(v, h / 2, acceleration_.data(), v, state_.whole());
        add_scaled(x, h, v, x, state_.whole());
        outside_.pass(h);
        if (!state_.finite() || !passed(forces.layout())) return false;
    } else if (!steps(forces, h, 1, threads, &Update::template move<VerletUpdate<1, false>>)) {
        return false;
    }
    if (!steps(forces, h, count - 1, threads, &Update::template move<VerletUpdate<2, false>>)) {
        return false;
    }
    if (!steps(forces, h, 1, threads, &Update::template move<VerletUpdate<1, true>>)) return false;
    acceleration_.resize(static_cast<std::size_t>(state_.whole()));
    std::copy_n(state_.planes().x.first, state_.whole(), acceleration_.data());
    state_.swap_positions();
    store(forces.layout(), h, count, state);
    last_h_ = h;
    return true;
}

}  // namespace taut::step_detail

#if !defined(TAUT_COMPILED)
#include "steps-inl.hpp"
#endif
