// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The largest safe time step of each integrator, and the feasible damping window, of a mesh, of a
// built-in scene, or of your own matrices.

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/main.hpp"
#include "common/matrix_market.hpp"
#include "common/scene.hpp"

namespace {

using taut::Method;
using Json = nlohmann::ordered_json;

struct Options {
    example::SceneOptions scene;
    std::string stiffness_matrix;
    std::string mass_matrix;
    std::string damping_matrix;
    double step = 0;  // s; 0: half the symplectic limit
    bool zero_modes = false;
    bool proof = false;     // narrow the brackets by factorisations
    bool any_pose = false;  // narrow the any-pose limit
    int blame = 0;          // springs and particles to name
    double want_step = 0;   // s; 0: none
    std::string json;
};

constexpr double proof_tightness = 1e-6;

/// What would make a wanted step safe.
struct Remedies {
    double step = 0;  // s
    bool safe_already = false;
    double stiffness_scale = 0;
    double mass_scale = 0;
    std::optional<taut::AddedMass> added_mass;
};

struct Findings {
    std::string name;
    taut::Index degrees_of_freedom = 0;
    std::optional<taut::Index> particles;
    std::optional<taut::Index> springs;
    taut::StiffnessSpectrum spectrum;
    taut::StepLimit<double> explicit_euler;
    taut::StepLimit<double> symplectic_euler;
    taut::StepLimit<double> implicit_euler;
    std::optional<taut::StepLimit<double>> any_pose;
    std::optional<taut::Certificate> proof;
    std::vector<taut::SpringShare> springs_to_blame;
    std::vector<taut::ParticleShare> particles_to_blame;
    std::optional<Remedies> remedies;
    double window_step = 0;  // s
    taut::AlphaWindow window;
    double setup = 0;     // s
    double analysis = 0;  // s
};

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void analyse(const taut::Stability<double>& stability, const Options& options, Findings& found) {
    found.degrees_of_freedom = stability.size();
    found.spectrum = stability.stiffness_spectrum(options.zero_modes);
    const double tightness = options.proof ? proof_tightness : 0;
    found.explicit_euler = stability.max_step(Method::explicit_euler, tightness);
    found.symplectic_euler = stability.max_step(Method::symplectic_euler, tightness);
    found.implicit_euler = stability.max_step(Method::implicit_euler, tightness);
    if (options.proof) {
        // The wanted step, or the largest that the bracket says can be had.
        const double h =
            options.want_step > 0 ? options.want_step : found.symplectic_euler.certified;
        if (h > 0 && std::isfinite(h)) found.proof = stability.certify(Method::symplectic_euler, h);
    }
    found.springs_to_blame = stability.limiting_springs(options.blame);
    found.particles_to_blame = stability.limiting_particles(options.blame);
    if (options.want_step > 0) {
        const double h = options.want_step;
        found.remedies = Remedies{h,
                                  stability.certify(Method::symplectic_euler, h).proved,
                                  stability.max_stiffness_scale(Method::symplectic_euler, h),
                                  stability.min_mass_scale(Method::symplectic_euler, h),
                                  {}};
    }
    found.window_step = options.step;
    if (found.window_step == 0) {
        const double limit = found.symplectic_euler.certified;
        found.window_step = limit > 0 && std::isfinite(limit) ? limit / 2 : 1.0 / 60;
    }
    found.window =
        stability.rayleigh_window(Method::explicit_euler, found.window_step, options.scene.d0);
}

Findings report_on_scene(const Options& options) {
    Findings found;
    const auto start = std::chrono::steady_clock::now();
    const auto scene = example::make_scene(options.scene);
    const auto state = scene.system.initial_state();
    found.setup = seconds_since(start);
    found.name = example::describe(scene);
    found.particles = scene.system.size();
    found.springs = scene.system.spring_count();
    const auto analysis = std::chrono::steady_clock::now();
    analyse(taut::Stability<double>(scene.system, state), options, found);
    found.any_pose =
        taut::any_pose_limit(scene.system, options.proof || options.any_pose ? proof_tightness : 0);
    if (found.remedies) {
        found.remedies->added_mass = taut::added_mass(scene.system, state, options.want_step);
    }
    found.analysis = seconds_since(analysis);
    return found;
}

Findings report_on_matrices(const Options& options) {
    Findings found;
    const auto start = std::chrono::steady_clock::now();
    const auto stiffness = example::read_matrix_market(options.stiffness_matrix);
    const auto mass = taut::diagonal_mass(example::read_matrix_market(options.mass_matrix));
    taut::SparseMatrix<double> damping;
    if (!options.damping_matrix.empty())
        damping = example::read_matrix_market(options.damping_matrix);
    const taut::LinearSystem<double> system(mass, damping, stiffness);
    found.setup = seconds_since(start);
    found.name = options.stiffness_matrix;
    const auto analysis = std::chrono::steady_clock::now();
    analyse(taut::Stability<double>(system), options, found);
    found.analysis = seconds_since(analysis);
    return found;
}

/// null: none is safe, or none is known to fail. "unbounded": every step is safe.
Json certified_json(const taut::StepLimit<double>& limit) {
    if (limit.unbounded()) return "unbounded";
    return limit.certified > 0 ? Json(limit.certified) : Json(nullptr);
}

Json limit_json(const taut::StepLimit<double>& limit) {
    return {{"certified", certified_json(limit)},
            {"refuted", std::isfinite(limit.refuted) ? Json(limit.refuted) : Json(nullptr)},
            {"cause", name(limit.cause)},
            {"growth_rate", limit.growth_rate},
            {"certified_up_to",
             limit.certified_up_to > 0 ? Json(limit.certified_up_to) : Json(nullptr)},
            {"admitted_growth", limit.admitted_growth}};
}

template <class T>
Json optional_json(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}

Json to_json(const Findings& found, double d0) {
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
    json["any_pose"] = {
        {"certified", found.any_pose ? certified_json(*found.any_pose) : Json(nullptr)}};
    json["rayleigh_window"] = {
        {"method", name(Method::explicit_euler)},
        {"h", found.window_step},
        {"d0", d0},
        {"lower", empty ? Json(nullptr) : Json(window.lower)},
        {"upper", empty || !std::isfinite(window.upper) ? Json(nullptr) : Json(window.upper)},
        {"empty", empty}};
    for (const auto& spring : found.springs_to_blame) {
        json["limiting_springs"].push_back(
            {{"index", spring.index}, {"a", spring.a}, {"b", spring.b}, {"share", spring.share}});
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
    }
    json["seconds"] = {{"setup", found.setup}, {"analysis", found.analysis}};
    return json;
}

std::string step_text(double h, const char* if_zero, const char* if_infinite) {
    if (h == 0) return if_zero;
    if (!std::isfinite(h)) return if_infinite;
    char text[32];
    std::snprintf(text, sizeof text, "%.4e s", h);
    return text;
}

void print_limit(const char* label, const taut::StepLimit<double>& limit) {
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

/// A sentence for every cause that a user can do something about.
void print_note(const char* label, const taut::StepLimit<double>& limit) {
    using taut::Cause;
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

void print_blame(const Findings& found) {
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

void print_remedies(const Remedies& remedies) {
    std::printf("For symplectic Euler at h = %.4e s in this pose", remedies.step);
    if (remedies.safe_already) {
        std::printf(": proved safe as the scene is\n");
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

void print_table(const Findings& found, double d0) {
    std::printf("%s, %lld degrees of freedom\n\n", found.name.c_str(),
                static_cast<long long>(found.degrees_of_freedom));
    std::printf("Largest stable time step\n  %-22s %-14s %-14s %7s  %s\n", "", "certified",
                "refuted", "ratio", "set by");
    print_limit("explicit Euler", found.explicit_euler);
    print_limit("symplectic Euler", found.symplectic_euler);
    print_limit("implicit Euler", found.implicit_euler);
    if (found.any_pose) print_limit("symplectic, any pose", *found.any_pose);
    std::printf(
        "  certified: proved stable at this pose, rounding included (any pose: while it moves)\n"
        "  refuted:   a vibration is known that grows at this step; the true limit lies between\n");
    print_note("explicit Euler", found.explicit_euler);
    print_note("symplectic Euler", found.symplectic_euler);
    print_note("implicit Euler", found.implicit_euler);
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
    std::printf("Seconds: setup %.3f, analysis %.3f\n", found.setup, found.analysis);
}

void write_json(const Json& json, const std::string& path) {
    if (path == "-") {
        std::printf("%s\n", json.dump(2).c_str());
        return;
    }
    // Beside the old file first, so that a failure leaves that one as it was.
    const std::string draft = path + ".part";
    std::ofstream file(draft);
    file << json.dump(2) << '\n';
    file.close();
    std::error_code failed;
    if (file) std::filesystem::rename(draft, path, failed);
    if (!file || failed) {
        std::filesystem::remove(draft, failed);
        throw std::runtime_error("--json: " + path + " cannot be written");
    }
}

int run(int argc, char** argv) {
    Options options;
    CLI::App app{
        "Largest safe time step of each integrator, with proof, and the feasible damping."};
    options.scene.add_to(app);
    auto* K = app.add_option("--stiffness-matrix", options.stiffness_matrix,
                             "K in Matrix Market form, N/m, instead of a scene");
    auto* M = app.add_option("--mass-matrix", options.mass_matrix, "M, diagonal, kg");
    app.add_option("--damping-matrix", options.damping_matrix, "D, N s/m")->needs(K);
    K->needs(M);
    M->needs(K);
    for (const char* other :
         {"MESH", "--scene", "--d0", "--alpha", "--pin", "--stretch", "--bend", "--mass"}) {
        K->excludes(app.get_option(other));
    }
    app.add_option("--step", options.step, "h of the damping window, s (default: half the limit)")
        ->check(example::positive());
    app.add_flag("--zero-modes", options.zero_modes, "count rigid motions and mechanisms");
    app.add_flag("--proof", options.proof, "narrow the limits to 1e-6 by proved factorisations");
    app.add_flag("--any-pose", options.any_pose, "narrow the limit of the moving scene likewise");
    app.add_option("--blame", options.blame, "name the N springs and particles that limit the step")
        ->check(CLI::Range(0, 1'000'000));
    app.add_option("--want-step", options.want_step, "say what would make step H, s, safe")
        ->check(example::positive());
    app.add_option("--json", options.json,
                   "write the findings as JSON (- is stdout, without table)");
    CLI11_PARSE(app, argc, argv)

    if (!options.scene.given() && options.stiffness_matrix.empty()) {
        throw std::runtime_error("name a mesh, --scene or --stiffness-matrix (see --help)");
    }
    const Findings found =
        options.stiffness_matrix.empty() ? report_on_scene(options) : report_on_matrices(options);
    if (options.json != "-") print_table(found, options.scene.d0);
    if (!options.json.empty()) write_json(to_json(found, options.scene.d0), options.json);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return example::guarded_main("stability_report", [&] { return run(argc, argv); });
}
