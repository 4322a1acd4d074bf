// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What LAMMPS itself makes of the files, on one rank and on two. This file is built only where
// CMake found `lmp` and `mpirun`, whose paths it is given.

#include <Eigen/Geometry>
#include <cmath>
#include <cstdlib>
#include <string>
#include <taut/integrator/velocity_verlet.hpp>
#include <taut/lammps/lammps.hpp>
#include <taut/lammps/lammps_dump.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/lattice/lattice.hpp>
#include <taut/stability/stability.hpp>

#include "../support/catch.hpp"
#include "../support/random_system.hpp"
#include "../support/temporary_file.hpp"
#include "../support/tolerance.hpp"
#include "lammps_files.hpp"

namespace taut_test::with_lammps_test {

using taut::Index;
using taut::LammpsOptions;
using taut::Method;

namespace {

/// The files of one run in the working directory, removed at the end of the test.
class Run {
public:
    explicit Run(const std::string& name)
        : data_(name + ".data"), script_(name + ".in"), dump_(name + ".dump"), log_(name + ".log") {
        options.name = data_.path.substr(0, data_.path.size() - 5);
    }

    /// Writes the scene, for a few frames alone.
    template <class System, class State>
    taut::LammpsReport write(const System& system, const State& state) const {
        auto report = taut::write_lammps("", system, state, options);
        REQUIRE(report);
        return report;
    }
    /// Whether LAMMPS ended well. Two ranks may share a processor, also as root, as they do in
    /// containers of CI.
    bool lammps(int ranks) const {
        std::remove(dump_.path.c_str());
        const std::string as_they_are =
            "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
            "OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_mpi_yield_when_idle=1 "
            "OMP_NUM_THREADS=1 ";
        const std::string command = as_they_are + TAUT_MPIRUN + " -n " + std::to_string(ranks) +
                                    " " + TAUT_LMP + " -log none -in " + script_.path + " > " +
                                    log_.path + " 2>&1";
        const bool well = std::system(command.c_str()) == 0;
        if (!well) UNSCOPED_INFO(log_.bytes());
        return well;
    }
    const std::string& dump() const { return dump_.path; }
    std::string log() const { return log_.bytes(); }

