// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <random>
#include <taut/equilibrium/equilibrium.hpp>
#include <taut/guard/guard.hpp>
#include <taut/network/tension_only.hpp>
#include <taut/scene/cloth.hpp>
#include <taut/scene/with_law.hpp>

#include "books.hpp"

namespace guard_table {

using taut::Index;
using Cloth = taut::SpringSystem<double, 3>;
using Strings = taut::SpringSystem<double, 3, taut::TensionOnly>;

constexpr double frame = 1.0 / 60;  // s

struct Random {
    std::mt19937_64 bits;
    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53;
    }
};

/// A system in double as one of another scalar and law, moved by `offset` m along every axis.
template <class System>
System as(const Cloth& from, double offset = 0) {
    using Scalar = typename System::Scalar;
    using Law = typename System::FirstLaw;
    System system;
    const auto start = from.initial_state();
    for (Index i = 0; i < from.size(); ++i) {
        const Eigen::Vector3d x = start.x.col(i).array() + offset;
        system.add_particle(x.cast<Scalar>(), static_cast<Scalar>(from.mass(i)));
        if (from.is_pinned(i)) system.pin(i);
    }
    from.visit_springs([&](const auto& spring) {
        system.add_spring(taut::Spring<Scalar, Law>{spring.a,
                                                    spring.b,
                                                    {Scalar(spring.parameters.stiffness)},
                                                    Scalar(spring.rest_length),
                                                    Scalar(spring.damping)});
    });
    system.set_gravity(from.gravity().template cast<Scalar>());
    system.set_rayleigh(from.rayleigh());
    return system;
}

inline Cloth square(Index side, bool pinned = true) {
    taut::ClothOptions options;
    options.rows = options.columns = side;
    options.pin_corners = pinned;
    if (!pinned) options.gravity = 0;
    return taut::hanging_cloth<double>(options);
}

/// A rope of `count` particles from a pin, level, with a weight of `last` kg at its end.
inline Cloth rope(Index count, double last) {
    Cloth net;
    const double d = 1 / static_cast<double>(count - 1);
    for (Index i = 0; i < count; ++i) {
        net.add_particle({d * static_cast<double>(i), 0, 0}, i + 1 < count ? 0.1 * d : last);
        if (i > 0) net.add_spring(i - 1, i, 50 / d);
    }
    net.pin(0);
    net.set_gravity({0, 0, -9.81});
    return net;
}

/// A net of particles anywhere in a box, each joined to the four before it.
inline Cloth irregular(Index count, bool pinned) {
    Random random;
    Cloth net;
    for (Index i = 0; i < count; ++i) {
        net.add_particle({random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)},
                         std::exp(random.uniform(-6, -3)));
        for (Index j = std::max(Index(0), i - 4); j < i; ++j) {
            net.add_spring(j, i, std::exp(random.uniform(4, 7)));
        }
    }
    if (pinned) net.pin(0);
    if (pinned) net.set_gravity({0, 0, -9.81});
    return net;
}

/// A cloth that hangs from its upper edge, at equilibrium.
template <class System>
System hanging(Index side, double offset, typename System::State& state) {
    taut::ClothOptions options;
    options.rows = options.columns = side;
    options.diagonals = false;  // they would compress the rows, and its flat pose would buckle
    Cloth cloth = taut::hanging_cloth<double>(options);
    for (Index c = 0; c < side; ++c) cloth.pin(c);
    cloth.set_gravity({0, 9.81, 0});
    auto rest = cloth.initial_state();
    if (!taut::static_equilibrium(cloth, rest)) std::printf("NO EQUILIBRIUM\n");
    System system = as<System>(cloth, offset);
    state = system.initial_state();
    using Scalar = typename System::Scalar;
    state.x = (rest.x.array() + offset).template cast<Scalar>();
    return system;
}

enum class Motion { let_go, thrown, at_rest, driven, jerked };

/// Moves the pins of a scene before its frame that begins at t, s.
template <class System, class State>
void drive(const System& system, State& state, Motion motion, double t) {
    using Scalar = typename System::Scalar;
    if (motion != Motion::driven && motion != Motion::jerked) return;
    const double rate = 2 * 3.14159265 * 1.5;
    for (Index i = 0; i < system.size(); ++i) {
        if (!system.is_pinned(i)) continue;
        // To and fro by 0.2 m; or at 2 m/s this way and that, for an eighth of a second each.
        const double jerk = static_cast<long>(t * 8) % 2 == 0 ? 2 : -2;
        const double speed = motion == Motion::driven ? 0.2 * rate * std::cos(rate * t) : jerk;
        state.v(1, i) = static_cast<Scalar>(speed);
    }
}

/// A free scene turns about its centre, and every particle has 1 m/s of its own.
template <class System, class State>
void throw_free(const System& system, State& state) {
    Random random;
    const Eigen::Vector3d centre = state.x.template cast<double>().rowwise().mean();
    for (Index i = 0; i < system.size(); ++i) {
        if (system.is_pinned(i)) continue;
        const Eigen::Vector3d r = state.x.col(i).template cast<double>() - centre;
        Eigen::Vector3d v = Eigen::Vector3d(2, 3, 8).cross(r);
        for (int d = 0; d < 3; ++d) v[d] += random.uniform(-1, 1);
        state.v.col(i) = v.template cast<typename System::Scalar>();
    }
}

/// What a row of frames came to.
struct Tally {
    Index frames = 0, trimmed = 0, again = 0, frozen = 0, refused = 0, broken = 0, blind = 0;

    template <class Report>
    bool add(const Report& report) {
        ++frames;
        trimmed += report.taken == taut::Taken::trimmed;
        again += report.taken == taut::Taken::again;
        frozen += report.taken == taut::Taken::frozen;
        blind += report.blind;
        const bool taken = report || report.status == taut::Status::frozen;
        refused += !taken;
        return taken;
    }
    bool sound() const { return refused == 0 && broken == 0; }
    void operator+=(const Tally& other) {
        frames += other.frames;
        trimmed += other.trimmed;
        again += other.again;
        frozen += other.frozen;
        refused += other.refused;
        broken += other.broken;
        blind += other.blind;
    }
};

template <class Scalar>
constexpr double unit_of() {
    return static_cast<double>(std::numeric_limits<Scalar>::epsilon()) / 2;
}

inline long count(Index n) { return static_cast<long>(n); }
inline double percent(Index part, Index whole) {
    return 100 * static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace guard_table
