// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What a step costs by each set of kernels that this program may take: dispatch_table is compiled
// for this processor by headers alone and has one, dispatch_table_compiled at -O2 with
// Taut::Compiled. One thread, processor time, the least of many runs. Prints Markdown. Arguments:
// meshes in OBJ form.

#include <cstdio>
#include <exception>
#include <string>
#include <taut/kernels.hpp>
#include <taut/network/tension_only.hpp>
#include <taut/scene/with_law.hpp>
#include <taut/taut.hpp>
#include <vector>

#include "measure.hpp"
#include "mesh_in.hpp"

namespace {

/// Of a step, microseconds; below 0 where one failed.
template <class Stepper, class System>
double time_of(const System& system, int calls, int steps_of_call) {
    using Scalar = typename System::Scalar;
    const Scalar h = taut::energy_limit(system).certified / 2;
    Stepper stepper(system);
    auto state = system.initial_state();
    bool ok = true;
    const auto run = [&] {
        for (int i = 0; i < calls; ++i) {
            ok = static_cast<bool>(stepper.step(state, h, steps_of_call)) && ok;
        }
    };
    run();  // warm-up
    bench::Stopwatch watch(bench::thread_time);
    for (int i = 0; i < 25; ++i) watch.run(run);
    return (ok ? 1e3 : -1e3) * watch.times().least / (calls * steps_of_call);
}

template <class System>
void row(const std::string& name, System system) {
    std::printf("| %s | %s | %ld |", taut::kernels(), name.c_str(),
                static_cast<long>(system.spring_count()));
    std::printf(" %.1f |", time_of<taut::SymplecticEuler<System>>(system, 1, 200));
    std::printf(" %.1f |", time_of<taut::EnergyStableEuler<System>>(system, 1, 200));
    std::printf(" %.1f |", time_of<taut::VelocityVerlet<System>>(system, 1, 200));
    std::printf(" %.1f |", time_of<taut::EnergyStableEuler<System>>(system, 200, 1));
    system.set_rayleigh({0.1, 1e-4});
    std::printf(" %.1f |\n", time_of<taut::EnergyStableEuler<System>>(system, 1, 200));
    std::fflush(stdout);
}

template <class Scalar>
void rows(const std::string& name, const taut::SpringSystem<Scalar, 3>& net) {
    const std::string scalar = sizeof(Scalar) == 4 ? ", float" : ", double";
    row(name + scalar, net);
    row(name + scalar + ", tension-only", taut::with_law<taut::TensionOnly>(net));
}

template <class Scalar>
void scenes(const std::vector<std::string>& meshes) {
    rows<Scalar>("hanging_cloth 100", taut::hanging_cloth<Scalar>({100, 100}));
    for (const auto& mesh : meshes) {
        rows<Scalar>(bench::file_name(mesh),
                     bench::mesh_in<Scalar>(example::read_obj(mesh)).system);
    }
}

}  // namespace

int main(int argc, char** argv) try {
    const std::vector<std::string> meshes(argv + 1, argv + argc);
    for (const auto& mesh : meshes) example::read_obj(mesh);  // else says what is wrong with it
    std::printf(
        "## A step by each set of kernels, µs\n\n"
        "| kernels | scene | springs | symplectic | energy stable | Verlet | energy stable, one a "
        "call | energy stable, damped |\n|---|---|---|---|---|---|---|---|\n");
    const std::string best = taut::kernels();
    for (const char* set : {"sse2", "avx2", "avx512"}) {
        if (!taut::set_kernels(set)) continue;
        scenes<float>(meshes);
        scenes<double>(meshes);
        if (best == set) break;
    }
} catch (const std::exception& error) {
    std::fprintf(stderr, "dispatch_table: %s\n", error.what());
    return 1;
}
