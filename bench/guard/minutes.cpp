// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include <taut/network/tension_only.hpp>

#include "scenes.hpp"
#include "tables.hpp"

namespace guard_table {

namespace {

template <class System>
bool minute(const char* law, Index side) {
    const auto system = as<System>(square(side));
    const auto part = guard_books::parts_of(system);
    auto state = system.initial_state();
    const auto start = guard_books::books_of(system, state, part);
    auto books = start, most = start;
    guard_books::Promise promise(unit_of<double>(), start);
    taut::Guarded guard(system);
    Tally tally;
    for (int i = 0; i < 3600; ++i) {
        const auto report = guard.advance(state, frame);
        if (!tally.add(report)) break;
        books = guard_books::books_of(system, state, part);
        tally.broken += !promise.keeps(books, report);
        most.moving = std::max(most.moving, books.moving);
    }
    std::printf("| %s, %ld × %ld | %+.2f | %.1f | %.2f |\n", law, count(side), count(side),
                static_cast<double>(100 * (books.energy - start.energy) / most.moving),
                percent(tally.trimmed, tally.frames), percent(tally.again, tally.frames));
    std::fflush(stdout);
    return tally.sound();
}

/// A free net that turns about the axis across it.
template <class System>
bool spin(const char* law) {
    const auto system = as<System>(square(16, false));
    auto state = system.initial_state();
    const Eigen::Vector3d centre = state.x.rowwise().mean();
    const Eigen::Vector3d axis(0.3, 0.5, 4);  // 1/s
    const auto momentum = [&] {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (Index i = 0; i < system.size(); ++i) {
            const Eigen::Vector3d r = state.x.col(i) - centre, v = state.v.col(i);
            sum += system.mass(i) * r.cross(v);
        }
        return sum;
    };
    for (Index i = 0; i < system.size(); ++i) {
        state.v.col(i) = axis.cross(Eigen::Vector3d(state.x.col(i) - centre));
    }
    const Eigen::Vector3d begun = momentum();
    const double energy = system.energy(state);
    taut::Guarded guard(system);
    Tally tally;
    for (int i = 0; i < 3600; ++i) {
        if (!tally.add(guard.advance(state, frame))) break;
    }
    std::printf("| %s | %.6f | %.4f | %.1f | %.2f |\n", law,
                momentum().dot(begun) / begun.squaredNorm(), system.energy(state) / energy,
                percent(tally.trimmed, tally.frames), percent(tally.again, tally.frames));
    return tally.sound();
}

template <class System>
bool rest_row(const char* law, double offset) {
    typename System::State state;
    const System system = hanging<System>(16, offset, state);
    const auto part = guard_books::parts_of(system);
    const auto start = guard_books::books_of(system, state, part);
    auto books = start;
    guard_books::Promise promise(unit_of<float>(), start);
    taut::Guarded guard(system);
    Tally tally;
    double fastest = 0, rounding = 0;
    for (int i = 0; i < 3600; ++i) {
        const auto report = guard.advance(state, static_cast<float>(frame));
        if (!tally.add(report)) break;
        books = guard_books::books_of(system, state, part);
        tally.broken += !promise.keeps(books, report);
        rounding = std::max(rounding, report.slack);
        fastest = std::max(fastest, static_cast<double>(state.v.colwise().norm().maxCoeff()));
    }
    std::printf("| %s | %g | %.2f | %.2f | %.0f | %.2g | %.2g | %.2g |\n", law, offset,
                percent(tally.trimmed, tally.frames), percent(tally.again, tally.frames),
                percent(tally.blind, tally.frames), fastest,
                static_cast<double>(books.energy - start.energy), rounding);
    std::fflush(stdout);
    return tally.sound();
}

}  // namespace

bool minutes() {
    std::printf(
        "## c. An undamped minute at 60 Hz\n\n"
        "| cloth | energy, %% of the largest kinetic | frames trimmed, %% | taken again, %% |\n"
        "|---|---|---|---|\n");
    bool sound = true;
    for (const Index side : {10, 16, 32}) {
        sound &= minute<Cloth>("Hookean", side);
        sound &= minute<Strings>("tension-only", side);
    }
    std::printf(
        "\n| free net of 16 × 16 that turns | angular momentum, end / start | energy, end / start "
        "| frames trimmed, %% | taken again, %% |\n|---|---|---|---|---|\n");
    sound &= spin<Cloth>("Hookean");
    sound &= spin<Strings>("tension-only");
    std::printf("\n");
    return sound;
}

bool at_rest() {
    std::printf(
        "## d. A cloth of 16 × 16 at rest, in float, a minute at 60 Hz\n\n"
        "| law | from the origin, m along every axis | frames trimmed, %% | taken again, %% | "
        "blind, %% | fastest, m/s | energy gained, J | largest ρ, J "
        "|\n|---|---|---|---|---|---|---|---|\n");
    bool sound = true;
    for (const double offset : {0.0, 10.0, 100.0}) {
        sound &= rest_row<taut::SpringSystem<float, 3>>("Hookean", offset);
        sound &= rest_row<taut::SpringSystem<float, 3, taut::TensionOnly>>("tension-only", offset);
    }
    std::printf("\n");
    return sound;
}

}  // namespace guard_table
