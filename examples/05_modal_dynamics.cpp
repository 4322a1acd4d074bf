// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// A net in its lowest modes, each stepped exactly. docs/systems/modal_dynamics.md reads along.
// Needs Spectra.

#include <cmath>
#include <cstdio>
#include <taut/modal/modal_analysis.hpp>
#include <taut/equilibrium/equilibrium.hpp>
#include <taut/modal/modal_dynamics.hpp>
#include <taut/own_matrices/linearize.hpp>
#include <taut/scene/cloth.hpp>

int main() {
    taut::ClothOptions options{40, 20};
    options.diagonals = false;  // they would compress the rows, and the flat net would buckle
    auto net = taut::hanging_cloth<double>(options);
    for (int i = 0; i < 20; ++i) net.pin(i);
    net.set_gravity({0, 9.81, 0});  // along the net: it hangs in its plane

    auto pose = net.initial_state();
    if (!taut::static_equilibrium(net, pose)) return 1;
    const auto linear = linearize(net, pose);
    taut::ModalBasis basis;
    if (!taut::modal_analysis(linear, 30, basis)) return 1;
    std::printf("%ld modes of %ld: %.2f to %.2f Hz\n", static_cast<long>(basis.size()),
                static_cast<long>(linear.size()), std::sqrt(basis.k[0]) / 6.2832,
                std::sqrt(basis.k[29]) / 6.2832);

    taut::ModalDynamics<float, 3> modal(linear, pose, basis);
    taut::Points<float, 3> wind = taut::Points<float, 3>::Zero(3, net.size());
    wind.row(2).setConstant(1e-4F);  // N
    modal.set_force(wind);
    taut::Points<float, 3> x;
    for (int frame = 0; frame < 60; ++frame) {
        if (!modal.step(1.0 / 60)) return 1;
        modal.positions(x);
    }
    std::printf("after 1 s of wind the free edge is %.3f m out of the plane\n",
                static_cast<double>(x.row(2).maxCoeff()));
}
