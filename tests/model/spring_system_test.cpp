// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// Building, revisions and bad input. Forces: spring_system_force_test.cpp.
#include <limits>
#include <taut/model/spring_system.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <utility>
#include <vector>

#include "../support/catch.hpp"
#include "../support/laws.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"

namespace taut_test::spring_system_test {

using taut::Hookean;
using taut::Spring;
using taut::SpringSystem;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

SpringSystem<double, 2> triangle() {
    SpringSystem<double, 2> system;
    system.add_particle({0, 0}, 1);
    system.add_particle({3, 0}, 2);
    system.add_particle({3, 4}, 3);
    system.add_spring(0, 1, 10);
    system.add_spring(1, 2, 20, 0.5);
    return system;
}

/// All that a failed call must leave as it was.
struct Snapshot {
    explicit Snapshot(const SpringSystem<double, 2>& system)
        : revision(system.revision()),
          topology(system.topology_revision()),
          size(system.size()),
          springs(system.spring_count()),
          pinned(system.pinned_count()),
          dampers(system.springs().damping.size()),
          gravity(system.gravity()),
          d0(system.rayleigh().mass_proportional),
          alpha(system.rayleigh().stiffness_proportional),
          state(system.initial_state()) {
        for (Index i = 0; i < system.size(); ++i) masses.push_back(system.mass(i));
    }
    bool operator==(const Snapshot& b) const {
        return revision == b.revision && topology == b.topology && size == b.size &&
               springs == b.springs && pinned == b.pinned && dampers == b.dampers &&
               gravity == b.gravity && d0 == b.d0 && alpha == b.alpha && masses == b.masses &&
               same_bits(state, b.state);
    }

    std::uint64_t revision, topology;
    Index size, springs, pinned;
    std::size_t dampers;
    Eigen::Vector2d gravity;
    double d0, alpha;
    taut::State<double, 2> state;
    std::vector<double> masses;
};

/// Runs `action` on a triangle: it must throw a message with all the words and change nothing.
template <class Action>
std::string refused(Action&& action, std::initializer_list<const char*> words) {
    auto system = triangle();
    const Snapshot before(system);
    const auto problem = missing(message_of([&] { action(system); }), words);
    if (!problem.empty()) return problem;
    return Snapshot(system) == before ? "" : "the system has changed";
}

}  // namespace

TEST_CASE("spring_system: particles and springs are numbered from 0 in the order of adding",
          "[model]") {
    SpringSystem<double, 2, Hookean, TensionOnly> system;
    CHECK(system.add_particle({0, 0}, 1) == 0);
    CHECK(system.add_particle({3, 4}, 2) == 1);
    CHECK(system.add_particle({3, 0}, 4) == 2);
    CHECK(system.add_spring<TensionOnly>(0, 1, {30}) == 0);
    CHECK(system.add_spring(2, 1, 10) == 0);
    CHECK(system.add_spring(Spring<double, TensionOnly>{2, 0, {40}, 7}) == 1);
    CHECK(system.size() == 3);
    CHECK(system.spring_count() == 3);
    CHECK(system.mass(2) == 4);
    CHECK((system.inverse_mass() == Eigen::Vector3d(1, 0.5, 0.25)));

    // Laws in the order of the template arguments, then in the order of adding.
    std::vector<std::pair<Index, Index>> ends;
    system.for_each_spring([&](Index a, Index b) { ends.emplace_back(a, b); });
    CHECK(ends == std::vector<std::pair<Index, Index>>{{2, 1}, {0, 1}, {2, 0}});
    CHECK(system.springs<Hookean>().size() == 1);
    CHECK(system.springs<TensionOnly>().rest_length == std::vector<double>{5, 7});
}

TEMPLATE_TEST_CASE("spring_system: a spring without a rest length is at rest to the last bit",
                   "[model]", float, double) {
    Random random(11);
    SpringSystem<TestType, 3> system;
    for (int i = 0; i < 40; ++i) system.add_particle(random.vector<TestType, 3>(-1, 1), 1);
    for (int i = 0; i < 39; ++i) system.add_spring(i, i + 1, 1000);
    taut::Points<TestType, 3> f;
    const auto state = system.initial_state();
    system.force(state, f);
    CHECK(f.isZero(0));
    CHECK(system.potential_energy(state) == 0);
    CHECK(state.v.isZero(0));
    CHECK(state.time == 0);
}

TEST_CASE("spring_system: a pinned particle keeps its mass and gets it back", "[model]") {
    auto system = triangle();
    system.pin(1);
    CHECK(system.is_pinned(1));
    CHECK(system.pinned_count() == 1);
    CHECK(system.mass(1) == 2);
    CHECK(system.inverse_mass()[1] == 0);
    system.set_mass(1, 8);
    CHECK(system.is_pinned(1));
    system.unpin(1);
    CHECK(system.inverse_mass()[1] == 0.125);
    CHECK(system.pinned_count() == 0);
}

