// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <taut/lattice/lattice.hpp>
#include <utility>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::lattice_test {

using taut::lattice;
using taut::LatticeOptions;

TEMPLATE_TEST_CASE("lattice: every neighbour and every diagonal of a face has one spring, at rest",
                   "[scene]", float, double) {
    using Scalar = TestType;
    for (const std::array<Index, 3> n :
         {std::array<Index, 3>{1, 1, 1}, {4, 1, 1}, {1, 3, 2}, {2, 2, 2}, {3, 5, 4}}) {
        LatticeOptions options;
        options.particles = n;
        options.diagonal = 500;
        const auto block = lattice<Scalar>(options);
        REQUIRE(block.size() == n[0] * n[1] * n[2]);
        const auto state = block.initial_state();
        std::set<std::pair<Index, Index>> joined;
        block.visit_springs([&](const auto& spring) {
            joined.insert(std::minmax(spring.a, spring.b));
            const double l =
                static_cast<double>((state.x.col(spring.b) - state.x.col(spring.a)).norm());
            const auto L = static_cast<double>(spring.rest_length);
            CHECK_THAT(l, WithinAbs(L, 8 * Tolerance<Scalar>::epsilon));
            CHECK(spring.parameters.stiffness == Scalar(L < 0.12 ? 1000 : 500));
        });
        CHECK(static_cast<Index>(joined.size()) == block.spring_count());
        // The pairs, counted by their distance alone.
        Index near = 0, met = 0;
        for (Index a = 0; a < block.size(); ++a) {
            for (Index b = a + 1; b < block.size(); ++b) {
                if ((state.x.col(b) - state.x.col(a)).norm() > Scalar(0.15)) continue;
                ++near;
                met += static_cast<Index>(joined.count({a, b}));
            }
        }
        CHECK(near == block.spring_count());
        CHECK(met == near);
        CHECK(block.pinned_count() == 0);
        CHECK(block.gravity().isZero(0));
    }
}

TEST_CASE("lattice: equal stiffnesses make an isotropic solid of Poisson's ratio 1/4", "[scene]") {
    const LatticeOptions options{{3, 3, 3}, 0.2, 700, 700, 0.01};
    const auto block = lattice<double>(options);
    const auto state = block.initial_state();
    const Index centre = 13;
    Random random(1);
    for (int draw = 0; draw < 20; ++draw) {
        Eigen::Matrix3d strain;
        strain.col(0) = random.vector<double, 3>(-1, 1);
        strain.col(1) = random.vector<double, 3>(-1, 1);
        strain.col(2) = random.vector<double, 3>(-1, 1);
        strain = (1e-6 * (strain + strain.transpose())).eval();
        // Half of each spring belongs to either end.
        double energy = 0;
        block.visit_springs([&](const auto& spring) {
            if (spring.a != centre && spring.b != centre) return;
            const Eigen::Vector3d d = state.x.col(spring.b) - state.x.col(spring.a);
            const double stretch = (d + strain * d).norm() - spring.rest_length;
            energy += 0.25 * spring.parameters.stiffness * stretch * stretch;
        });
        const double a = options.spacing;
        const double E = 5 * options.stiffness / (2 * a), nu = 0.25;
        const double mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
        const double trace = strain.trace();
        const double density = lambda / 2 * trace * trace + mu * strain.squaredNorm();
        CHECK_THAT(energy, WithinRel(density * a * a * a, 1e-4));
    }
}

TEST_CASE("lattice: bad input: options are named", "[scene][bad_input]") {
    const auto refused = [](const char* words, auto&& change) {
        LatticeOptions options;
        change(options);
        CHECK(missing(message_of([&] { (void)lattice<double>(options); }), {words}).empty());
    };
    refused("8 by 0 by 8", [](auto& o) { o.particles[1] = 0; });
    refused("spacing is 0", [](auto& o) { o.spacing = 0; });
    refused("stiffness is -1", [](auto& o) { o.stiffness = -1; });
    refused("diagonal is nan", [](auto& o) { o.diagonal = std::nan(""); });
    refused("mass is 0", [](auto& o) { o.mass = 0; });
}

}  // namespace taut_test::lattice_test
