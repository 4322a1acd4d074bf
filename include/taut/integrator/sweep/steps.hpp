// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

#include "force_plan.hpp"
#include "place_update.hpp"
#include "waves.hpp"

#ifdef _OPENMP
#include <omp.h>
#endif

namespace taut::integrator_detail::sweep {

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
    /// What that force and the constant ones are at a state, N; empty planes for none.
    Planes<Scalar> at_state(const Layout<Scalar>& layout, const StatePlanes<Scalar>& planes) {
        const auto& constant = forces_->constant;
        if (!asks_for_state() && constant.cols() == 0) return {};
        force_.resize(Dim, layout.size());
        detail::set_zero(force_.data(), force_.size());
        std::copy_n(constant.data(), constant.size(), force_.data());
        if (asks_for_state()) {
            state_.x.resize(Dim, layout.size());
            state_.v.resize(Dim, layout.size());
            layout.from_planes(planes.x, state_.x);
            layout.from_planes(planes.v, state_.v);
            forces_->whole(state_, force_);
        }
        const auto size = static_cast<std::size_t>(layout.planes() * layout.stride());
        if (planes_.size() != size) planes_.assign(size, Scalar(0));  // padding is stepped, too
        layout.to_planes(force_, {planes_.data(), layout.stride()});
        return {planes_.data(), layout.stride()};
    }

    /// What the force of the whole state was last asked at; null without one.
    const State<Scalar, Dim>* state() const { return asks_for_state() ? &state_ : nullptr; }
    /// All that at_state() last gave, N; null where a force is missing in it.
    const Points<Scalar, Dim>* force() const {
        return asks_for_state() && !forces_->outside ? &force_ : nullptr;
    }

private:
    const ExternalForces<Scalar, Dim>* forces_ = nullptr;  // the system's
    State<Scalar, Dim> state_;                             // what a force of the whole state sees
    Points<Scalar, Dim> force_;                            // N
    Buffer<Scalar> planes_;                                // N
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
    /// As of Sweep.
    Index first_not_finite(const Layout<Scalar>& layout) const {
        const Buffer<int> places = layout.places();
        for (Index i = 0; i < layout.size(); ++i) {
            for (int d = 0; d < Dim; ++d) {
                for (const Planes<Scalar>& of : {state_.planes().x, state_.planes().v}) {
                    if (!std::isfinite(layout.at(of, d, places[i]))) return i;
                }
            }
        }
        return -1;
    }
    template <class AnyState>
    bool run(const Forces& forces, AnyState& state, Scalar h, Index count, int threads, Move move);
    template <class AnyState>
    bool run_verlet(const Forces& forces, AnyState& state, Scalar h, Index count, int threads,
                    bool go_on);
    template <bool Ahead, class AnyState, class Correct>
    bool run_corrected(const Forces& forces, AnyState& state, Scalar h, Index count, int threads,
                       const Correct& correct);

private:
    using Register = VectorRegister<Scalar>;
    /// Not finite is noticed after so many steps; until then they cost as much as others.
    static constexpr Index steps_between_checks = 64;
    /// A register may begin before its block or end behind it.
    static constexpr Index scratch_stride = most_of_block + most_of_block / 16;

    /// Puts the state back after `count` steps. @param x  its positions, planes, m
    template <class AnyState>
    void store(const Layout<Scalar>& layout, const Planes<Scalar>& x, Scalar h, Index count,
               AnyState& state) const {
        layout.from_planes(x, state.x);
        layout.from_planes(state_.planes().v, state.v);
        for (Index i = 0; i < count; ++i) state.time += h;
    }
    void show(const Layout<Scalar>& layout, const State<Scalar, Dim>* state,
              const Points<Scalar, Dim>* force) {
        if (!watch_) return;
        if (places_.empty()) places_ = layout.places();
        watch_->see({layout, places_, state_.planes().x}, {layout, places_, state_.planes().v},
                    outside_.time(), state, force);
    }
    void copy_whole(const Scalar* from, Buffer<Scalar>& to) const {
        to.resize(static_cast<std::size_t>(state_.whole()));
        std::copy_n(from, state_.whole(), to.data());
    }
    /// @returns whether all is finite
    bool steps(const Forces& forces, Scalar h, Index count, int threads, Move move);
    void some_steps(const Forces& forces, Scalar h, Index count, int threads, Move move);
    void step_block(const Forces& forces, const StatePlanes<Scalar>& planes, int block, Scalar h,
                    Scalar* scratch, Move move) const;

