// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What a guard lets pass, what it takes back for nothing, and what it costs. Prints Markdown; exits
// with 1 if an accepted frame breaks the promise of Guarded's docstring. Arguments: seconds of each
// start and of each ordinary scene, and another share of the limit than the guard's own.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <taut/model/tension_only.hpp>
#include <taut/contact/contact.hpp>
#include <taut/taut.hpp>

#include "measure.hpp"

namespace {

using bench::Stopwatch;
using bench::Times;
using taut::Index;

constexpr double frame = 1.0 / 60;  // s

struct Random {
    std::mt19937_64 bits;
    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53;
    }
};

/// One mass of 1 kg on a pinned spring of 11.7 kN/m, anywhere, at any speed, in frames of 0.9 of
/// the limit: pressed through its pin, such a spring multiplies its energy under a bare step.
template <class Stepper, class Spring>
bool starts_row(const char* name, double damper, double seconds) {
    using Scalar = typename Spring::Scalar;
    Random random;
    int given_up = 0, above = 0, broken = 0;
    double highest = 0;
    Index frames = 0, retried = 0;
    for (int start = 0; start < 300; ++start) {
        Spring spring;
        spring.add_particle({0, 0}, 1);
        spring.add_particle({1, 0}, 1);
        spring.add_spring(0, 1, Scalar(11700), static_cast<Scalar>(damper));
        spring.pin(0);
        auto state = spring.initial_state();
        for (int d = 0; d < 2; ++d) {
            state.x(d, 1) = static_cast<Scalar>(random.uniform(-2, 2));
            state.v(d, 1) = static_cast<Scalar>(random.uniform(-100, 100));
        }
        taut::Guarded<Stepper> guard(spring);
        const Scalar h = Scalar(0.9) * taut::any_pose_limit(spring).certified;
        const auto first = static_cast<double>(spring.energy(state));
        double energy = first;
        double most = first;
        bool ok = true;
        for (double t = 0; ok && t < seconds; t += static_cast<double>(h)) {
            const auto report = guard.advance(state, h);
            ++frames;
            retried += report.retries > 0;
            ok = bool(report);
            if (!ok) break;
            energy = static_cast<double>(spring.energy(state));
            most = std::max(most, energy);
            const double rounding =
                1e3 * static_cast<double>(std::numeric_limits<Scalar>::epsilon());
            // Of the docstring; S is at most the largest energy so far.
            broken += energy > 3.5 * first + 2.4 * (0.01 + 0.003 * t + rounding) * most;
        }
        given_up += !ok;
        above += ok && energy > 4 * first;
        highest = std::max(highest, most / first);
    }
    std::printf("| %s | %g | %d | %d | %d | %.2f | %.2f %% |\n", name, damper, given_up, above,
                broken, highest,
                100.0 * static_cast<double>(retried) / static_cast<double>(frames));
    return broken == 0 && above == 0;
}

bool starts(double seconds) {
    using Double = taut::SpringSystem<double, 2>;
    using Float = taut::SpringSystem<float, 2>;
    std::printf(
        "## 300 starts of one mass on a pinned spring, %g s\n\n"
        "| stepper | damper, N s/m | given up | ended above 4 times their energy | frames beyond "
        "the "
        "promise | highest energy / start | frames retried |\n|---|---|---|---|---|---|---|\n",
        seconds);
    bool ok = true;
    for (const double damper : {0.0, 0.5}) {
        ok &= starts_row<taut::SymplecticEuler<Double>, Double>("symplectic, double", damper,
                                                                seconds);
        ok &= starts_row<taut::SymplecticEuler<Float>, Float>("symplectic, float", damper, seconds);
        ok &= starts_row<taut::VelocityVerlet<Double>, Double>("Verlet, double", damper, seconds);
        ok &= starts_row<taut::VelocityVerlet<Float>, Float>("Verlet, float", damper, seconds);
    }
    std::printf("\n");
    return ok;
}

/// What a row of ordinary scenes came to.
struct Tally {
    Index frames = 0, retried = 0, given_up = 0, scenes = 0;
};

