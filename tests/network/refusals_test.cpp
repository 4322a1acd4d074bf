// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <functional>
#include <limits>
#include <taut/network/spring_system.hpp>
#include <taut/network/buckling.hpp>
#include <vector>

#include "../support/catch.hpp"
#include "../support/laws.hpp"
#include "../support/message.hpp"
#include "triangle.hpp"

namespace taut_test::refusals_test {

using taut::Hookean;
using taut::Spring;
using taut::SpringSystem;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

using System = SpringSystem<double, 2>;

/// All that a failed call must leave as it was.
std::vector<double> snapshot(const System& system) {
    const auto state = system.initial_state();
    std::vector<double> all{static_cast<double>(system.revision()),
                            static_cast<double>(system.force_revision()),
                            static_cast<double>(system.topology_revision()),
                            static_cast<double>(system.spring_count()),
                            static_cast<double>(system.springs().damping.size()),
                            system.gravity()[0],
                            system.gravity()[1],
                            system.rayleigh().mass_proportional,
                            system.rayleigh().stiffness_proportional};
    for (Index i = 0; i < system.size(); ++i)
        all.insert(all.end(),
                   {system.mass(i), system.inverse_mass()[i], state.x(0, i), state.x(1, i)});
    return all;
}

/// Runs `action` on a triangle: it must throw a message with all the words and change nothing.
void refuses(const std::function<void(System&)>& action, std::initializer_list<const char*> words) {
    auto system = triangle();
    const auto before = snapshot(system);
    CHECK(missing(message_of([&] { action(system); }), words) == "");
    CHECK(snapshot(system) == before);
}

Eigen::Vector2d at(double x, double y) { return {x, y}; }
taut::RayleighDamping damping(double d0, double alpha) { return {d0, alpha}; }
Spring<double, Hookean> spring(Index a, Index b, double rest_length, double damping = 0) {
    return {a, b, {10}, rest_length, damping};
}

}  // namespace

TEST_CASE("refusals: masses, positions, gravity, damping", "[network][bad_input]") {
    for (const double bad : {-1.0, infinity, -infinity, not_a_number}) {
        if (bad != -1) {
            refuses([&](System& s) { s.add_particle(at(0, bad), 1); },
                    {"add_particle", "position of particle 3", "finite"});
            refuses([&](System& s) { s.set_gravity(at(bad, 0)); },
                    {"set_gravity", "gravity", "finite"});
            refuses([&](System& s) { s.set_constant_force(1, at(0, bad)); },
                    {"set_constant_force", "particle 1", "finite"});
        }
        for (const double mass : {bad, 0.0, std::numeric_limits<double>::denorm_min()}) {
            refuses([&](System& s) { s.add_particle(at(0, 0), mass); },
                    {"add_particle", "mass of particle 3 is ", "finite and > 0"});
            refuses([&](System& s) { s.set_mass(1, mass); },
                    {"set_mass", "mass of particle 1 is ", "finite and > 0"});
        }
        refuses([&](System& s) { s.add_spring(0, 2, bad); },
                {"add_spring(0, 2)", "stiffness is ", ">= 0"});
        refuses([&](System& s) { s.add_spring(0, 2, 10, bad); },
                {"add_spring(0, 2)", "damping is ", ">= 0"});
        refuses([&](System& s) { s.add_spring(spring(0, 2, bad)); },
                {"add_spring(0, 2)", "rest_length is ", ">= 0"});
        refuses([&](System& s) { s.add_spring(spring(0, 2, 1, bad)); },
                {"add_spring(0, 2)", "damping is ", ">= 0"});
        refuses([&](System& s) { s.set_rayleigh(damping(bad, 0)); },
                {"set_rayleigh", "mass_proportional is ", ">= 0"});
        refuses([&](System& s) { s.set_rayleigh(damping(0, bad)); },
                {"set_rayleigh", "stiffness_proportional is ", ">= 0"});
    }
    refuses([](System& s) { s.add_particle(at(0, 0), -2.5); }, {"-2.5"});
    refuses([](System& s) { s.add_spring(0, 2, -0.125); }, {"-0.125"});

    Mixed<double, 2> buckling;
    buckling.add_particle({0, 0}, 1);
    buckling.add_particle({1, 0}, 1);
    const Buckling::Parameters<double> bad{10, not_a_number, 1};
    CHECK(missing(message_of([&] { buckling.add_spring<Buckling>(0, 1, bad); }),
                  {"add_spring(0, 1)", "bending is nan"}) == "");
    CHECK(buckling.spring_count() == 0);
}

