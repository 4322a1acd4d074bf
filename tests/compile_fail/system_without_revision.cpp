// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::System: needs `revision() const`

#include <taut/integrator/symplectic_euler.hpp>
#include <taut/network/state.hpp>

struct Incomplete {
    using Scalar = double;
    using State = taut::State<double, 1>;
    taut::Index size() const { return 1; }
    void force(const State&, taut::Points<double, 1>&) const {}
    Eigen::VectorXd inverse_mass() const { return Eigen::VectorXd::Ones(1); }
};

void step(const Incomplete& system) { taut::SymplecticEuler<Incomplete> stepper(system); }
