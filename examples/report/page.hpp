// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "../common/findings.hpp"
#include "../common/progress.hpp"
#include "../common/scene.hpp"

// What stability_report writes as JSON and as a page: a unit of its own, or one compiler would take
// more than 1.2 GB.

namespace example {

/// Sets found.page. Its limiting mode must be known.
void set_page(Findings& found, const taut::Stability<double>& stability, const Scene& scene,
              Progress& progress);
/// Of bare matrices. @param rayleigh  theirs, if Rayleigh damping is all they have
void set_page(Findings& found, const taut::Stability<double>& stability,
              const std::optional<taut::RayleighDamping>& rayleigh);

std::string json_text(const Findings& found, double d0);
std::string html_text(const Findings& found, double d0);

}  // namespace example
