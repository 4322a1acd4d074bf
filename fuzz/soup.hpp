// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <taut/taut.hpp>
#include <taut/network/buckling.hpp>
#include <taut/network/tension_only.hpp>

// Scenes decoded from bytes: every input is one, and a small change of it is a small change of the
// scene.

namespace taut_fuzz {

using taut::Index;

/// libFuzzer reports an abort and keeps the input.
inline void require(bool holds, const char* property) {
    if (holds) return;
    std::fprintf(stderr, "does not hold: %s\n", property);
    std::abort();
}

template <class State>
bool same(const State& a, const State& b) {
    const auto equal = [](const auto& p, const auto& q) {
        return p.cols() == q.cols() &&
               (p.size() == 0 || std::memcmp(p.data(), q.data(),
                                             sizeof(typename std::decay_t<decltype(p)>::Scalar) *
                                                 static_cast<std::size_t>(p.size())) == 0);
    };
    return equal(a.x, b.x) && equal(a.v, b.v);
}

/// Bytes, taken from the front; zeros when there are none left.
class Bytes {
public:
    Bytes(const std::uint8_t* data, std::size_t size) : data_(data), end_(data + size) {}

    bool empty() const { return data_ == end_; }
    std::uint8_t byte() { return empty() ? std::uint8_t(0) : *data_++; }
    Index below(Index n) { return byte() % n; }
    bool one_in(int n) { return byte() % n == n - 1; }

    /// 2^-40 … 2^39 times 1 … 2, one value in 256 out of a list of hard ones, or any bits.
    double positive() {
        const std::uint8_t exponent = byte();
        const double mantissa = 1 + byte() / 256.0;
        if (exponent >= 244) return any();
        if (exponent >= 240) return 0;
        return std::ldexp(mantissa, exponent / 3 - 40);
    }
    /// A coordinate: sixteenths of −8 … 8, so that places coincide, or any bits.
    double coordinate() {
        const std::uint8_t code = byte();
        return code == 255 ? any() : (code - 128) / 16.0;
    }

private:
    double any() {
        std::uint64_t bits = 0;
        for (int i = 0; i < 8; ++i) bits = bits << 8 | byte();
        double value = 0;
        std::memcpy(&value, &bits, sizeof value);
        return value;
    }

    const std::uint8_t* data_;
    const std::uint8_t* end_;
};

/// Runs `call`; false if it was refused as wrong input, which must be named.
template <class Call>
bool accepted(Call&& call) {
    try {
        call();
        return true;
    } catch (const std::invalid_argument& refusal) {
        if (std::strncmp(refusal.what(), "taut::", 6) != 0) throw;
        return false;
    }
}

template <class Scalar>
auto parameters(Bytes& bytes, taut::Hookean) {
    return taut::Hookean::Parameters<Scalar>{static_cast<Scalar>(bytes.positive())};
}
template <class Scalar>
auto parameters(Bytes& bytes, taut::TensionOnly) {
    return parameters<Scalar>(bytes, taut::Hookean{});
}
template <class Scalar>
auto parameters(Bytes& bytes, taut::Buckling) {
    const auto stiffness = static_cast<Scalar>(bytes.positive());
    const auto bending = static_cast<Scalar>(bytes.positive());
    return taut::Buckling::Parameters<Scalar>{stiffness, bending,
                                              static_cast<Scalar>(bytes.positive())};
}

template <class Scalar, int Dim>
Eigen::Matrix<Scalar, Dim, 1> place(Bytes& bytes) {
    Eigen::Matrix<Scalar, Dim, 1> x;
    for (int d = 0; d < Dim; ++d) x[d] = static_cast<Scalar>(bytes.coordinate());
    return x;
}

/// At most 8 particles and 20 springs; what the builders refuse is left out.
template <class System>
System decode_system(Bytes& bytes) {
    using Scalar = typename System::Scalar;
    constexpr int Dim = System::Dim;
    System system;
    const Index particles = 1 + bytes.below(8);
    for (Index i = 0; i < particles; ++i) {
        const auto x = place<Scalar, Dim>(bytes);
        const auto mass = static_cast<Scalar>(bytes.positive());
        accepted([&] { system.add_particle(x, mass); });
    }
    const Index springs = bytes.below(21);
    for (Index s = 0; s < springs; ++s) {
        const Index a = bytes.below(particles);
        const Index b = bytes.below(particles);
        const Index chosen = bytes.byte();
        const double rest = bytes.one_in(4) ? bytes.positive() : bytes.byte() / 16.0;
        const double damping = bytes.one_in(3) ? bytes.positive() : 0;
        Index law = 0;
        system.for_each_set([&](const auto& set) {
            using Law = typename std::decay_t<decltype(set)>::Law;
            if (law++ !=
                chosen % static_cast<Index>(std::tuple_size_v<typename System::SpringSets>))
                return;
            const auto p = parameters<Scalar>(bytes, Law{});
            accepted([&] {
                system.add_spring(taut::Spring<Scalar, Law>{a, b, p, static_cast<Scalar>(rest),
                                                            static_cast<Scalar>(damping)});
            });
        });
    }
    const std::uint8_t pins = bytes.byte();
    for (Index i = 0; i < system.size(); ++i) {
        if (pins >> i & 1) system.pin(i);
    }
    if (bytes.one_in(2)) {
        const auto g = place<Scalar, Dim>(bytes);
        accepted([&] { system.set_gravity(g); });
    }
    if (bytes.one_in(3)) {
        const double d0 = bytes.positive();
        const double alpha = bytes.positive();
        accepted([&] { system.set_rayleigh({d0, alpha}); });
    }
    return system;
}

/// The initial state, or any places and velocities.
template <class System>
typename System::State decode_state(Bytes& bytes, const System& system) {
    using Scalar = typename System::Scalar;
    auto state = system.initial_state();
    if (!bytes.one_in(2)) return state;
    for (Index i = 0; i < system.size(); ++i) {
        state.x.col(i) = place<Scalar, System::Dim>(bytes);
        state.v.col(i) = place<Scalar, System::Dim>(bytes);
    }
    return state;
}

}  // namespace taut_fuzz