/// Cloths of 8 × 8 to 32 × 32 particles: hung, dropped on a floor, waved, torn.
template <class Stepper, class Cloth>
void ordinary_scene(int kind, Index size, Random& random, double seconds, Tally& tally,
                    double safety) {
    using Scalar = typename Cloth::Scalar;
    using Law = typename Cloth::FirstLaw;
    taut::ClothOptions options;
    options.rows = options.columns = size;
    options.stretch = std::pow(10, random.uniform(2, 4));
    options.bend = options.stretch / 10;
    const auto plain = taut::hanging_cloth<Scalar>(options);
    Cloth cloth;
    const auto x = plain.initial_state().x;
    for (Index i = 0; i < plain.size(); ++i) cloth.add_particle(x.col(i), plain.mass(i));
    const auto& springs = plain.springs();
    for (Index s = 0; s < springs.size(); ++s) {
        const auto k = static_cast<std::size_t>(s);
        cloth.add_spring(taut::Spring<Scalar, Law>{
            springs.a[k], springs.b[k], {springs.parameters[k].stiffness}, springs.rest_length[k]});
    }
    cloth.set_gravity(plain.gravity());
    cloth.set_rayleigh({random.uniform(0, 1), 0});
    const Index corners[] = {0, size - 1};
    if (kind != 1) {
        for (const Index i : corners) cloth.pin(i);
    }
    typename taut::Guarded<Stepper>::Options guarded;
    if (safety > 0) guarded.safety = static_cast<Scalar>(safety);
    taut::Guarded<Stepper> guard(cloth, guarded);
    auto state = cloth.initial_state();
    const taut::HalfSpace<Scalar, 3> floor({0, 0, Scalar(-0.3)}, {0, 0, 1});
    const double rate = random.uniform(2, 8);
    const double reach = random.uniform(0.1, 1);
    ++tally.scenes;
    for (double t = 0; t < seconds; t += frame) {
        if (kind == 2) {
            for (const Index i : corners) {
                state.v(1, i) = static_cast<Scalar>(reach * rate * std::cos(rate * t));
                state.v(2, i) = static_cast<Scalar>(reach * rate * std::sin(2 * rate * t));
            }
        }
        if (kind == 3 && cloth.spring_count() > 0 && random.uniform(0, 1) < 0.2) {
            const auto from = static_cast<Index>(random.uniform(0, 1) * cloth.spring_count());
            cloth.remove_spring(from);
        }
        const auto report =
            kind == 1 ? guard.advance(state, static_cast<Scalar>(frame),
                                      [&](auto& s) {
                                          (void)taut::resolve_contacts(cloth, floor, s, {0.3, 0});
                                      })
                      : guard.advance(state, static_cast<Scalar>(frame));
        ++tally.frames;
        tally.retried += report.retries > 0;
        if (!report) {
            ++tally.given_up;
            break;
        }
    }
}

template <class Stepper, class Cloth>
void ordinary_row(const char* name, int scenes, double seconds, double safety) {
    const char* kinds[] = {"hung", "dropped", "waved", "torn"};
    for (int kind = 0; kind < 4; ++kind) {
        Random random;
        Tally tally;
        for (int scene = 0; scene < scenes / 4; ++scene) {
            const auto size = static_cast<Index>(random.uniform(8, 33));
            ordinary_scene<Stepper, Cloth>(kind, size, random, seconds, tally, safety);
        }
        std::printf("| %s | %s | %ld | %ld | %.3f %% |\n", name, kinds[kind],
                    static_cast<long>(tally.scenes), static_cast<long>(tally.given_up),
                    100.0 * static_cast<double>(tally.retried) / static_cast<double>(tally.frames));
        std::fflush(stdout);
    }
}

void ordinary(double seconds, double safety) {
    using Cloth = taut::SpringSystem<double, 3>;
    using Small = taut::SpringSystem<float, 3>;
    using Strings = taut::SpringSystem<double, 3, taut::TensionOnly>;
    std::printf(
        "## Ordinary scenes, cloths of 8 × 8 to 32 × 32, %g s each\n\n"
        "| stepper and law | scene | scenes | given up | frames retried |\n|---|---|---|---|---|\n",
        seconds);
    ordinary_row<taut::SymplecticEuler<Cloth>, Cloth>("symplectic, Hookean", 200, seconds, safety);
    ordinary_row<taut::SymplecticEuler<Small>, Small>("the same in float", 40, seconds, safety);
    ordinary_row<taut::VelocityVerlet<Cloth>, Cloth>("Verlet, Hookean", 40, seconds, safety);
    ordinary_row<taut::SymplecticEuler<Strings>, Strings>("symplectic, tension-only", 40, seconds,
                                                          safety);
    std::printf("\n");
}

/// What works on the scene while it is timed.
enum class Outside { nothing, force, pins, contacts };

/// A stepper without a guard, damped as the guard's own or not at all.
template <class Stepper, class System>
Stepper unguarded(const System& system, bool damped) {
    if constexpr (std::is_constructible_v<Stepper, const System&, taut::ExplicitOptions>) {
        return Stepper(system, {1, damped ? taut::recipe.damping : taut::StepDamping{}});
    } else {
        return Stepper(system);
    }
}

