// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Whatever kernels Taut::Compiled takes, 200 steps end the same but for rounding, with
// TAUT_SAME_BITS to the last bit: every law, dimension and scalar that it holds, in runs, batches
// and stars, damped and not.

#include <taut/kernels.hpp>
#include <taut/network/buckling.hpp>
#include <taut/network/tension_only.hpp>
#include <taut/taut.hpp>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace {

using taut::Index;

double most_off = 0;  // of all comparisons, roundings of the largest number

unsigned draw(unsigned& seed, unsigned below) {
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 8u) % below;
}

template <class System, class Law>
void join(System& system, Index a, Index b, double damping) {
    using Scalar = typename System::Scalar;
    if constexpr (std::is_same_v<Law, taut::Buckling>) {
        system.template add_spring<Law>(a, b, {Scalar(50), Scalar(1e-4), Scalar(20)},
                                        Scalar(damping));
    } else {
        system.template add_spring<Law>(a, b, {Scalar(50)}, Scalar(damping));
    }
}

enum class Net { grid, torn, garment };

/// More than a block of particles. First and Last are laws of the system, maybe the same.
template <class System, class First, class Last>
System net_of(Net kind, double damping) {
    using Scalar = typename System::Scalar;
    constexpr Index columns = 67, rows = 37, size = columns * rows;
    System system;
    unsigned seed = 7;
    for (Index i = 0; i < size; ++i) {
        typename System::Vector x;
        x[0] = static_cast<Scalar>(System::Dim > 1 ? i % columns : i);
        if (System::Dim > 1) x[1] = static_cast<Scalar>(i / columns);
        if (System::Dim > 2) x[2] = static_cast<Scalar>(draw(seed, 100)) / 400;
        system.add_particle(x, static_cast<Scalar>(1 + draw(seed, 8)) / 8);
    }
    for (const Index pinned : {Index(0), columns - 1, size - 1}) system.pin(pinned);
    for (Index i = 0; i < size && kind != Net::garment; ++i) {
        if (i % columns + 1 < columns) join<System, First>(system, i, i + 1, damping);
        if (i + columns < size) join<System, Last>(system, i, i + columns, 0);
    }
    const Index scattered = kind == Net::grid ? 0 : kind == Net::torn ? 150 : 3 * size;
    for (Index s = 0; s < scattered; ++s) {
        const Index a = s % size, b = (a + 1 + static_cast<Index>(draw(seed, 300))) % size;
        s % 2 == 0 ? join<System, First>(system, a, b, damping)
                   : join<System, Last>(system, a, b, damping);
    }
    return system;
}

/// @param scale  of the numbers that rounding errors come from
template <class Points>
bool near(const Points& a, const Points& b, double scale) {
    const auto off = static_cast<double>((a - b).cwiseAbs().maxCoeff());
    const double roundings =
        off / scale / static_cast<double>(std::numeric_limits<typename Points::Scalar>::epsilon());
    most_off = (std::max)(most_off, roundings);
#if defined(TAUT_SAME_BITS)
    return roundings == 0;
#else
    return roundings < 512;
#endif
}

template <class Stepper, class System>
bool same(const char* stepper, const std::vector<const char*>& sets, const System& system) {
    using Scalar = typename System::Scalar;
    const Scalar h = taut::energy_limit(system).certified / 8;
    auto start = system.initial_state();
    start.x *= Scalar(1) + Scalar(1) / 4096;  // at rest a rounding decides between two slopes
    const auto size = static_cast<double>(start.x.cwiseAbs().maxCoeff());
    for (Index i = 0; i < system.size(); ++i) {
        if (!system.is_pinned(i)) start.v.col(i).setConstant((static_cast<Scalar>(i % 5) - 2) / 64);
    }
    auto expected = start;
    for (const char* set : sets) {
        taut::set_kernels(set);
        auto state = start;
        Stepper steps(system);
        if (!steps.step(state, h, 1) || !steps.step(state, h, 199)) return false;
        if (set == sets.front()) expected = state;
        if (near(state.x, expected.x, size) &&
            near(state.v, expected.v, size / static_cast<double>(h)))
            continue;
        std::fprintf(stderr, "%s, dimension %d, %d bytes: %s differs from %s\n", stepper,
                     System::Dim, static_cast<int>(sizeof(Scalar)), set, sets.front());
        return false;
    }
    return true;
}

template <class System, class First, class Last = First>
bool same_nets(const std::vector<const char*>& sets) {
    bool ok = true;
    for (const Net kind : {Net::grid, Net::torn, Net::garment}) {
        auto system = net_of<System, First, Last>(kind, 0);
        ok = same<taut::EnergyStableEuler<System>>("EnergyStableEuler", sets, system) && ok;
        ok = same<taut::VelocityVerlet<System>>("VelocityVerlet", sets, system) && ok;
        system = net_of<System, First, Last>(kind, 0.05);
        ok = same<taut::SymplecticEuler<System>>("SymplecticEuler", sets, system) && ok;
        system.set_rayleigh({0.1, 1e-3});
        ok = same<taut::EnergyStableEuler<System>>("EnergyStableEuler", sets, system) && ok;
        ok = same<taut::ExplicitEuler<System>>("ExplicitEuler", sets, system) && ok;
    }
    return ok;
}

template <class Scalar>
bool same_systems(const std::vector<const char*>& sets) {
    using namespace taut;
    bool ok = same_nets<SpringSystem<Scalar, 1>, Hookean>(sets);
    ok = same_nets<SpringSystem<Scalar, 2>, Hookean>(sets) && ok;
    ok = same_nets<SpringSystem<Scalar, 3>, Hookean>(sets) && ok;
    ok = same_nets<SpringSystem<Scalar, 2, TensionOnly>, TensionOnly>(sets) && ok;
    ok = same_nets<SpringSystem<Scalar, 3, TensionOnly>, TensionOnly>(sets) && ok;
    ok = same_nets<SpringSystem<Scalar, 2, Hookean, Buckling>, Hookean, Buckling>(sets) && ok;
    return same_nets<SpringSystem<Scalar, 3, Hookean, Buckling>, Hookean, Buckling>(sets) && ok;
}

}  // namespace

int main() {
    const std::string best = taut::kernels();
    std::vector<const char*> sets;
    for (const char* set : {taut::detail::kernels_of_flags(), "avx2", "avx512"}) {
        const bool is_new = sets.empty() || std::string(set) != sets.front();
        if (is_new && taut::set_kernels(set)) sets.push_back(set);
        if (taut::kernels() != std::string(sets.back())) return 1;
    }
    if (sets.back() != best || taut::set_kernels("none") || taut::kernels() != best) return 1;
    if (sets.size() == 1) return 0;  // another processor, or another compiler
    for (const char* set : sets) std::printf("%s ", set);
    const bool ok = same_systems<float>(sets) & same_systems<double>(sets);
    std::printf("%s: at most %.0f roundings apart\n", ok ? "agree" : "DO NOT AGREE", most_off);
    return !ok;
}
