// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <taut/resolution/resolution.hpp>
#include <taut/taut.hpp>
#include <taut/tight/tight.hpp>
#include <taut/proof/bracket.hpp>
#include <vector>

#include "remedies.hpp"

// What stability_report finds.

namespace example {

using taut::Method;
using Json = nlohmann::ordered_json;

/// What is known of one step of symplectic Euler at this pose.
struct Verdict {
    enum class Standing { certified, refuted, undecided };

    double step = 0;  // s
    Standing standing = Standing::undecided;
    double growth = 1;  ///< where it is refuted, with every step, of the vibrations that are known;
                        ///< not above 1 where none of these is what refutes
};

/// @param limit  of symplectic Euler at this pose
/// @param mode   returns the limiting vibration; called only where the step is refuted
template <class FindMode>
Verdict judge(const taut::Stability<double>& stability, const taut::StepLimit<double>& limit,
              const FindMode& mode, double h) {
    using Standing = Verdict::Standing;
    if (h <= limit.certified) return {h, Standing::certified};
    if (h < limit.refuted) {
        const bool proved = taut::certify(stability, Method::symplectic_euler, h).proved;
        return {h, proved ? Standing::certified : Standing::undecided};
    }
    const taut::Mode& limiting = mode();
    return {h, Standing::refuted,
            std::max(taut::spectral_radius(Method::symplectic_euler, limiting.k, limiting.d, h),
                     taut::spectral_radius(stability, Method::symplectic_euler, h))};
}

inline const char* name(Verdict::Standing standing) {
    switch (standing) {
        case Verdict::Standing::certified: return "certified";
        case Verdict::Standing::refuted: return "refuted";
        case Verdict::Standing::undecided: return "undecided";
    }
    return "";
}

/// What would make a wanted step safe: at any pose where the findings have such a limit.
struct Remedies {
    Verdict verdict;
    Cures cures;
};

/// How few particles would do.
struct ResolutionFound {
    double duration = 0;  // s
    taut::Resolution<taut::SpringSystem<double, 3>> found;
    std::optional<double> measured;  ///< error against the scene itself, where that was run
};

struct Findings {
    std::string name;
    std::string space;  // the scene's size and which way is down; empty for bare matrices
    taut::Index degrees_of_freedom = 0;
    std::optional<taut::Index> particles;
    std::optional<taut::Index> springs;
    taut::StiffnessSpectrum spectrum;
    std::optional<taut::Index> zero_modes;  // where asked for
    taut::StepLimit<double> explicit_euler;
    taut::StepLimit<double> symplectic_euler;
    taut::StepLimit<double> implicit_euler;
    std::optional<taut::StepLimit<double>> any_pose;
    std::optional<taut::StepLimit<double>> energy_stable;
    std::optional<taut::Certificate> proof;
    std::optional<taut::Mode> limiting_mode;  // where something needed it
    std::vector<taut::SpringShare> springs_to_blame;
    std::vector<taut::ParticleShare> particles_to_blame;
    double participants = 0;         // 1/Σ of the squared shares of all particles
    std::optional<Verdict> verdict;  // on a step that was asked for
    std::optional<Remedies> remedies;
    std::optional<ResolutionFound> resolution;
    double window_step = 0;  // s
    taut::AlphaWindow window;
    double setup = 0;     // s
    double analysis = 0;  // s
    std::string lammps;   // lines on what was written for it
    Json page;            // what only the HTML page shows; null without --html

    /// Whether `step`, s, may be used as the scene is.
    bool is_safe(const Verdict& step) const {
        if (any_pose) return any_pose->substeps(step.step, safe_part) == 1;
        return step.standing == Verdict::Standing::certified;
    }
    /// At which to step a moving scene, s; 0: none, or every step.
    double moving_step() const {
        return energy_stable && !energy_stable->unbounded() ? energy_stable->certified : 0;
    }
};

}  // namespace example
