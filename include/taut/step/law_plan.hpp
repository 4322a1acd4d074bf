// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "star_plan.hpp"

namespace taut::step_detail {

/// Springs of a batch that are computed together: all that is known of them stays in the first
/// cache. Coefficients of their pulls overwrite the products that they are made of.
template <class Scalar>
struct Chunk {
    static constexpr int most = 64;
    static_assert(most % max_width == 0);

    alignas(64) Scalar l2[most] = {};
    alignas(64) Scalar dx_dv[most] = {};
    alignas(64) Scalar old_l2[most] = {};
};

/// Adds the forces of a batch: the same for all laws but for coefficients.
/// @tparam Both  whether a spring takes its positions ahead and as they are [T42]
/// @param pull   pull(springs, chunk, count): coefficients of the next springs of the batch
template <class Scalar, bool Damped, bool Both>
void add_batch(const PlannedBatches& plan, const Batch& batch, int dim,
               const TileView<Scalar>& view,
               void (*pull)(void* springs, Chunk<Scalar>& chunk, int count), void* springs);

/// The springs of one law: runs, and batches of those that fit none; or all of them in stars.
template <class Scalar, int Dim, class Law>
class LawPlan {
public:
    /// In place of the last springs.
    TAUT_COLD void renew(const SpringSet<Scalar, Law>& set, const SortedSprings& springs,
                         const Blocks& blocks, bool stars);
    /// Whether a spring has a damper of its own.
    bool damped() const { return damped_; }
    /// Adds the forces of the tile's springs on the places of its block.
    /// @tparam Both  whether a spring takes its positions ahead and as they are [T42]
    template <bool Both>
    void add_forces(const TileView<Scalar>& view) const;

private:
    using Register = VectorRegister<Scalar>;
    using Reader = SpringReader<Scalar, Law, Register>;
    using Vector = Few<Register, Dim>;

    static EIGEN_ALWAYS_INLINE Register dot(const Vector& a, const Vector& b) {
        Register sum = a[0] * b[0];
        if constexpr (Dim > 1) sum += a[1] * b[1];
        if constexpr (Dim > 2) sum += a[2] * b[2];
        return sum;
    }
    /// What adds the forces of a kind of damping.
    struct Kernels {
        void (LawPlan::*segment)(const TileView<Scalar>&, const Segment&) const;
        void (*batch)(const PlannedBatches&, const Batch&, int, const TileView<Scalar>&,
                      void (*)(void*, Chunk<Scalar>&, int), void*);
        void (*pull)(void*, Chunk<Scalar>&, int);

        template <bool Damped, bool Both>
        static constexpr Kernels of() {
            return {&LawPlan::add_segment<Damped, Both>, &add_batch<Scalar, Damped, Both>,
                    &LawPlan::pull<Damped, Both>};
        }
    };
    void add(const Kernels& kernels, const TileView<Scalar>& view) const;
    template <bool Damped, bool Both>
    void add_segment(const TileView<Scalar>& view, const Segment& segment) const;
    /// What a batch asks for coefficients.
    struct BatchSprings {
        Reader reader;
        Scalar alpha;
    };
    template <bool Damped, bool Both>
    static void pull(void* springs, Chunk<Scalar>& chunk, int count);

