// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <taut/proof/rayleigh.hpp>

#include "scenes.hpp"
#include "tables.hpp"

namespace guard_table {

namespace {

const char* name_of(Motion motion) {
    const char* names[] = {"let go", "thrown", "at rest", "driven", "jerked"};
    return names[static_cast<int>(motion)];
}

struct Row {
    Tally tally;
    double lost = 0;     ///< beyond work, in the largest kinetic energy
    bool moved = false;  ///< there was some
};

template <class System>
Row two_seconds(const System& system, typename System::State state, Motion motion) {
    taut::Guarded guard(system);
    if (motion == Motion::thrown) throw_free(system, state);
    Row row;
    const auto part = guard_books::parts_of(system);
    auto books = guard_books::books_of(system, state, part);
    guard_books::Promise promise(unit_of<typename System::Scalar>(), books);
    const auto start = books;
    double work = 0;
    auto most = books.moving;
    for (int i = 0; i < 120; ++i) {
        drive(system, state, motion, i * frame);
        const auto report = guard.advance(state, frame);
        if (!row.tally.add(report)) break;
        work += report.work;
        books = guard_books::books_of(system, state, part);
        row.tally.broken += !promise.keeps(books, report);
        most = std::max(most, books.moving);
    }
    row.moved = most > 1e-6 * books.size;
    row.lost = static_cast<double>((start.energy + work - books.energy) / most);
    return row;
}

void print(const char* law, const char* scene, const Row& row) {
    const Tally& t = row.tally;
    std::printf("| %s, %s | %ld | %ld | %ld | %ld | ", law, scene,
                count(t.frames - t.trimmed - t.again - t.frozen - t.refused), count(t.trimmed),
                count(t.again), count(t.frozen));
    if (row.moved) {
        std::printf("%.2f |\n", 100 * row.lost);
    } else {
        std::printf("– |\n");
    }
    std::fflush(stdout);
}

struct Sum {
    Tally tally;
    double lost = 0;
    int scenes = 0;
    void add(const Row& row) {
        tally += row.tally;
        if (!row.moved) return;
        lost += row.lost;
        ++scenes;
    }
};

template <class System>
void rows(const char* law, Sum& sum) {
    const auto one = [&](const char* scene, const Row& row) {
        print(law, scene, row);
        sum.add(row);
    };
    Index side = 16;
    for (const Motion motion :
         {Motion::let_go, Motion::thrown, Motion::at_rest, Motion::driven, Motion::jerked}) {
        typename System::State state;
        System system;
        if (motion == Motion::at_rest) {
            system = hanging<System>(side, 0, state);
        } else {
            system = as<System>(square(side, motion != Motion::thrown));
            state = system.initial_state();
        }
        char scene[64];
        std::snprintf(scene, sizeof scene, "cloth %ld × %ld, %s", count(side), count(side),
                      name_of(motion));
        one(scene, two_seconds(system, state, motion));
        side += 4;
    }
    const auto line = as<System>(rope(40, 0.5));
    one("rope with a weight, let go", two_seconds(line, line.initial_state(), Motion::let_go));
    const auto net = as<System>(irregular(100, true));
    one("irregular net, driven", two_seconds(net, net.initial_state(), Motion::driven));
    const auto thrown = as<System>(irregular(100, false));
    one("irregular net, thrown", two_seconds(thrown, thrown.initial_state(), Motion::thrown));
}

template <class System>
bool damped_rows(const char* law) {
    bool sound = true;
    const Cloth plain = square(28);
    const double undamped = taut::energy_limit(as<System>(plain)).certified;
    // A strip along the height: its links, two diagonals at 45° and two bends carry 2.4 stretch.
    const double m = plain.mass(30), links = 27;
    const double omega = 3.14159265 / 2 * std::sqrt(2.4 * 1000 / m) / links;
    for (const auto& [drag, share] :
         {std::pair{0.0, 0.0}, {1.0, 0.0}, {0.0, 0.1}, {1.0, 0.1}, {1.0, 0.4}}) {
        const taut::RayleighDamping damping{drag, share * undamped};
        for (const Motion motion : {Motion::driven, Motion::jerked}) {
            auto system = as<System>(plain);
            system.set_rayleigh(damping);
            const Row row = two_seconds(system, system.initial_state(), motion);
            sound = sound && row.tally.sound();
            std::printf("| %s, %s | %g | %g | %.4f | %.1f | %.1f | %.3f |\n", law, name_of(motion),
                        drag, share, taut::damping_ratio(damping, omega),
                        percent(row.tally.trimmed, row.tally.frames),
                        percent(row.tally.again, row.tally.frames),
                        taut::energy_limit(system).certified / undamped);
            std::fflush(stdout);
        }
    }
    return sound;
}

}  // namespace

bool ordinary() {
    std::printf(
        "## a. 16 undamped scenes, 2 s each at 60 Hz\n\n"
        "| scene | tried | trimmed | taken again | frozen | lost beyond work, %% of the largest "
        "kinetic energy |\n|---|---|---|---|---|---|\n");
    Sum sum;
    rows<Cloth>("Hookean", sum);
    rows<Strings>("tension-only", sum);
    const Tally& t = sum.tally;
    std::printf(
        "\n%ld frames: %.1f %% trimmed, %.2f %% taken again, %ld frozen, %ld refused, %ld break "
        "the promise; lost, mean of the scenes that move: %.2f %%.\n\n",
        count(t.frames), percent(t.trimmed, t.frames), percent(t.again, t.frames), count(t.frozen),
        count(t.refused), count(t.broken), 100 * sum.lost / sum.scenes);
    return t.sound();
}

bool damped() {
    std::printf(
        "## e. A driven cloth of 28 × 28 with damping, 2 s at 60 Hz\n\n"
        "ζ: damping ratio of its first stretch along the height. Step: energy_limit beside "
        "undamped.\n\n"
        "| law, motion | drag, 1/s | α, undamped steps | ζ | frames trimmed, %% | taken again, %% "
        "| step |\n|---|---|---|---|---|---|---|\n");
    const bool hookean = damped_rows<Cloth>("Hookean");
    const bool strings = damped_rows<Strings>("tension-only");
    std::printf("\n");
    return hookean && strings;
}

}  // namespace guard_table
