// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// TAUT_SAME_BITS: whatever the compiler, its level and its registers, 1000 steps of four scenes end
// in the same bits. Prints them, and fails where they are others.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <taut/network/tension_only.hpp>
#include <taut/taut.hpp>

#if !defined(TAUT_SAME_BITS)
#error "this program is of a build with TAUT_SAME_BITS"
#endif

namespace {

/// Fowler, Noll and Vo's hash of the bits of x and v.
template <class State>
std::uint64_t hash(const State& state) {
    using Scalar = typename State::Scalar;
    std::uint64_t sum = 14695981039346656037U;
    for (const auto* points : {&state.x, &state.v}) {
        for (Eigen::Index i = 0; i < points->size(); ++i) {
            std::uint64_t bits = 0;
            const Scalar number = points->data()[i];
            std::memcpy(&bits, &number, sizeof number);
            sum = (sum ^ bits) * 1099511628211U;
        }
    }
    return sum;
}

int below(unsigned& seed, int most) {
    seed = seed * 1664525U + 1013904223U;
    return static_cast<int>((seed >> 8U) % static_cast<unsigned>(most));
}

/// Springs between particles at random, which are swept in stars; whole numbers over 1024, which
/// every scalar holds.
template <class System>
System net(int particles, double damping) {
    using Scalar = typename System::Scalar;
    using Law = typename System::FirstLaw;
    unsigned seed = 1;
    System system;
    for (int i = 0; i < particles; ++i) {
        typename System::Vector x;
        for (auto& axis : x) axis = static_cast<Scalar>(below(seed, 1024)) / 1024;
        system.add_particle(x, Scalar(1) / 1024);
    }
    for (int s = 0; s < 3 * particles; ++s) {
        const int a = s % particles;
        const int b = (a + 1 + below(seed, 40)) % particles;
        if (a != b) system.template add_spring<Law>(a, b, {Scalar(16)}, Scalar(damping));
    }
    return system;
}

template <class Stepper, class System>
bool same(const char* name, const System& system, double h, std::uint64_t expected) {
    auto state = system.initial_state();
    Stepper stepper(system);
    using Scalar = typename System::Scalar;
    bool ok = static_cast<bool>(stepper.step(state, static_cast<Scalar>(h), 500));
    ok = ok && stepper.step(state, static_cast<Scalar>(h), 500);
    const std::uint64_t bits = hash(state);
    std::printf("%s: %016llx\n", name, static_cast<unsigned long long>(bits));
    return ok && bits == expected;
}

}  // namespace

int main() {
    using Float = taut::SpringSystem<float, 3>;
    using Double = taut::SpringSystem<double, 3>;
    using Strings = taut::SpringSystem<double, 2, taut::TensionOnly>;
    taut::ClothOptions options;
    options.rows = 20;
    options.columns = 33;
    auto cloth = taut::hanging_cloth<float>(options);
    cloth.set_rayleigh({0.5, 0x1p-14});
    options.gravity = 8;
    auto torn = taut::hanging_cloth<double>(options);
    torn.remove_springs([](Eigen::Index s) { return s % 29 == 0; });
    for (int i = 0; i < 60; ++i) torn.add_spring(i, 659 - 7 * i, 32, 0x1p-10);  // in batches

    int others = 0;
    others += !same<taut::EnergyStableEuler<Float>>("a damped cloth, float", cloth, 0x1p-13,
                                                    0x34641ed69ab1da05);
    others +=
        !same<taut::VelocityVerlet<Double>>("scattered dampers", torn, 0x1p-13, 0xdbc76a052605d60f);
    others += !same<taut::SymplecticEuler<Float>>("a net, float", net<Float>(300, 0), 0x1p-12,
                                                  0x77e854b1fd85860e);
    others += !same<taut::EnergyStableEuler<Strings>>("strings", net<Strings>(200, 0x1p-11),
                                                      0x1p-12, 0x79a7fc9330cc2863);
    return others;
}
