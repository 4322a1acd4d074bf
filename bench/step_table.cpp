// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What a symplectic step costs beside the plain loop over springs and Boost.odeint, and what
// becomes of the scene, beside XPBD. Prints Markdown; a mesh in OBJ form may be named on the
// command line.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <malloc.h>
#include <string>
#include <taut/taut.hpp>
#include <taut/wind/wind.hpp>
#include <tuple>
#include <utility>
#include <vector>

#include "measure.hpp"
#include "mesh_in.hpp"
#include "odeint.hpp"
#include "outcome.hpp"
#include "plain_loop.hpp"
#include "sleeve.hpp"
#include "xpbd.hpp"

namespace {

using taut::Index;
template <class Scalar>
using Net = taut::SpringSystem<Scalar, 3>;

constexpr int steps = 100;  // of a turn

void print(const std::string& label, const bench::Turns& turns) {
    std::printf("| %s | %s |\n", label.c_str(), turns.cells().c_str());
    std::fflush(stdout);
}

template <class Scalar>
void compare(const std::string& label, const Net<Scalar>& net, int turns) {
    const Scalar h = Scalar(0.9) * taut::any_pose_limit(net).certified;
    bench::PlainLoop<Scalar> plain(net);
    taut::SymplecticEuler<Net<Scalar>> stepper(net);
    auto state = net.initial_state();
    bench::Turns both(steps);
    both.run(
        turns,
        [&] {
            for (int i = 0; i < steps; ++i) plain.step(h);
        },
        [&] {
            if (!stepper.step(state, h, steps)) std::printf("%s: diverged\n", label.c_str());
        });
    print(label, both);
}

/// Another step of h beside the plain symplectic one.
template <class Scalar, class Stepper>
void compare_steppers(const std::string& label, const Net<Scalar>& net, Scalar h, Stepper stepper) {
    taut::SymplecticEuler plain(net);
    auto state = net.initial_state();
    auto state_of_plain = state;
    bench::Turns both(steps);
    both.run(
        21, [&] { std::ignore = plain.step(state_of_plain, h, steps); },
        [&] { std::ignore = stepper.step(state, h, steps); });
    print(label, both);
}

/// A damped step beside the undamped one: α = 0.4 h on K⁺.
template <class Scalar>
void compare_damping(const std::string& label, const Net<Scalar>& net) {
    const Scalar h = Scalar(0.5) * taut::any_pose_limit(net).certified;
    auto rayleigh = net;
    rayleigh.set_rayleigh({0, 0.4 * static_cast<double>(h)});
    compare_steppers(label, net, h, taut::SymplecticEuler<Net<Scalar>>(rayleigh));
}

/// What else is asked of a step, beside the step without.
template <class Scalar>
void compare_kinds(const std::string& label, const Net<Scalar>& net,
                   std::vector<taut::Triangle> triangles) {
    const Scalar h = Scalar(0.5) * taut::any_pose_limit(net).certified;
    compare_steppers(label + ", velocity Verlet", net, h, taut::VelocityVerlet(net));
    const auto with = [&](const char* force, const auto& set) {
        auto copy = net;
        set(copy);
        compare_steppers(label + ", " + force, net, h, taut::SymplecticEuler(copy));
    };
    taut::Wind<Scalar> wind;
    wind.velocity = {1, 2, 3};
    wind.triangles = std::move(triangles);
    with("wind on every triangle", [&](auto& copy) { taut::set_wind(copy, wind); });
    with("a force of the whole state", [](auto& copy) {
        copy.set_external_force([](const auto& state, auto& f) { f -= Scalar(1e-6) * state.v; });
    });
}

/// Two threads beside one.
void compare_threads(const std::string& label, const Net<double>& net, int turns) {
    const double h = 0.9 * taut::any_pose_limit(net).certified;
    taut::SymplecticEuler<Net<double>> one(net);
    taut::SymplecticEuler<Net<double>> two(net, {2});
    auto state_of_one = net.initial_state();
    auto state_of_two = state_of_one;
    bench::Turns both(steps, bench::wall);
    both.run(
        turns, [&] { std::ignore = one.step(state_of_one, h, steps); },
        [&] { std::ignore = two.step(state_of_two, h, steps); });
    print(label, both);
    if (state_of_one.x != state_of_two.x) std::printf("the bits differ\n");
}

void compare_odeint(const std::string& label, const Net<double>& net) {
    const double h = 0.9 * taut::any_pose_limit(net).certified;
    bench::OdeintSymplectic peer(net);
    taut::SymplecticEuler stepper(net);
    auto state = net.initial_state();
    bench::Turns both(steps);
    both.run(
        7, [&] { peer.step(h, steps); }, [&] { std::ignore = stepper.step(state, h, steps); });
    print(label, both);
}

/// A lattice of n³ particles in the shape of a cube, its springs to the 13 nearest, nothing pinned.
Net<double> lattice(Index n) {
    Net<double> net;
    for (Index i = 0; i < n * n * n; ++i) {
        net.add_particle(Eigen::Vector3d(static_cast<double>(i % n), static_cast<double>(i / n % n),
                                         static_cast<double>(i / n / n)) /
                             static_cast<double>(n),
                         0.3 / static_cast<double>(n * n * n));
    }
    for (Index z = 0; z < 2; ++z) {
        for (Index y = z > 0 ? -1 : 0; y < 2; ++y) {
            for (Index x = z > 0 || y > 0 ? -1 : 1; x < 2; ++x) {
                for (Index i = 0; i < n * n * n; ++i) {
                    const Index u = i % n + x;
                    const Index v = i / n % n + y;
                    const Index w = i / n / n + z;
                    if (u < 0 || u >= n || v < 0 || v >= n || w >= n) continue;
                    net.add_spring(i, (w * n + v) * n + u, 1000);
                }
            }
        }
    }
    net.set_gravity({0, 0, -9.81});
    return net;
}

constexpr double frame = 1.0 / 60;  // s

struct Second {
    Index substeps;  // a frame
    bench::Times times;
    std::string cells;

