// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <string>
#include <taut/lammps/lammps_dump.hpp>
#include <taut/lammps/lammps_options.hpp>
#include <taut/proof/stability.hpp>
#include <taut/proof/bracket.hpp>

#include "../support/scene.hpp"

// The module lammps for scenes: of Hookean springs, and of any law in three dimensions by double.

namespace taut_test {

using taut::LammpsOptions;

taut::LammpsReport write_lammps(const std::string& folder, const Scene& scene,
                                const AnyState& state, const LammpsOptions& options = {});

class AnyDump {
public:
    virtual ~AnyDump() = default;
    virtual taut::DumpReport read(AnyState& state) = 0;
    virtual Index frames() const = 0;
    virtual bool has_velocities() const = 0;
};
std::unique_ptr<AnyDump> open_dump(const Kind& kind, const std::string& path, Index particles);

Scene cloth_scene(Index rows, Index columns);
Scene lattice_scene(const std::array<Index, 3>& size);
void blow(Scene& scene);
taut::Mode limiting_mode(const Scene& scene, const AnyState& state);

}  // namespace taut_test
