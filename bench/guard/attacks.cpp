// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <taut/network/tension_only.hpp>

#include "../measure.hpp"
#include "scenes.hpp"
#include "tables.hpp"

namespace guard_table {

namespace {

enum class Attack { thrown, jerked, light_and_heavy, torn };

constexpr Index frames_a_scene = 125;
constexpr int scenes_a_row = 25;

/// Two nets, with masses of `second` times those of the first, side by side.
Cloth pair_of(Index side, double second) {
    const Cloth one = square(side, false);
    Cloth both;
    const auto x = one.initial_state().x;
    for (const double factor : {1.0, second}) {
        for (Index i = 0; i < one.size(); ++i) {
            const Eigen::Vector3d shift(factor == 1 ? 0 : 1.2, 0, 0);
            both.add_particle(x.col(i) + shift, factor * one.mass(i));
        }
    }
    for (const Index first : {Index(0), one.size()}) {
        one.visit_springs([&](const auto& s) {
            both.add_spring(first + s.a, first + s.b, s.parameters.stiffness);
        });
    }
    both.set_gravity({0, 0, -9.81});
    return both;
}

template <class System>
struct Scene {
    using Scalar = typename System::Scalar;
    Attack attack;
    System system;
    typename System::State state;
    Random& random;

    Scene(Attack kind, double offset, Random& draw) : attack(kind), random(draw) {
        const auto side = static_cast<Index>(random.uniform(4, 9));
        Cloth plain = attack == Attack::thrown            ? square(side, false)
                      : attack == Attack::jerked          ? square(side)
                      : attack == Attack::light_and_heavy ? pair_of(side, 1e6)
                                                          : pair_of(side, 1);
        if (attack == Attack::light_and_heavy) {
            for (Index i = 0; i < plain.size(); ++i) {
                plain.set_mass(i, 2 * i < plain.size() ? 1e-3 : 1e3);
            }
            join(plain);
        }
        system = as<System>(plain, offset);
        state = system.initial_state();
        const double speed = attack == Attack::jerked ? 1 : std::exp(random.uniform(0, 4.6));
        for (Index i = 0; i < system.size(); ++i) {
            if (system.is_pinned(i)) continue;
            for (int d = 0; d < 3; ++d) {
                state.v(d, i) = static_cast<Scalar>(random.uniform(-speed, speed));
            }
        }
    }
    /// Between two frames. @returns whether anything but pins was touched
    bool edit(Index i) {
        if (attack == Attack::jerked) {
            // A corner is 0.5 m away after two frames, and back after two more.
            const double speed = i / 2 % 2 == 0 ? 15 : -15;
            for (Index p = 0; p < system.size(); ++p) {
                if (!system.is_pinned(p)) continue;
                state.v.col(p).setZero();
                state.v((p + i / 8) % 3, p) = static_cast<Scalar>(speed);
            }
            return false;
        }
        if (attack != Attack::torn || random.uniform(0, 1) > 0.3) return false;
        if (random.uniform(0, 1) < 0.5) {
            join(system);
        } else {
            for (int k = 0; k < 8 && system.spring_count() > 0; ++k) {
                const double which = random.uniform(0, 1);
                system.remove_spring(
                    static_cast<Index>(which * static_cast<double>(system.spring_count())));
            }
        }
        return true;
    }
    /// Joins a particle of each half.
    template <class Net>
    void join(Net& net) {
        const auto half = static_cast<double>(net.size() / 2);
        const auto a = static_cast<Index>(random.uniform(0, half));
        const auto b = static_cast<Index>(random.uniform(half, 2 * half));
        net.add_spring(taut::Spring<typename Net::Scalar, typename Net::FirstLaw>{
            a, b, {typename Net::Scalar(1000)}, typename Net::Scalar(0.3)});
    }
};

struct Row {
    Tally tally;
    double guarded = 0, bare = 0;  // ms
};

template <class System>
void one_scene(Scene<System> scene, Row& row) {
    using Scalar = typename System::Scalar;
    taut::Guarded guard(scene.system);
    taut::VelocityVerlet<System> verlet(scene.system);
    auto bare = scene.state;
    auto part = guard_books::parts_of(scene.system);
    auto books = guard_books::books_of(scene.system, scene.state, part);
    guard_books::Promise promise(unit_of<Scalar>(), books);
    for (Index i = 0; i < frames_a_scene; ++i) {
        if (scene.edit(i)) {
            part = guard_books::parts_of(scene.system);
            const auto edited = guard_books::books_of(scene.system, scene.state, part);
            promise.edit(books, edited);
        }
        for (Index p = 0; p < scene.system.size(); ++p) {
            if (scene.system.is_pinned(p)) bare.v.col(p) = scene.state.v.col(p);
        }
        const double start = bench::now(bench::thread_time);
        const auto report = guard.advance(scene.state, static_cast<Scalar>(frame));
        const double middle = bench::now(bench::thread_time);
        const bool fine = report.substeps > 0 && verlet.step(bare, report.h, report.substeps);
        const double end = bench::now(bench::thread_time);
        if (!row.tally.add(report)) return;
        if (fine && i > 0) {  // the first asks for the limits
            row.guarded += middle - start;
            row.bare += end - middle;
        }
        if (!fine || !(bare.v.norm() < 1e4)) bare = scene.state;
        books = guard_books::books_of(scene.system, scene.state, part);
        const bool kept = promise.keeps(books, report);
        row.tally.broken += !kept;
        if (!kept && row.tally.broken == 1) {
            std::fprintf(stderr,
                         "broken: frame %ld, %ld particles, taken %d, by %.3Lg J of %.3Lg\n",
                         count(i), count(scene.system.size()), static_cast<int>(report.taken),
                         promise.over(), books.size);
        }
    }
}

struct All {
    Tally tally;
    double guarded = 0, bare = 0;
};

template <class System>
void rows(const char* law, double offset, All& all) {
    const char* names[] = {"thrown", "corners jerked", "light beside heavy", "joined and torn"};
    for (const Attack attack :
         {Attack::thrown, Attack::jerked, Attack::light_and_heavy, Attack::torn}) {
        Random random;
        Row row;
        for (int i = 0; i < scenes_a_row; ++i) {
            one_scene(Scene<System>(attack, offset, random), row);
        }
        const Tally& t = row.tally;
        std::printf("| %s, %s | %g | %ld | %ld | %ld | %ld | %.1f | %.1f | %.2f |\n",
                    names[static_cast<int>(attack)], law, offset, count(t.frames), count(t.refused),
                    count(t.broken), count(t.frozen), percent(t.trimmed, t.frames),
                    percent(t.again, t.frames), row.guarded / row.bare);
        std::fflush(stdout);
        all.tally += t;
        all.guarded += row.guarded;
        all.bare += row.bare;
    }
}

}  // namespace

bool attacks() {
    std::printf(
        "## b. Violent scenes of 16 to 128 particles\n\n"
        "Time: of the guard beside bare velocity Verlet at the same step, in turns, without the "
        "frame that asks for the limits.\n\n"
        "| scene | from the origin, m | frames | refused | broken | frozen | trimmed, %% | taken "
        "again, %% | time |\n|---|---|---|---|---|---|---|---|---|\n");
    All all;
    rows<Cloth>("Hookean", 0, all);
    rows<Strings>("tension-only", 0, all);
    for (const double offset : {0.0, 10.0, 100.0}) {
        rows<taut::SpringSystem<float, 3>>("Hookean, float", offset, all);
        rows<taut::SpringSystem<float, 3, taut::TensionOnly>>("tension-only, float", offset, all);
    }
    const Tally& t = all.tally;
    std::printf("\n%ld frames: %ld refused, %ld broken, %ld frozen; time %.2f.\n\n",
                count(t.frames), count(t.refused), count(t.broken), count(t.frozen),
                all.guarded / all.bare);
    return t.sound() && t.frozen == 0;
}

}  // namespace guard_table
