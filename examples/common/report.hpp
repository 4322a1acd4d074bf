// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <taut/taut.hpp>
#include <vector>

// What stability_report found, as a table and as JSON.

namespace example {

using taut::Method;
using Json = nlohmann::ordered_json;

/// What would make a wanted step safe.
struct Remedies {
    double step = 0;  // s
    bool safe_already = false;
    double stiffness_scale = 0;
    double mass_scale = 0;
    std::optional<taut::AddedMass> added_mass;
};

/// The step up to which no step raises the energy, and what this asks for and costs [T34].
struct EnergyProof {
    taut::EnergyLimit<double> limit;
    taut::GraphDampingRange alpha;  ///< s, at the certified step; empty where there is no such step
    double rotation = 0;  ///< 1/s²; times α the rate at which it slows rotation, over all axes
};

template <class System>
EnergyProof prove_energy(const System& system, double tightness) {
    EnergyProof proof;
    proof.limit = taut::energy_limit(system, tightness);
    const double h = proof.limit.certified;
    if (!(h > 0) || !std::isfinite(h)) return proof;
    proof.alpha = proof.limit.alpha(h);
    // Σ k l² over the moment of inertia about the centre of mass.
    const auto x = system.initial_state().x;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double mass = 0, inertia = 0, pull = 0;
    for (taut::Index i = 0; i < system.size(); ++i) {
        centre += system.mass(i) * x.col(i);
        mass += system.mass(i);
    }
    centre /= mass;
    for (taut::Index i = 0; i < system.size(); ++i)
        inertia += system.mass(i) * (x.col(i) - centre).squaredNorm();
    const auto& springs = system.springs();
    for (taut::Index s = 0; s < springs.size(); ++s) {
        const auto at = static_cast<std::size_t>(s);
        const double l = (x.col(springs.b[at]) - x.col(springs.a[at])).norm();
        pull += springs.parameters[at].stiffness * l * l;
    }
    if (inertia > 0) proof.rotation = pull / inertia;
    return proof;
}

/// What graph inertia would make of the wanted step [T33].
struct InertiaTold {
    bool possible = false;  ///< some shares make the step safe
    taut::Index implicit_springs = 0;
    taut::Index touched = 0;  ///< free particles at their ends
    taut::InertiaPrice price;
};

template <class System>
InertiaTold tell_inertia(const System& system, double h) {
    const taut::GraphShares shares =
        taut::graph_shares(system, h, taut::GraphInertiaOptions{}.margin);
    InertiaTold told;
    told.possible = shares.status == taut::Status::ok;
    told.implicit_springs = shares.implicit_springs();
    told.touched = taut::touched_particles(system, shares);
    const taut::Index modes = told.implicit_springs > 0 ? 10 : 0;
    told.price = taut::inertia_price(system, system.initial_state(), shares, modes);
    return told;
}

struct Findings {
    std::string name;
    taut::Index degrees_of_freedom = 0;
    std::optional<taut::Index> particles;
    std::optional<taut::Index> springs;
    taut::StiffnessSpectrum spectrum;
    taut::StepLimit<double> explicit_euler;
    taut::StepLimit<double> symplectic_euler;
    taut::StepLimit<double> implicit_euler;
    /// At any pose, so at this one too; bare matrices have no springs to share.
    std::optional<taut::StepLimit<double>> graph_inertia;
    std::optional<taut::StepLimit<double>> any_pose;
    std::optional<EnergyProof> energy;
    std::optional<taut::Certificate> proof;
    taut::LimitingMode limiting_mode;  // where it was asked for
    std::vector<taut::SpringShare> springs_to_blame;
    std::vector<taut::ParticleShare> particles_to_blame;
    std::optional<Remedies> remedies;
    std::optional<InertiaTold> inertia;  // at the wanted step
    double window_step = 0;              // s
    taut::AlphaWindow window;
    double setup = 0;     // s
    double analysis = 0;  // s
    Json page;            // what only the HTML page shows; null without --html
};

/// null: none is safe, or none is known to fail. "unbounded": every step is safe.
inline Json certified_json(const taut::StepLimit<double>& limit) {
    if (limit.unbounded()) return "unbounded";
    return limit.certified > 0 ? Json(limit.certified) : Json(nullptr);
}

inline Json limit_json(const taut::StepLimit<double>& limit) {
    return {{"certified", certified_json(limit)},
            {"refuted", std::isfinite(limit.refuted) ? Json(limit.refuted) : Json(nullptr)},
            {"cause", name(limit.cause)},
            {"growth_rate", limit.growth_rate},
            {"certified_up_to",
             limit.certified_up_to > 0 ? Json(limit.certified_up_to) : Json(nullptr)},
            {"admitted_growth", limit.admitted_growth},
            {"estimate", limit.estimate > 0 ? Json(limit.estimate) : Json(nullptr)}};
}

template <class T>
inline Json optional_json(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

/// null: not known, or no damping is.
inline Json energy_json(const std::optional<EnergyProof>& energy) {
    const bool known = energy && !energy->alpha.empty();
    Json json = energy ? limit_json(energy->limit) : Json{{"certified", nullptr}};
    json["alpha_lower"] = known ? Json(energy->alpha.lower) : Json(nullptr);
    json["alpha_upper"] = known ? Json(energy->alpha.upper) : Json(nullptr);
    return json;
}

/// null: no shares make the wanted step safe, or there are no springs.
inline Json inertia_json(const std::optional<InertiaTold>& told) {
    if (!told || !told->possible) return nullptr;
    Json changes = Json::array();
    for (const auto& mode : told->price.modes) changes.push_back(mode.change());
    return {{"implicit_springs", told->implicit_springs},
            {"touched_particles", told->touched},
            {"added_inertia", told->price.added},
            {"frequency_changes", changes}};
}

inline Json to_json(const Findings& found, double d0) {
    const auto bracket = [](const taut::EigenvalueBracket& k) {
        return Json{{"lower", k.lower}, {"upper", k.upper}};
    };
    const auto& window = found.window;
    const bool empty = window.empty != taut::EmptyWindow::none;
    Json json;
    json["degrees_of_freedom"] = found.degrees_of_freedom;
    json["particles"] = optional_json(found.particles);
    json["springs"] = optional_json(found.springs);
    json["zero_modes"] = optional_json(found.spectrum.zero_modes);
    json["k_min"] = bracket(found.spectrum.k_min);
    json["k_max"] = bracket(found.spectrum.k_max);
    json["explicit_euler"] = limit_json(found.explicit_euler);
    json["symplectic_euler"] = limit_json(found.symplectic_euler);
    json["implicit_euler"] = limit_json(found.implicit_euler);
    json["graph_inertia"] =
        found.graph_inertia ? limit_json(*found.graph_inertia) : Json{{"certified", nullptr}};
    json["any_pose"] = {
        {"certified", found.any_pose ? certified_json(*found.any_pose) : Json(nullptr)}};
    json["energy"] = energy_json(found.energy);
    json["rayleigh_window"] = {{"method", name(Method::explicit_euler)},
                               {"h", found.window_step},
                               {"d0", d0},
                               {"lower", empty ? Json(nullptr) : Json(window.lower)},
                               {"upper", empty                         ? Json(nullptr)
                                         : std::isfinite(window.upper) ? Json(window.upper)
                                                                       : Json("unbounded")},
                               {"empty", empty},
                               {"includes_zero", window.includes_zero}};
    for (const auto& spring : found.springs_to_blame) {
        json["limiting_springs"].push_back(
            {{"index", spring.index}, {"a", spring.a}, {"b", spring.b}, {"share", spring.share}});
    }
    for (const auto& particle : found.particles_to_blame) {
        json["limiting_particles"].push_back(
            {{"index", particle.index}, {"share", particle.share}});
    }
    if (found.proof) {
        json["proof"] = {{"method", name(found.proof->method)},
                         {"h", found.proof->step},
                         {"proved", found.proof->proved}};
    }
    if (found.remedies) {
        const auto& remedies = *found.remedies;
        json["want_step"] = {{"h", remedies.step},
                             {"safe_already", remedies.safe_already},
                             {"stiffness_scale", remedies.stiffness_scale},
                             {"mass_scale", remedies.mass_scale},
                             {"added_mass", remedies.added_mass && remedies.added_mass->reached
                                                ? Json(remedies.added_mass->total)
                                                : Json(nullptr)}};
        json["want_step"]["graph_inertia"] = inertia_json(found.inertia);
    }
    json["seconds"] = {{"setup", found.setup}, {"analysis", found.analysis}};
    return json;
}

inline std::string step_text(double h, const char* if_zero, const char* if_infinite) {
    if (h == 0) return if_zero;
    if (!std::isfinite(h)) return if_infinite;
    char text[32];
    std::snprintf(text, sizeof text, "%.4e s", h);
    return text;
}

inline void print_limit(const char* label, const taut::StepLimit<double>& limit) {
    std::printf("  %-22s %-14s %-14s", label,
                step_text(limit.certified, "none", "every step").c_str(),
                step_text(limit.refuted, "every step", "none").c_str());
    if (limit.certified > 0 && std::isfinite(limit.refuted)) {
        std::printf(" %5.1f %%", 100 * limit.certified / limit.refuted);
    } else {
        std::printf(" %7s", "");
    }
    std::printf("  %s\n", name(limit.cause));
}

/// Which of three a limit is, what it costs, and what is no proof.
inline void print_promises(const Findings& found) {
    std::printf("  this pose: no small vibration about it grows\n");
    if (!found.any_pose || !found.energy || found.any_pose->unbounded()) return;
    const auto& at_pose = found.symplectic_euler;
    const auto& at_any = *found.any_pose;
    std::printf(
        "  any pose:  the same about every pose that it moves through, yet its energy may rise\n");
    if (at_any.certified > 0 && at_pose.certified > 0 && !at_pose.unbounded()) {
        std::printf("             (%.1f %% of the step at this pose)\n",
                    100 * at_any.certified / at_pose.certified);
    }
    const auto& energy = *found.energy;
    if (!energy.alpha.empty()) {
        constexpr double share = 0.9;  // at the limit itself one α is left
        const auto alpha = energy.limit.alpha(share * energy.limit.certified);
        std::printf(
            "  energy:    no step raises it, with graph damping alpha = %.4e s; at %.1f of the "
            "step\n"
            "             alpha in [%.4e, %.4e] s; the least of these slows rotation at %.2g /s\n",
            energy.alpha.lower, share, alpha.lower, alpha.upper, alpha.lower * energy.rotation);
    }
    std::printf(
        "  recipe:    %.4g of any pose, springs looking %.4g h ahead: measured, not proved\n",
        taut::recipe.safety, taut::recipe.damping.look_ahead);
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
        std::printf("  %s: %s.\n    %.4e s, growth at most %.3g 1/s\n", label,
                    describe(limit.cause), limit.certified_up_to, limit.admitted_growth);
    } else if (limit.cause != Cause::stiffness && limit.cause != Cause::unconditional) {
        std::printf("  %s: %s.\n", label, describe(limit.cause));
    }
}

inline void print_blame(const Findings& found) {
    std::printf("The limiting vibration\n");
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

inline void print_remedies(const Remedies& remedies) {
    std::printf("For symplectic Euler at h = %.4e s in this pose", remedies.step);
    if (remedies.safe_already) {
        std::printf(": proved safe as the scene is\n");
        return;
    }
    if (!(remedies.stiffness_scale > 0) || !std::isfinite(remedies.mass_scale)) {
        std::printf(": no scale of stiffness or masses is proved to make it safe\n");
        return;
    }
    std::printf(", any one of\n  all stiffness times %.4g, or all masses times %.4g\n",
                remedies.stiffness_scale, remedies.mass_scale);
    if (!remedies.added_mass || !remedies.added_mass->reached) return;
    const auto& added = *remedies.added_mass;
    const auto heavier =
        std::count_if(added.mass.begin(), added.mass.end(), [](double m) { return m > 0; });
    std::printf("  %.4g kg more on %lld particles", added.total, static_cast<long long>(heavier));
    if (!added.frequency_change.empty()) {
        const auto most =
            std::min_element(added.frequency_change.begin(), added.frequency_change.end());
        std::printf("; the lowest frequencies change by at most %.3g %%", -100 * *most);
    }
    std::printf("\n");
}

/// The price of making springs implicit.
inline void print_inertia(const InertiaTold& told, const Findings& found) {
    std::printf("For graph inertia at h = %.4e s at any pose, ", found.remedies->step);
    if (!told.possible) {
        std::printf("no shares are proved to make it safe\n");
        return;
    }
    std::printf("%lld of %lld springs implicit", static_cast<long long>(told.implicit_springs),
                static_cast<long long>(*found.springs));
    if (told.implicit_springs == 0) {
        std::printf(": it is symplectic Euler, and safe\n");
        return;
    }
    std::printf("\n  one factor of %lld particles; the inertia added is %.3g %% of the mass",
                static_cast<long long>(told.touched), 100 * told.price.added);
    double most = 0;
    for (const auto& mode : told.price.modes) most = std::min(most, mode.change());
    if (!told.price.modes.empty())
        std::printf(";\n  the lowest frequencies change by at most %.3g %%", -100 * most);
    std::printf("\n");
}

inline void print_table(const Findings& found, double d0) {
    std::printf("%s, %lld degrees of freedom\n\n", found.name.c_str(),
                static_cast<long long>(found.degrees_of_freedom));
    std::printf("Largest stable time step\n  %-22s %-14s %-14s %7s  %s\n", "", "certified",
                "refuted", "ratio", "set by");
    std::printf(" at this pose (linear)\n");
    print_limit("explicit Euler", found.explicit_euler);
    print_limit("symplectic Euler", found.symplectic_euler);
    print_limit("implicit Euler", found.implicit_euler);
    if (found.graph_inertia) print_limit("graph inertia", *found.graph_inertia);
    if (found.any_pose) {
        std::printf(" at any pose (linearised)\n");
        print_limit("symplectic Euler", *found.any_pose);
        if (found.graph_inertia) print_limit("graph inertia", *found.graph_inertia);
    }
    if (found.energy) {
        std::printf(" energy (nonlinear)\n");
        print_limit("symplectic Euler", found.energy->limit);
    }
    std::printf(
        "  certified: proved, rounding included\n"
        "  refuted:   a vibration is known that grows (any pose, energy: the condition fails)\n");
    print_promises(found);
    print_note("explicit Euler", found.explicit_euler);
    print_note("symplectic Euler", found.symplectic_euler);
    print_note("implicit Euler", found.implicit_euler);
    if (found.graph_inertia) print_note("graph inertia", *found.graph_inertia);
    std::printf("\n");

    const auto& k = found.spectrum;
    std::printf("Eigenvalues of K/M: k_min in [%.4g, %.4g], k_max in [%.6g, %.6g] 1/s^2\n",
                k.k_min.lower, k.k_min.upper, k.k_max.lower, k.k_max.upper);
    if (k.zero_modes) {
        std::printf("Zero modes (rigid motions and mechanisms): %lld\n",
                    static_cast<long long>(*k.zero_modes));
    }
    std::printf("Explicit Euler at h = %.4e s with d0 = %g 1/s: ", found.window_step, d0);
    if (found.window.empty != taut::EmptyWindow::none) {
        std::printf("no alpha is proved stable: %s\n", describe(found.window.empty));
    } else {
        std::printf("stable for alpha in (%.4e, %.4e) s\n", found.window.lower, found.window.upper);
    }
    if (found.proof) {
        std::printf("%s at h = %.9e s: %s\n", name(found.proof->method), found.proof->step,
                    found.proof->proved ? "proved stable" : "not proved");
    }
    if (!found.particles_to_blame.empty()) print_blame(found);
    if (found.remedies) print_remedies(*found.remedies);
    if (found.inertia) print_inertia(*found.inertia, found);
    std::printf("Seconds: setup %.3f, analysis %.3f\n", found.setup, found.analysis);
}

}  // namespace example
