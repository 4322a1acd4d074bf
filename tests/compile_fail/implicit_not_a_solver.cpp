// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::Solver: needs `factorize(const SparseMatrix&)`

#include <taut/integrator/implicit_euler.hpp>
#include <taut/own_matrices/linear_system.hpp>

struct Incomplete {
    void analyzePattern(const taut::SparseMatrix<double>&) {}
};

void step(const taut::LinearSystem<double>& system) {
    taut::ImplicitEuler<taut::LinearSystem<double>, Incomplete> stepper(system);
}
