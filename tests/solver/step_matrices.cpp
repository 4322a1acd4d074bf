// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "step_matrices.hpp"

#include <taut/network/tangent_matrix.hpp>

#include "../support/random_system.hpp"

namespace taut_test {

namespace {

template <int Dim>
taut::SparseMatrix<double> of(Random& random, const RandomOptions& options, double h) {
    const auto system = random_system<double, Dim>(random, options);
    const taut::TangentMatrix<double, Dim> tangent(system);
    auto A = tangent.zero();
    tangent.assemble(system, random_state(random, system).x,
                     taut::matrices::M + h * h * taut::matrices::K_plus, A);
    return A;
}

}  // namespace

taut::SparseMatrix<double> random_step_matrix(Random& random, int dim, Index particles,
                                              Index springs, double h) {
    RandomOptions options;
    options.particles = particles;
    options.springs = springs;
    return dim == 1   ? of<1>(random, options, h)
           : dim == 2 ? of<2>(random, options, h)
                      : of<3>(random, options, h);
}

}  // namespace taut_test