    StateMemory<Scalar> state_;
    PlaceUpdate<Scalar> update_;
    Outside<Scalar, Dim> outside_;
    Buffer<Scalar> scratch_;  // forces on one block for each thread, N; 0 between blocks
    Buffer<Scalar> end_x_;    // of run_verlet, planes, m
    Buffer<int> places_;      // of each particle, if known
    StepWatch<Scalar, Dim>* watch_ = nullptr;
    Buffer<Scalar> acceleration_;  // at the end of the last run_verlet, planes, m/s²
    Scalar last_h_ = 0;            // its step, s
    Scalar alpha_ = 0;             // of Rayleigh damping, s
};

template <class Scalar, int Dim>
template <class AnyState>
void Steps<Scalar, Dim>::load(const Surroundings<Scalar, Dim>& surroundings,
                              const Layout<Scalar>& layout, bool new_plan, const AnyState& state,
                              Scalar ahead, const ReadAnywhere& read) {
    alpha_ = static_cast<Scalar>(surroundings.rayleigh.stiffness_proportional);
    if (new_plan) places_.clear();
    // A new plan may have other places for what is discarded.
    if (new_plan) scratch_.assign(scratch_.size(), Scalar(0));
    state_.resize(layout.planes(), layout.size() * layout.grain(), layout.stride(), ahead > 0,
                  read);
    update_.load(layout, surroundings.gravity.data(), Dim,
                 static_cast<Scalar>(surroundings.rayleigh.mass_proportional),
                 surroundings.inverse_mass, ahead);
    layout.to_planes(state.x, state_.planes().x);
    layout.to_planes(state.v, state_.planes().v);
    if (ahead > 0) state_.look_ahead(ahead);
    outside_.begin(surroundings.external, static_cast<Scalar>(state.time));
}

template <class Scalar, int Dim>
bool Steps<Scalar, Dim>::steps(const Forces& forces, Scalar h, Index count, int threads,
                               Move move) {
    const bool asks = outside_.asks_for_state();
    if (asks && !state_.finite()) return false;  // a finite double may be infinite as a float
    for (Index done = 0; done < count;) {
        const Index next = asks || watch_ ? 1 : std::min(steps_between_checks, count - done);
        update_.set_external(outside_.at_state(forces.layout(), state_.planes()));
        show(forces.layout(), outside_.state(), outside_.force());
        some_steps(forces, h, next, threads, move);
        done += next;
        const bool check = asks || done == count || done % steps_between_checks == 0;
        if (check && !state_.finite()) return false;
        outside_.pass(h);
    }
    return true;
}

template <class Scalar, int Dim>
void Steps<Scalar, Dim>::some_steps(const Forces& forces, Scalar h, Index count, int threads,
                                    Move move) {
    const Blocks& blocks = forces.layout().blocks();
    threads = blocks.workers(threads);
    constexpr Index scratch_size = 3 * Dim * scratch_stride;
    const auto needed = static_cast<std::size_t>(threads * scratch_size);
    if (scratch_.size() < needed) scratch_.assign(needed, Scalar(0));
    const auto work = [&](int thread, int workers, const auto& wait) {
        const Waves waves(blocks.count(), forces.reach(), workers);
        waves.run(
            thread, count,
            [&](Index step, int block) {
                StatePlanes<Scalar> planes = state_.planes();
                if (step % 2 == 1) planes.swap();
                step_block(forces, planes, block, h, scratch_.data() + thread * scratch_size, move);
            },
            wait);
    };
#ifdef _OPENMP
    if (threads > 1) {
#pragma omp parallel num_threads(threads)
        work(omp_get_thread_num(), omp_get_num_threads(), [] {
#pragma omp barrier
        });
    } else
#endif
    {
        work(0, 1, [] {});
    }
    if (count % 2 == 1) state_.swap();
}