TEST_CASE(
    "spring_system: revision changes with all that a step limit depends on, and with no query",
    "[model]") {
    auto system = triangle();
    auto revision = system.revision();
    const auto changed = [&] { return std::exchange(revision, system.revision()) != revision; };
    system.add_particle({9, 9}, 1);
    CHECK(changed());
    system.add_spring(2, 3, 10);
    CHECK(changed());
    system.add_spring(Spring<double, Hookean>{0, 3, {10}, 1});
    CHECK(changed());
    system.set_mass(0, 2);
    CHECK(changed());
    system.set_rayleigh({0.1, 0.2});
    CHECK(changed());
    system.pin(0);
    CHECK(changed());
    system.pin(0);  // is already
    CHECK_FALSE(changed());
    system.unpin(0);
    CHECK(changed());
    system.unpin(0);
    CHECK_FALSE(changed());

    const auto state = system.initial_state();
    static_cast<void>(system.linearize(state));
    static_cast<void>(system.energy(state));
    CHECK_FALSE(changed());
}

TEST_CASE("spring_system: topology_revision changes with the sparsity pattern alone", "[model]") {
    auto system = triangle();
    auto revision = system.topology_revision();
    const auto changed = [&] {
        return std::exchange(revision, system.topology_revision()) != revision;
    };
    system.add_particle({9, 9}, 1);
    CHECK(changed());
    system.add_spring(2, 3, 10);
    CHECK(changed());
    system.pin(0);
    CHECK(changed());
    system.pin(0);
    CHECK_FALSE(changed());
    system.unpin(0);
    CHECK(changed());
    system.set_mass(0, 2);
    system.set_rayleigh({0.1, 0.2});
    system.set_gravity({0, -10});
    system.set_external_force([](const auto&, auto&) {});
    CHECK_FALSE(changed());
}

TEST_CASE("spring_system: bad input: mass", "[model][bad_input]") {
    for (const double mass : {0.0, -1.0, infinity, -infinity, not_a_number,
                              std::numeric_limits<double>::denorm_min()}) {
        CHECK(refused(
                  [&](auto& s) {
                      s.add_particle({0, 0}, mass);
                  },
                  {"add_particle", "mass of particle 3 is ", "finite and > 0"}) == "");
        CHECK(refused([&](auto& s) { s.set_mass(1, mass); },
                      {"set_mass", "mass of particle 1 is ", "finite and > 0"}) == "");
    }
    CHECK(refused([](auto& s) { s.add_particle({0, 0}, -2.5); }, {"-2.5"}) == "");
    CHECK(refused([](auto& s) { s.set_mass(3, 1); }, {"set_mass", "i is 3", "3 particles"}) == "");
}

TEST_CASE("spring_system: bad input: position and gravity", "[model][bad_input]") {
    for (const double bad : {infinity, -infinity, not_a_number}) {
        CHECK(refused(
                  [&](auto& s) {
                      s.add_particle({0, bad}, 1);
                  },
                  {"add_particle", "position of particle 3", "finite"}) == "");
        CHECK(refused(
                  [&](auto& s) {
                      s.set_gravity({bad, 0});
                  },
                  {"set_gravity", "gravity", "finite"}) == "");
    }
}

TEST_CASE("spring_system: bad input: stiffness, rest length, damping", "[model][bad_input]") {
    for (const double bad : {-1.0, infinity, not_a_number}) {
        CHECK(refused([&](auto& s) { s.add_spring(0, 2, bad); },
                      {"add_spring(0, 2)", "stiffness is ", ">= 0"}) == "");
        CHECK(refused([&](auto& s) { s.add_spring(0, 2, 10, bad); },
                      {"add_spring(0, 2)", "damping is ", ">= 0"}) == "");
        CHECK(refused(
                  [&](auto& s) {
                      s.add_spring(Spring<double, Hookean>{0, 2, {10}, bad});
                  },
                  {"add_spring(0, 2)", "rest_length is ", ">= 0"}) == "");
        CHECK(refused(
                  [&](auto& s) {
                      s.add_spring(Spring<double, Hookean>{0, 2, {10}, 1, bad});
                  },
                  {"add_spring(0, 2)", "damping is ", ">= 0"}) == "");
        CHECK(refused(
                  [&](auto& s) {
                      s.set_rayleigh({bad, 0});
                  },
                  {"set_rayleigh", "mass_proportional is ", ">= 0"}) == "");
        CHECK(refused(
                  [&](auto& s) {
                      s.set_rayleigh({0, bad});
                  },
                  {"set_rayleigh", "stiffness_proportional is ", ">= 0"}) == "");
    }
    CHECK(refused([](auto& s) { s.add_spring(0, 2, -0.125); }, {"-0.125"}) == "");

    SpringSystem<double, 2, Glue> glue;
    glue.add_particle({0, 0}, 1);
    glue.add_particle({1, 0}, 1);
    CHECK(missing(message_of([&] {
                      glue.add_spring<Glue>(0, 1, {10, not_a_number});
                  }),
                  {"add_spring(0, 1)", "width is nan"}) == "");
    CHECK(glue.spring_count() == 0);
}

