// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// The numbers behind the figures of docs/systems: one CSV file a figure, written into the folder
// given by --csv. scripts/systems_figures.py draws them. Nothing is timed: one
// build gives the same files at every run.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <taut/bdf2/bdf2.hpp>
#include <taut/contact/contact.hpp>
#include <taut/guard/guard.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/modal/modal_analysis.hpp>
#include <taut/modal/modal_dynamics.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/projective/projective.hpp>
#include <taut/taut.hpp>
#include <taut/network/buckling.hpp>
#include <taut/network/tension_only.hpp>
#include <utility>

#include "hanging_net.hpp"

namespace {

using taut::Index;
using Cloth = taut::SpringSystem<double, 3>;

/// A CSV file under construction; exits when it cannot be written.
class Table {
public:
    Table(const std::string& folder, const char* name, const char* header)
        : path_(folder + "/" + name), file_(std::fopen(path_.c_str(), "w")) {
        if (file_ == nullptr) give_up();
        std::fprintf(file_, "%s\n", header);
    }
    ~Table() {
        if (std::fclose(file_) != 0) give_up();
        std::printf("%s\n", path_.c_str());
    }
    Table(const Table&) = delete;
    Table& operator=(const Table&) = delete;

    template <class... Values>
    void row(const char* format, Values... values) {
        if (std::fprintf(file_, format, values...) < 0) give_up();
    }

private:
    [[noreturn]] void give_up() const {
        std::fprintf(stderr, "systems_figures: %s cannot be written\n", path_.c_str());
        std::exit(1);
    }

