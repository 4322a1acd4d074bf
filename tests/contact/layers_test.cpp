// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/contact/self_contact.hpp>
#include <taut/guard/guard.hpp>

#include "../support/catch.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::layers_test {

using taut::Index;

namespace {

constexpr Index side = 16;
constexpr double spacing = 1.0 / (side - 1);

/// A cloth of side × side particles, 1 m × 1 m, around the origin of x and y.
template <class System>
void add_cloth(System& system, double z, double shift, double bend) {
    using Scalar = typename System::Scalar;
    const Index first = system.size();
    for (Index r = 0; r < side; ++r) {
        for (Index c = 0; c < side; ++c) {
            system.add_particle(
                {static_cast<Scalar>(spacing * double(c) - 0.5 + shift),
                 static_cast<Scalar>(spacing * double(r) - 0.5 + shift), static_cast<Scalar>(z)},
                static_cast<Scalar>(0.3 / (side * side)));
        }
    }
    const auto join = [&](Index rise, Index run, double k) {
        for (Index r = 0; r + rise < side; ++r) {
            for (Index c = run < 0 ? -run : 0; c + run < side && c < side; ++c) {
                const Index a = first + r * side + c;
                if (k > 0) system.add_spring(a, a + rise * side + run, static_cast<Scalar>(k));
            }
        }
    };
    join(0, 1, 1000);
    join(1, 0, 1000);
    join(1, 1, 1000);
    join(1, -1, 1000);
    join(0, 2, bend);
    join(2, 0, bend);
}

/// Columns of a cloth.
struct Layer {
    Index first;  ///< particle of the cloth
    Index begin, end;
};

/// Balls of one layer that are on the wrong side of another one where it is nearest.
/// @param up  which side is right: 1 that of the normal, along columns × along rows; −1 the other
template <class State>
int behind(const State& state, const Layer& below, const Layer& above, int up) {
    const auto at = [&](Index r, Index c) -> Eigen::Vector3d {
        r = std::min(std::max(r, Index(0)), side - 1);
        c = std::min(std::max(c, below.begin), below.end - 1);
        return state.x.col(below.first + r * side + c).template cast<double>();
    };
    int count = 0;
    for (Index row = 0; row < side; ++row) {
        for (Index column = above.begin; column < above.end; ++column) {
            const Eigen::Vector3d x =
                state.x.col(above.first + row * side + column).template cast<double>();
            Index best_r = 0, best_c = below.begin;
            for (Index r = 0; r < side; ++r) {
                for (Index c = below.begin; c < below.end; ++c) {
                    if ((at(r, c) - x).norm() < (at(best_r, best_c) - x).norm())
                        best_r = r, best_c = c;
                }
            }
            const Eigen::Vector3d along = at(best_r, best_c + 1) - at(best_r, best_c - 1);
            const Eigen::Vector3d across = at(best_r + 1, best_c) - at(best_r - 1, best_c);
            count += along.cross(across).dot(x - at(best_r, best_c)) * up < 0;
        }
    }
    return count;
}

/// Ten seconds of frames. @param guarded  whether by Guarded
/// @returns the kinetic energy at the end beside its peak
template <class System>
double run(const System& system, typename System::State& state, taut::SelfContact<System>& contact,
           bool guarded) {
    using Scalar = typename System::Scalar;
    constexpr double frame = 1.0 / 60;
    taut::EnergyStableEuler stepper(system);
    taut::Guarded guard(system);
    const double longest = 0.9 * static_cast<double>(taut::energy_limit(system).certified);
    const auto count = static_cast<Index>(std::ceil(frame / longest));
    const Scalar h = static_cast<Scalar>(frame) / static_cast<Scalar>(count);
    double peak = 0, kinetic = 0;
    Index again = 0;
    for (int n = 0; n < 600; ++n) {
        if (guarded) {
            const auto report = guard.advance(state, static_cast<Scalar>(frame), contact);
            REQUIRE(report);
            again += report.again;
        } else {
            REQUIRE(taut::step_through(stepper, state, h, count, contact));
        }
        kinetic = static_cast<double>(system.kinetic_energy(state));
        peak = std::max(peak, kinetic);
    }
    CHECK(again == 0);
    return kinetic / peak;
}

template <class Scalar>
constexpr double at_rest = std::is_same_v<Scalar, float> ? 1e-5 : 1e-6;

}  // namespace

