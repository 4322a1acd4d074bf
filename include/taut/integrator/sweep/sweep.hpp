// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// The explicit steps of springs, as this folder takes them. The page goes from what a step costs to
// what becomes of each spring, and ends with the folder's words.
//
//
// 1. What a step costs
//
// A spring takes some dozens of operations. A vector register does several of each at once, if the
// numbers lie side by side in memory. In a plain loop over springs they do not: both ends are
// looked up by index, a coordinate at a time, and each addition to a force may
// wait for the store of the one before. So particles lie in planes, one array a coordinate (but see
// 7), and springs are sorted once so that a step reads memory forwards: a plan, which lasts until
// the springs change. A state is converted once a call, however many steps it takes.
//
//
// 2. Places, tiles, blocks
//
//   place  0        256      512           1792                          3584
//          +--------+--------+---     -----+--------+---        ---------+---
//   x  x0  | tile 0 | tile 1 |     ...     | tile 7 |        ...         |  ...
//      x1  |        |        |             |        |                    |
//      x2  |        |        |             |        |                    |
//          +--------+--------+---     -----+--------+---        ---------+---
//          |<---------- block 0 ---------->|<--------- block 1 --------->|
//            one thread goes through it,     maybe another thread
//            tile by tile
//
// A block has at most 2048 places. All have the same size but for the last; their number is even
// where whole tiles allow it, so that two threads have the same to do. A tile is what the first
// cache holds: the tile's springs put their forces there, and the update takes them out again at
// once. A spring is computed with the tile of a, its lower end. So once a tile is done, every
// spring that touches it has been computed: its own and those of tiles before. One that comes from
// an earlier block goes with the first tile of the block.
//
//
// 3. Runs, gaps, segments
//
//    0---1---2---3---4     offset 1   a   0  1  2  3  .  5  6  7  8  .  10 11 12 13
//    |   |   |   |   |                b   1  2  3  4  .  6  7  8  9  .  11 12 13 14
//    5---6---7---8---9
//    |   |   |   |   |     offset 5   a   0  1  2  3  4  5  6  7  8  9
//   10--11--12--13--14                b   5  6  7  8  9 10 11 12 13 14
//
// Springs of one offset b - a and ascending a are a run: their ends lie side by side and need no
// index. A grid is a handful of runs. Where a row ends, the run goes on over a gap (.), which is
// computed like a spring and gives no force; fewer than 16 springs make no run, nor
// do springs with more gaps than springs between them. A segment is what one tile takes of a run.
// Where springs leave their block there are two: one adds the forces on the ends a, in the tile of
// a; the other those on the ends b, in the block of b.
//
//
// 4. What a thread reads and writes
//
//        spring_x, v of the old step, of any place        the plan
//                                |                           |
//                                v                           v
//                   springs of the tile: segments, then batches; or stars
//                                |                           |
//                                v                           v
//          force_a, force_b on places of the block        discard: segments' on other blocks
//                                |
//                                v
//          update of the tile's places: forces are taken and cleared
//                                |
//                                v
//          x, v, spring_x of the new step, of the tile's places only
//
// What all threads read, none writes before the step ends: springs' positions, velocities where
// springs are damped or a module has a force of its own, and positions where it has, have planes
// for the old step and others for the new. What a thread writes is its scratch (force_a, force_b,
// discard) and the places of its blocks. A spring between two blocks is evaluated in both, and each
// keeps its own end. Blocks have the same size and each sum the same order for any number of
// threads, and so results have the same bits.
//
// One thread goes in waves: a block takes its next step as soon as the blocks that its springs and
// other forces reach have taken the last one. So a large scene comes from memory once in several
// steps.
//
//
// 5. What a register holds
//
// One quantity of consecutive springs, a lane each: a coordinate of dx, a rest length, a stiffness.
// In the update, one of consecutive places. Its width is what the compiler's flags allow. A law
// that is plain arithmetic (Law::vectorizable) takes a register for its Scalar; another one is
// asked lane by lane. Whole registers touch some scalars beyond the last place: the padding.
//
//
// 6. Springs that fit no run
//
// Scattered springs come in batches, each of which touches few places. Those are gathered, copied
// to where one load finds all coordinates; coefficients are computed by whole registers, and forces
// are summed for each copy and added to the block at the end. Where too many are scattered,
// particles get an order that brings ends together before runs are sought again.
//
//
// 7. Stars
//
//           tip                   point    x  y  z  0
//            |                    hub      .  .  .  .
//     tip---hub---tip             tips     .  .  .  .     four differences, twelve squares;
//            |                             .  .  .  .     four lengths side by side,
//           tip                            .  .  .  .     a lane each; four forces
//                                          .  .  .  .
//
// Where too many springs are scattered even in that order, as in a garment, all of them are in
// stars and none in runs or batches; in one dimension there are none. A star is four springs with
// one end in common. There is one plane, of points, in which a place's vector lies in one piece.
// Either end of a spring may be its hub, so places hand springs to later ones until nearly all are
// the hub of a multiple of four; what is missing is filled with gaps, from the hub to itself. A
// star that reaches into another block is outer: it goes with the first tile of each of its blocks,
// and forces on other blocks go behind the block's last place. The others go with a tile that none
// of their places comes before, in the order of hubs. Registers are no wider than 32 bytes here.
//
//
// Words, each for one thing
//
//   place         a particle's index in the planes; its index in the system, if there is no order
//   order         the particle at each place
//   plane         one coordinate of one vector, of all places                        planes.hpp
//   block         consecutive places: what a thread does at a time                     tile.hpp
//   reach         the most blocks between places that a force ties together
//   wave          steps that are taken block by block, not one by one                 waves.hpp
//   tile          256 of them: what the first cache holds                              tile.hpp
//   view          what springs and other forces of a tile read and write               tile.hpp
//   ends a, b     of a spring, places, a < b
//   offset        b - a
//   run           springs of one offset and ascending a                      sorted_springs.hpp
//   gap           a place between springs of a run where no spring begins; or what a star lacks
//   segment       what one tile takes of a run                                     run_plan.hpp
//   star          up to four springs with one end in common                           stars.hpp
//   hub, tip      that end, and another end of a star                                  hubs.hpp
//   outer         of a star: in more than one block
//   point         one vector of one place, x y z 0; with stars a plane has points
//   outside       of a force: a module's, with a plan of its own         model/outside_force.hpp
//   grain         scalars of a place in a plane: 1, or 4 with stars
//   scattered     of a spring: in no run
//   batch         scattered springs of one tile that touch few places            batch_plan.hpp
//   gathered      of places: copied for a batch
//   chunk         springs of a batch that are computed together
//   table         rest lengths, dampings and parameters of one law's springs   spring_table.hpp
//   column        one of these quantities, of the springs of a run or a batch, or of all stars
//   field         one Scalar of a law's parameters: a column, if the law is plain arithmetic
//   reader        goes through columns, a register at a time
//   register      a vector register, which Eigen calls a packet                    register.hpp
//   lane          one number of a register
//   width         the number of lanes
//   padding       scalars beyond the last place, for whole registers
//   dx, dv        x_b - x_a, v_b - v_a
//   coefficients  of dx and dv in a spring's pull               model/spring_mechanics.hpp
//   plan          what is known of the springs before a step                     force_plan.hpp
//   scratch       a thread's forces on one block
//   sweep         one pass over all blocks: a step

