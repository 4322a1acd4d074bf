// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "particle_scene.hpp"

namespace taut_test {

template std::array<Step, 2> solved_steps<float, 1>(Random&, const ParticleOptions&);
template std::vector<std::array<Step, 2>> pushed_steps<float, 1>(Random&, bool);
template std::array<Step, 2> solved_steps<float, 2>(Random&, const ParticleOptions&);
template std::vector<std::array<Step, 2>> pushed_steps<float, 2>(Random&, bool);
template std::array<Step, 2> solved_steps<float, 3>(Random&, const ParticleOptions&);
template std::vector<std::array<Step, 2>> pushed_steps<float, 3>(Random&, bool);

}  // namespace taut_test