TEMPLATE_TEST_CASE("layers: two over a ball stay in their order and come to rest", "[contact]",
                   (Case<float, 3>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    // In float velocity Verlet leaves a cloth on a body a tremble of 1e-5 of the peak.
    const bool guarded = !std::is_same_v<Scalar, float> && GENERATE(false, true);
    taut::SpringSystem<Scalar, 3> system;
    add_cloth(system, 0.35, 0, 100);
    add_cloth(system, 0.35 + 2 * spacing, 0.2 * spacing, 100);
    // Nothing rubs between balls: sewn at their corners, or one layer slides off the other.
    for (const Index corner : {Index(0), side - 1, side * (side - 1), side * side - 1})
        system.add_spring(corner, side * side + corner, 1000);
    system.set_gravity({0, 0, Scalar(-9.81)});
    system.set_rayleigh({2, 0});
    taut::Contacts bodies(system);
    taut::BodyOptions options;
    options.friction = 0.5;
    options.thickness = spacing * spacing / (4 * 0.3);
    bodies.add(taut::Sphere<Scalar, 3>({0, 0, 0}, Scalar(0.3)), options);
    taut::SelfContact contact(system, bodies);
    auto state = system.initial_state();
    CHECK(run(system, state, contact, guarded) < at_rest<Scalar>);
    CHECK(behind(state, {0, 0, side}, {side * side, 0, side}, 1) == 0);
    CHECK(contact.touching() > 10);
    CHECK(bodies.touching() > 10);
}

TEMPLATE_TEST_CASE("layers: a cloth folded onto itself stays so and comes to rest", "[contact]",
                   (Case<float, 3>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    const bool guarded = GENERATE(false, true);
    const bool hangs = GENERATE(false, true);
    taut::SpringSystem<Scalar, 3> system;
    add_cloth(system, 0, 0, 0);
    for (Index r = 0; r < side && hangs; ++r) system.pin(r * side + side / 2);
    system.set_gravity({0, 0, Scalar(-9.81)});
    system.set_rayleigh({2, 0});
    auto state = system.initial_state();
    for (Index i = 0; i < system.size(); ++i) {
        // Over a rail, its halves leaning on each other; or on the floor, one half on the other.
        const double at = spacing * double(i % side - side / 2), radius = 0.6 * spacing;
        double x = 0.9 * at, z = 1 - 0.43 * std::abs(at);
        if (!hangs) {
            const double turn = std::min(std::max(at / radius, 0.0), 3.14159265358979);
            x = radius * std::sin(turn) + std::min(at, 0.0) -
                std::max(at - 3.14159265358979 * radius, 0.0);
            z = 0.05 + radius * (1 - std::cos(turn));
        }
        state.x(0, i) = static_cast<Scalar>(x);
        state.x(2, i) = static_cast<Scalar>(z);
    }
    taut::Contacts bodies(system);
    if (!hangs) bodies.add(taut::HalfSpace<Scalar, 3>({0, 0, 0}, {0, 0, 1}), {0.5, 0.01});
    taut::SelfContact contact(system, bodies);
    CHECK(run(system, state, contact, guarded) < at_rest<Scalar>);
    const Layer first{0, 0, side / 2 - 2}, second{0, side / 2 + 3, side};
    CHECK(behind(state, first, second, hangs ? -1 : 1) == 0);
    CHECK(contact.touching() > 5);
}

}  // namespace taut_test::layers_test