TEST_CASE("refusals: a spring to itself or to a missing particle", "[network][bad_input]") {
    refuses([](System& s) { s.add_spring(1, 1, 10); }, {"add_spring", "a and b are both 1"});
    refuses([](System& s) { s.add_spring(-1, 1, 10); }, {"add_spring", "a is -1", "3 particles"});
    refuses([](System& s) { s.add_spring(0, 3, 10); }, {"add_spring", "b is 3", "3 particles"});
    refuses([](System& s) { s.add_spring(spring(3, 0, 1)); }, {"add_spring", "a is 3"});
    refuses([](System& s) { s.add_spring(spring(2, 2, 1)); }, {"add_spring", "both 2"});
    refuses([](System& s) { s.pin(3); }, {"pin", "i is 3", "3 particles"});
    refuses([](System& s) { s.unpin(-7); }, {"unpin", "i is -7", "3 particles"});
    refuses([](System& s) { s.set_mass(3, 1); }, {"set_mass", "i is 3", "3 particles"});
    refuses([](System& s) { s.set_constant_force(3, at(0, 0)); }, {"set_constant_force", "i is 3"});
}

#ifndef NDEBUG
namespace {

/// A constant pull: T' = 0, and T/l without bound.
struct Weight : Hookean {
    static constexpr bool monotone = false;
    template <class Scalar>
    static Scalar tension(const Parameters<Scalar>& p, Scalar, Scalar) {
        return p.stiffness;
    }
    template <class Scalar>
    static Scalar tension_slope(const Parameters<Scalar>&, Scalar, Scalar) {
        return 0;
    }
};
/// As stiff as it says not to be.
struct Steep : Weight {
    template <class Scalar>
    static Scalar tension(const Parameters<Scalar>&, Scalar, Scalar) {
        return 0;
    }
    template <class Scalar>
    static Scalar tension_slope(const Parameters<Scalar>& p, Scalar, Scalar) {
        return 2 * p.stiffness;
    }
};
/// Falls, and says that it does not.
struct Falling : Steep {
    static constexpr bool monotone = true;
    template <class Scalar>
    static Scalar tension_slope(const Parameters<Scalar>& p, Scalar, Scalar) {
        return -p.stiffness;
    }
};

}  // namespace

TEST_CASE("refusals: a debug build refuses a law that breaks its own word",
          "[network][bad_input]") {
    SpringSystem<double, 1, Weight, Steep, Falling> system;
    for (const double x : {0, 1}) system.add_particle(Eigen::Matrix<double, 1, 1>(x), 1);
    const auto says = [&](auto&& add, std::initializer_list<const char*> words) {
        CHECK(missing(message_of(add), words) == "");
        CHECK(system.spring_count() == 0);
    };
    says([&] { system.add_spring<Weight>(0, 1, {10}); }, {"stiffness_bound 10", "T/l is "});
    says([&] { system.add_spring<Steep>(0, 1, {10}); }, {"stiffness_bound 10", "T' is 20"});
    says([&] { system.add_spring<Falling>(0, 1, {10}); }, {"never falls", "T' is -10"});
}
#endif

TEST_CASE("refusals: a state that does not fit", "[network][bad_input]") {
    const auto system = triangle();
    taut::Points<double, 2> f = taut::Points<double, 2>::Ones(2, 1);
    for (const bool shorten_x : {true, false}) {
        auto bad = system.initial_state();
        (shorten_x ? bad.x : bad.v).resize(2, 2);
        const auto says = [&](auto&& action, const char* word) {
            CHECK(missing(message_of(action), {word, "3 particles"}) == "");
        };
        says([&] { system.force(bad, f); }, "force");
        says([&] { system.force_ahead(bad, 1, f); }, "force_ahead");
        says([&] { (void)system.energy(bad); }, "energy");
    }
    CHECK((f == taut::Points<double, 2>::Ones(2, 1)));
}

}  // namespace taut_test::refusals_test
