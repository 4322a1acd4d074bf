// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "findings.hpp"
#include "number.hpp"
#include "resolution_report.hpp"

// What stability_report found, as a table.

namespace example {

inline std::string certified_text(double h) {
    if (h == 0) return "none";
    return std::isfinite(h) ? rounded_down(h, 5) + " s" : "every step";
}

inline std::string refuted_text(double h) {
    if (h == 0) return "every step";
    return std::isfinite(h) ? rounded_up(h, 5) + " s" : "none";
}

inline void print_limit(const char* label, const taut::StepLimit<double>& limit) {
    std::printf("  %-22s %-14s %-14s", label, certified_text(limit.certified).c_str(),
                refuted_text(limit.refuted).c_str());
    if (limit.certified > 0 && std::isfinite(limit.refuted)) {
        std::printf(" %5.1f %%", 100 * limit.certified / limit.refuted);
    } else {
        std::printf(" %7s", "");
    }
    std::printf("  %s\n", name(limit.cause));
}

/// Which of three a limit is, and what it costs.
inline void print_promises(const Findings& found) {
    std::printf("  this pose: no small vibration about it grows\n");
    if (!found.any_pose || !found.energy_stable || found.any_pose->unbounded()) return;
    const auto& at_pose = found.symplectic_euler;
    const auto& at_any = *found.any_pose;
    std::printf(
        "  any pose:  the same about every pose that it moves through, yet its energy may rise\n");
    if (at_any.certified > 0 && at_pose.certified > 0 && !at_pose.unbounded()) {
        std::printf("             (%.1f %% of the step at this pose)\n",
                    100 * at_any.certified / at_pose.certified);
    }
    const double step = found.moving_step();
    if (step > 0) {
        std::printf(
            "  energy:    no step of taut::EnergyStableEuler gains more than the work from "
            "outside\n"
            "             (%.0f steps a frame of 1/60 s); above refuted the proof ends, not the "
            "scene\n",
            std::ceil(1 / (60 * step)));
    }
}

/// A sentence for every cause that a user can do something about.
inline void print_note(const char* label, const taut::StepLimit<double>& limit) {
    using taut::Cause;
    if (limit.estimate > 0) {
        std::printf("  %s: the limit is near %.4g s; an estimate, not proved\n", label,
                    limit.estimate);
    }
    if (limit.growth_rate > 0) {
        std::printf("  %s: %s\n    growth rate %.3g 1/s\n", label, describe(limit.cause),
                    limit.growth_rate);
    } else if (limit.certified_up_to > limit.certified) {
        std::printf("  %s: %s.\n    %s s, growth at most %s 1/s\n", label, describe(limit.cause),
                    rounded_down(limit.certified_up_to, 5).c_str(),
                    rounded_up(limit.admitted_growth, 3, 'g').c_str());
    } else if (limit.cause != Cause::stiffness && limit.cause != Cause::unconditional) {
        std::printf("  %s: %s.\n", label, describe(limit.cause));
    }
}

inline void print_blame(const Findings& found) {
    std::printf("The limiting vibration\n");
    const auto all = static_cast<double>(found.particles.value_or(found.degrees_of_freedom));
    const double foremost =
        found.springs_to_blame.empty() ? 0 : found.springs_to_blame.front().share;
    // A sine over a whole cloth has 0.44.
    if (found.participants > 0.3 * all && foremost < 0.05) {
        std::printf(
            "  spread evenly: the whole net sets the limit; no spring holds more than %.2g %% of "
            "its energy\n",
            100 * foremost);
        return;
    }
    std::printf("  about %.0f of %.0f particles take part\n", std::max(1.0, found.participants),
                all);
    for (const auto& spring : found.springs_to_blame) {
        std::printf(
            "  spring %-8lld between particles %lld and %lld: %.2f %% of its elastic energy\n",
            static_cast<long long>(spring.index), static_cast<long long>(spring.a),
            static_cast<long long>(spring.b), 100 * spring.share);
    }
    for (const auto& particle : found.particles_to_blame) {
        std::printf("  particle %-6lld %.2f %% of its kinetic energy\n",
                    static_cast<long long>(particle.index), 100 * particle.share);
    }
}

/// A step that was asked for; where something is known of it, then of the printed number too.
inline std::string step_text(const Verdict& verdict) {
    if (verdict.standing == Verdict::Standing::refuted) return rounded_up(verdict.step, 5);
    return rounded_down(verdict.step, 5);
}

/// The rest of a sentence that names the step.
inline std::string describe(const Verdict& verdict) {
    if (verdict.standing == Verdict::Standing::certified) return "proved";
    if (verdict.standing == Verdict::Standing::undecided) return "neither proved nor refuted";
    char text[96];
    if (!(verdict.growth > 1)) return "refuted";
    if (verdict.growth < 1.01) {
        std::snprintf(text, sizeof text,
                      "refuted: the limiting vibration grows by %.2g %% with every step",
                      100 * (verdict.growth - 1));
    } else {
        std::snprintf(text, sizeof text,
                      "refuted: the limiting vibration grows %.4g-fold with every step",
                      verdict.growth);
    }
    return text;
}

/// What is known of a step: first while the scene moves.
inline void print_verdict(const Findings& found, const char* step, const Verdict& verdict) {
    const std::string h = step_text(verdict);
    if (!found.any_pose) {
        std::printf("%s h = %s s in this pose: %s\n", step, h.c_str(), describe(verdict).c_str());
        return;
    }
    std::printf("%s h = %s s\n  at any pose:  ", step, h.c_str());
    const bool proved = found.any_pose->substeps(verdict.step, 1) == 1;
    const auto substeps = found.any_pose->substeps(verdict.step, safe_part);
    if (substeps == 1) {
        std::printf("proved\n");
    } else if (!substeps) {
        std::printf("not proved, nor is any other step\n");
    } else if (proved) {
        std::printf("proved, but above %g of the limit: take 2 steps in its place\n", safe_part);
    } else {
        std::printf("not proved; take %lld steps in its place, each at most %g of the limit\n",
                    static_cast<long long>(*substeps), safe_part);
    }
    std::printf("  in this pose: %s\n", describe(verdict).c_str());
}

inline void print_remedies(const Findings& found) {
    const auto& [verdict, cures] = *found.remedies;
    print_verdict(found, "The wanted step of symplectic Euler,", verdict);
    if (found.is_safe(verdict)) return;
    if (found.moving_step() > 0) {
        std::printf(
            "  %.0f steps of taut::EnergyStableEuler take its place as well, at any speed\n",
            std::ceil(verdict.step / found.moving_step()));
    }
    if (!(cures.stiffness_scale > 0) || !std::isfinite(cures.mass_scale)) {
        std::printf("  no scale of stiffness or masses is proved to make it safe\n");
        return;
    }
    if (!cures.are_near()) {
        std::printf("  no other cure is near: stiffness or masses would have to change %s-fold\n",
                    rounded_up(cures.mass_scale, 3, 'g').c_str());
        return;
    }
    if (found.any_pose) {
        std::printf("  any one of these makes it safe at any pose, at %g of the limit:\n",
                    safe_part);
    } else {
        std::printf("  any one of these makes it safe in this pose:\n");
    }
    std::printf("    all stiffness times %s, or all masses times %s\n",
                rounded_down(cures.stiffness_scale, 4, 'g').c_str(),
                rounded_up(cures.mass_scale, 4, 'g').c_str());
    if (!cures.added_mass || !cures.added_mass->reached) return;
    const auto& added = *cures.added_mass;
    const auto heavier =
        std::count_if(added.mass.begin(), added.mass.end(), [](double m) { return m > 0; });
    std::printf("    about %.4g kg more on %lld particles", added.total,
                static_cast<long long>(heavier));
    if (!added.frequency_change.empty()) {
        const auto most =
            std::min_element(added.frequency_change.begin(), added.frequency_change.end());
        std::printf("; the lowest frequencies change by at most %.3g %%", -100 * *most);
    }
    std::printf("\n");
}

/// The α, s, that explicit Euler needs, as far as the digits that are printed tell them apart.
inline void print_window(const Findings& found, double d0) {
    constexpr int digits = 5;
    std::printf("Explicit Euler at h = %.4e s with drag d0 = %g 1/s: ", found.window_step, d0);
    if (found.window.empty != taut::EmptyWindow::none) {
        std::printf("no alpha is proved stable: %s\n", describe(found.window.empty));
        return;
    }
    const std::string lower = rounded_up(found.window.lower, digits);
    const std::string upper = rounded_down(found.window.upper, digits);
    if (std::isfinite(found.window.upper) && !(std::stod(lower) < std::stod(upper))) {
        std::printf("no alpha of %d digits is proved stable: take a smaller step\n", digits);
        return;
    }
    std::printf("stable for alpha in (%s, %s) s\n", lower.c_str(), upper.c_str());
}

inline void print_table(const Findings& found, double d0) {
    std::printf("%s, %lld degrees of freedom\n", found.name.c_str(),
                static_cast<long long>(found.degrees_of_freedom));
    if (!found.space.empty()) std::printf("%s\n", found.space.c_str());
    std::printf("\n");
    std::printf("Largest stable time step\n  %-22s %-14s %-14s %7s  %s\n", "", "certified",
                "refuted", "ratio", "set by");
    std::printf(" at this pose (linear)\n");
    print_limit("explicit Euler", found.explicit_euler);
    print_limit("symplectic Euler", found.symplectic_euler);
    print_limit("implicit Euler", found.implicit_euler);
    if (found.any_pose) {
        std::printf(" at any pose (linearised)\n");
        print_limit("symplectic Euler", *found.any_pose);
    }
    if (found.energy_stable) {
        std::printf(" energy (nonlinear)\n");
        print_limit("energy-stable Euler", *found.energy_stable);
    }
    std::printf(
        "  certified: proved, rounding included\n"
        "  refuted:   a vibration is known that grows (any pose, energy: the condition fails)\n"
        "  ratio:     of certified to refuted; between them nothing is claimed\n");
    print_promises(found);
    print_note("explicit Euler", found.explicit_euler);
    print_note("symplectic Euler", found.symplectic_euler);
    print_note("implicit Euler", found.implicit_euler);
    std::printf("\n");

    const auto& k = found.spectrum;
    std::printf(
        "Eigenvalues of K/M (stiffness, masses): k_min in [%s, %s], k_max in [%s, %s] 1/s^2\n",
        rounded_down(k.k_min.lower, 4, 'g').c_str(), rounded_up(k.k_min.upper, 4, 'g').c_str(),
        rounded_down(k.k_max.lower, 6, 'g').c_str(), rounded_up(k.k_max.upper, 6, 'g').c_str());
    if (found.zero_modes) {
        std::printf("Zero modes (rigid motions and mechanisms): %lld\n",
                    static_cast<long long>(*found.zero_modes));
    }
    print_window(found, d0);
    if (found.verdict) print_verdict(found, "Symplectic Euler at", *found.verdict);
    if (found.proof) {
        std::printf("%s at h = %s s: %s\n", name(found.proof->method),
                    rounded_down(found.proof->step, 10).c_str(),
                    found.proof->proved ? "proved stable" : "not proved");
    }
    if (!found.particles_to_blame.empty()) print_blame(found);
    if (found.remedies) print_remedies(found);
    if (found.resolution) print_resolution(*found.resolution);
    std::printf("Seconds: setup %.3f, analysis %.3f\n", found.setup, found.analysis);
}

}  // namespace example
