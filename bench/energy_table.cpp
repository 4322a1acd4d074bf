// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Whether a step within energy_limit ever raises the energy [T34]: random networks of all laws,
// masses and stiffnesses over twelve decades, pins, springs of no length, thrown violently. Prints
// Markdown; exits with 1 if one did. Arguments: networks of each row, steps of each.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/stability/energy_limit.hpp>
#include <taut/stability/lanczos.hpp>
#include <taut/tight/tight.hpp>
#include <utility>

#include "../tests/support/energy_networks.hpp"

namespace {

using taut::Hookean, taut_test::Buckling, taut_test::Index, taut_test::TensionOnly;

/// The network at rest, so far apart in its stiffest mode that rest lengths count for little: one
/// step beyond the edge turns all of the energy into motion, and more [T34].
template <class System>
typename System::State pulled(const System& system) {
    using Scalar = typename System::Scalar;
    auto state = system.initial_state();
    state.x.setZero();
    const auto laplacian = taut::SpringPencil<1>::any_pose(system);
    const Eigen::VectorXd mode = taut::largest_ritz_pair(laplacian, taut::matrices::K_plus).vector;
    double longest = 0;
    system.for_each_set([&](const auto& set) {
        for (const auto length : set.rest_length)
            longest = std::max(longest, static_cast<double>(length));
    });
    Index free = 0;
    for (Index i = 0; i < system.size(); ++i) {
        if (!system.is_pinned(i)) state.x(0, i) = static_cast<Scalar>(mode[free++]);
    }
    state.x *= static_cast<Scalar>(1e3 * longest) / state.x.cwiseAbs().maxCoeff();
    return state;
}

/// How many of `networks` without buckling springs, which are stiffest when pushed, gain energy in
/// one step at 1.05 of the edge. @returns that and the number tried
template <class Scalar, int Dim>
std::pair<int, int> pulled_beyond(int networks) {
    using System = taut::SpringSystem<Scalar, Dim, Hookean, TensionOnly>;
    taut_test::Random random(static_cast<unsigned>(34100 + 10 * Dim + sizeof(Scalar)));
    int tried = 0, risen = 0;
    for (int i = 0; i < networks; ++i) {
        auto system = taut_test::random_network<System>(random, i % 2 == 0 ? 12 : 3);
        const auto limit = taut::energy_limit(system, 1e-6);
        if (limit.unbounded()) continue;
        ++tried;
        const double h = 1.05 * static_cast<double>(limit.certified);
        system.set_graph_damping(h);
        risen += taut_test::rises<taut::SymplecticEuler<System>>(system, pulled(system), h, 1) > 0;
    }
    return {risen, tried};
}

template <class Scalar, int Dim>
int row(int networks, int steps) {
    using System = taut::SpringSystem<Scalar, Dim, Hookean, TensionOnly, Buckling>;
    using Stepper = taut::SymplecticEuler<System>;
    taut_test::Random random(static_cast<unsigned>(34000 + 10 * Dim + sizeof(Scalar)));
    int tried = 0, with_rise = 0, above = 0;
    long rises = 0;
    for (int i = 0; i < networks; ++i) {
        auto system = taut_test::random_network<System>(random, i % 2 == 0 ? 12 : 3);
        const auto limit = taut::energy_limit(system, 1e-6);
        const auto state = taut_test::thrown(random, system);
        if (limit.unbounded()) continue;
        ++tried;
        const auto h = static_cast<double>(limit.certified);
        system.set_graph_damping(limit.alpha(h).lower);
        const int risen = taut_test::rises<Stepper>(system, state, h, steps);
        rises += risen;
        with_rise += risen > 0;
        system.set_graph_damping(1.05 * h);
        above += taut_test::rises<Stepper>(system, state, 1.05 * h, steps) > 0;
    }
    const auto [gained, among] = pulled_beyond<Scalar, Dim>(networks);
    std::printf("| %s, %d-D | %d | %ld | %d | %d | %d of %d |\n",
                sizeof(Scalar) == 4 ? "float" : "double", Dim, tried, rises, with_rise, above,
                gained, among);
    std::fflush(stdout);
    return with_rise;
}

}  // namespace

int main(int argc, char** argv) {
    const int networks = argc > 1 ? std::atoi(argv[1]) : 200;
    const int steps = argc > 2 ? std::atoi(argv[2]) : 500;
    std::printf(
        "## Steps that raise the energy, at the certified edge\n\n"
        "%d steps of each network from a violent start.\n\n"
        "| scalar | networks | steps that raise it | networks with one | with one at 1.05 of "
        "the edge | the same without buckling, one step, pulled into its stiffest mode "
        "|\n|---|---|---|---|---|---|\n",
        steps);
    int wrong = 0;
    wrong += row<double, 1>(networks, steps) + row<double, 2>(networks, steps);
    wrong += row<double, 3>(networks, steps) + row<float, 1>(networks, steps);
    wrong += row<float, 2>(networks, steps) + row<float, 3>(networks, steps);
    return wrong == 0 ? 0 : 1;
}