    std::string path_;
    std::FILE* file_;
};

/// The height of a hanging cloth's free edge, of 16 × 16 particles.
template <class Stepper>
void fall(Table& table, const char* name, double h, double duration) {
    const auto cloth = taut::hanging_cloth<double>({16, 16});
    auto state = cloth.initial_state();
    Stepper stepper(cloth);
    const auto steps = static_cast<int>(std::round(duration / h));
    const int every = std::max(1, static_cast<int>(1.0 / 120 / h));
    for (int i = 0; i <= steps; ++i) {
        if (i > 0 && !stepper.step(state, h)) return;
        if (i % every != 0) continue;
        const double lowest = state.x.row(2).minCoeff();
        if (!(std::abs(lowest) < 20)) return;  // 20 times its size: exploded
        table.row("%s,%.6g,%.6g,%.6g\n", name, h, state.time, lowest);
    }
}

void large_steps(const std::string& folder) {
    Table table(folder, "large_steps.csv", "method,h_s,time_s,lowest_m");
    const auto cloth = taut::hanging_cloth<double>({16, 16});
    const double proved = 0.95 * taut::any_pose_limit(cloth).certified;
    fall<taut::SymplecticEuler<Cloth>>(table, "symplectic", proved, 2);
    fall<taut::SymplecticEuler<Cloth>>(table, "symplectic", 2 * proved, 2);
    for (const double h : {1.0 / 240, 1.0 / 60, 1.0 / 30}) {
        fall<taut::ImplicitEuler<Cloth>>(table, "implicit", h, 2);
    }
}

/// 1 m × 0.1 m of 21 × 3 particles, flat but for 0.1 mm, undamped, its ends pinned; stretch springs
/// of law Stretch and bending springs of law Bend.
template <class System, class AddStretch, class AddBend>
System strip(AddStretch&& stretch, AddBend&& bend) {
    constexpr Index rows = 3, columns = 21;
    System system;
    for (Index r = 0; r < rows; ++r) {
        for (Index c = 0; c < columns; ++c) {
            const auto x = static_cast<double>(c), y = static_cast<double>(r);
            system.add_particle({0.05 * x, 0.05 * y, 1e-4 * std::sin(1.3 * x + y)}, 0.01);
        }
    }
    const auto join = [&](Index r, Index c, Index rise, Index run, auto&& add) {
        if (r + rise >= rows || c + run >= columns || c + run < 0) return;
        add(system, r * columns + c, (r + rise) * columns + c + run);
    };
    for (Index r = 0; r < rows; ++r) {
        for (Index c = 0; c < columns; ++c) {
            join(r, c, 0, 1, stretch);
            join(r, c, 1, 0, stretch);
            join(r, c, 1, 1, stretch);
            join(r, c, 1, -1, stretch);
            join(r, c, 0, 2, bend);
            join(r, c, 2, 0, bend);
        }
        system.pin(r * columns);
        system.pin(r * columns + columns - 1);
    }
    return system;
}

/// Pushes one end in by 0.3 m within a second at h = 1/60 s. @returns the rise of the strip, m, and
/// the fastest particle on the way, m/s; both NaN after a failed step
template <class Stepper, class System>
std::pair<double, double> push(const System& system) {
    auto state = system.initial_state();
    Stepper stepper(system);
    double fastest = 0;
    for (int frame = 0; frame < 120; ++frame) {
        for (const Index end : {20, 41, 62}) state.v(0, end) = frame < 60 ? -0.3 : 0.0;
        if (!stepper.step(state, 1.0 / 60)) return {std::nan(""), std::nan("")};
        fastest = std::max(fastest, state.v.colwise().norm().maxCoeff());
    }
    return {state.x.row(2).cwiseAbs().maxCoeff(), fastest};
}

void strips(const std::string& folder) {
    Table table(folder, "strip.csv", "springs,method,stiffness_N_per_m,rise_m,fastest_m_per_s");
    using ChoiKo = taut::SpringSystem<double, 3, taut::TensionOnly, taut::Buckling>;
    for (double k = 10; k < 2e6; k *= 10) {
        const auto choi_ko = strip<ChoiKo>(
            [&](ChoiKo& s, Index a, Index b) { s.add_spring<taut::TensionOnly>(a, b, {k}); },
            [&](ChoiKo& s, Index a, Index b) {
                s.add_spring<taut::Buckling>(a, b, {k, 0.01 * k * 0.001, k});
            });
        const auto linear =
            strip<Cloth>([&](Cloth& s, Index a, Index b) { s.add_spring(a, b, k); },
                         [&](Cloth& s, Index a, Index b) { s.add_spring(a, b, k); });
        const auto row = [&](const char* springs, const char* method,
                             std::pair<double, double> found) {
            table.row("%s,%s,%.0e,%.5g,%.5g\n", springs, method, k, found.first, found.second);
        };
        row("choi_ko", "bdf2", push<taut::Bdf2<ChoiKo>>(choi_ko));
        row("choi_ko", "implicit", push<taut::ImplicitEuler<ChoiKo>>(choi_ko));
        row("hookean", "bdf2", push<taut::Bdf2<Cloth>>(linear));
        row("hookean", "implicit", push<taut::ImplicitEuler<Cloth>>(linear));
    }
}

using Chain = taut::SpringSystem<double, 2>;

template <class Stepper>
void swing(Table& table, const char* name, const Chain& chain, double energy) {
    auto state = chain.initial_state();
    const double start = chain.energy(state);
    Stepper stepper(chain);
    for (int i = 0; i <= 240; ++i) {
        if (i > 0 && !stepper.step(state, 1.0 / 60)) return;
        const double left = 1 - (start - chain.energy(state)) / energy;
        table.row("%s,%.6g,%.6g\n", name, state.time, left);
    }
}

/// A chain of eight links of 0.1 m, let go at 0.5 rad.
void swings(const std::string& folder) {
    Table table(folder, "swing.csv", "method,time_s,energy_left");
    Chain chain;
    double energy = 0;  // of the swing, J
    for (int i = 0; i < 9; ++i) {
        const double along = 0.1 * i;
        chain.add_particle({along * std::sin(0.5), -along * std::cos(0.5)}, 0.01);
        if (i > 0) chain.add_spring(i - 1, i, 1000);
        energy += 0.01 * 9.81 * along * (1 - std::cos(0.5));
    }
    chain.pin(0);
    chain.set_gravity({0, -9.81});
    swing<taut::ImplicitEuler<Chain>>(table, "implicit", chain, energy);
    swing<taut::Bdf2<Chain>>(table, "bdf2", chain, energy);
}

/// What r of all modes make of a gust on the net: the largest distance from the full linear
/// solution in 2 s, over the largest displacement.
void modes(const std::string& folder) {
    Table table(folder, "modal.csv", "force,r,relative_error");
    Cloth::State pose;
    const auto net = bench::hanging_net(12, 8, pose);
    const auto linear = taut::linearize(net, pose);
    taut::ModalBasis all;
    if (!taut::modal_analysis(linear, linear.size(), all)) std::exit(1);
    taut::Points<double, 3> wind = taut::Points<double, 3>::Zero(3, net.size());
    for (Index i = 0; i < net.size(); ++i) wind(1, i) = 0.05 * net.mass(i) * 9.81;
    taut::Points<double, 3> poke = taut::Points<double, 3>::Zero(3, net.size());
    poke(1, net.size() / 2) = wind.sum();
    const auto error = [&](Index r, const taut::Points<double, 3>& force) {
        const taut::ModalBasis basis{all.k.head(r), all.d.head(r), all.p.head(r),
                                     all.shapes.leftCols(r)};
        taut::ModalDynamics<double, 3> full(linear, pose, all), reduced(linear, pose, basis);
        full.set_force(force);
        reduced.set_force(force);
        double largest = 0, worst = 0;
        taut::Points<double, 3> x, y;
        for (int i = 0; i < 120; ++i) {
            if (!full.step(1.0 / 60) || !reduced.step(1.0 / 60)) std::exit(1);
            full.positions(x);
            reduced.positions(y);
            worst = std::max(worst, (x - y).colwise().norm().maxCoeff());
            largest = std::max(largest, (x - pose.x).colwise().norm().maxCoeff());
        }
        return worst / largest;
    };
    for (const Index r : {1, 2, 3, 5, 7, 10, 15, 20, 30, 50, 70, 80}) {
        table.row("wind,%ld,%.4g\n", static_cast<long>(r), error(r, wind));
        table.row("poke,%ld,%.4g\n", static_cast<long>(r), error(r, poke));
    }
}

using Strings = taut::SpringSystem<double, 3, taut::TensionOnly>;

/// A hanging cloth whose springs only pull, from rest, at one step.
template <class Stepper, class... Options>
void string_cloth(Table& table, const char* name, double h, const Options&... options) {
    Strings cloth;
    const auto hookean = taut::hanging_cloth<double>({12, 12});
    const auto start = hookean.initial_state();
    for (Index i = 0; i < hookean.size(); ++i) {
        cloth.add_particle(start.x.col(i), hookean.mass(i));
        if (hookean.is_pinned(i)) cloth.pin(i);
    }
    hookean.for_each_spring(
        [&](Index a, Index b) { cloth.add_spring<taut::TensionOnly>(a, b, {1000}); });
    cloth.set_gravity(hookean.gravity());
    Stepper stepper(cloth, options...);
    auto state = cloth.initial_state();
    for (int i = 0; i <= 60; ++i) {
        if (i > 0 && !stepper.step(state, h)) return;
        table.row("%s,%.6g,%d,%.8g\n", name, h, i, cloth.energy(state));
    }
}

void energies(const std::string& folder) {
    Table table(folder, "energy.csv", "method,h_s,step,energy_J");
    using Solved = taut::ProjectiveDynamics<Strings>;
    Solved::Options until_solved;
    until_solved.iterations = 20000;
    until_solved.tolerance = 1e-8;
    for (const double h : {1.0 / 60, 1.0 / 10, 1.0, 10.0}) {
        string_cloth<taut::ImplicitEuler<Strings>>(table, "linearised", h);
        string_cloth<Solved>(table, "solved", h, until_solved);
    }
}

/// The middle column of a cloth that fell on a sphere of 0.3 m, after 0.7 s.
void contacts(const std::string& folder) {
    Table table(folder, "contact.csv", "friction,along_m,height_m");
    for (const double friction : {0.0, 0.3, 1.0}) {
        taut::ClothOptions options{33, 33};
        options.pin_corners = false;
        auto cloth = taut::hanging_cloth<double>(options);
        cloth.set_rayleigh({1, 0});
        const taut::Sphere<double, 3> sphere({0.5, 0.45, -0.32}, 0.3);
        auto state = cloth.initial_state();
        taut::Contacts bodies(cloth);
        bodies.add(sphere, {friction, 0.002});
        taut::Guarded guard(cloth);
        for (int frame = 0; frame < 42; ++frame) {
            if (!guard.advance(state, 1.0 / 60, bodies)) std::exit(1);
        }
        for (Index r = 0; r < 33; ++r) {
            const auto x = state.x.col(r * 33 + 16);
            table.row("%g,%.5g,%.5g\n", friction, x[1], x[2]);
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3 || std::strcmp(argv[1], "--csv") != 0) {
        std::fprintf(stderr, "usage: systems_figures --csv FOLDER\n");
        return 1;
    }
    const std::string folder = argv[2];
    large_steps(folder);
    strips(folder);
    swings(folder);
    modes(folder);
    energies(folder);
    contacts(folder);
}
