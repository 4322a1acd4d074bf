// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdlib>
#include <string>
#include <taut/network/tension_only.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "lammps_files.hpp"

namespace taut_test::lammps_test {

namespace {

Eigen::VectorXd at(double x, double y, double z) { return Eigen::Vector3d(x, y, z); }

void check_bonds(const Network& network, const Scene& scene) {
    const auto springs = scene.springs();
    REQUIRE(network.bonds.size() == springs.size());
    std::size_t wrong = 0;
    for (std::size_t s = 0; s < springs.size(); ++s) {
        const auto& bond = network.bonds[s];
        const bool same = 2 * bond.K == springs[s].stiffness && bond.L == springs[s].rest_length &&
                          bond.a == springs[s].a && bond.b == springs[s].b;
        wrong += same ? 0 : 1;
    }
    CHECK(wrong == 0);
}

/// Expects write_lammps to refuse in these words, writing nothing.
void refuse(const Files& files, const Scene& scene, const AnyState& state,
            const LammpsOptions& options, std::initializer_list<const char*> words) {
    const auto message = message_of([&] { (void)write_lammps("", scene, state, options); });
    CHECK(missing(message, words).empty());
    CHECK(missing(message, {"write_lammps"}).empty());
    CHECK(files.data.bytes() + files.script.bytes() == "");
}

}  // namespace

TEST_CASE("lammps: the files hold the scene to the bit, and its motion", "[io]") {
    // With masses by type and by particle; drag, gravity, and pins that move.
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        for (unsigned seed = 1; seed <= 10; ++seed) {
            CAPTURE(kind, seed);
            const bool many_masses = seed > 5;
            const Files files("motion");
            Random random(seed);
            Scene scene = random_scene(random, kind);
            if (many_masses) add_masses(scene);
            // So many that only free and pinned ones together are too many types.
            for (Index i = seed > 8 ? 8 : scene.size(); i < scene.size(); i += 2) scene.pin(i);
            if (seed % 2 == 0) scene.set_rayleigh(0.3, 0);
            if (seed % 5 == 3) scene.set_gravity(Eigen::VectorXd::Zero(kind.dim));
            auto state = random_state(random, scene);
            const auto report = write_lammps("", scene, state, files.options());
            REQUIRE(report);
            CHECK(report.warnings.empty());
            CHECK(report.mass_per_atom == many_masses);
            Network network = read(files);
            CHECK(network.atom_types == report.atom_types);
            CHECK(network.bond_types == report.bond_types);
            REQUIRE(network.x.cols() == scene.size());
            CHECK(network.difference(state) == 0);
            for (Index i = 0; i < scene.size(); ++i) {
                REQUIRE(network.mass[i] == scene.mass(i));
                REQUIRE(network.pinned[static_cast<std::size_t>(i)] == scene.is_pinned(i));
            }
            CHECK(((network.x.colwise() - network.low).array() > 0).all());
            CHECK(((network.x.colwise() - network.high).array() < 0).all());
            check_bonds(network, scene);

            const int steps = 20;
            network.run(steps);
            const auto stepper = scene.stepper(taut::Method::velocity_verlet);
            REQUIRE(stepper->step(state, report.step, steps));
            CHECK(network.difference(state) < 100 * kind.accumulated());
        }
    }
}

TEST_CASE("lammps: a file of many blocks is whole", "[io]") {
    const Files files("blocks");
    const Scene cloth = cloth_scene(40, 41);
    Random random(7);
    auto state = cloth.initial_state();
    state.v = random_points(random, 3, cloth.size(), -1, 1);
    REQUIRE(write_lammps("", cloth, state, files.options()));
    CHECK(files.data.bytes().size() > 3 * 65536);
    const Network network = read(files);
    CHECK(network.difference(state) == 0);
    check_bonds(network, cloth);
}

