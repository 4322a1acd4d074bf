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
// wait for the store of the one before. So particles lie in planes, one array a coordinate,
// and springs are sorted once so that a step reads memory forwards: a plan, which lasts until the
// springs change. A state is converted once a call, however many steps it takes.
//
//
// 2. Places, tiles, blocks
//
//   place  0        256      512           2048                          4096
//          +--------+--------+---     -----+--------+---        ---------+---
//   x  x0  | tile 0 | tile 1 |     ...     | tile 8 |        ...         |  ...
//      x1  |        |        |             |        |                    |
//      x2  |        |        |             |        |                    |
//          +--------+--------+---     -----+--------+---        ---------+---
//          |<---------- block 0 ---------->|<--------- block 1 --------->|
//            one thread goes through it,     maybe another thread
//            tile by tile
//
// A tile is what the first cache holds: the tile's springs put their forces there, and the update
// takes them out again at once. A spring is computed with the tile of a, its lower end. So once a
// tile is done, every spring that touches it has been computed: its own and those of tiles before.
// One that comes from an earlier block goes with the first tile of the block.
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
//                   springs of the tile: segments, then batches
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
// What all threads read, none writes before the step ends: springs' positions, and velocities where
// springs are damped, have planes for the old step and others for the new. What a thread writes is
// its scratch (force_a, force_b, discard) and the places of its blocks. A spring between two blocks
// is evaluated in both, and each keeps its own end. Blocks have the same size and each sum the same
// order for any number of threads, and so results have the same bits.
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
// are summed for each copy and added to the block at the end. Where most springs are scattered,
// particles get an order that brings ends together before runs are sought again.
//
//
// Words, each for one thing
//
//   place         a particle's index in the planes; its index in the system, if there is no order
//   order         the particle at each place
//   plane         one coordinate of one vector, of all places                        planes.hpp
//   block         2048 consecutive places: what a thread does at a time                tile.hpp
//   tile          256 of them: what the first cache holds                              tile.hpp
//   view          what the springs of a tile read and write                            tile.hpp
//   ends a, b     of a spring, places, a < b
//   offset        b - a
//   run           springs of one offset and ascending a                      sorted_springs.hpp
//   gap           a place between springs of a run where no spring begins
//   segment       what one tile takes of a run                                     run_plan.hpp
//   scattered     of a spring: in no run
//   batch         scattered springs of one tile that touch few places            batch_plan.hpp
//   gathered      of places: copied for a batch
//   chunk         springs of a batch that are computed together
//   table         rest lengths, dampings and parameters of one law's springs   spring_table.hpp
//   column        one of these quantities, of the springs of a run or a batch
//   field         one Scalar of a law's parameters: a column, if the law is plain arithmetic
//   reader        goes through the columns of a run or a batch, a register at a time
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
#include "state_planes.hpp"

#ifdef _OPENMP
#include <omp.h>
#endif

namespace taut::integrator_detail::sweep {

/// Explicit steps of a SpringSystem without external forces.
template <class System>
class Sweep {
public:
    using Scalar = typename System::Scalar;
    static constexpr int Dim = System::Dim;

    /// Takes `count` steps of h, s.
    /// @param added   damping beside the system's, StepDamping::times(h)
    /// @param update  update(x, v, a, h): x, v, of one coordinate, by the acceleration a; registers
    /// @returns whether the new state is finite; else `state` is not touched
    template <class AnyState, class Update>
    bool run(const System& system, AnyState& state, Scalar h, Index count, int threads,
             const StepDamping& added, const Update& update);

private:
    using Register = VectorRegister<Scalar>;
    /// Not finite is noticed after so many steps; until then they cost as much as others.
    static constexpr Index steps_between_checks = 64;
    /// A register may begin before its block or end behind it.
    static constexpr Index scratch_stride = block_size + block_size / 16;

    /// Brings all members up to date.
    template <class AnyState>
    void load(const System& system, const AnyState& state, const StepDamping& added);
    template <class Update>
    void steps(Scalar h, Index count, int threads, const Update& update);
    template <bool Pins, bool Drag, class Update>
    void steps(Scalar h, Index count, int threads, const Update& update);
    template <bool Pins, bool Drag, class Update>
    void step_block(const StatePlanes<Scalar>& planes, int block, Scalar h, Scalar* scratch,
                    const Update& update) const;
    /// The places first, first + 1, … by the forces on them, which are cleared.
    template <bool Pins, bool Drag, class Update>
    void move(const StatePlanes<Scalar>& planes, Index first, Index count, Scalar h,
              const Planes<Scalar>& force_a, const Planes<Scalar>& force_b,
              const Update& update) const;

