// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Dense>
#include <taut/graph_inertia/graph_inertia.hpp>
#include <taut/graph_inertia/inertia_price.hpp>

#include "../hanging_net.hpp"
#include "price.hpp"

namespace bench::graph_inertia {

/// Squares of the frequencies of the free degrees of freedom, ascending: K⁺u = λMu, or with M̃.
inline Eigen::VectorXd squares(const Net& net, const Net::State& state,
                               const taut::GraphShares* shares) {
    const auto pencil = taut::SpringPencil<3>::at_pose(net, state.x);
    const Index N = pencil.size();
    Eigen::MatrixXd K(N, N);
    Eigen::VectorXd column;
    for (Index j = 0; j < N; ++j) {
        pencil.multiply(taut::matrices::K_plus, Eigen::VectorXd::Unit(N, j), column);
        K.col(j) = column;
    }
    Eigen::MatrixXd M = pencil.mass().asDiagonal();
    const taut::FreeParticles free(net);
    if (shares) {
        taut::for_each_inertia(net, *shares, [&](Index a, Index b, double damped, double elastic) {
            const Index i = free.place(a), j = free.place(b);
            for (int d = 0; d < 3; ++d) {
                for (const Index row : {i, j}) {
                    if (row >= 0) M(3 * row + d, 3 * row + d) += damped + elastic;
                }
                if (i < 0 || j < 0) continue;
                M(3 * i + d, 3 * j + d) -= damped + elastic;
                M(3 * j + d, 3 * i + d) -= damped + elastic;
            }
        });
    }
    return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(K, M, Eigen::EigenvaluesOnly)
        .eigenvalues();
}

struct Agreement {
    int scenes = 0, modes = 0, compared = 0, within = 0;
    double worst = 0;  // |predicted − computed| over computed
};

inline void compare_modes(const Net& net, const Net::State& state, double multiple,
                          Agreement& agreement) {
    const double h = multiple * taut::any_pose_limit(net).certified;
    const auto shares = taut::graph_shares(net, h, taut::GraphInertiaOptions{}.margin);
    const auto price = taut::inertia_price(net, state, shares, 10);
    const auto before = squares(net, state, nullptr);
    const auto after = squares(net, state, &shares);
    if (price.modes.empty()) return;
    Index first = 0;  // above the zero modes
    const double lowest = price.modes.front().frequency;
    while (first < before.size() && std::sqrt(std::max(0.0, before[first])) < 0.999 * lowest)
        ++first;
    ++agreement.scenes;
    for (std::size_t j = 0; j < price.modes.size(); ++j) {
        const Index at = first + static_cast<Index>(j);
        if (at >= before.size()) break;
        ++agreement.modes;
        const double change = std::sqrt(after[at] / before[at]) - 1;
        if (!(std::abs(change) > 1e-4)) continue;
        ++agreement.compared;
        const double off = std::abs(price.modes[j].change() - change) / std::abs(change);
        agreement.within += off <= 0.1;
        agreement.worst = std::max(agreement.worst, off);
    }
}

inline bool modes_table() {
    std::printf(
        "## Predicted and computed change of the ten lowest frequencies\n\n"
        "| scene | scenes | modes | that change by more than 1e-4 | predicted within 10 %% of the "
        "change | furthest |\n|---|---|---|---|---|---|\n");
    bool ok = true;
    const auto row = [&](const char* name, const Agreement& a) {
        std::printf("| %s | %d | %d | %d | %d | %.2g %% |\n", name, a.scenes, a.modes, a.compared,
                    a.within, 100 * a.worst);
        std::fflush(stdout);
        ok = ok && a.within == a.compared;
    };
    const double multiples[] = {1.5, 3, 10, 30};
    Agreement nets, small, large;
    Random random(5);
    for (const double multiple : multiples) {
        Net::State state;
        const Net net = hanging_net(9, 9, state);
        compare_modes(net, state, multiple, nets);
        Net hemmed = hem(10, 100);
        for (Index c = 0; c < 10; ++c) hemmed.pin(c);
        compare_modes(hemmed, hemmed.initial_state(), multiple, small);
        const Net worn = garment(rough_tube(12, 9, random), 1000);
        compare_modes(worn, worn.initial_state(), multiple, small);
        const Net wide = garment(rough_tube(20, 14, random), 1000);  // by Krylov vectors
        compare_modes(wide, wide.initial_state(), multiple, large);
    }
    row("nets of 81 at equilibrium", nets);
    row("cloths of 100 with a hem × 100, garments of 108", small);
    row("garments of 280", large);
    std::printf("\n");
    return ok;
}

/// The dial: what dissipation does to the error over half a second and to the energy of 5 s.
inline void dial_table(const taut::GraphInertiaOptions& given) {
    std::printf(
        "## The dial\n\n"
        "Error over 0.5 s as in the price table; energy lost after 5 s, of the most kinetic "
        "energy that the explicit step saw.\n\n"
        "| scene | δ | steps a frame | rms, %% | energy lost, %% |\n|---|---|---|---|---|\n");
    Random random(3);
    const Scene scenes[] = {{"hanging_cloth 32, hem × 1000", hem(32, 1000), 0},
                            {"garment of 280", garment(rough_tube(20, 14, random), 1000), 0}};
    for (const Scene& scene : scenes) {
        const Net& net = scene.net;
        const double limit = taut::any_pose_limit(net).certified;
        const auto substeps = static_cast<Index>(std::ceil(frame / limit));
        taut::VelocityVerlet fine(net);
        const auto reference = simulate(net, fine, 4 * substeps, 30);
        double most = 0, end = 0;
        auto state = net.initial_state();
        taut::SymplecticEuler plain(net);
        for (int f = 0; f < 300; ++f) {
            if (!plain.step(state, frame / static_cast<double>(substeps), substeps)) return;
            most = std::max(most, net.kinetic_energy(state));
        }
        end = net.energy(state);
        const Index n = fewest_that_touch(net, 0.3, substeps);
        std::printf("| %s | explicit | %ld | | %.2f |\n", scene.name.c_str(),
                    static_cast<long>(substeps),
                    100 * (net.energy(net.initial_state()) - end) / most);
        for (const double dissipation : {0.0, 0.01, 0.03, 0.1, 0.3, 1.0}) {
            auto options = given;
            options.dissipation = dissipation;
            const auto found = price(net, n, *reference, options);
            taut::GraphInertia stepper(net, options);
            state = net.initial_state();
            bool ok = found.has_value();
            for (int f = 0; ok && f < 300; ++f)
                ok = bool(stepper.step(state, frame / static_cast<double>(n), n));
            if (!ok) continue;
            std::printf("| | %g | %ld | %.2f | %.2f |\n", dissipation, static_cast<long>(n),
                        100 * found->error.rms,
                        100 * (net.energy(net.initial_state()) - net.energy(state)) / most);
            std::fflush(stdout);
        }
    }
    std::printf("\n");
}

}  // namespace bench::graph_inertia
