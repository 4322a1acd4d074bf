// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "../../model/force_plan.hpp"

#ifdef _OPENMP
#include <omp.h>
#endif

namespace taut::detail {

/// Many explicit steps of a SpringSystem in planes: converted once, then for each block of
/// particles the forces of its springs, gravity, damping and the update in one go.
template <class System>
class PlaneSteps {
public:
    using Scalar = typename System::Scalar;
    static constexpr int Dim = System::Dim;

    /// Takes `count` steps of h. Without external forces only.
    /// @param added   damping beside the system's, StepDamping::times(h)
    /// @param update  update(x, v, a, h): one coordinate of x and v by the acceleration a, in Lanes
    /// @returns whether the new state is finite; else `state` is not touched
    template <class AnyState, class Update>
    bool run(const System& system, AnyState& state, Scalar h, Index count, int threads,
             const StepDamping& added, const Update& update);

private:
    using Pack = Lanes<Scalar>;
    using Field = Planes<Scalar>;
    /// What springs read changes place from step to step; the rest is stepped where it is.
    struct Fields {
        Field x, new_x;        // one and the same where springs look ahead
        Field seen, new_seen;  // where springs see the particles: x, or x + ahead·v
        Field v, new_v;        // one and the same where no spring asks for velocities
        void swap() {
            std::swap(x, new_x);
            std::swap(seen, new_seen);
            std::swap(v, new_v);
        }
    };
    /// Not finite is noticed after so many steps; until then they cost as much as others.
    static constexpr Index steps_between_checks = 64;
    static constexpr Index scratch_stride = block_size + block_size / 16;

    template <class AnyState>
    void load(const System& system, const AnyState& state, const StepDamping& added);
    bool finite() const;
    template <class Update>
    void steps(Scalar h, Index count, int threads, const Update& update);
    template <bool Pins, bool Drag, class Update>
    void steps(Scalar h, Index count, int threads, const Update& update);
    template <bool Pins, bool Drag, class Update>
    void step_block(const Fields& fields, int block, Scalar h, Scalar* scratch,
                    const Update& update) const;
    /// Particles first, first + 1, … by the forces on them, which are cleared.
    template <bool Pins, bool Drag, class Update>
    void move(const Fields& fields, Index first, Index count, Scalar h, const Field& begin_force,
              const Field& end_force, const Update& update) const;

