// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "page.hpp"

#include "../common/page.hpp"
#include "../common/page_data.hpp"

namespace example {

void set_page(Findings& found, const taut::Stability<double>& stability, const Scene& scene,
              Progress& progress) {
    progress.at("stepping the mesh for the page");
    const auto& mode = *found.limiting_mode;
    found.page = page_data(stability, found, mode, scene.system.rayleigh());
    add_mesh(found.page, scene, stability, mode);
    add_runs(found.page, scene, found.symplectic_euler, mode);
    if (found.resolution) {
        progress.at("running the scene and its coarse network for the page");
        add_resolution(found.page, scene, *found.resolution);
    }
}

void set_page(Findings& found, const taut::Stability<double>& stability,
              const std::optional<taut::RayleighDamping>& rayleigh) {
    found.page = page_data(stability, found, *found.limiting_mode, rayleigh);
}

std::string json_text(const Findings& found, double d0) { return to_json(found, d0).dump(2); }
std::string html_text(const Findings& found, double d0) { return page(found, d0); }

}  // namespace example