TEST_CASE("lammps: the step is the stated share of the certified any-pose limit", "[io]") {
    const Files files("share");
    const Scene cloth = cloth_scene(6, 5);
    const auto state = cloth.initial_state();
    const double certified = cloth.any_pose_limit().certified;
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
    Scene scene(Kind{});
    scene.add_particle(at(0, 0, 0), 1);
    scene.add_particle(at(0, 3, 4), 1);
    for (const double L : {1.0, 7.0}) {
        scene.add_spring({0, 1, 10, L});
        const auto report = write_lammps("", scene, scene.initial_state(), files.options());
        CHECK(report.cutoff == 2 * std::max(5.0, L));
        CHECK(read(files).cutoff == report.cutoff);
    }
}

TEST_CASE("lammps: springs without rest length, particles without springs, far from the origin",
          "[io]") {
    const Files files("corners");
    Scene scene({false, 2});
    scene.add_particle(Eigen::Vector2d(1e9, 1), 1);
    LammpsOptions options = files.options();
    refuse(files, scene, scene.initial_state(), options, {"certified step is inf", "::step"});
    options.step = 0.1;
    const auto alone = write_lammps("", scene, scene.initial_state(), options);
    REQUIRE(alone);
    CHECK(alone.warnings.empty());
    const Network one = read(files);
    CHECK(one.bonds.empty());
    CHECK(one.low[0] < 1e9);
    CHECK(one.high[0] > 1e9);
    scene.add_particle(Eigen::Vector2d(1e9 + 1, 1), 1);
    scene.add_spring({0, 1, 10, 0});
    REQUIRE(write_lammps("", scene, scene.initial_state(), files.options()));
    check_bonds(read(files), scene);
}

TEST_CASE("lammps: bad input: what LAMMPS lacks is refused by name, or left out with a warning",
          "[io][bad_input]") {
    const Files files("nearest");
    Scene plain({false, 3, Laws::any});
    plain.add_particle(at(0, 0, 0), 1);
    plain.add_particle(at(1, 0, 0), 1);
    plain.add_particle(at(0, 1, 0), 1);
    plain.add_spring({0, 1, 100, 1});
    LammpsOptions nearest = files.options();
    nearest.nearest = true;
    const auto refused = [&](const char* words, auto&& change, const char* instead) {
        CAPTURE(words);
        Scene scene = plain;
        change(scene);
        const auto state = scene.initial_state();
        refuse(files, scene, state, files.options(), {words});
        if (instead == nullptr) {
            refuse(files, scene, state, nearest, {words});
            return;
        }
        const auto report = write_lammps("", scene, state, nearest);
        REQUIRE(report.warnings.size() == 1);
        CHECK(missing(report.warnings[0], {words, instead}).empty());
        // What is left out does not lower the limit.
        CHECK(report.certified <= plain.any_pose_limit().certified);
        const Network network = read(files);
        REQUIRE(static_cast<Index>(network.bonds.size()) == scene.spring_count());
        CHECK(network.bonds[0].K == 50);
        if (network.bonds.size() == 2) {  // in index order: that of the laws
            CHECK(network.bonds[1].K == 5);
            CHECK(network.bonds[1].b == 2);
        }
        std::remove(files.data.path.c_str());
        std::remove(files.script.path.c_str());
    };
    const auto out = "left out";
    const auto spring = [](LawOf law, double damping = 0) {
        return [law, damping](Scene& s) { s.add_spring({0, 2, 10, 1, damping, law, 1, 1}); };
    };
    refused(
        "set_rayleigh", [](Scene& s) { s.set_rayleigh(0, 1e-4); }, out);
    refused("set_wind", blow, out);
    refused(
        "set_external_force", [](Scene& s) { s.set_external_force([](auto&, auto&) {}); }, out);
    refused(
        "set_constant_force", [](Scene& s) { s.set_constant_force(1, at(0, 0, 1)); }, out);
    refused("spring 1 has a damper of 0.5", spring(LawOf::hookean, 0.5), out);
    refused("spring 1, are TensionOnly", spring(LawOf::tension_only), "harmonic bond");
    refused("spring 1 is neither Hookean", spring(LawOf::buckling), nullptr);
    refused("spring 1 is neither Hookean", spring(LawOf::glue), nullptr);
}

