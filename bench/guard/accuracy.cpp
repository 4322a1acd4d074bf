// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <string>

#include "scenes.hpp"
#include "tables.hpp"

namespace guard_table {

namespace {

/// Half a second by steps of 1/count of a frame. @returns the end
template <class Stepper, class System>
typename System::State moved(const System& system, typename System::State state, Index count) {
    Stepper stepper(system);
    const double h = frame / static_cast<double>(count);
    for (int i = 0; i < 30; ++i) {
        if (!stepper.step(state, h, count)) std::printf("A STEP FAILED\n");
    }
    return state;
}

template <class System>
bool accuracy_rows(const char* law) {
    using State = typename System::State;
    using Verlet = taut::VelocityVerlet<System>;
    bool sound = true;
    for (const bool falls : {true, false}) {
        State state;
        System system;
        if (falls) {
            system = as<System>(square(32));
            state = system.initial_state();
        } else {
            system = hanging<System>(32, 0, state);
            for (Index i = 0; i < system.size(); ++i) {
                if (!system.is_pinned(i)) state.v(2, i) = 0.5 * std::sin(6 * state.x(1, i));
            }
        }
        taut::Guarded guard(system);
        State guarded = state;
        Tally tally;
        Index count = 0;
        for (int i = 0; i < 30; ++i) {
            const auto report = guard.advance(guarded, frame);
            sound = tally.add(report) && sound;
            count = report.substeps;
        }
        const double proved = taut::energy_limit(system).certified;
        const State truth = moved<Verlet>(system, state, 16 * count);
        const State finer = moved<Verlet>(system, state, 32 * count);
        const State bare = moved<Verlet>(system, state, count);
        const State stable = moved<taut::EnergyStableEuler<System>>(
            system, state, static_cast<Index>(std::ceil(frame / proved)));
        const auto error = [&](const State& end) {
            return 1e3 * std::sqrt((end.x - truth.x).colwise().squaredNorm().mean());
        };
        std::printf("| %s, %s | %.1f | %.4g | %.4g | %.4g | %.4g | %.2f | %.1f |\n", law,
                    falls ? "let go" : "hanging, waves of 0.5 m/s",
                    percent(tally.trimmed, tally.frames), error(guarded), error(bare),
                    error(stable), error(finer), error(guarded) / error(bare),
                    error(stable) / error(bare));
        std::fflush(stdout);
    }
    return sound;
}

constexpr const char* codes[] = {"drag, hc/m = 3", "spring, h²k/m = 3", "wall below 0, h²k/m = 30",
                                 "drag, hc/m = 3e5", "wind, hc/m = 30"};

template <class System>
bool code_rows(const char* law) {
    bool sound = true;
    for (int kind = 0; kind < 5; ++kind) {
        System system = as<System>(square(8));
        const double h = 0.95 * taut::any_pose_limit(system).certified;
        const double m = system.mass(9);
        system.set_external_force([=](const auto& s, auto& f) {
            if (kind == 0) f -= 3 * m / h * s.v;
            if (kind == 1) f -= 3 * m / (h * h) * s.x;
            if (kind == 2) f.row(2) -= 30 * m / (h * h) * s.x.row(2).cwiseMin(0.0);
            if (kind == 3) f -= 3e5 * m / h * s.v;
            if (kind == 4) f -= 30 * m / h * (s.v.colwise() - Eigen::Vector3d(10, 5, 0));
        });
        auto state = system.initial_state();
        taut::Guarded guard(system);
        Tally tally;
        Index named = 0;
        double fastest = 0, widest = 0;
        for (int i = 0; i < 600; ++i) {
            const auto report = guard.advance(state, frame);
            if (!tally.add(report)) break;
            named += report.force != nullptr;
            fastest = std::max(fastest, state.v.colwise().norm().maxCoeff());
            widest =
                std::max(widest, (state.x.colwise() - state.x.col(0)).colwise().norm().maxCoeff());
        }
        // Springs of 3m/h² hold so much energy.
        const double most = kind == 1 ? 3 / h : 1000;
        const bool exploded = !state.finite() || fastest > most || widest > 14;
        std::printf("| %s, %s | %s | %ld | %ld | %ld | %ld | %.3g | %.3g |\n", law, codes[kind],
                    exploded ? "yes" : "no", count(tally.refused), count(tally.again),
                    count(tally.frozen), count(named), fastest, widest);
        std::fflush(stdout);
        sound = sound && !exploded && tally.sound() && named > 0 && named >= tally.frozen;
    }
    return sound;
}

}  // namespace

bool accuracy() {
    std::printf(
        "## f. A cloth of 32 × 32 after 0.5 s: root mean square error, mm\n\n"
        "Beside velocity Verlet at a sixteenth of the step; EnergyStableEuler at its own limit.\n\n"
        "| scene | frames trimmed, %% | guard | bare Verlet | EnergyStableEuler | Verlet at a 32nd "
        "| guard / bare | EnergyStableEuler / bare |\n|---|---|---|---|---|---|---|---|\n");
    const bool hookean = accuracy_rows<Cloth>("Hookean");
    const bool strings = accuracy_rows<Strings>("tension-only");
    std::printf("\n");
    return hookean && strings;
}

bool stiff_codes() {
    std::printf(
        "## g. Stiff forces given as code: a cloth of 8 × 8, 10 s at 60 Hz\n\n"
        "h: the step of the trial.\n\n"
        "| scene | exploded | refused | frames taken again | frozen | named | fastest, m/s | "
        "widest, m |\n|---|---|---|---|---|---|---|---|\n");
    const bool hookean = code_rows<Cloth>("Hookean");
    const bool strings = code_rows<Strings>("tension-only");
    std::printf("\n");
    return hookean && strings;
}

}  // namespace guard_table
