// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <taut/conditions/visit.hpp>
#include <taut/proof/any_pose.hpp>
#include <taut/proof/energy_limit.hpp>
#include <taut/proof/stability.hpp>
#include <taut/proof/bracket.hpp>
#include <vector>

#include "../examples/common/kick.hpp"
#include "lab.hpp"
#include "scene.hpp"

namespace {

using taut::Method;

struct Limits {
    taut::StepLimit<double> any_pose, energy_stable;
    std::optional<taut::Stability<double>> stability;
    std::array<std::optional<taut::StepLimit<double>>, int(Method::last) + 1> at_pose;
    LabMode mode{};
    taut::Points<double, 3> kick;
    std::vector<int> blamed;
    std::vector<double> shares;
};

Limits found;
LabLimits answer{};
std::array<double, 2> window{};

/// The limit at any pose: linearised, but of energy-stable Euler as proved. Explicit Euler has
/// none, implicit steps no need of one.
double any_pose(Method method) {
    using taut::method::AnyPose;
    const AnyPose safe = taut::method::any_pose(method);
    if (safe == AnyPose::limited) return found.any_pose.certified;
    if (safe == AnyPose::proved) return found.energy_stable.certified;
    return safe == AnyPose::every_step ? std::numeric_limits<double>::infinity() : 0;
}

const taut::StepLimit<double>& at_pose(int method) {
    auto& limit = found.at_pose[std::size_t(method)];
    if (!limit) limit = taut::bracket(*found.stability, static_cast<Method>(method));
    return *limit;
}

/// The step above which this vibration grows by energy-stable Euler, which is symplectic Euler with
/// D + hK⁺ in the linear [T42]. No smaller one is refuted, and none at this pose alone is
/// certified.
double refuted_energy_stable(const Eigen::VectorXd& shape) {
    using namespace taut::matrices;
    if (shape.size() == 0) return std::numeric_limits<double>::infinity();
    const auto& pencil = found.stability->pencil();
    const double m = pencil.quadratic(M, shape).upper();
    const double k = pencil.quadratic(2 * K_plus + K, shape).lower() / m;
    const double d = std::max(0.0, pencil.quadratic(D, shape).lower() / m);
    return taut::critical_step(Method::symplectic_euler, k, d);
}

/// Of a large mesh a rougher shape must do: the fine one takes ten times as long, and differs by
/// less than can be seen.
taut::Mode limiting_mode() {
    constexpr taut::Index large = 15'000;  // particles
    const auto& cloth = lab::scene().cloth;
    if (cloth.size() <= large) return taut::limiting_mode(*found.stability);
    taut::LanczosOptions options;
    options.tolerance = 3e-3;
    const auto pair =
        taut::largest_ritz_pair(found.stability->pencil(), taut::matrices::K_plus, options);
    const auto rayleigh = cloth.rayleigh();
    const double d = rayleigh.mass_proportional + rayleigh.stiffness_proportional * pair.value;
    return {pair.value, d, pair.vector};
}

void take_kick(const taut::Mode& mode) {
    const auto& limit = at_pose(static_cast<int>(Method::symplectic_euler));
    const bool bounded = limit.certified > 0 && std::isfinite(limit.refuted);
    if (!bounded || mode.shape.size() == 0) return;
    const auto kick = example::kick_along(lab::scene().cloth, lab::scene().edge, limit, mode);
    found.kick = kick.shape;
    found.mode.kick = kick.size;
    found.mode.speed = kick.speed;
    found.mode.steps = static_cast<double>(kick.steps);
}

void take_blamed(const taut::Mode& mode) {
    constexpr double least = 1e-3;  // of what the foremost holds
    found.blamed.clear();
    found.shares.clear();
    if (mode.shape.size() == 0) return;
    auto shares = found.stability->pencil().spring_shares(mode.shape);
    std::sort(shares.begin(), shares.end(),
              [](const auto& p, const auto& q) { return p.share > q.share; });
    for (const auto& spring : shares) {
        if (!(spring.share >= least * shares.front().share)) break;
        found.blamed.insert(found.blamed.end(),
                            {static_cast<int>(spring.a), static_cast<int>(spring.b)});
        found.shares.push_back(spring.share);
    }
}

}  // namespace

void lab::forget_limits() { found = {}; }

void lab_analyse_any_pose() {
    found.any_pose = taut::any_pose_bracket(lab::scene().cloth);
    found.energy_stable = taut::energy_bracket(lab::scene().cloth);
}

void lab_analyse_pose() {
    const auto& cloth = lab::scene().cloth;
    // Pins change the size of what the search began at.
    found.stability.emplace(cloth, cloth.initial_state());
    found.at_pose = {};
    for (int method = 0; method <= static_cast<int>(Method::last); ++method) {
        if (!taut::method::is_limited_by<taut::method::Absent>(Method(method))) at_pose(method);
    }
}

void lab_analyse_mode() {
    const auto mode = limiting_mode();
    const auto& pencil = found.stability->pencil();
    found.mode = {};
    found.kick.setZero(3, lab::scene().cloth.size());
    if (found.stability->size() > 0) {
        found.mode.k = mode.k;
        found.mode.d = mode.d;
        found.mode.k_max = std::max(0.0, pencil.upper_bound(taut::matrices::K_plus));
        found.mode.compression = pencil.compression();
        take_kick(mode);
    }
    take_blamed(mode);
    auto& proved = found.at_pose[std::size_t(Method::energy_stable_euler)];
    proved = found.energy_stable;
    proved->refuted = refuted_energy_stable(mode.shape);
}

const LabLimits* lab_limits(int method) {
    const auto& limit = at_pose(method);
    answer = {any_pose(static_cast<Method>(method)), limit.certified, limit.refuted};
    return &answer;
}
const char* lab_cause(int method) { return taut::describe(at_pose(method).cause); }

const LabMode* lab_mode() { return &found.mode; }
const double* lab_kick() { return found.kick.data(); }
const int* lab_blamed() { return found.blamed.data(); }
int lab_blamed_count() { return static_cast<int>(found.shares.size()); }
const double* lab_shares() { return found.shares.data(); }

double lab_growth(int method, double k, double d, double h) {
    return taut::spectral_radius(static_cast<Method>(method), k, d, h);
}

const double* lab_window(double h, double drag, double k_max, double compression) {
    window = {0, 0};
    if (!std::isfinite(k_max) || !std::isfinite(compression)) return window.data();
    const auto found_window =
        taut::rayleigh_window(Method::explicit_euler, h, drag, 0, k_max, compression);
    if (found_window.empty == taut::EmptyWindow::none) {
        window = {found_window.includes_zero ? -1 : found_window.lower, found_window.upper};
    }
    return window.data();
}
