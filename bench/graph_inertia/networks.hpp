// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <taut/graph_inertia/graph_inertia.hpp>
#include <taut/taut.hpp>

#include "../../tests/support/energy_networks.hpp"

namespace bench::graph_inertia {

using taut::Hookean, taut::Index, taut_test::Buckling, taut_test::TensionOnly;

struct Rises {
    int networks = 0, refused = 0, with_rise = 0, failed = 0;
    long steps = 0, rises = 0;
    double nearest = 0;  // rise over what rounding may add, at most
};

/// Energies of networks at δ = 1 [T35], thrown violently, at steps of 1 to 1000 times the any-pose
/// limit. Rounding is that of energy_networks.hpp and of the Cholesky factor, (n + 1)ε·|L||Lᵀ|,
/// whose entries are at most √(a_ii a_jj).
template <class Scalar, int Dim>
void watch_networks(int networks, int steps, Rises& total) {
    using System = taut::SpringSystem<Scalar, Dim, Hookean, TensionOnly, Buckling>;
    taut_test::Random random(static_cast<unsigned>(35000 + 10 * Dim + sizeof(Scalar)));
    taut::GraphInertiaOptions options;
    options.dissipation = 1;
    for (int i = 0; i < networks; ++i) {
        const auto system = taut_test::random_network<System>(random, i % 2 == 0 ? 6 : 3);
        auto state = taut_test::thrown(random, system);
        const double multiple = taut_test::log_uniform(random, 1, 1000);
        const auto limit = taut::any_pose_limit(system);
        if (limit.unbounded()) continue;
        const auto h = static_cast<Scalar>(multiple * static_cast<double>(limit.certified));
        ++total.networks;
        taut::GraphInertia<System> stepper(system, options);
        if (!stepper.prepare(h)) {
            ++total.refused;
            continue;
        }
        Eigen::VectorXd diagonal(system.size());
        for (Index j = 0; j < system.size(); ++j) {
            diagonal[j] = system.is_pinned(j) ? 0 : static_cast<double>(system.mass(j));
        }
        taut::for_each_inertia(system, stepper.shares(),
                               [&](Index a, Index b, double damped, double elastic) {
                                   diagonal[a] += damped + 2 * elastic;
                                   diagonal[b] += damped + 2 * elastic;
                               });
        const Eigen::VectorXd root = diagonal.cwiseSqrt();
        const double eps = static_cast<double>(system.size() + 1) *
                           static_cast<double>(std::numeric_limits<Scalar>::epsilon());
        auto energy = taut_test::total_energy(system, state);
        int rises = 0;
        for (int step = 0; step < steps; ++step) {
            double allowed = taut_test::rounding(system, state, static_cast<double>(h));
            const auto before = state.v;
            if (!stepper.step(state, h)) {
                ++total.failed;
                break;
            }
            double change = 0, after = 0;
            for (Index j = 0; j < system.size(); ++j) {
                change += root[j] * (state.v.col(j) - before.col(j)).template cast<double>().norm();
                after += root[j] * state.v.col(j).template cast<double>().norm();
            }
            allowed += eps * change * after;
            const auto next = taut_test::total_energy(system, state);
            const auto rise = static_cast<double>(next - energy);
            rises += rise > allowed;
            total.nearest = std::max(total.nearest, rise / allowed);
            energy = next;
            ++total.steps;
        }
        total.rises += rises;
        total.with_rise += rises > 0;
    }
}

inline bool networks_table(int networks, int steps) {
    std::printf(
        "## Energy at dissipation = 1\n\n"
        "Random networks of three laws, masses and stiffnesses over 3 or 6 decades, thrown "
        "violently; steps of 1 to 1000 times the any-pose limit.\n\n"
        "| scalar | networks | refused: masses lost | steps | steps that raise the energy | "
        "networks "
        "with one | failed | rise over what rounding may add, at most "
        "|\n|---|---|---|---|---|---|---|---|\n");
    bool ok = true;
    const auto row = [&](const char* name, const Rises& r) {
        std::printf("| %s | %d | %d | %ld | %ld | %d | %d | %.2g |\n", name, r.networks, r.refused,
                    r.steps, r.rises, r.with_rise, r.failed, r.nearest);
        std::fflush(stdout);
        ok = ok && r.rises == 0 && r.failed == 0;
    };
    Rises in_double, in_float;
    watch_networks<double, 1>(networks / 4, steps, in_double);
    watch_networks<double, 2>(networks / 4, steps, in_double);
    watch_networks<double, 3>(networks / 4, steps, in_double);
    row("double, 1 to 3-D", in_double);
    watch_networks<float, 2>(networks / 8, steps, in_float);
    watch_networks<float, 3>(networks / 8, steps, in_float);
    row("float, 2 and 3-D", in_float);
    std::printf("\n");
    return ok;
}

}  // namespace bench::graph_inertia