#include <algorithm>

#include "force_plan.hpp"
#include "outside.hpp"
#include "place_update.hpp"
#include "waves.hpp"

#ifdef _OPENMP
#include <omp.h>
#endif

namespace taut::integrator_detail::sweep {

/// Sees the states between the steps of a sweep, from the first to the last.
template <class System>
class StepWatch {
public:
    /// @param x, v   by particle; velocities are those that the forces there are taken at
    /// @param state  the same, and @param force  all external forces there, N; each null if unknown
    virtual void see(const PlaceVectors<System>& x, const PlaceVectors<System>& v,
                     const typename System::State* state, const typename System::Force* force) = 0;

protected:
    ~StepWatch() = default;
};

/// An update of steps whose springs take their positions ahead and as they are.
template <class Update>
struct WithBoth : Update {};
template <class Update>
inline constexpr bool is_with_both_v = false;
template <class Update>
inline constexpr bool is_with_both_v<WithBoth<Update>> = true;

/// Explicit steps of a SpringSystem.
template <class System>
class Sweep {
public:
    using Scalar = typename System::Scalar;
    static constexpr int Dim = System::Dim;

    /// From now on run, run_ahead and run_verlet show their states to that; null ends it.
    void watch(StepWatch<System>* by) { watch_ = by; }
    /// Takes `count` steps of h, s.
    /// @param update  update(x, v, a, h): x, v, of one coordinate, by the acceleration a; registers
    /// @returns whether the new state is finite; else `state` is not touched
    template <class AnyState, class Update>
    bool run(const System& system, AnyState& state, Scalar h, Index count, int threads,
             const Update& update);
    /// The same with the springs one step ahead: they pull along their new direction, push along
    /// the old one [T42].
    template <class AnyState, class Update>
    bool run_ahead(const System& system, AnyState& state, Scalar h, Index count, int threads,
                   const Update& update);
    /// Takes `count` > 0 steps of velocity Verlet.
    /// @param go_on  whether state and system are as the last call of this left them
    template <class AnyState>
    bool run_verlet(const System& system, AnyState& state, Scalar h, Index count, int threads,
                    bool go_on);
    /// Takes `count` steps of h, s: v⁺ = v + h a, x⁺ = x + h v⁺, by accelerations that are
    /// corrected all together.
    /// @tparam Ahead   whether springs pull as in run_ahead
    /// @param correct  correct(a, v): of accelerations and velocities by particle, PlaceVectors
    template <bool Ahead = false, class AnyState, class Correct>
    bool run_corrected(const System& system, AnyState& state, Scalar h, Index count, int threads,
                       const Correct& correct);

private:
    using Register = VectorRegister<Scalar>;
    /// Not finite is noticed after so many steps; until then they cost as much as others.
    static constexpr Index steps_between_checks = 64;
    /// A register may begin before its block or end behind it.
    static constexpr Index scratch_stride = most_of_block + most_of_block / 16;