/// Frames by the bare stepper, by one damped as the guard's own, and by the guard, in turns, from
/// the same state.
template <class Stepper>
void cost_row(const char* name, Outside outside, Index size, int runs) {
    using Cloth = taut::SpringSystem<double, 3>;
    taut::ClothOptions options;
    options.rows = options.columns = size;
    auto cloth = taut::hanging_cloth<double>(options);
    if (outside == Outside::force) {
        cloth.set_external_force([](const auto&, auto& f) { f.row(0).array() += 1e-5; });
    }
    auto by_guard = cloth.initial_state();
    if (outside == Outside::pins) by_guard.v.col(0).setConstant(0.01);
    const taut::HalfSpace<double, 3> floor({0, 0, -0.1}, {0, 0, 1});
    const auto respond = [&](auto& s) { (void)taut::resolve_contacts(cloth, floor, s); };
    taut::Guarded<Stepper> guard(cloth);
    Stepper bare = unguarded<Stepper>(cloth, false);
    Stepper damped = unguarded<Stepper>(cloth, true);
    const auto guarded_frame = [&] {
        return outside == Outside::contacts ? guard.advance(by_guard, frame, respond)
                                            : guard.advance(by_guard, frame);
    };
    const auto first = guarded_frame();
    auto by_bare = by_guard;
    auto by_damped = by_guard;
    const auto unguarded_frame = [&](Stepper& stepper, auto& state) {
        if (outside != Outside::contacts) {
            return bool(stepper.step(state, first.h, first.substeps));
        }
        bool ok = true;
        for (Index i = 0; ok && i < first.substeps; ++i) {
            ok = bool(stepper.step(state, first.h));
            respond(state);
        }
        return ok;
    };
    Stopwatch watches[3] = {Stopwatch(bench::thread_time), Stopwatch(bench::thread_time),
                            Stopwatch(bench::thread_time)};
    bool ok = bool(first);
    for (int run = 0; run < runs; ++run) {
        watches[0].run([&] { ok = unguarded_frame(bare, by_bare) && ok; });
        watches[1].run([&] { ok = unguarded_frame(damped, by_damped) && ok; });
        watches[2].run([&] { ok = bool(guarded_frame()) && ok; });
    }
    if (!ok) std::printf("A STEP FAILED\n");
    const Times plain = watches[0].times(), own = watches[1].times(), guarded = watches[2].times();
    const auto more = [](double part, double whole) { return 100 * (part / whole - 1); };
    std::printf(
        "| %s | %ld × %ld | %ld | %.3f / %.3f | %+.1f %% / %+.1f %% | %+.1f %% / %+.1f %% |\n",
        name, static_cast<long>(size), static_cast<long>(size), static_cast<long>(first.substeps),
        plain.least, plain.median, more(own.least, plain.least), more(own.median, plain.median),
        more(guarded.least, own.least), more(guarded.median, own.median));
    std::fflush(stdout);
}

void costs() {
    using Cloth = taut::SpringSystem<double, 3>;
    using Symplectic = taut::SymplecticEuler<Cloth>;
    std::printf(
        "## The price: a frame of 1/60 s of the hanging cloth, processor time of the thread\n\n"
        "| stepper, from outside | cloth | substeps | bare, ms: least, median | damping, more | "
        "guard, more again |\n"
        "|---|---|---|---|---|---|\n");
    for (const Index size : {16, 32, 64, 100}) {
        const auto runs = static_cast<int>(6400 / size);
        cost_row<Symplectic>("symplectic, nothing", Outside::nothing, size, runs);
        cost_row<taut::VelocityVerlet<Cloth>>("Verlet, nothing", Outside::nothing, size, runs / 4);
        cost_row<Symplectic>("symplectic, a force", Outside::force, size, runs / 4);
        cost_row<Symplectic>("symplectic, a moving pin", Outside::pins, size, runs / 4);
        cost_row<Symplectic>("symplectic, contacts", Outside::contacts, size, runs / 4);
    }
    cost_row<taut::ImplicitEuler<Cloth>>("implicit, nothing", Outside::nothing, 32, 40);
    std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
    const bool ok = starts(argc > 1 ? std::atof(argv[1]) : 30);
    ordinary(argc > 2 ? std::atof(argv[2]) : 20, argc > 3 ? std::atof(argv[3]) : 0);
    costs();
    return ok ? 0 : 1;
}