    void print(const std::string& label) const {
        std::printf("| %s | %lld | %.2f (%.2f) | %s |\n", label.c_str(),
                    static_cast<long long>(substeps), times.least, times.median, cells.c_str());
        std::fflush(stdout);
    }
};

/// One second in frames of 1/60 s: the time of a frame, and what became of the scene.
/// @param advance  by a frame; false when the scene is lost
/// @param state  as it is then
template <class Advance, class State>
Second second(const Net<double>& net, Index substeps, Advance&& advance, State&& state) {
    bench::Outcome seen(net);
    bench::Stopwatch watch(bench::thread_time);
    for (int i = 1; i <= 60 && !seen.lost(); ++i) {
        bool moved = false;
        watch.run([&] { moved = advance(); });
        if (moved) {
            seen.see(i * frame, state());
        } else {
            seen.explode();
        }
    }
    return {substeps, watch.times(), seen.cells()};
}

Second second_of_xpbd(const Net<double>& net, Index substeps) {
    bench::Xpbd xpbd(net, frame / static_cast<double>(substeps));
    const auto advance = [&] {
        xpbd.step(substeps);
        return true;
    };
    return second(
        net, substeps, advance, [&]() -> const auto& { return xpbd.state(); });
}

/// The most substeps of XPBD that take no longer a frame.
/// @param other  any second of XPBD, for its time
Second second_in_time(const Net<double>& net, const Second& other, double time) {
    const double substep = other.times.least / static_cast<double>(other.substeps);
    auto substeps = std::max(Index(1), static_cast<Index>(time / substep));
    auto result = second_of_xpbd(net, substeps);
    while (result.times.least > time && substeps > 1) result = second_of_xpbd(net, --substeps);
    return result;
}

void outcome(const std::string& label, const Net<double>& net) {
    const double limit = taut::any_pose_limit(net).certified;
    const auto substeps = static_cast<Index>(std::ceil(frame / limit));
    taut::SymplecticEuler stepper(net);
    auto state = net.initial_state();
    const auto advance = [&] {
        return bool(stepper.step(state, frame / static_cast<double>(substeps), substeps));
    };
    const auto ours = second(
        net, substeps, advance, [&]() -> const auto& { return state; });
    ours.print(label);
    const auto as_many = second_of_xpbd(net, substeps);
    second_in_time(net, as_many, ours.times.least).print(label + ", XPBD in this time");
    as_many.print(label + ", XPBD, as many");
}

void memory() {
    const auto before = mallinfo2();
    const auto net = taut::hanging_cloth<double>({100, 100});
    const auto system = mallinfo2();
    auto state = net.initial_state();
    const auto given = mallinfo2();
    taut::SymplecticEuler stepper(net);
    std::ignore = stepper.step(state, 1e-5);
    const auto after = mallinfo2();
    const auto bytes = [](const auto& from, const auto& to) {
        return static_cast<double>(to.uordblks + to.hblkhd) -
               static_cast<double>(from.uordblks + from.hblkhd);
    };
    const auto springs = static_cast<double>(net.spring_count());
    std::printf(
        "\n%.1f bytes a spring, hanging_cloth 100 in double: SpringSystem %.1f, "
        "SymplecticEuler %.1f.\n",
        (bytes(before, system) + bytes(given, after)) / springs, bytes(before, system) / springs,
        bytes(given, after) / springs);
}

struct Mesh {
    std::string name;
    taut::MeshSprings<double> in_double;
    taut::MeshSprings<float> in_float;
};

Mesh mesh_of(std::string name, const example::MeshFile& file) {
    return {std::move(name), bench::mesh_in<double>(file), bench::mesh_in<float>(file)};
}

void plain_rows(const Mesh& mesh) {
    compare<double>(mesh.name, mesh.in_double.system, 21);
    compare<float>(mesh.name + ", float", mesh.in_float.system, 21);
}

void kinds_rows(const Mesh& mesh) {
    compare_kinds<double>(mesh.name, mesh.in_double.system, mesh.in_double.triangles);
    compare_kinds<float>(mesh.name + ", float", mesh.in_float.system, mesh.in_float.triangles);
}

}  // namespace

