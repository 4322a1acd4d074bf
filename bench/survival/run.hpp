// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <taut/recommend/recommend.hpp>
#include <taut/taut.hpp>
#include <type_traits>

#include "scenes.hpp"

namespace bench::survival {

enum class DampingKind { none, look_ahead, rayleigh, graph };

/// What damps, in shares of the step.
struct Damping {
    DampingKind kind = DampingKind::none;
    double share = 0;  // of the step: α/h, or how far springs look ahead

    std::string name() const {
        const auto print = [&](const char* before, const char* after) {
            char text[64];
            std::snprintf(text, sizeof text, "%s%gh%s", before, share, after);
            return std::string(text);
        };
        switch (kind) {
            case DampingKind::look_ahead: return print("springs look ", " ahead");
            case DampingKind::rayleigh: return print("α = ", " on K⁺");
            case DampingKind::graph: return print("α = ", " on L_k");
            default: return "no damping";
        }
    }
    template <class System>
    void set(System& system, double h) const {
        if (kind == DampingKind::rayleigh) system.set_rayleigh({0, share * h});
    }
    taut::StepDamping own() const {
        return {kind == DampingKind::look_ahead ? share : 0,
                kind == DampingKind::graph ? share : 0};
    }
};

/// One column of one table.
struct Setting {
    taut::Method method = taut::Method::symplectic_euler;
    double share = 0.5;  // of the any-pose limit without damping
    Damping damping;

    /// Whether the linearised step is stable at every pose (explicit Euler: at one where K = K⁺).
    bool is_linearly_stable() const {
        const double r = damping.share;
        if (method == taut::Method::explicit_euler) {
            return r > 1 && share * share * (2 * r - 1) <= 1;  // [T14]
        }
        return share * share * (1 + 2 * r) <= 1;  // [T23]
    }
};

enum class End { survived, swung, rose, blew_up };

/// What became of a run.
struct Run {
    End end = End::survived;
    double peak = 0;  // highest energy above the start, of the largest kinetic energy seen
    double late = 0;  // the same of the mean of the last ten looks
};

/// Looks at the energy every hundred steps.
template <class System>
class Watch {
public:
    static constexpr Index every = 100;
    static constexpr double tolerance = 0.01;
    static constexpr double explosion = 10;

    Watch(const System& system, const typename System::State& start)
        : system_(system),
          start_(system.energy(start)),
          kinetic_(system.kinetic_energy(start)),
          whole_(kinetic_ + system.potential_energy(start)) {
        const auto extent = (start.x.rowwise().maxCoeff() - start.x.rowwise().minCoeff()).norm();
        for (Index i = 0; i < system.size(); ++i) {
            if (system.is_pinned(i)) continue;
            const auto& g = system.gravity();
            whole_ += system.mass(i) * (g.dot(start.x.col(i)) + g.norm() * extent);
        }
    }
    /// @returns whether there is any more to see
    bool see(const typename System::State& state) {
        const double kinetic = system_.kinetic_energy(state);
        const double rise = kinetic + system_.potential_energy(state) - start_;
        if (!std::isfinite(rise)) return explode();
        kinetic_ = std::max(kinetic_, kinetic);
        highest_ = std::max(highest_, rise);
        last_[static_cast<std::size_t>(looks_++) % last_.size()] = rise;
        return rise > explosion * whole_ ? explode() : true;
    }
    /// @returns false
    bool explode() {
        exploded_ = true;
        return false;
    }
    Run result() const {
        if (exploded_) return {End::blew_up, INFINITY, INFINITY};
        double sum = 0;
        const auto count = std::min(static_cast<std::size_t>(looks_), last_.size());
        for (std::size_t i = 0; i < count; ++i) sum += last_[i];
        const double mean = count > 0 ? sum / static_cast<double>(count) : 0;
        Run run{End::survived, highest_ / kinetic_, mean / kinetic_};
        if (!(kinetic_ > 0)) run.peak = run.late = highest_ > 0 ? INFINITY : 0;
        if (run.peak > tolerance) run.end = run.late > tolerance ? End::rose : End::swung;
        return run;
    }

private:
    const System& system_;
    double start_;        // energy, J
    double kinetic_;      // largest, J
    double whole_;        // kinetic and elastic energy, and the weight times the extent, J
    double highest_ = 0;  // above the start, J
    Index looks_ = 0;
    std::array<double, 10> last_{};  // rises, J
    bool exploded_ = false;
};

template <class Stepper, class System>
Run run_with(const System& system, typename System::State state, const taut::StepDamping& damping,
             double h, Index steps) {
    Stepper stepper(system, taut::ExplicitOptions{1, damping});
    Watch<System> watch(system, state);
    for (Index done = 0; done < steps; done += Watch<System>::every) {
        const bool moved = bool(stepper.step(state, h, Watch<System>::every));
        if (!(moved ? watch.see(state) : watch.explode())) break;
    }
    return watch.result();
}

/// @param limit  any_pose_limit of the system without damping, s
template <class System>
Run run(System system, const typename System::State& start, const Setting& setting, double limit,
        Index steps) {
    const double h = setting.share * limit;
    setting.damping.set(system, h);
    const auto own = setting.damping.own();
    return taut::method::visit(setting.method, [&](auto descriptor) -> Run {
        using Descriptor = decltype(descriptor);
        if constexpr (Descriptor::is_implicit) {
            taut::fail("survival: ", Descriptor::name, " is not explicit");
        } else {
            using Stepper =
                typename taut::tradeoff_detail::StepperOf<Descriptor, System, void>::type;
            if constexpr (std::is_constructible_v<Stepper, const System&, taut::ExplicitOptions>) {
                return run_with<Stepper>(system, start, own, h, steps);
            } else {
                taut::fail("survival: ", Descriptor::name, " is not compared here");
            }
        }
    });
}

/// What became of the runs of one cell.
struct Tally {
    int runs = 0, swung = 0, rose = 0, blew_up = 0;
    double highest = 0;  // Run::peak, of runs that did not blow up

    void add(const Run& run) {
        ++runs;
        swung += run.end == End::swung;
        rose += run.end == End::rose;
        blew_up += run.end == End::blew_up;
        if (run.end != End::blew_up) highest = std::max(highest, run.peak);
    }
    void add(const Tally& other) {
        runs += other.runs;
        swung += other.swung;
        rose += other.rose;
        blew_up += other.blew_up;
        highest = std::max(highest, other.highest);
    }
    int failed() const { return rose + blew_up; }
};

}  // namespace bench::survival
