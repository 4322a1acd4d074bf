// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What LAMMPS itself makes of the files, on one rank and on two. This file is built only where
// CMake found `lmp` and `mpirun`, whose paths it is given.

#include <Eigen/Geometry>
#include <cmath>
#include <cstdlib>
#include <string>

#include "../support/catch.hpp"
#include "../support/tolerance.hpp"
#include "lammps_files.hpp"

namespace taut_test::with_lammps_test {

using taut::Method;

namespace {

/// The files of one run in the working directory, removed at the end of the test.
class Run : public Files {
public:
    explicit Run(const std::string& name)
        : Files(name), options(Files::options()), dump_(name + ".dump"), log_(name + ".log") {}

    taut::LammpsReport write(const Scene& scene, const AnyState& state) const {
        auto report = write_lammps("", scene, state, options);
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
                                    " " + TAUT_LMP + " -log none -in " + script.path + " > " +
                                    log_.path + " 2>&1";
        const bool well = std::system(command.c_str()) == 0;
        if (!well) UNSCOPED_INFO(log_.bytes());
        return well;
    }
    const std::string& dump() const { return dump_.path; }

    LammpsOptions options;

private:
    TemporaryFile dump_, log_;
};

/// LAMMPS on one rank and on two, and Taut, from the same state at the same step.
void compare(Run& run, const Scene& scene, const AnyState& start, Index steps, double tolerance) {
    run.options.steps = run.options.every = steps;
    const auto report = run.write(scene, start);
    auto state = start;
    state.time = 0;
    REQUIRE(scene.stepper(Method::velocity_verlet)->step(state, report.step, steps));
    const double size = largest((start.x.colwise() - start.x.col(0)).eval());
    REQUIRE(distance(state.x, start.x) > 1e-3 * size);  // it moves
    for (const int ranks : {1, 2}) {
        CAPTURE(ranks);
        REQUIRE(run.lammps(ranks));
        const auto dump = open_dump(scene.kind(), run.dump(), scene.size());
        AnyState theirs;
        while (dump->read(theirs)) continue;
        const auto end = dump->read(theirs);
        INFO(end.message());
        REQUIRE(end.status == taut::DumpStatus::end);
        REQUIRE(dump->frames() == 2);
        CHECK(distance(theirs.x, state.x) <= tolerance * size);
        CHECK(distance(theirs.v, state.v) <= 1e3 * tolerance * largest(state.v));
        CHECK_THAT(theirs.time, WithinRel(state.time, 1e-12));
    }
}

}  // namespace

// Where the last digits go depends on the order in which forces are added: 4e-15 and 6e-15 of a
// metre were measured after these 1000 steps.
TEST_CASE("with_lammps: the hanging cloth moves as by velocity Verlet, on one rank and two",
          "[io][deep]") {
    Run run("cloth");
    run.options.share = 0.95;
    const Scene cloth = cloth_scene(64, 64);
    compare(run, cloth, cloth.initial_state(), 1000, 1e-12);
}

TEST_CASE("with_lammps: so does a free lattice that turns and vibrates", "[io][deep]") {
    Run run("lattice");
    run.options.share = 0.95;
    const Scene lattice = lattice_scene({20, 20, 20});
    auto state = lattice.initial_state();
    Random random(1);
    const Eigen::Vector3d spin(0.1, 0.5, -0.2);
    for (Index i = 0; i < lattice.size(); ++i) {
        const Eigen::Vector3d x = state.x.col(i);
        state.v.col(i) = spin.cross(x) + random_vector(random, 3, -0.1, 0.1);
    }
    compare(run, lattice, state, 1000, 1e-12);
}

TEST_CASE("with_lammps: pins that move, drag, gravity, masses by type and by particle",
          "[io][deep]") {
    for (const int dim : {1, 2, 3}) {
        CAPTURE(dim);  // and the seed
        Random random(static_cast<std::uint32_t>(dim));
        RandomOptions what;
        what.particles = 40;
        what.springs = 120;
        Scene scene = random_scene(random, {false, dim}, what);
        scene.set_rayleigh(0.3, 0);
        for (const bool many_masses : {false, true}) {
            if (many_masses) add_masses(scene);
            auto state = random_state(random, scene);
            state.x *= 20;  // so far apart that no two come so near that forces turn round at once
            Run run("net");
            compare(run, scene, state, 200, 1e-9);
        }
    }
}

TEST_CASE("with_lammps: a bond may be as long as the whole scene", "[io][deep]") {
    Run run("long_bond");
    Scene scene(Kind{});
    scene.add_particle(Eigen::Vector3d(0, 0, 0), 1);
    scene.add_particle(Eigen::Vector3d(10, 0, 0), 2);
    scene.add_spring({0, 1, 10, 9});
    auto state = scene.initial_state();
    state.v.col(1) << 0, 1, 2;
    compare(run, scene, state, 100, 1e-12);
}

TEST_CASE("with_lammps: bounded below the certified step, growing above the refuted one",
          "[io][deep]") {
    // The same for 20 × 20 × 20 particles takes minutes: bench/lammps_table.cpp. One rank takes the
    // long run, since two that share a processor wait for each other in every step.
    Run run("limit");
    run.options.velocities = false;
    const Scene lattice = lattice_scene({6, 6, 6});
    const auto rest = lattice.initial_state();
    const auto limit = lattice.limit(Method::velocity_verlet, rest);
    const auto mode = limiting_mode(lattice, rest);
    const double kick = 1e-6 * 0.5;  // of the lattice's size
    auto state = rest;
    Eigen::Map<Eigen::VectorXd>(state.x.data(), state.x.size()) +=
        kick / mode.shape.cwiseAbs().maxCoeff() * mode.shape;

    const auto largest_motion = [&](Index frames) {
        const auto dump = open_dump({}, run.dump(), lattice.size());
        double most = 0;
        auto frame = rest;
        while (dump->read(frame)) most = std::max(most, distance(frame.x, rest.x));
        REQUIRE(dump->frames() == frames);
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