    /// Brings all members up to date.
    /// @param both  whether springs that push take their positions as they are, too
    template <class AnyState>
    void load(const System& system, const AnyState& state, Scalar ahead = 0, bool both = false);
    /// Puts the state back after `count` steps. @param x  its positions, planes, m
    template <class AnyState>
    void store(const Planes<Scalar>& x, Scalar h, Index count, AnyState& state) const {
        plan_.from_planes(x, state.x);
        plan_.from_planes(state_.planes().v, state.v);
        for (Index i = 0; i < count; ++i) state.time += h;
    }
    void show(const typename System::State* state, const typename System::Force* force) {
        if (!watch_) return;
        if (places_.empty()) places_ = plan_.places();
        watch_->see({plan_, places_, state_.planes().x}, {plan_, places_, state_.planes().v}, state,
                    force);
    }
    /// @returns whether all is finite
    template <class Update>
    bool steps(Scalar h, Index count, int threads, const Update& update);
    template <class Update>
    void some_steps(Scalar h, Index count, int threads, const Update& update);
    template <bool Pins, bool Drag, class Update>
    void some_steps(Scalar h, Index count, int threads, const Update& update);
    template <bool Pins, bool Drag, bool Stars, class Update>
    void step_block(const StatePlanes<Scalar>& planes, int block, Scalar h, Scalar* scratch,
                    const Update& update) const;

