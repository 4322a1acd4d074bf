// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Compiled with OpenMP: any number of threads gives the same bits, and so does any run: what this
// prints, same_output.cmake compares. With an argument it steps a second of play alone.

#include <taut/guard/guard.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/taut.hpp>
#include <taut/wind/wind.hpp>

#include <cstdint>
#include <cstdio>
#include <filesystem>

#include "steppers.hpp"

#ifndef _OPENMP
#error "this unit must be compiled with OpenMP: the flag was lost"
#endif

namespace {

constexpr taut::Index steps = 24;  // several of those that threads take between two waits

template <class Stepper, class System>
bool same_bits(const System& system) {
    using Scalar = typename System::Scalar;
    auto expected = system.initial_state();
    expected.v.setRandom();
    const auto start = expected;
    Stepper one(system, {1});
    if (!one.step(expected, Scalar(1e-5), steps)) return false;
    for (const int threads : {2, 3, 8}) {
        auto state = start;
        Stepper many(system, {threads});
        if (!many.step(state, Scalar(1e-5), steps)) return false;
        if (state.x != expected.x || state.v != expected.v) {
            std::fprintf(stderr, "%d threads give other bits than one\n", threads);
            return false;
        }
    }
    return true;
}

/// Fowler, Noll and Vo's hash, 1a, of the numbers' bytes.
template <class Matrix>
void add_to_hash(const Matrix& numbers, std::uint64_t& hash) {
    const auto* byte = reinterpret_cast<const unsigned char*>(numbers.data());
    const auto count = static_cast<std::size_t>(numbers.size()) * sizeof(*numbers.data());
    for (std::size_t i = 0; i < count; ++i) hash = (hash ^ byte[i]) * 1099511628211u;
}

/// An engine's second: guarded frames under wind while springs tear, then an implicit step.
template <class Scalar>
std::uint64_t second_of_play() {
    auto cloth = taut::hanging_cloth<Scalar>({20, 20});
    cloth.set_external_force([](const auto& state, auto& f) { f -= Scalar(1e-3) * state.v; });
    auto state = cloth.initial_state();
    taut::Guarded guard(cloth);
    std::uint64_t hash = 14695981039346656037u;
    for (int frame = 0; frame < 60; ++frame) {
        if (!guard.advance(state, Scalar(1) / 60)) return 0;
        if (frame % 20 == 10) {
            cloth.remove_springs([&](taut::Index s) { return s % 97 == frame; });
        }
        add_to_hash(state.x, hash);
        add_to_hash(state.v, hash);
    }
    taut::ImplicitEuler<taut::SpringSystem<Scalar, 3>> implicit(cloth);
    if (!implicit.step(state, Scalar(0.01), 2)) return 0;
    add_to_hash(state.x, hash);
    return hash;
}

template <class Scalar>
bool same_bits() {
    auto cloth = taut::hanging_cloth<Scalar>({110, 90});
    if (!same_bits<taut::SymplecticEuler<taut::SpringSystem<Scalar, 3>>>(cloth)) return false;
    for (taut::Index i = 0; i < 4000; i += 3)
        cloth.add_spring(i, 9899 - i, Scalar(5), Scalar(0.01));
    cloth.set_rayleigh({0.1, 1e-6});
    // Most springs in no order.
    auto scattered = cloth;
    for (taut::Index i = 1; i < 80000; ++i) {
        const taut::Index a = i * 31 % 9900;
        scattered.add_spring(a, (a + 1 + i * 17 % 9899) % 9900, Scalar(5), Scalar(0.01));
    }
    taut::Wind<Scalar> wind;
    wind.velocity = {1, 2, 3};
    wind.triangles = taut::cloth_triangles({110, 90});
    wind.triangles.push_back({1, 5000, 9000});
    auto blown = cloth;
    auto scattered_blown = scattered;
    for (auto* system : {&blown, &scattered_blown}) taut::set_wind(*system, wind);
    // So long that threads take several steps between two waits.
    taut::SpringSystem<Scalar, 3> chain;
    for (taut::Index i = 0; i < 90000; ++i) {
        chain.add_particle({Scalar(i), 0, 0}, Scalar(0.01));
        if (i > 0) chain.add_spring(i - 1, i, Scalar(20));
    }
    chain.set_gravity({0, -10, 3});
    for (taut::Index i = 0; i < 90000; i += 1000) chain.pin(i);
    bool same = true;
    for (const auto* system : {&cloth, &scattered, &blown, &scattered_blown, &chain}) {
        edges::each_explicit<taut::SpringSystem<Scalar, 3>>(
            [&](auto kind) { same = same && same_bits<typename decltype(kind)::Type>(*system); });
    }
    return same;
}

/// Whether the process has several threads, as OpenMP keeps those that it has started; true where
/// the system does not say.
bool threads_were_started() {
    std::error_code error;
    const std::filesystem::directory_iterator threads("/proc/self/task", error);
    if (error || std::distance(begin(threads), end(threads)) > 1) return true;
    std::fprintf(stderr, "no step has started threads\n");
    return false;
}

}  // namespace

int main(int argc, char**) {
    const auto in_float = second_of_play<float>();
    const auto in_double = second_of_play<double>();
    std::printf("%016llx %016llx\n", static_cast<unsigned long long>(in_float),
                static_cast<unsigned long long>(in_double));
    if (in_float == 0 || in_double == 0) return 1;
    if (argc > 1) return 0;
    return same_bits<float>() && same_bits<double>() && threads_were_started() ? 0 : 1;
}