    ForcePlan<System> plan_;
    VectorX<Scalar> memory_;  // the planes of fields_
    Fields fields_;
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
bool PlaneSteps<System>::run(const System& system, AnyState& state, Scalar h, Index count,
                             int threads, const StepDamping& added, const Update& update) {
    load(system, state, added);
    for (Index done = 0; done < count;) {
        const Index next = std::min(steps_between_checks, count - done);
        steps(h, next, threads, update);
        if (!finite()) return false;
        done += next;
    }
    plan_.from_planes(fields_.x, state.x);
    plan_.from_planes(fields_.v, state.v);
    for (Index i = 0; i < count; ++i) state.time += h;
    return true;
}

template <class System>
template <class AnyState>
void PlaneSteps<System>::load(const System& system, const AnyState& state,
                              const StepDamping& added) {
    gravity_ = system.gravity();
    drag_ = static_cast<Scalar>(system.rayleigh().mass_proportional);
    damping_ = (system.stiffness_damping() + StiffnessDamping<double>{0, added.graph})
                   .template cast<Scalar>();
    ahead_ = static_cast<Scalar>(added.look_ahead);
    plan_.update(system);
    const Index planes = Dim * plan_.stride();
    const bool looks_ahead = ahead_ > 0;
    const bool moving = plan_.damped() || bool(damping_);
    memory_.resize((3 + (moving ? 1 : 0) + (looks_ahead ? 1 : 0)) * planes);
    inverse_mass_.resize(plan_.stride());
    // What whole registers touch beyond the last particle takes part in the steps: from rest.
    const Index beyond = plan_.stride() - plan_.size();
    for (Index end = plan_.stride(); end <= memory_.size(); end += plan_.stride()) {
        memory_.segment(end - beyond, beyond).setZero();
    }
    inverse_mass_.tail(beyond).setZero();
    const auto field = [&](Index which) {
        return Field{memory_.data() + which * planes, plan_.stride()};
    };
    const Field seen = field(0);
    const Field x = looks_ahead ? field(3) : seen;
    fields_ = {x,        looks_ahead ? x : field(1),
               seen,     field(1),
               field(2), field(moving ? (looks_ahead ? 4 : 3) : 2)};
    plan_.to_planes(state.x, fields_.x);
    plan_.to_planes(state.v, fields_.v);
    if (looks_ahead) {
        const auto whole = [&](const Field& where) {
            return Eigen::Map<VectorX<Scalar>>(where.first, planes);
        };
        whole(seen) = whole(x) + ahead_ * whole(fields_.v);
    }
    plan_.to_planes(system.inverse_mass().transpose(), {inverse_mass_.data(), plan_.stride()});
    pins_ = (inverse_mass_.head(plan_.size()).array() == Scalar(0)).any();
}

template <class System>
bool PlaneSteps<System>::finite() const {
    // x − x is 0, or NaN where x is not finite; and so is the sum.
    const auto all = [&](const Field& field) {
        Scalar sum = 0;
        for (int d = 0; d < Dim; ++d) {
            const Eigen::Map<const VectorX<Scalar>> plane(field[d], plan_.size());
            sum += (plane - plane).sum();
        }
        return sum == Scalar(0);
    };
    return all(fields_.x) && all(fields_.v);
}

template <class System>
template <class Update>
void PlaneSteps<System>::steps(Scalar h, Index count, int threads, const Update& update) {
    const bool drag = drag_ > 0;
    if (pins_ && drag) steps<true, true>(h, count, threads, update);
    if (pins_ && !drag) steps<true, false>(h, count, threads, update);
    if (!pins_ && drag) steps<false, true>(h, count, threads, update);
    if (!pins_ && !drag) steps<false, false>(h, count, threads, update);
}

template <class System>
template <bool Pins, bool Drag, class Update>
void PlaneSteps<System>::steps(Scalar h, Index count, int threads, const Update& update) {
    const int blocks = plan_.blocks();
    const int workers = std::max(1, std::min(threads, blocks));
    const Index scratch_size = 3 * Dim * scratch_stride;
    if (scratch_.size() < workers * scratch_size) scratch_.setZero(workers * scratch_size);
    const auto work = [&](int worker, const auto& for_each_block) {
        Fields fields = fields_;
        Scalar* scratch = scratch_.data() + worker * scratch_size;
        for (Index step = 0; step < count; ++step) {
            for_each_block(
                [&](int block) { step_block<Pins, Drag>(fields, block, h, scratch, update); });
            fields.swap();
        }
    };
#ifdef _OPENMP
    if (workers > 1) {
#pragma omp parallel num_threads(workers)
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
    if (count % 2 == 1) fields_.swap();
}

template <class System>
template <bool Pins, bool Drag, class Update>
void PlaneSteps<System>::step_block(const Fields& fields, int block, Scalar h, Scalar* scratch,
                                    const Update& update) const {
    const auto force = [&](int which) {
        return Field{scratch + which * Dim * scratch_stride + most_lanes, scratch_stride};
    };
    const Field begin_force = force(0);
    const Field end_force = force(1);
    BlockSweep<Scalar> sweep{{fields.seen.first, fields.seen.stride},
                             {fields.v.first, fields.v.stride},
                             damping_,
                             block,
                             0,
                             begin_force,
                             end_force,
                             force(2)};
    const Index first = static_cast<Index>(block) * block_size;
    const Index count = std::min<Index>(block_size, plan_.size() - first);
    for (Index tile = 0; tile < count; tile += tile_size) {
        sweep.tile = static_cast<int>((first + tile) / tile_size);
        plan_.add_forces(sweep);
        move<Pins, Drag>(fields, first + tile, std::min<Index>(tile_size, count - tile), h,
                         begin_force.at(tile), end_force.at(tile), update);
    }
}

template <class System>
template <bool Pins, bool Drag, class Update>
void PlaneSteps<System>::move(const Fields& fields, Index first, Index count, Scalar h,
                              const Field& begin_force, const Field& end_force,
                              const Update& update) const {
    const Pack step(h);
    const Pack zero(Scalar(0));
    const Pack ahead(ahead_);
    const bool looks_ahead = ahead_ > 0;
    [[maybe_unused]] const Pack d0(drag_);
    for (int d = 0; d < Dim; ++d) {
        const Pack gravity(gravity_[d]);
        const Scalar* inverse_masses = inverse_mass_.data() + first;
        const Scalar* xs = fields.x[d] + first;
        const Scalar* vs = fields.v[d] + first;
        Scalar* new_xs = fields.new_x[d] + first;
        Scalar* new_vs = fields.new_v[d] + first;
        Scalar* new_seen = fields.new_seen[d] + first;
        Scalar* begin_forces = begin_force[d];
        Scalar* end_forces = end_force[d];
        for (Index i = 0; i < count; i += Pack::size) {
            const Pack inverse_mass = Pack::load(inverse_masses + i);
            Pack x = Pack::load(xs + i);
            Pack v = Pack::load(vs + i);
            Pack free_fall = gravity;
            if constexpr (Drag) free_fall -= d0 * v;
            if constexpr (Pins) free_fall = where_less(zero, inverse_mass, free_fall, zero);
            const Pack f = Pack::load(begin_forces + i) + Pack::load(end_forces + i);
            zero.store(begin_forces + i);
            zero.store(end_forces + i);
            update(x, v, free_fall + inverse_mass * f, step);
            x.store(new_xs + i);
            v.store(new_vs + i);
            if (looks_ahead) (x + ahead * v).store(new_seen + i);
        }
    }
}

}  // namespace taut::detail
