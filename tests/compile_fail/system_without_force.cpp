// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// EXPECT: taut::System: needs `void force(const State&, Points& f) const`

#include <cstdint>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/network/state.hpp>

struct Incomplete {
    using Scalar = double;
    using State = taut::State<double, 1>;
    taut::Index size() const { return 1; }
    void force(const State&, taut::Points<double, 1>&) {}  // not const
    Eigen::VectorXd inverse_mass() const { return Eigen::VectorXd::Ones(1); }
    std::uint64_t revision() const { return 0; }
    std::uint64_t force_revision() const { return 0; }
};

void step(const Incomplete& system) { taut::SymplecticEuler<Incomplete> stepper(system); }