TEST_CASE("spring_system: zero stiffness, rest length and damping are allowed", "[model]") {
    auto system = triangle();
    system.add_spring(0, 2, 0);
    system.add_spring(Spring<double, Hookean>{0, 2, {10}, 0, 0});
    CHECK(system.spring_count() == 4);
}

TEST_CASE("spring_system: bad input: a spring to itself or to a missing particle",
          "[model][bad_input]") {
    CHECK(refused([](auto& s) { s.add_spring(1, 1, 10); }, {"add_spring", "a and b are both 1"}) ==
          "");
    CHECK(refused([](auto& s) { s.add_spring(-1, 1, 10); },
                  {"add_spring", "a is -1", "3 particles"}) == "");
    CHECK(refused([](auto& s) { s.add_spring(0, 3, 10); },
                  {"add_spring", "b is 3", "3 particles"}) == "");
    CHECK(refused(
              [](auto& s) {
                  s.add_spring(Spring<double, Hookean>{3, 0, {10}, 1});
              },
              {"add_spring", "a is 3", "3 particles"}) == "");
    CHECK(refused(
              [](auto& s) {
                  s.add_spring(Spring<double, Hookean>{2, 2, {10}, 1});
              },
              {"add_spring", "a and b are both 2"}) == "");
    CHECK(refused([](auto& s) { s.pin(3); }, {"pin", "i is 3", "3 particles"}) == "");
    CHECK(refused([](auto& s) { s.unpin(-7); }, {"unpin", "i is -7", "3 particles"}) == "");
}

TEST_CASE("spring_system: bad input: a state that does not fit", "[model][bad_input]") {
    auto system = triangle();
    auto state = system.initial_state();
    taut::Points<double, 2> f = taut::Points<double, 2>::Ones(2, 1);
    for (const bool shorten_x : {true, false}) {
        auto bad = state;
        (shorten_x ? bad.x : bad.v).resize(2, 2);
        CHECK(missing(message_of([&] { system.force(bad, f); }), {"force", "3 particles"}) == "");
        CHECK(missing(message_of([&] { static_cast<void>(system.energy(bad)); }),
                      {"energy", "3 particles"}) == "");
        CHECK(missing(message_of([&] { static_cast<void>(system.linearize(bad)); }),
                      {"linearize", "3 particles"}) == "");
    }
    CHECK((f == taut::Points<double, 2>::Ones(2, 1)));
    state.x(1, 2) = not_a_number;
    CHECK(missing(message_of([&] { static_cast<void>(system.linearize(state)); }),
                  {"linearize", "particle 2", "finite"}) == "");
}

TEST_CASE("spring_system: bad input: nothing to linearize", "[model][bad_input]") {
    SpringSystem<double, 2> empty;
    CHECK(missing(message_of([&] { static_cast<void>(empty.linearize(empty.initial_state())); }),
                  {"linearize", "none of the 0 particles is free"}) == "");
    auto pinned = triangle();
    for (Index i = 0; i < 3; ++i) pinned.pin(i);
    CHECK(missing(message_of([&] { static_cast<void>(pinned.linearize(pinned.initial_state())); }),
                  {"linearize", "none of the 3 particles is free"}) == "");
}

TEST_CASE("spring_system: a system without particles has a force and an energy of nothing",
          "[model]") {
    const SpringSystem<double, 3> system;
    const auto state = system.initial_state();
    taut::Points<double, 3> f;
    system.force(state, f);
    CHECK(f.cols() == 0);
    CHECK(system.energy(state) == 0);
    CHECK(system.spring_count() == 0);
}

TEST_CASE("spring_system: a copy is independent of its original", "[model]") {
    const auto original = triangle();
    auto copy = original;
    copy.add_spring(0, 2, 5);
    copy.pin(0);
    CHECK(original.spring_count() == 2);
    CHECK(original.pinned_count() == 0);
}

TEST_CASE("spring_system: long double works too", "[model]") {
    SpringSystem<long double, 2> system;
    system.add_particle({0, 0}, 1);
    system.add_particle({0, 2}, 1);
    system.pin(0);
    system.add_spring(Spring<long double, Hookean>{0, 1, {10}, 1});
    taut::Points<long double, 2> f;
    system.force(system.initial_state(), f);
    CHECK(f(1, 1) == -10);
}

}  // namespace taut_test::spring_system_test