    ForcePlan<System> plan_;
    StateMemory<Scalar> state_;
    PlaceUpdate<Scalar, Dim> update_;
    Outside<System> outside_;
    VectorX<Scalar> scratch_;  // forces on one block for each thread, N; 0 between blocks
    VectorX<Scalar> end_x_;    // of run_verlet, planes, m
    std::vector<int> places_;  // of each particle, if known
    StepWatch<System>* watch_ = nullptr;
    VectorX<Scalar> acceleration_;  // at the end of the last run_verlet, planes, m/s²
    Scalar alpha_ = 0;              // of Rayleigh damping, s
    Scalar ahead_ = 0;              // s, by which springs see x ahead
};

template <class System>
template <class AnyState>
void Sweep<System>::load(const System& system, const AnyState& state, Scalar ahead, bool both) {
    alpha_ = static_cast<Scalar>(system.rayleigh().stiffness_proportional);
    ahead_ = ahead;
    const bool new_plan = plan_.update(system);
    if (new_plan) places_.clear();
    // A new plan may have other places for what is discarded.
    if (new_plan) scratch_.setZero();
    const Index size = plan_.size() * plan_.grain();
    state_.resize(
        plan_.planes(), size, plan_.stride(), ahead_ > 0,
        {plan_.damped() || alpha_ > 0 || plan_.has_outside(), plan_.has_outside() || both});
    plan_.to_planes(state.x, state_.planes().x);
    plan_.to_planes(state.v, state_.planes().v);
    if (ahead_ > 0) state_.look_ahead(ahead_);
    update_.load(system, plan_, ahead_);
    outside_.begin(system, static_cast<Scalar>(state.time));
}

template <class System>
template <class Update>
bool Sweep<System>::steps(Scalar h, Index count, int threads, const Update& update) {
    const bool asks = outside_.asks_for_state();
    if (asks && !state_.finite()) return false;  // a finite double may be infinite as a float
    for (Index done = 0; done < count;) {
        const Index next = asks || watch_ ? 1 : std::min(steps_between_checks, count - done);
        update_.set_external(outside_.at_state(plan_, state_.planes()));
        show(outside_.state(), outside_.force());
        some_steps(h, next, threads, update);
        done += next;
        const bool check = asks || done == count || done % steps_between_checks == 0;
        if (check && !state_.finite()) return false;
        outside_.pass(h);
    }
    return true;
}

template <class System>
template <class Update>
void Sweep<System>::some_steps(Scalar h, Index count, int threads, const Update& update) {
    const bool pins = update_.has_pins();
    const bool drag = update_.has_drag();
    if (pins && drag) some_steps<true, true>(h, count, threads, update);
    if (pins && !drag) some_steps<true, false>(h, count, threads, update);
    if (!pins && drag) some_steps<false, true>(h, count, threads, update);
    if (!pins && !drag) some_steps<false, false>(h, count, threads, update);
}

template <class System>
template <bool Pins, bool Drag, class Update>
void Sweep<System>::some_steps(Scalar h, Index count, int threads, const Update& update) {
    const int blocks = plan_.blocks().count();
    threads = plan_.blocks().workers(threads);
    const Index scratch_size = 3 * Dim * scratch_stride;
    if (scratch_.size() < threads * scratch_size) scratch_.setZero(threads * scratch_size);
    const auto step_of = [&](int thread, Index step, int block) {
        StatePlanes<Scalar> planes = state_.planes();
        if (step % 2 == 1) planes.swap();
        Scalar* scratch = scratch_.data() + thread * scratch_size;
        if (plan_.has_stars()) {
            if constexpr (Dim > 1) step_block<Pins, Drag, true>(planes, block, h, scratch, update);
        } else {
            step_block<Pins, Drag, false>(planes, block, h, scratch, update);
        }
    };
    const auto work = [&](int thread, int workers, const auto& wait) {
        const Waves waves(blocks, plan_.reach(), workers);
        waves.run(
            thread, count, [&](Index step, int block) { step_of(thread, step, block); }, wait);
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

template <class System>
template <bool Pins, bool Drag, bool Stars, class Update>
void Sweep<System>::step_block(const StatePlanes<Scalar>& planes, int block, Scalar h,
                               Scalar* scratch, const Update& update) const {
    const auto vector = [&](int number) {
        return Planes<Scalar>{scratch + number * Dim * scratch_stride + max_width, scratch_stride};
    };
    TileView<Scalar> view{{planes.spring_x.first, planes.spring_x.stride},
                          {planes.v.first, planes.v.stride},
                          {planes.x.first, planes.x.stride},
                          alpha_,
                          plan_.blocks().begin(block),
                          plan_.blocks().size(),
                          0,
                          vector(0),
                          vector(1),
                          vector(2)};
    const Index begin = view.begin;
    const Index count = std::min<Index>(view.size, plan_.size() - begin);
    constexpr Index grain = Stars ? 4 : 1;
    for (Index i = 0; i < count; i += tile_size) {
        view.tile = static_cast<int>((begin + i) / tile_size);
        plan_.template add_forces<is_with_both_v<Update>>(view);
        update_.template move<Pins, Drag, Stars>(
            planes, (begin + i) * grain, std::min<Index>(tile_size, count - i) * grain, h,
            view.force_a.at(i * grain), view.force_b.at(i * grain), update);
    }
}

}  // namespace taut::integrator_detail::sweep

#include "sweep_methods.ipp"
