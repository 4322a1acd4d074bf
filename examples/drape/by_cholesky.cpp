// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include "implicit_motion.hpp"

namespace drape {

Advance motion_by_cholesky(const Options& options, const Scene& scene) {
    if (options.integrator == "projective") {
        return plain_or_guarded<taut::ProjectiveDynamics<Cloth>>(options, scene, AsItIs());
    }
    if (options.integrator == "graph_inertia") {
        return plain_or_guarded<taut::GraphInertia<Cloth>>(options, scene, AsItIs());
    }
    using Cholesky =
        Eigen::SimplicialLLT<taut::SparseMatrix<double>, Eigen::Lower, taut::BlockOrdering<>>;
    return implicit_motion<Cholesky>(options, scene);
}

}  // namespace drape
