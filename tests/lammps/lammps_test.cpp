// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <taut/integrator/velocity_verlet.hpp>
#include <taut/lammps/lammps.hpp>
#include <taut/model/buckling.hpp>
#include <taut/model/tension_only.hpp>
#include <taut/scene/cloth.hpp>
#include <vector>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"
#include "lammps_files.hpp"

namespace taut_test::lammps_test {

TEMPLATE_TEST_CASE("lammps: the files hold the scene to the bit, and its motion", "[io]",
                   (Case<float, 1>), (Case<float, 3>), (Case<double, 1>), (Case<double, 2>),
                   (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    // With masses by type and by particle; drag, gravity, and pins that move.
    for (const bool many_masses : {false, true}) {
        for (unsigned seed = 1; seed <= 5; ++seed) {
            const Files files("motion_" + std::to_string(sizeof(Scalar)) + std::to_string(Dim));
            Random random(seed);
            auto system = random_system<Scalar, Dim>(random);
            if (many_masses) add_masses(system);
            if (seed % 2 == 0) system.set_rayleigh({0.3, 0});
            if (seed == 3) system.set_gravity(Eigen::Matrix<Scalar, Dim, 1>::Zero());
            auto state = random_state(random, system);
            const auto report = write_lammps("", system, state, files.options());
            REQUIRE(report);
            CHECK(report.warnings.empty());
            CHECK(report.mass_per_atom == many_masses);
            Network network = read(files);
            CHECK(network.atom_types == static_cast<std::size_t>(report.atom_types));
            CHECK(network.bond_types == static_cast<std::size_t>(report.bond_types));
            REQUIRE(network.x.size() == static_cast<std::size_t>(system.size()));
            CHECK(difference(network, state) == 0);
            for (Index i = 0; i < system.size(); ++i) {
                const auto at = static_cast<std::size_t>(i);
                CHECK(network.mass[at] == static_cast<double>(system.mass(i)));
                CHECK(network.pinned[at] == system.is_pinned(i));
                CHECK((network.low.array() < network.x[at].array()).all());
                CHECK((network.high.array() > network.x[at].array()).all());
            }
            REQUIRE(network.bonds.size() == static_cast<std::size_t>(system.spring_count()));
            std::size_t s = 0;
            system.visit_springs([&](const auto& spring) {
                const auto& bond = network.bonds[s++];
                CHECK(2 * bond.K == static_cast<double>(spring.parameters.stiffness));
                CHECK(bond.L == static_cast<double>(spring.rest_length));
                CHECK(bond.a == static_cast<std::size_t>(spring.a));
                CHECK(bond.b == static_cast<std::size_t>(spring.b));
            });

            const int steps = 20;
            network.run(steps);
            taut::VelocityVerlet stepper(system);
            REQUIRE(stepper.step(state, static_cast<Scalar>(report.step), steps));
            CHECK(difference(network, state) < 100 * Tolerance<Scalar>::accumulated);
        }
    }
}

TEST_CASE("lammps: a file of many blocks is whole", "[io]") {
    const Files files("blocks");
    const auto cloth = taut::hanging_cloth<double>({40, 41});
    Random random(7);
    auto state = cloth.initial_state();
    state.v = random.points<double, 3>(cloth.size(), -1, 1);
    REQUIRE(write_lammps("", cloth, state, files.options()));
    CHECK(files.data.bytes().size() > 3 * 65536);
    const Network network = read(files);
    CHECK(difference(network, state) == 0);
    REQUIRE(network.bonds.size() == static_cast<std::size_t>(cloth.spring_count()));
    std::size_t s = 0, wrong = 0;
    cloth.visit_springs([&](const auto& spring) {
        const auto& bond = network.bonds[s++];
        wrong += bond.a == static_cast<std::size_t>(spring.a) &&
                         bond.b == static_cast<std::size_t>(spring.b) &&
                         bond.L == spring.rest_length
                     ? 0
                     : 1;
    });
    CHECK(wrong == 0);
}

TEST_CASE("lammps: the step is the stated share of the certified any-pose limit", "[io]") {
    const Files files("share");
    const auto cloth = taut::hanging_cloth<double>({6, 5});
    const auto state = cloth.initial_state();
    const double certified = taut::any_pose_limit(cloth).certified;
    LammpsOptions options = files.options();
    for (const double share : {0.3, 0.95, 1.0}) {
        options.share = share;
        const auto report = write_lammps("", cloth, state, options);
        REQUIRE(report);
        CHECK(report.certified == certified);
        CHECK(report.step == share * certified);
        CHECK(read(files).step == report.step);
        CHECK(report.warnings.empty());
    }
    options.step = 1.01 * certified;
    const auto beyond = write_lammps("", cloth, state, options);
    CHECK(read(files).step == options.step);
    REQUIRE(beyond.warnings.size() == 1);
    CHECK_THAT(beyond.warnings[0], ContainsSubstring("not certified"));
    options.step = certified;
    CHECK(write_lammps("", cloth, state, options).warnings.empty());
}

TEST_CASE("lammps: the cutoff is the stretch of the longest spring, now or at rest", "[io]") {
    const Files files("cutoff");
    taut::SpringSystem<double, 3> system;
    system.add_particle({0, 0, 0}, 1);
    system.add_particle({0, 3, 4}, 1);
    for (const double L : {1.0, 7.0}) {
        system.add_spring<taut::Hookean>({0, 1, {10}, L});
        const auto report = write_lammps("", system, system.initial_state(), files.options());
        CHECK(report.cutoff == 2 * std::max(5.0, L));
        CHECK(read(files).cutoff == report.cutoff);
    }
}

TEST_CASE("lammps: springs without rest length, particles without springs, far from the origin",
          "[io]") {
    const Files files("corners");
    taut::SpringSystem<double, 2> system;
    system.add_particle({1e9, 1}, 1);
    LammpsOptions options = files.options();
    CHECK_THAT(message_of([&] { (void)write_lammps("", system, system.initial_state(), options); }),
               ContainsSubstring("certified step is inf") && ContainsSubstring("::step"));
    options.step = 0.1;
    const auto alone = write_lammps("", system, system.initial_state(), options);
    REQUIRE(alone);
    CHECK(alone.warnings.empty());
    const Network one = read(files);
    CHECK(one.bonds.empty());
    CHECK(one.low[0] < 1e9);
    CHECK(one.high[0] > 1e9);
    system.add_particle({1e9 + 1, 1}, 1);
    system.add_spring<taut::Hookean>({0, 1, {10}, 0});
    REQUIRE(write_lammps("", system, system.initial_state(), files.options()));
    const Network two = read(files);
    REQUIRE(two.bonds.size() == 1);
    CHECK(two.bonds[0].L == 0);
}

TEST_CASE("lammps: a tension-only spring is written as a bond of its stiffness", "[io]") {
    const Files files("strings");
    taut::SpringSystem<double, 3, taut::Hookean, taut::TensionOnly> system;
    system.add_particle({0, 0, 0}, 1);
    system.add_particle({1, 0, 0}, 1);
    system.add_particle({0, 1, 0}, 1);
    system.add_spring<taut::TensionOnly>(0, 2, {30});
    system.add_spring(0, 1, 100);
    LammpsOptions options = files.options();
    options.nearest = true;
    REQUIRE(write_lammps("", system, system.initial_state(), options));
    const Network network = read(files);
    REQUIRE(network.bonds.size() == 2);  // in index order: that of the laws
    CHECK(network.bonds[0].K == 50);
    CHECK(network.bonds[1].K == 15);
    CHECK(network.bonds[1].b == 2);
}

}  // namespace taut_test::lammps_test