    LammpsOptions options;

private:
    TemporaryFile data_, script_, dump_, log_;
};

/// The state of the last frame.
template <class State>
State last_frame(const Run& run, Index particles, Index frames) {
    taut::LammpsDump<typename State::Scalar, State::Dim> dump(run.dump(), particles);
    State state;
    auto report = dump.read(state);
    while (report) report = dump.read(state);
    INFO(report.message());
    REQUIRE(report.status == taut::DumpStatus::end);
    REQUIRE(dump.frames() == frames);
    return state;
}

/// LAMMPS on one rank and on two, and Taut, from the same state at the same step.
template <class System>
void compare(Run& run, const System& system, const typename System::State& start, Index steps,
             double tolerance) {
    run.options.steps = run.options.every = steps;
    const auto report = run.write(system, start);
    auto state = start;
    state.time = 0;
    taut::VelocityVerlet stepper(system);
    REQUIRE(stepper.step(state, static_cast<typename System::Scalar>(report.step), steps));
    const double size = largest((start.x.colwise() - start.x.col(0)).eval());
    REQUIRE(distance(state.x, start.x) > 1e-3 * size);  // it moves
    for (const int ranks : {1, 2}) {
        CAPTURE(ranks);
        REQUIRE(run.lammps(ranks));
        const auto theirs = last_frame<typename System::State>(run, system.size(), 2);
        CHECK(distance(theirs.x, state.x) <= tolerance * size);
        CHECK(distance(theirs.v, state.v) <= 1e3 * tolerance * largest(state.v));
        CHECK_THAT(theirs.time, WithinRel(state.time, 1e-12));
    }
}

}  // namespace

// Where the last digits go depends on the order in which forces are added: 4e-15 and 6e-15 of a
// metre were measured after these 1000 steps.
TEST_CASE("with_lammps: the hanging cloth moves as by velocity Verlet, on one rank and two",
          "[io][slow]") {
    Run run("cloth");
    run.options.share = 0.95;
    const auto cloth = taut::hanging_cloth<double>({64, 64});
    compare(run, cloth, cloth.initial_state(), 1000, 1e-12);
}

TEST_CASE("with_lammps: so does a free lattice that turns and vibrates", "[io][slow]") {
    Run run("lattice");
    run.options.share = 0.95;
    const auto lattice = taut::lattice<double>({{20, 20, 20}});
    auto state = lattice.initial_state();
    Random random(1);
    const Eigen::Vector3d spin(0.1, 0.5, -0.2);
    for (Index i = 0; i < lattice.size(); ++i) {
        state.v.col(i) = spin.cross(state.x.col(i)) + random.vector<double, 3>(-0.1, 0.1);
    }
    compare(run, lattice, state, 1000, 1e-12);
}

TEMPLATE_TEST_CASE("with_lammps: pins that move, drag, gravity, masses by type and by particle",
                   "[io][slow]", (Case<double, 1>), (Case<double, 2>), (Case<double, 3>)) {
    constexpr int Dim = TestType::Dim;
    Random random(static_cast<std::uint32_t>(Dim));
    RandomOptions what;
    what.particles = 40;
    what.springs = 120;
    auto system = random_system<double, Dim>(random, what);
    system.set_rayleigh({0.3, 0});
    for (const bool many_masses : {false, true}) {
        if (many_masses) add_masses(system);
        auto state = random_state(random, system);
        state.x *= 20;  // so far apart that no two come so near that forces turn round at once
        Run run("net_" + std::to_string(Dim));
        compare(run, system, state, 200, 1e-9);
    }
}

TEST_CASE("with_lammps: a bond may be as long as the whole scene", "[io][slow]") {
    Run run("long_bond");
    taut::SpringSystem<double, 3> system;
    system.add_particle({0, 0, 0}, 1);
    system.add_particle({10, 0, 0}, 2);
    system.add_spring<taut::Hookean>({0, 1, {10}, 9});
    auto state = system.initial_state();
    state.v.col(1) << 0, 1, 2;
    compare(run, system, state, 100, 1e-12);
}

TEST_CASE("with_lammps: bounded below the certified step, growing above the refuted one",
          "[io][slow]") {
    // The same for 20 × 20 × 20 particles takes minutes: bench/lammps_table.cpp. One rank takes the
    // long run, since two that share a processor wait for each other in every step.
    Run run("limit");
    run.options.velocities = false;
    const auto lattice = taut::lattice<double>({{6, 6, 6}});
    const auto rest = lattice.initial_state();
    const taut::Stability<double> stability(lattice, rest);
    const auto limit = stability.max_step(Method::velocity_verlet);
    const auto mode = stability.limiting_mode();
    const double kick = 1e-6 * 0.5;  // of the lattice's size
    auto state = rest;
    Eigen::Map<Eigen::VectorXd>(state.x.data(), state.x.size()) +=
        kick / mode.shape.cwiseAbs().maxCoeff() * mode.shape;

    const auto largest_motion = [&](Index frames) {
        taut::LammpsDump<double, 3> dump(run.dump(), lattice.size());
        double most = 0;
        auto frame = rest;
        while (auto report = dump.read(frame)) most = std::max(most, distance(frame.x, rest.x));
        REQUIRE(dump.frames() == frames);
        return most;
    };
    run.options.step = 0.99 * limit.certified;
    run.options.steps = 100000;
    run.options.every = 1009;  // odd: a mode at the limit changes its sign with every step
    (void)run.write(lattice, state);
    REQUIRE(run.lammps(1));
    // Energy of the step's own kind is kept: a displacement grows by 1/√(1 − (h/h₂)²) at most.
    CHECK(largest_motion(100) < 10 * kick);

    run.options.step = 1.02 * limit.refuted;
    run.options.steps = run.options.every = 20;
    CHECK(run.write(lattice, state).warnings.size() == 1);  // not certified
    REQUIRE(run.lammps(2));
    const auto mu = taut::multipliers(Method::velocity_verlet, mode.k, mode.d, run.options.step);
    const double growth = std::pow(std::max(std::abs(mu[0]), std::abs(mu[1])), 20);
    CHECK(growth > 1000);
    const double grown = largest_motion(2);
    CHECK(grown > growth / 4 * kick);
    CHECK(grown < 2 * growth * kick);
}

}  // namespace taut_test::with_lammps_test