/// Arguments: meshes in OBJ form.
int main(int argc, char** argv) try {
    std::vector<Mesh> meshes;
    for (int i = 1; i < argc; ++i) {
        meshes.push_back(mesh_of(bench::file_name(argv[i]), example::read_obj(argv[i])));
    }
    std::printf(
        "Processor time, least of many turns (median); ratio: the right time over the left. "
        "hanging_cloth N has\nN × N particles; the sleeve is irregular, its vertices are numbered "
        "at random. In double unless said.\n\n"
        "## A symplectic step beside the plain loop over springs, ms\n\n"
        "| scene | plain loop | Taut | ratio |\n|---|---|---|---|\n");
    for (const Index n : {32, 64, 100, 200, 400}) {
        const int turns = n < 200 ? 21 : 7;
        const auto label = "hanging_cloth " + std::to_string(n);
        compare<double>(label, taut::hanging_cloth<double>({n, n}), turns);
        compare<float>(label + ", float", taut::hanging_cloth<float>({n, n}), turns);
    }
    const auto free_lattice = lattice(30);
    compare<double>("free lattice 30³", free_lattice, 7);
    plain_rows(mesh_of("sleeve of 500 vertices", bench::sleeve()));
    for (const Mesh& mesh : meshes) plain_rows(mesh);
    const Mesh cloth{
        "hanging_cloth 100",
        {taut::hanging_cloth<double>({100, 100}), {}, 0, 0, 0, taut::cloth_triangles({100, 100})},
        {taut::hanging_cloth<float>({100, 100}), {}, 0, 0, 0, taut::cloth_triangles({100, 100})}};
    std::printf(
        "\n## A damped symplectic step beside the undamped, ms\n\n"
        "| scene | undamped | α = 0.4 h | ratio |\n|---|---|---|---|\n");
    compare_damping<double>(cloth.name, cloth.in_double.system);
    compare_damping<float>(cloth.name + ", float", cloth.in_float.system);
    for (const Mesh& mesh : meshes) compare_damping<double>(mesh.name, mesh.in_double.system);
    std::printf(
        "\n## What else is asked of a step, beside the symplectic step without, ms\n\n"
        "| scene, what is asked | without | with | ratio |\n|---|---|---|---|\n");
    kinds_rows(cloth);
    for (const Mesh& mesh : meshes) kinds_rows(mesh);
    std::printf(
        "\n## A symplectic step beside Boost.odeint's, ms\n\n"
        "| scene | Boost.odeint | Taut | ratio |\n|---|---|---|---|\n");
    compare_odeint(cloth.name, cloth.in_double.system);
#ifdef _OPENMP
    std::printf(
        "\n## A symplectic step on two threads beside one, ms by the clock on the wall\n\n"
        "| scene | one thread | two | ratio |\n|---|---|---|---|\n");
    compare_threads(cloth.name, cloth.in_double.system, 11);
    compare_threads("hanging_cloth 400", taut::hanging_cloth<double>({400, 400}), 7);
    for (const Mesh& mesh : meshes) compare_threads(mesh.name, mesh.in_double.system, 11);
#endif
    std::printf(
        "\n## One second in frames of 1/60 s at the any-pose limit\n\n"
        "| scene | substeps | frame, ms: min (median) | %s |\n"
        "|---|---|---|---|---|---|\n",
        bench::Outcome::columns);
    for (const Index n : {32, 64, 100}) {
        outcome("hanging_cloth " + std::to_string(n), taut::hanging_cloth<double>({n, n}));
    }
    outcome("free lattice 30³", free_lattice);
    for (const Mesh& mesh : meshes) outcome(mesh.name, mesh.in_double.system);
    memory();
} catch (const std::exception& error) {
    std::fprintf(stderr, "step_table: %s\n", error.what());
    return 1;
}
