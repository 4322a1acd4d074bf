// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// The explicit steps of springs, from what a step costs to what becomes of each spring.
//
// 1. What a step costs
// A spring takes some dozens of operations. A vector register does several of each at once, if the
// numbers lie side by side in memory. In a plain loop over springs they do not: both ends are
// looked up by index, a coordinate at a time, and each addition to a force may wait for the store
// of the one before. So particles lie in planes, one array a coordinate (but see 7), and springs
// are sorted once so that a step reads memory forwards: a plan, which lasts until the springs
// change. A state is converted once a call, however many steps it takes.
//
// 2. Places, tiles, blocks
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
// 3. Runs, gaps, segments
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
// 4. What a thread reads and writes
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
// 5. What a register holds
// One quantity of consecutive springs, a lane each: a coordinate of dx, a rest length, a stiffness.
// In the update, one of consecutive places. Its width is what the compiler's flags allow. A law
// that is plain arithmetic (Law::vectorizable) takes a register for its Scalar; another one is
// asked lane by lane. Whole registers touch some scalars beyond the last place: the padding.
//
// 6. Springs that fit no run
// Scattered springs come in batches, each of which touches few places. Those are gathered, copied
// to where one load finds all coordinates; coefficients are computed by whole registers, and forces
// are summed for each copy and added to the block at the end. Where too many are scattered,
// particles get an order that brings ends together before runs are sought again.
//
// 7. Stars
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
// 8. What is compiled once
// Plans are made of indices alone (Planner), places are the same for all laws (Layout, PlaceUpdate,
// Steps), and a law has its table and loops (LawPlan). They meet at a tile's forces: a virtual
// call. Taut::Compiled has what asks TAUT_BY_KERNEL for wider registers, too.
//
// Words, each for one thing
//
//   place         a particle's index in the planes; its index in the system, if there is no order
//   order         the particle at each place                                        planner.hpp
//   plane         one coordinate of one vector, of all places                          tile.hpp
//   block         consecutive places: what a thread does at a time                     tile.hpp
//   reach         the most blocks between places that a force ties together
//   wave          steps that are taken block by block, not one by one                 waves.hpp
//   tile          256 of them: what the first cache holds                              tile.hpp
//   view          what springs and other forces of a tile read and write               tile.hpp
//   ends a, b     of a spring, places, a < b
//   offset        b - a
//   run           springs of one offset and ascending a                      sorted_springs.hpp
//   gap           a place between springs of a run where no spring begins; or what a star lacks
//   segment       what one tile takes of a run                                      planner.hpp
//   star          up to four springs with one end in common                           stars.hpp
//   hub, tip      that end, and another end of a star                                 stars.hpp
//   outer         of a star: in more than one block
//   point         one vector of one place, x y z 0; with stars a plane has points
//   outside       of a force: a module's, with a plan of its own  network/detail/outside_force.hpp
//   grain         scalars of a place in a plane: 1, or 4 with stars                  layout.hpp
//   scattered     of a spring: in no run
//   batch         scattered springs of one tile that touch few places               planner.hpp
//   gathered      of places: copied for a batch
//   chunk         springs of a batch that are computed together                   law_plan.hpp
//   table         rest lengths, dampings and parameters of one law's springs   spring_table.hpp
//   column        one of these quantities, of the springs of a run or a batch, or of all stars
//   field         one Scalar of a law's parameters: a column, if the law is plain arithmetic
//   reader        goes through columns, a register at a time
//   register      a vector register, which Eigen calls a packet                    register.hpp
//   lane          one number of a register
//   width         the number of lanes
//   padding       scalars beyond the last place, for whole registers
//   dx, dv        x_b - x_a, v_b - v_a
//   coefficients  of dx and dv in a spring's pull               network/spring_mechanics.hpp
//   plan          what is known of the springs before a step           planner.hpp, *_plan.hpp
//   scratch       a thread's forces on one block
//   sweep         one pass over all blocks: a step

#include "steps.hpp"

namespace taut::step_detail {

/// Explicit steps of a SpringSystem.
template <class System>
class Sweep {
public:
    using Scalar = typename System::Scalar;
    static constexpr int Dim = System::Dim;

    /// From now on run, run_ahead and run_verlet show their states to that; null ends it.
    void watch(StepWatch<Scalar, Dim>* by) { steps_.watch(by); }
    /// Takes `count` steps of h, s. @param update  see PlaceUpdate::move
    /// @returns whether the new state is finite; else `state` is not touched
    template <class AnyState, class Update>
    bool run(const System& system, AnyState& state, Scalar h, Index count, int threads,
             const Update&) {
        load(system, state, 0, false);
        return steps_.run(Forces<false>(plan_), state, h, count, threads, move<Update>);
    }
    /// The particle that the last call left not finite, or −1.
    Index first_not_finite() const { return steps_.first_not_finite(plan_.layout()); }
    /// The same with the springs one step ahead: they pull along their new direction, push along
    /// the old one [T42].
    template <class AnyState, class Update>
    bool run_ahead(const System& system, AnyState& state, Scalar h, Index count, int threads,
                   const Update&) {
        load(system, state, h, ForcePlan<System>::pushes);
        return steps_.run(Forces<true>(plan_), state, h, count, threads, move<Update>);
    }
    /// Takes `count` > 0 steps of velocity Verlet.
    /// @param go_on  whether state and system are as the last call of this left them
    template <class AnyState>
    bool run_verlet(const System& system, AnyState& state, Scalar h, Index count, int threads,
                    bool go_on) {
        load(system, state, 0, false);
        return steps_.run_verlet(Forces<false>(plan_), state, h, count, threads, go_on);
    }
    /// Takes `count` steps of h, s: v⁺ = v + h a, x⁺ = x + h v⁺, by accelerations that are
    /// corrected all together.
    /// @tparam Ahead   whether springs pull as in run_ahead
    /// @param correct  correct(a, v): of accelerations and velocities by particle, PlaceVectors
    template <bool Ahead = false, class AnyState, class Correct>
    bool run_corrected(const System& system, AnyState& state, Scalar h, Index count, int threads,
                       const Correct& correct) {
        // The acceleration takes the place of the new x, which must not be that of the old one.
        load(system, state, Ahead ? h : Scalar(0), Ahead);
        return steps_.template run_corrected<Ahead>(Forces<Ahead>(plan_), state, h, count, threads,
                                                    correct);
    }

private:
    template <bool Ahead>
    using Forces = typename ForcePlan<System>::template Forces<Ahead>;
    template <class Update>
    static constexpr typename Steps<Scalar, Dim>::Move move =
        &PlaceUpdate<Scalar>::template move<Update>;

    /// Brings all members up to date.
    /// @param both  whether springs that push take their positions as they are, too
    template <class AnyState>
    void load(const System& system, const AnyState& state, Scalar ahead, bool both) {
        const bool new_plan = plan_.update(system);
        const bool alpha = static_cast<Scalar>(system.rayleigh().stiffness_proportional) > 0;
        steps_.load({system.gravity(), system.rayleigh(), system.inverse_mass().data(),
                     system.revision(), system.external_forces()},
                    plan_.layout(), new_plan, state, ahead,
                    {plan_.damped() || alpha || plan_.has_outside(), plan_.has_outside() || both});
    }

    ForcePlan<System> plan_;
    Steps<Scalar, Dim> steps_;
};

}  // namespace taut::step_detail