template <class Scalar, int Dim>
void Steps<Scalar, Dim>::step_block(const Forces& forces, const StatePlanes<Scalar>& planes,
                                    int block, Scalar h, Scalar* scratch, Move move) const {
    const auto vector = [&](int number) {
        return Planes<Scalar>{scratch + number * Dim * scratch_stride + max_width, scratch_stride};
    };
    const Layout<Scalar>& layout = forces.layout();
    TileView<Scalar> view{{planes.spring_x.first, planes.spring_x.stride},
                          {planes.v.first, planes.v.stride},
                          {planes.x.first, planes.x.stride},
                          alpha_,
                          layout.blocks().begin(block),
                          layout.blocks().size(),
                          0,
                          vector(0),
                          vector(1),
                          vector(2)};
    const Index begin = view.begin;
    const Index count = std::min<Index>(view.size, layout.size() - begin);
    const Index grain = layout.grain();
    for (Index i = 0; i < count; i += tile_size) {
        view.tile = static_cast<int>((begin + i) / tile_size);
        forces.add(view);
        (update_.*move)(layout,
                        {planes, (begin + i) * grain, std::min<Index>(tile_size, count - i) * grain,
                         view.force_a.at(i * grain), view.force_b.at(i * grain)},
                        h);
    }
}

template <class Scalar, int Dim>
template <class AnyState>
bool Steps<Scalar, Dim>::run(const Forces& forces, AnyState& state, Scalar h, Index count,
                             int threads, Move move) {
    if (!steps(forces, h, count, threads, move)) return false;
    show(forces.layout(), nullptr, nullptr);
    store(forces.layout(), state_.planes().x, h, count, state);
    return true;
}

template <class Scalar, int Dim>
template <class AnyState>
bool Steps<Scalar, Dim>::run_verlet(const Forces& forces, AnyState& state, Scalar h, Index count,
                                    int threads, bool go_on) {
    using Update = PlaceUpdate<Scalar>;
    if (go_on) {
        Scalar *x = state_.planes().x.first, *v = state_.planes().v.first;
        const auto kick = [&](Scalar by) {
            const Register factor(by);
            state_.for_each_register([&](Index i) {
                const Register a = Register::load(acceleration_.data() + i);
                (Register::load(v + i) + factor * a).store(v + i);
            });
        };
        if (watch_) {  // the forces here were taken at the last step's v½
            copy_whole(v, end_x_);
            kick(-last_h_ / 2);
            show(forces.layout(), nullptr, nullptr);
            std::copy_n(end_x_.data(), state_.whole(), v);
        }
        kick(h / 2);
        state_.for_each_register([&](Index i) {
            (Register::load(x + i) + Register(h) * Register::load(v + i)).store(x + i);
        });
        outside_.pass(h);
        if (!state_.finite()) return false;
    } else if (!steps(forces, h, 1, threads, &Update::template move<VerletUpdate<1, false>>)) {
        return false;
    }
    if (!steps(forces, h, count - 1, threads, &Update::template move<VerletUpdate<2, false>>)) {
        return false;
    }
    copy_whole(state_.planes().x.first, end_x_);
    if (!steps(forces, h, 1, threads, &Update::template move<VerletUpdate<1, true>>)) return false;
    store(forces.layout(), {end_x_.data(), forces.layout().stride()}, h, count, state);
    copy_whole(state_.planes().x.first, acceleration_);
    last_h_ = h;
    return true;
}

template <class Scalar, int Dim>
template <bool Ahead, class AnyState, class Correct>
bool Steps<Scalar, Dim>::run_corrected(const Forces& forces, AnyState& state, Scalar h, Index count,
                                       int threads, const Correct& correct) {
    const bool one_by_one = outside_.asks_for_state();
    if (one_by_one && !state_.finite()) return false;
    if (places_.empty()) places_ = forces.layout().places();
    for (Index i = 1; i <= count; ++i) {
        if (Ahead && i > 1) state_.look_ahead(h);
        update_.set_external(outside_.at_state(forces.layout(), state_.planes()));
        some_steps(forces, h, 1, threads,
                   &PlaceUpdate<Scalar>::template move<VerletUpdate<0, true>>);
        const StatePlanes<Scalar> planes = state_.planes();
        correct(PlaceVectors<Scalar, Dim>(forces.layout(), places_, planes.x),
                PlaceVectors<Scalar, Dim>(forces.layout(), places_, planes.v));
        const Register step(h);
        state_.for_each_register([&](Index k) {
            const Register a = Register::load(planes.x.first + k);
            const Register v = Register::load(planes.v.first + k) + step * a;
            v.store(planes.v.first + k);
            (Register::load(planes.new_x.first + k) + step * v).store(planes.x.first + k);
        });
        const bool check = one_by_one || i == count || i % steps_between_checks == 0;
        if (check && !state_.finite()) return false;
        outside_.pass(h);
    }
    store(forces.layout(), state_.planes().x, h, count, state);
    return true;
}

}  // namespace taut::integrator_detail::sweep
