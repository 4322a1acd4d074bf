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
#include <taut/wind/wind.hpp>
#include <vector>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"
#include "lammps_files.hpp"

namespace taut_test::lammps_refusal_test {

TEST_CASE("lammps: bad input: what LAMMPS lacks is refused by name, or left out with a warning",
          "[io][bad_input]") {
    using System = taut::SpringSystem<double, 3, taut::Hookean, taut::TensionOnly, taut::Buckling>;
    const Files files("nearest");
    System plain;
    plain.add_particle({0, 0, 0}, 1);
    plain.add_particle({1, 0, 0}, 1);
    plain.add_particle({0, 1, 0}, 1);
    plain.add_spring(0, 1, 100);
    const auto refused = [&](const char* words, auto&& change, const char* nearest) {
        CAPTURE(words);
        System system = plain;
        change(system);
        const auto state = system.initial_state();
        LammpsOptions options = files.options();
        const auto write = [&] { return write_lammps("", system, state, options); };
        CHECK(missing(message_of([&] { (void)write(); }), {words, "write_lammps"}).empty());
        CHECK(files.script.bytes().empty());  // nothing is written before all is checked
        if (nearest == nullptr) return;
        options.nearest = true;
        const auto report = write();
        REQUIRE(report.warnings.size() == 1);
        CHECK(missing(report.warnings[0], {words, nearest}).empty());
        // What is left out does not lower the limit.
        CHECK(report.certified <= taut::any_pose_limit(plain).certified);
        std::remove(files.script.path.c_str());
    };
    const auto out = "left out";
    refused(
        "set_rayleigh",
        [](System& s) {
            s.set_rayleigh({0, 1e-4});
        },
        out);
    refused(
        "set_wind",
        [](System& s) {
            taut::Wind<double> wind;
            wind.triangles = {{0, 1, 2}};
            wind.density = 1;
            wind.drag = 1;
            taut::set_wind(s, wind);
        },
        out);
    refused(
        "set_external_force", [](System& s) { s.set_external_force([](const auto&, auto&) {}); },
        out);
    refused(
        "set_constant_force",
        [](System& s) {
            s.set_constant_force(1, {0, 0, 1});
        },
        out);
    refused(
        "spring 1 has a damper of 0.5", [](System& s) { s.add_spring(0, 2, 10, 0.5); }, out);
    refused(
        "spring 1, are TensionOnly", [](System& s) { s.add_spring<taut::TensionOnly>(0, 2, {10}); },
        "harmonic bond");
    refused(
        "spring 1 is neither Hookean",
        [](System& s) {
            s.add_spring<taut::Buckling>(0, 2, {1, 1, 1});
        },
        nullptr);
}

TEST_CASE("lammps: bad input: springs that are no bond are named", "[io][bad_input]") {
    const Files files("bonds");
    taut::SpringSystem<double, 3> system;
    for (const double x : {0.0, 1.0, 2.5, 4.7}) system.add_particle({x, 0, 0}, 1);
    for (Index i = 0; i < 3; ++i) system.add_spring(i, i + 1, 100);
    const auto refusal = [&](const auto& state, const LammpsOptions& options) {
        return message_of([&] { (void)write_lammps("", system, state, options); });
    };
    auto state = system.initial_state();
    state.x.col(2) = state.x.col(1);
    CHECK(missing(refusal(state, files.options()), {"spring 1 is 0 m", "particle 1 to 2"}).empty());
    state = system.initial_state();
    state.x(0, 0) = -1.5e308;
    state.x(0, 1) = 1.5e308;
    CHECK(missing(refusal(state, files.options()), {"spring 0 is inf m"}).empty());
    state.x(0, 0) = 0;
    state.x(0, 1) = 1e308;
    CHECK(missing(refusal(state, files.options()), {"twice the longest spring", "inf m"}).empty());
    // Each spring has a length of its own: so many types are memory, and refused beyond a number.
    CHECK(write_lammps("", system, system.initial_state(), files.options()).bond_types == 3);
    for (Index s = 3; s <= 1 << 20; ++s) system.add_spring(0, 1, 1000.0 + static_cast<double>(s));
    CHECK(missing(refusal(system.initial_state(), files.options()),
                  {"spring 1048576", "bond type 1048577", "at most 1048576"})
              .empty());
}

TEST_CASE("lammps: bad input: options are named", "[io][bad_input]") {
    const Files files("options");
    const auto cloth = taut::hanging_cloth<double>({3, 3});
    const auto refused = [&](const char* words, auto&& change) {
        LammpsOptions options = files.options();
        change(options);
        CHECK(missing(message_of(
                          [&] { (void)write_lammps("", cloth, cloth.initial_state(), options); }),
                      {words})
                  .empty());
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
    auto state = cloth.initial_state();
    state.x.resize(3, 4);
    CHECK(missing(message_of([&] { (void)write_lammps("", cloth, state); }), {"4 positions"})
              .empty());
    const taut::SpringSystem<double, 3> empty;
    CHECK(missing(message_of([&] { (void)write_lammps("", empty, empty.initial_state()); }),
                  {"no particles"})
              .empty());
}

TEST_CASE("lammps: bad input: files that cannot be written, and states that are not finite",
          "[io][bad_input]") {
    const Files files("folder");
    const auto cloth = taut::hanging_cloth<double>({3, 3});
    auto state = cloth.initial_state();
    const auto nowhere = write_lammps("no/such/folder", cloth, state);
    CHECK_FALSE(nowhere);
    CHECK(nowhere.file.status == taut::FileStatus::not_opened);
    CHECK(nowhere.file.path == "no/such/folder/taut.data");
    CHECK(write_lammps("no/such/folder/", cloth, state).file.path == nowhere.file.path);
#if defined(__linux__)
    // A disk that is full: the data file is a link to it.
    const TemporaryFile full("full.data");
    if (std::system(("ln -s /dev/full " + full.path).c_str()) == 0) {
        LammpsOptions options;
        options.name = full.path.substr(0, full.path.size() - 5);
        const auto report = write_lammps(".", cloth, state, options);
        CHECK(report.file.status == taut::FileStatus::not_written);
        CHECK(report.file.path == "./" + full.path);
    }
#endif
    state.v(1, 4) = std::nan("");
    const auto report = write_lammps("", cloth, state, files.options());
    CHECK(report.file.status == taut::FileStatus::not_finite);
    CHECK(report.file.where == 4);
    CHECK(files.data.bytes().empty());
}

}  // namespace taut_test::lammps_refusal_test
