// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "law_plan.hpp"

namespace taut::step_detail {

template <class Scalar, bool Damped, bool Both>
void add_batch(const PlannedBatches& plan, const Batch& batch, int dim,
               const TileView<Scalar>& view,
               void (*pull)(void* springs, Chunk<Scalar>& chunk, int count), void* springs) {
    using Vector = Quad<Scalar>;
    using Factor = typename Vector::Part;
    constexpr int most = Chunk<Scalar>::most;
    alignas(64) Scalar x[most_gathered][4];
    alignas(64) Scalar here[Both ? most_gathered : 1][4];
    alignas(64) Scalar v[Damped ? most_gathered : 1][4];
    alignas(64) Scalar f[most_gathered][4];
    const Scalar alpha = view.alpha;
    const int* places = plan.gathered.data() + batch.first_gathered;
    const auto gather = [&](Scalar(&to)[4], const Planes<const Scalar>& from, int place) {
        for (int d = 0; d < 4; ++d) to[d] = d < dim ? from[d][place] : Scalar(0);
    };
    for (int g = 0; g < batch.gathered; ++g) {
        for (Scalar& axis : f[g]) axis = 0;
        gather(x[g], view.x, places[g]);
        if constexpr (Both) gather(here[g], view.at, places[g]);
        if constexpr (Damped) gather(v[g], view.v, places[g]);
    }
    Few<Vector, most> dx;
    Few<Vector, Both ? most : 1> old_dx;
    Few<Vector, Damped ? most : 1> dv;
    Chunk<Scalar> chunk;
    for (int done = 0; done < batch.springs; done += most) {
        const auto* ends = plan.ends.data() + batch.first_spring + done;
        const int count = (std::min)(most, batch.springs - done);
        for (int s = 0; s < count; ++s) {
            const auto [a, b] = ends[s];
            dx[s] = Vector::load(x[b]) - Vector::load(x[a]);
            chunk.l2[s] = (dx[s] * dx[s]).total();
            if constexpr (Both) {
                old_dx[s] = Vector::load(here[b]) - Vector::load(here[a]);
                chunk.old_l2[s] = (old_dx[s] * old_dx[s]).total();
            }
            if constexpr (Damped) {
                dv[s] = Vector::load(v[b]) - Vector::load(v[a]);
                chunk.dx_dv[s] = (dx[s] * dv[s]).total();
            }
        }
        pull(springs, chunk, count);
        for (int s = 0; s < count; ++s) {
            Vector force = Factor(chunk.l2[s]) * dx[s];
            if constexpr (Both) force = force - Factor(chunk.old_l2[s]) * old_dx[s];
            if constexpr (Damped) {
                if (alpha > 0) force = force + Factor(chunk.dx_dv[s]) * dv[s];
            }
            const auto [a, b] = ends[s];
            (Vector::load(f[a]) + force).store(f[a]);
            (Vector::load(f[b]) - force).store(f[b]);
        }
    }
    for (int g = 0; g < batch.gathered; ++g) {
        const int i = places[g] - view.begin;
        if (i < 0 || i >= view.size) continue;  // another block sees to it
        for (int d = 0; d < dim; ++d) view.force_a[d][i] += f[g][d];
    }
}

}  // namespace taut::step_detail
