// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>

#include "steps.hpp"
#include "waves.hpp"

#ifdef _OPENMP
#include <omp.h>
#endif

namespace taut::step_detail {

template <class Scalar>
void add_scaled(const Scalar* a, Scalar by, const Scalar* b, Scalar* sum, Index count) {
    TAUT_BY_KERNEL(add_scaled(), a, by, b, sum, count);
    using Register = VectorRegister<Scalar>;
    for (Index i = 0; i < count; i += Register::width) {
        (Register::load(a + i) + Register(by) * Register::load(b + i)).store(sum + i);
    }
}

template <class Scalar, int Dim>
void Outside<Scalar, Dim>::ask(const Layout<Scalar>& layout, const StatePlanes<Scalar>& planes,
                               bool first) {
    const auto& constant = forces_->constant;
    found_ = {};
    // Particles in any order are all over memory: a tile of them fills the first cache.
    by_tile_ = asks_for_state() && layout.side_by_side();
    if (!asks_for_state() && constant.cols() == 0) return;
    force_.resize(Dim, layout.size());
    detail::set_zero(force_.data(), force_.size());
    std::copy_n(constant.data(), constant.size(), force_.data());
    if (asks_for_state()) {
        state_.x.resize(Dim, layout.size());
        state_.v.resize(Dim, layout.size());
        if (first || !by_tile_) {
            layout.from_planes(planes.x, state_.x, layout.all());
            layout.from_planes(planes.v, state_.v, layout.all());
        }
        forces_->whole(state_, force_);
        if (by_tile_) return;
    }
    const auto size = static_cast<std::size_t>(layout.planes() * layout.stride());
    if (planes_.size() != size) planes_.assign(size, Scalar(0));  // padding is stepped, too
    found_ = {planes_.data(), layout.stride()};
    layout.to_planes(force_, found_, layout.all());
}

template <class Scalar, int Dim>
bool Steps<Scalar, Dim>::steps(const Forces& forces, Scalar h, Index count, int threads,
                               Move move) {
    const bool asks = outside_.asks_for_state();
    if (asks && !state_.finite()) return false;  // a finite double may be infinite as a float
    for (Index done = 0; done < count;) {
        const Index next = asks || watch_ ? 1 : (std::min)(steps_between_checks, count - done);
        outside_.ask(forces.layout(), state_.planes(), done == 0 || watch_);
        show(forces.layout(), outside_.state(), outside_.force());
        const bool finite = some_steps(forces, h, next, threads, move);
        done += next;
        const bool check = asks || done == count || done % steps_between_checks == 0;
        if (check && !finite && !state_.finite()) return false;
        outside_.pass(h);
        if (!passed(forces.layout())) return false;
    }
    return true;
}

template <class Scalar, int Dim>
bool Steps<Scalar, Dim>::some_steps(const Forces& forces, Scalar h, Index count, int threads,
                                    Move move) {
    const Blocks& blocks = forces.layout().blocks();
    threads = blocks.workers(threads);
    const auto needed = static_cast<std::size_t>(threads * scratch_size);
    if (scratch_.size() < needed) scratch_.assign(needed, Scalar(0));
    std::atomic<bool> finite{true};
    const auto work = [&](int thread, int workers, const auto& wait) {
        const Waves waves(blocks.count(), forces.reach(), workers);
        waves.run(
            thread, count,
            [&](Index step, int block) {
                StatePlanes<Scalar> planes = state_.planes();
                if (step % 2 == 1) planes.swap();
                if (!step_block(forces, planes, block, h, scratch_.data() + thread * scratch_size,
                                move)) {
                    finite.store(false, std::memory_order_relaxed);
                }
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
    return finite;
}

template <class Scalar, int Dim>
bool Steps<Scalar, Dim>::step_block(const Forces& forces, const StatePlanes<Scalar>& planes,
                                    int block, Scalar h, Scalar* scratch, Move move) {
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
    bool finite = true;
    const Planes<Scalar> room{scratch + 3 * Dim * scratch_stride, tile_stride};
    for (Index i = 0; i < count; i += tile_size) {
        const Places tile{begin + i, std::min<Index>(tile_size, count - i)};
        view.tile = static_cast<int>(tile.first / tile_size);
        forces.add(view);
        (update_.*move)(layout,
                        {planes, tile.first * grain, tile.count * grain, view.force_a.at(i * grain),
                         view.force_b.at(i * grain), outside_.on_tile(layout, tile, room)},
                        h);
        finite = outside_.moved(layout, tile, planes) && finite;
    }
    return finite;
}

}  // namespace taut::step_detail
