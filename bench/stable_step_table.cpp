// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What a step of EnergyStableEuler costs beside one of SymplecticEuler, at the same h and in turns:
// in float, many steps at once, processor time. Prints Markdown. Arguments: meshes in OBJ form.

#include <cstdio>
#include <exception>
#include <string>
#include <taut/integrator/energy_stable_euler.hpp>
#include <taut/integrator/symplectic_euler.hpp>
#include <taut/network/tension_only.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/scene/with_law.hpp>
#include <taut/proof/energy_limit.hpp>
#include <utility>
#include <vector>

#include "measure.hpp"
#include "mesh_in.hpp"

namespace {

using Net = taut::SpringSystem<float, 3>;

template <class System>
void row(const std::string& label, const System& net) {
    const float h = taut::energy_limit(net).certified;
    taut::SymplecticEuler<System> symplectic(net);
    taut::EnergyStableEuler<System> stable(net);
    auto by_symplectic = net.initial_state();
    auto by_stable = by_symplectic;
    bool ok = true;
    constexpr int steps = 200;
    bench::Turns both(steps);
    both.run(
        21, [&] { ok = bool(symplectic.step(by_symplectic, h, steps)) && ok; },
        [&] { ok = bool(stable.step(by_stable, h, steps)) && ok; });
    std::printf("| %s | %ld | %s%s |\n", label.c_str(), static_cast<long>(net.spring_count()),
                both.cells().c_str(), ok ? "" : " A STEP FAILED");
    std::fflush(stdout);
}

void rows(const std::string& label, const Net& net) {
    row(label + ", Hookean", net);
    row(label + ", tension-only", taut::with_law<taut::TensionOnly>(net));
}

}  // namespace

int main(int argc, char** argv) try {
    std::vector<std::pair<std::string, taut::SpringSystem<float, 3>>> scenes{
        {"hanging_cloth 100", taut::hanging_cloth<float>({100, 100})}};
    for (int i = 1; i < argc; ++i) {
        scenes.emplace_back(bench::file_name(argv[i]),
                            bench::mesh_in<float>(example::read_obj(argv[i])).system);
    }
    std::printf(
        "## A step of EnergyStableEuler beside one of SymplecticEuler, ms, in float\n\n"
        "Processor time, least of 21 turns of 200 steps (median).\n\n"
        "| scene | springs | symplectic | energy stable | ratio |\n"
        "|---|---|---|---|---|\n");
    for (const auto& [name, system] : scenes) rows(name, system);
} catch (const std::exception& error) {
    std::fprintf(stderr, "stable_step_table: %s\n", error.what());
    return 1;
}
