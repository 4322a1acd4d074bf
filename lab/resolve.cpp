// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <chrono>
#include <string>
#include <taut/resolution/resolution.hpp>
#include <taut/proof/energy_limit.hpp>
#include <vector>

#include "lab.hpp"
#include "scene.hpp"

#ifdef __EMSCRIPTEN__
// Emscripten takes no import that it has no body for; engine.js brings the real one.
EM_JS(void, lab_resolving, (int run, int sample), {});
#endif

namespace {

constexpr double patience = 60;  // s

struct Answer {
    LabResolution resolution{};
    std::string words;
    std::vector<LabLevel> levels;
};

Answer answer;
const taut::ResolveOptions defaults;
taut::Index looks = 0;  // that the search has had at its clock

/// The search looks at its clock once before it begins and then at every sample of a run: that is
/// how the page learns how far it is.
double told_clock() {
    if (looks > 0) {
        const taut::Index sample = looks - 1;
        lab_resolving(static_cast<int>(sample / defaults.samples),
                      static_cast<int>(sample % defaults.samples));
    }
    ++looks;
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double>(now).count();
}

}  // namespace

void lab_resolve(double duration, double goal) {
    const auto& cloth = lab::scene().cloth;
    answer = {};
    answer.resolution.outcome = answer.resolution.chosen = -1;
    answer.words = "No step of this scene is certified, so no coarser one is searched for.";
    // resolve() takes such a scene for a mistake and would end the program.
    if (!(taut::energy_limit(cloth).certified > 0)) return;
    taut::ResolveOptions options;
    options.seconds = patience;
    options.clock = &told_clock;
    looks = 0;
    const auto found = taut::resolve(cloth, cloth.initial_state(), duration, goal, options);
    answer.resolution = {static_cast<double>(found.outcome), static_cast<double>(found.chosen),
                         found.cheaper(), found.fine_cost, found.search_cost};
    answer.words = found.why;
    for (const auto& level : found.levels) {
        answer.levels.push_back({static_cast<double>(level.particles),
                                 static_cast<double>(level.springs), level.h, level.cost,
                                 level.error});
    }
}

const LabResolution* lab_resolution() { return &answer.resolution; }
const char* lab_resolution_words() { return answer.words.c_str(); }
const LabLevel* lab_level(int i) { return &answer.levels[static_cast<std::size_t>(i)]; }
int lab_level_count() { return static_cast<int>(answer.levels.size()); }