    SpringTable<Scalar, Law> table_;  // of runs, then of batches
    PlannedRuns runs_;
    PlannedBatches batches_;
    StarPlan<Scalar, Law> stars_;
    bool damped_ = false;
    bool in_stars_ = false;
};

template <class Scalar, int Dim, class Law>
void LawPlan<Scalar, Dim, Law>::renew(const SpringSet<Scalar, Law>& set,
                                      const SortedSprings& springs, const Blocks& blocks,
                                      bool stars) {
    *this = {};
    damped_ = !set.damping.empty();
    in_stars_ = stars;
    if (stars) {
        stars_ = {set, springs, blocks};
        return;
    }
    Buffer<int> index;
    runs_ = Planner<Scalar>::runs(springs, blocks, index);
    batches_ = Planner<Scalar>::batches(springs, blocks, index);
    int first = 0;
    const auto add = [&](int count) {
        table_.add(set, index, first, first + count);
        first += count;
    };
    for (const auto& run : runs_.runs) add(run.count);
    for (const auto& batch : batches_.batches) add(batch.springs);
    table_.finish();
}

template <class Scalar, int Dim, class Law>
template <bool Both>
void LawPlan<Scalar, Dim, Law>::add_forces(const TileView<Scalar>& view) const {
    TAUT_BY_KERNEL(template add<Both>(*this), this, &view);
    const bool damped = damped_ || view.alpha > 0;
    if constexpr (Dim > 1) {
        if (in_stars_) {
            return damped ? stars_.template add_forces<true, Both>(view)
                          : stars_.template add_forces<false, Both>(view);
        }
    }
    static constexpr Kernels kernels[] = {Kernels::template of<false, Both>(),
                                          Kernels::template of<true, Both>()};
    add(kernels[damped], view);
}

template <class Scalar, int Dim, class Law>
void LawPlan<Scalar, Dim, Law>::add(const Kernels& kernels, const TileView<Scalar>& view) const {
    const auto begin = [&](const auto& ends) { return view.tile == 0 ? 0 : ends[view.tile - 1]; };
    const int last_segment = runs_.segment_end[view.tile];
    for (int s = begin(runs_.segment_end); s < last_segment; ++s) {
        (this->*kernels.segment)(view, runs_.segments[s]);
    }
    const int runs = static_cast<int>(runs_.runs.size());
    const int last_batch = batches_.batch_end[view.tile];
    for (int b = begin(batches_.batch_end); b < last_batch; ++b) {
        BatchSprings springs{{table_, runs + b, 0}, view.alpha};
        kernels.batch(batches_, batches_.batches[b], Dim, view, kernels.pull, &springs);
    }
}

template <class Scalar, int Dim, class Law>
template <bool Damped, bool Both>
void LawPlan<Scalar, Dim, Law>::add_segment(const TileView<Scalar>& view,
                                            const Segment& segment) const {
    const auto& run = runs_.runs[segment.run];
    const int first_a = segment.first_a;
    const int first_b = first_a + run.offset;
    const Planes<const Scalar> x_a = view.x.at(first_a);
    const Planes<const Scalar> x_b = view.x.at(first_b);
    [[maybe_unused]] const Planes<const Scalar> here_a = view.at.at(first_a);
    [[maybe_unused]] const Planes<const Scalar> here_b = view.at.at(first_b);
    const Planes<const Scalar> v_a = view.v.at(first_a);
    const Planes<const Scalar> v_b = view.v.at(first_b);
    const Planes<Scalar> force_a =
        segment.writes_a ? view.force_a.at(first_a - view.begin) : view.discard;
    const Planes<Scalar> force_b =
        segment.writes_b ? view.force_b.at(first_b - view.begin) : view.discard;
    const Scalar alpha = view.alpha;
    Reader springs(table_, segment.run, static_cast<std::size_t>(first_a - run.first_a));
    for (int i = 0; i < segment.count; i += Register::width, springs.next()) {
        Vector dx, dv;
        [[maybe_unused]] Vector here;
        for_each_axis<Dim>([&](int d) {
            dx[d] = Register::load(x_b[d] + i) - Register::load(x_a[d] + i);
            if constexpr (Damped) {
                dv[d] = Register::load(v_b[d] + i) - Register::load(v_a[d] + i);
            }
            if constexpr (Both) {
                here[d] = Register::load(here_b[d] + i) - Register::load(here_a[d] + i);
            }
        });
        Register dx_dv(Scalar(0)), old_l2(Scalar(0));
        if constexpr (Damped) dx_dv = dot(dx, dv);
        if constexpr (Both) old_l2 = dot(here, here);
        const auto pull = springs.template pull_of<Damped, Both>(alpha, dot(dx, dx), dx_dv, old_l2);
        for_each_axis<Dim>([&](int d) {
            Register force = pull.of_dx * dx[d];
            if constexpr (Both) force -= pull.of_here * here[d];
            if constexpr (Damped) {
                if (alpha > 0) force += pull.of_dv * dv[d];
            }
            Scalar* on_a = force_a[d] + i;
            Scalar* on_b = force_b[d] + i;
            (Register::load(on_a) + force).store(on_a);
            (Register::load(on_b) - force).store(on_b);
        });
    }
}

template <class Scalar, int Dim, class Law>
template <bool Damped, bool Both>
void LawPlan<Scalar, Dim, Law>::pull(void* of, Chunk<Scalar>& chunk, int count) {
    auto& all = *static_cast<BatchSprings*>(of);
    BatchSprings springs = all;  // a copy is in registers
    for (int s = 0; s < count; s += Register::width, springs.reader.next()) {
        const Register square = Register::load(chunk.l2 + s);
        const Register product = Register::load(chunk.dx_dv + s);
        const auto keep = [&](const auto& pull) {
            pull.of_dx.store(chunk.l2 + s);
            pull.of_dv.store(chunk.dx_dv + s);
        };
        if constexpr (Both) {
            const auto pull = springs.reader.template pull_ahead<Damped>(
                springs.alpha, square, product, Register::load(chunk.old_l2 + s));
            keep(pull);
            pull.of_here.store(chunk.old_l2 + s);
        } else {
            keep(springs.reader.template pull<Damped>(springs.alpha, square, product));
        }
    }
    all = springs;
}

}  // namespace taut::step_detail

#if !defined(TAUT_COMPILED)
#include "law_plan-inl.hpp"
#endif