TEST_CASE("lammps: bad input: springs that are no bond are named", "[io][bad_input]") {
    const Files files("bonds");
    Scene scene(Kind{});
    for (const double x : {0.0, 1.0, 2.5, 4.7}) scene.add_particle(at(x, 0, 0), 1);
    for (Index i = 0; i < 3; ++i) scene.add_spring({i, i + 1, 100, 1.0 + static_cast<double>(i)});
    const auto refused = [&](const AnyState& state, std::initializer_list<const char*> words) {
        refuse(files, scene, state, files.options(), words);
    };
    auto state = scene.initial_state();
    state.x.col(2) = state.x.col(1);
    refused(state, {"spring 1 is 0 m", "particle 1 to 2"});
    state = scene.initial_state();
    state.x(0, 0) = -1.5e308;
    state.x(0, 1) = 1.5e308;
    refused(state, {"spring 0 is inf m"});
    state.x(0, 0) = 0;
    state.x(0, 1) = 1e308;
    refused(state, {"twice the longest spring", "inf m"});
    // Each spring has a length of its own: so many types are memory, and refused beyond a number.
    for (Index s = 3; s <= 1 << 20; ++s) scene.add_spring({0, 1, 1000.0 + double(s), 1});
    refused(scene.initial_state(), {"spring 1048576", "bond type 1048577", "at most 1048576"});
}

TEST_CASE("lammps: bad input: options and states are named", "[io][bad_input]") {
    const Files files("options");
    const Scene cloth = cloth_scene(3, 3);
    auto state = cloth.initial_state();
    const auto refused = [&](const char* words, auto&& change) {
        LammpsOptions options = files.options();
        change(options);
        refuse(files, cloth, state, options, {words});
    };
    const double nan = std::nan("");
    refused("share is 0", [](auto& o) { o.share = 0; });
    refused("share is 1.5", [](auto& o) { o.share = 1.5; });
    refused("share is nan", [&](auto& o) { o.share = nan; });
    refused("step is -1", [](auto& o) { o.step = -1; });
    refused("step is nan", [&](auto& o) { o.step = nan; });
    refused("steps is 0", [](auto& o) { o.steps = 0; });
    refused("every is 0", [](auto& o) { o.every = 0; });
    refused("name is \"\"", [](auto& o) { o.name = ""; });
    refused("name is \"a b\"", [](auto& o) { o.name = "a b"; });
    refused("name is \"../a\"", [](auto& o) { o.name = "../a"; });
    state.x.resize(3, 4);
    refused("4 positions", [](auto&) {});
    const Scene empty(Kind{});
    refuse(files, empty, empty.initial_state(), files.options(), {"no particles"});
}

TEST_CASE("lammps: bad input: files that cannot be written, and states that are not finite",
          "[io][bad_input]") {
    const Files files("folder");
    const Scene cloth = cloth_scene(3, 3);
    auto state = cloth.initial_state();
    const auto nowhere = write_lammps("no/such/folder", cloth, state);
    CHECK_FALSE(nowhere);
    CHECK(nowhere.file.status == taut::FileStatus::not_opened);
    CHECK(nowhere.file.path == "no/such/folder/taut.data");
    CHECK(write_lammps("no/such/folder/", cloth, state).file.path == nowhere.file.path);
#if defined(__linux__)
    // A disk that is full: the data file is a link to it.
    const Files full("full");
    if (std::system(("ln -s /dev/full " + full.data.path).c_str()) == 0) {
        const auto report = write_lammps(".", cloth, state, full.options());
        CHECK(report.file.status == taut::FileStatus::not_written);
        CHECK(report.file.path == "./" + full.data.path);
    }
#endif
    state.v(1, 4) = std::nan("");
    const auto report = write_lammps("", cloth, state, files.options());
    CHECK(report.file.status == taut::FileStatus::not_finite);
    CHECK(report.file.where == 4);
    CHECK(files.data.bytes().empty());
}

}  // namespace taut_test::lammps_test
