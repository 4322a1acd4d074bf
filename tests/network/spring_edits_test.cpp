// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// Edits of a system that is being simulated: what they leave, what they raise, what they refuse.
#include <limits>
#include <taut/proof/any_pose.hpp>
#include <taut/network/buckling.hpp>
#include <tuple>
#include <vector>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"

namespace taut_test::spring_edits_test {

using taut::Hookean;

namespace {

using System = Mixed<double, 2>;
using Row = std::tuple<int, int, double, double, double>;  // a, b, L, k, damping

template <class Law>
std::vector<Row> rows(const System& system) {
    const auto& set = system.springs<Law>();
    std::vector<Row> rows;
    for (std::size_t s = 0; s < set.a.size(); ++s) {
        rows.emplace_back(set.a[s], set.b[s], set.rest_length[s], set.parameters[s].stiffness,
                          set.damping_of(s));
    }
    return rows;
}

System drawn(std::uint32_t seed, bool dampers) {
    Random random(seed);
    RandomOptions options;
    options.dampers = dampers;
    return random_like<System>(random, options);
}

}  // namespace

TEST_CASE("spring edits: a removed spring leaves its index to the last one of its law",
          "[network]") {
    for (const bool dampers : {false, true}) {
        auto system = drawn(3, dampers);
        const auto others = rows<Hookean>(system);
        for (const Index s : {Index(4), Index(12), Index(0)}) {  // 12: by then the last one
            auto expected = rows<Buckling>(system);
            expected[s] = expected.back();
            expected.pop_back();
            system.remove_spring<Buckling>(s);
            CHECK(rows<Buckling>(system) == expected);
        }
        CHECK(rows<Hookean>(system) == others);
    }
}

TEST_CASE(
    "spring edits: a predicate is asked once for each spring, and those that stay keep their "
    "order",
    "[network]") {
    for (const bool dampers : {false, true}) {
        auto system = drawn(4, dampers);
        const auto all = rows<Hookean>(system);
        std::vector<Row> expected;
        for (std::size_t s = 0; s < all.size(); ++s) {
            if (s % 3 != 1) expected.push_back(all[s]);
        }
        Index asked = 0;
        const Index removed = system.remove_springs([&](Index s) {
            CHECK(s == asked++);
            return s % 3 == 1;
        });
        CHECK(asked == static_cast<Index>(all.size()));
        CHECK(removed == static_cast<Index>(all.size() - expected.size()));
        CHECK(rows<Hookean>(system) == expected);
        const auto revision = system.revision();
        CHECK(system.remove_springs([](Index) { return false; }) == 0);
        CHECK(system.revision() == revision);
        CHECK(system.remove_springs([](Index) { return true; }) ==
              static_cast<Index>(expected.size()));
        CHECK(system.springs<Hookean>().size() == 0);
    }
}

TEST_CASE("spring edits: the force is that of a system built so", "[network]") {
    Random random(5);
    auto system = drawn(6, true);
    system.remove_spring<Hookean>(2);
    system.remove_springs<Buckling>([](Index s) { return s % 4 == 0; });
    system.set_stiffness(1, 7.5);
    system.set_parameters<Buckling>(3, {0.25, 0.5, 0.125});
    System built;
    const auto start = system.initial_state();
    for (Index i = 0; i < system.size(); ++i) built.add_particle(start.x.col(i), system.mass(i));
    system.visit_springs([&](const auto& spring) { built.add_spring(spring); });
    CHECK(std::get<3>(rows<Hookean>(system)[1]) == 7.5);
    CHECK(std::get<3>(rows<Buckling>(system)[3]) == 0.25);
    built.set_gravity(system.gravity());
    const auto state = random_state(random, system);
    System::Force f, expected;
    system.force(state, f);
    built.force(state, expected);
    CHECK(f == expected);
}

TEST_CASE("spring edits: each voids a limit, and the new one is that of the new scene",
          "[network]") {
    auto system = drawn(7, false);
    const auto revised = [&](auto&& edit) {
        const auto before = taut::any_pose_limit(system);
        REQUIRE(before.step_for(system, 0.95));
        const auto springs = system.spring_revision();
        edit();
        CHECK_FALSE(before.step_for(system, 0.95));
        CHECK(system.spring_revision() > springs);
        const auto after = taut::any_pose_limit(system);
        CHECK(after.step_for(system, 0.95));
        return after.certified / before.certified;
    };
    CHECK(revised([&] { system.set_stiffness(0, 1e6); }) < 0.5);
    CHECK(revised([&] { system.remove_spring<Hookean>(0); }) > 2);
    CHECK(revised([&] { system.set_parameters<Buckling>(5, {2e6, 0, 0}); }) < 0.5);
    CHECK(revised([&] { system.remove_springs<Buckling>([](Index s) { return s == 5; }); }) > 2);
    CHECK(revised([&] { system.pin(5); }) >= 1);
    CHECK(revised([&] { system.unpin(5); }) <= 1);
}

TEST_CASE("spring edits: what changes parameters alone leaves the topology", "[network]") {
    auto system = drawn(8, false);
    const auto topology = system.topology_revision();
    system.set_stiffness(0, 3);
    CHECK(system.topology_revision() == topology);
    system.remove_spring<Buckling>(0);
    CHECK(system.topology_revision() > topology);
}

TEST_CASE("spring edits: wrong ones name index and value, and change nothing", "[network]") {
    auto system = drawn(9, true);
    const auto hookean = rows<Hookean>(system);
    const auto revision = system.revision();
    const auto says = [&](auto&& edit, std::initializer_list<const char*> words) {
        CHECK(missing(message_of(edit), words) == "");
        CHECK(rows<Hookean>(system) == hookean);
        CHECK(system.revision() == revision);
    };
    says([&] { system.remove_spring(14); }, {"remove_spring", "s is 14", "14 springs"});
    says([&] { system.remove_spring<Buckling>(-1); }, {"remove_spring", "s is -1"});
    says([&] { system.set_stiffness(99, 1); }, {"set_parameters", "s is 99", "14 springs"});
    says([&] { system.set_stiffness(2, -1); }, {"set_parameters(2)", "stiffness is -1", ">= 0"});
    says([&] { system.set_stiffness(2, std::numeric_limits<double>::quiet_NaN()); },
         {"set_parameters(2)", "stiffness is nan"});
}

}  // namespace taut_test::spring_edits_test