    ForcePlan<System> plan_;
    StateMemory<Scalar, Dim> state_;
    VectorX<Scalar> inverse_mass_;  // 1/kg, 0 if pinned
    VectorX<Scalar> scratch_;       // forces on one block for each thread, N; 0 between blocks
    Eigen::Matrix<Scalar, Dim, 1> gravity_;
    Scalar drag_ = 0;  // d0, 1/s
    StiffnessDamping<Scalar> damping_;
    Scalar ahead_ = 0;  // s, by which springs see x ahead
    bool pins_ = false;
};

template <class System>
template <class AnyState, class Update>
bool Sweep<System>::run(const System& system, AnyState& state, Scalar h, Index count, int threads,
                        const StepDamping& added, const Update& update) {
    load(system, state, added);
    for (Index done = 0; done < count;) {
        const Index next = std::min(steps_between_checks, count - done);
        steps(h, next, threads, update);
        if (!state_.finite()) return false;
        done += next;
    }
    plan_.from_planes(state_.planes().x, state.x);
    plan_.from_planes(state_.planes().v, state.v);
    for (Index i = 0; i < count; ++i) state.time += h;
    return true;
}

template <class System>
template <class AnyState>
void Sweep<System>::load(const System& system, const AnyState& state, const StepDamping& added) {
    gravity_ = system.gravity();
    drag_ = static_cast<Scalar>(system.rayleigh().mass_proportional);
    damping_ = system.stiffness_damping(added).template cast<Scalar>();
    ahead_ = static_cast<Scalar>(added.look_ahead);
    plan_.update(system);
    state_.resize(plan_.size(), plan_.stride(), ahead_ > 0, plan_.damped() || bool(damping_));
    plan_.to_planes(state.x, state_.planes().x);
    plan_.to_planes(state.v, state_.planes().v);
    if (ahead_ > 0) state_.look_ahead(ahead_);
    inverse_mass_.resize(plan_.stride());
    inverse_mass_.tail(plan_.stride() - plan_.size()).setZero();
    plan_.to_planes(system.inverse_mass().transpose(), {inverse_mass_.data(), plan_.stride()});
    pins_ = (inverse_mass_.head(plan_.size()).array() == Scalar(0)).any();
}

template <class System>
template <class Update>
void Sweep<System>::steps(Scalar h, Index count, int threads, const Update& update) {
    const bool drag = drag_ > 0;
    if (pins_ && drag) steps<true, true>(h, count, threads, update);
    if (pins_ && !drag) steps<true, false>(h, count, threads, update);
    if (!pins_ && drag) steps<false, true>(h, count, threads, update);
    if (!pins_ && !drag) steps<false, false>(h, count, threads, update);
}

template <class System>
template <bool Pins, bool Drag, class Update>
void Sweep<System>::steps(Scalar h, Index count, int threads, const Update& update) {
    const int blocks = plan_.blocks();
    threads = std::max(1, std::min(threads, blocks));
    const Index scratch_size = 3 * Dim * scratch_stride;
    if (scratch_.size() < threads * scratch_size) scratch_.setZero(threads * scratch_size);
    const auto work = [&](int thread, const auto& for_each_block) {
        StatePlanes<Scalar> planes = state_.planes();
        Scalar* scratch = scratch_.data() + thread * scratch_size;
        for (Index step = 0; step < count; ++step) {
            for_each_block(
                [&](int block) { step_block<Pins, Drag>(planes, block, h, scratch, update); });
            planes.swap();
        }
    };
#ifdef _OPENMP
    if (threads > 1) {
#pragma omp parallel num_threads(threads)
        work(omp_get_thread_num(), [&](const auto& visit) {
#pragma omp for schedule(static)
            for (int block = 0; block < blocks; ++block) visit(block);
        });
    } else
#endif
    {
        work(0, [&](const auto& visit) {
            for (int block = 0; block < blocks; ++block) visit(block);
        });
    }
    if (count % 2 == 1) state_.swap();
}

template <class System>
template <bool Pins, bool Drag, class Update>
void Sweep<System>::step_block(const StatePlanes<Scalar>& planes, int block, Scalar h,
                               Scalar* scratch, const Update& update) const {
    const auto vector = [&](int number) {
        return Planes<Scalar>{scratch + number * Dim * scratch_stride + max_width, scratch_stride};
    };
    TileView<Scalar> view{{planes.spring_x.first, planes.spring_x.stride},
                          {planes.v.first, planes.v.stride},
                          damping_,
                          block,
                          0,
                          vector(0),
                          vector(1),
                          vector(2)};
    const Index begin = static_cast<Index>(block) * block_size;
    const Index count = std::min<Index>(block_size, plan_.size() - begin);
    for (Index i = 0; i < count; i += tile_size) {
        view.tile = static_cast<int>((begin + i) / tile_size);
        plan_.add_forces(view);
        move<Pins, Drag>(planes, begin + i, std::min<Index>(tile_size, count - i), h,
                         view.force_a.at(i), view.force_b.at(i), update);
    }
}

template <class System>
template <bool Pins, bool Drag, class Update>
void Sweep<System>::move(const StatePlanes<Scalar>& planes, Index first, Index count, Scalar h,
                         const Planes<Scalar>& force_a, const Planes<Scalar>& force_b,
                         const Update& update) const {
    const Register step(h);
    const Register zero(Scalar(0));
    const Register ahead(ahead_);
    const bool looks_ahead = ahead_ > 0;
    [[maybe_unused]] const Register d0(drag_);
    for (int d = 0; d < Dim; ++d) {
        const Register gravity(gravity_[d]);
        const Scalar* inverse_masses = inverse_mass_.data() + first;
        const Scalar* xs = planes.x[d] + first;
        const Scalar* vs = planes.v[d] + first;
        Scalar* new_xs = planes.new_x[d] + first;
        Scalar* new_vs = planes.new_v[d] + first;
        Scalar* new_spring_xs = planes.new_spring_x[d] + first;
        Scalar* forces_a = force_a[d];
        Scalar* forces_b = force_b[d];
        for (Index i = 0; i < count; i += Register::width) {
            const Register inverse_mass = Register::load(inverse_masses + i);
            Register x = Register::load(xs + i);
            Register v = Register::load(vs + i);
            Register free_fall = gravity;
            if constexpr (Drag) free_fall -= d0 * v;
            if constexpr (Pins) free_fall = where_less(zero, inverse_mass, free_fall, zero);
            const Register f = Register::load(forces_a + i) + Register::load(forces_b + i);
            zero.store(forces_a + i);
            zero.store(forces_b + i);
            update(x, v, free_fall + inverse_mass * f, step);
            x.store(new_xs + i);
            v.store(new_vs + i);
            if (looks_ahead) (x + ahead * v).store(new_spring_xs + i);
        }
    }
}

}  // namespace taut::integrator_detail::sweep
