// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
// Building and revisions. What is refused: refusals_test.cpp.
#include <taut/network/spring_system.hpp>
#include <taut/network/tangent_matrix.hpp>
#include <taut/network/buckling.hpp>
#include <utility>
#include <vector>

#include "../support/catch.hpp"
#include "../support/laws.hpp"
#include "../support/random_system.hpp"
#include "triangle.hpp"

namespace taut_test::spring_system_test {

using taut::Hookean;
using taut::Spring;
using taut::SpringSystem;

TEST_CASE("spring_system: particles and springs are numbered from 0 in the order of adding",
          "[network]") {
    Mixed<double, 2> system;
    CHECK(system.add_particle({0, 0}, 1) == 0);
    CHECK(system.add_particle({3, 4}, 2) == 1);
    CHECK(system.add_particle({3, 0}, 4) == 2);
    CHECK(system.add_spring<Buckling>(0, 1, {30, 1, 1}) == 0);
    CHECK(system.add_spring(2, 1, 10) == 0);
    CHECK(system.add_spring(Spring<double, Buckling>{2, 0, {40, 1, 1}, 7}) == 1);
    CHECK(system.size() == 3);
    CHECK(system.spring_count() == 3);
    CHECK(system.mass(2) == 4);
    CHECK((system.inverse_mass() == Eigen::Vector3d(1, 0.5, 0.25)));

    // Laws in the order of the template arguments, then in the order of adding.
    std::vector<std::pair<Index, Index>> ends;
    system.for_each_spring([&](Index a, Index b) { ends.emplace_back(a, b); });
    CHECK(ends == std::vector<std::pair<Index, Index>>{{2, 1}, {0, 1}, {2, 0}});
    std::size_t s = 0;
    system.visit_springs(
        [&](const auto& spring) { CHECK(ends[s++] == std::pair(spring.a, spring.b)); });
    CHECK(s == 3);
    CHECK(system.springs<Hookean>().size() == 1);
    const auto& lengths = system.springs<Buckling>().rest_length;
    CHECK(std::vector<double>(lengths.begin(), lengths.end()) == std::vector<double>{5, 7});
}

TEMPLATE_TEST_CASE("spring_system: a spring without a rest length is at rest to the last bit",
                   "[network]", float, double) {
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

TEST_CASE("spring_system: a pinned particle keeps its mass and gets it back", "[network]") {
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
    "[network]") {
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
    static_cast<void>(system.energy(state));
    CHECK_FALSE(changed());
}

TEST_CASE("spring_system: topology_revision changes with the sparsity pattern alone", "[network]") {
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

TEST_CASE("spring_system: zero stiffness, rest length and damping are allowed", "[network]") {
    auto system = triangle();
    system.add_spring(Spring<double, Hookean>{0, 2, {10}, 0, 0});
    system.add_spring(Spring<double, Hookean>{0, 2, {10}, 0, 0});
    CHECK(system.spring_count() == 4);
}

TEST_CASE("spring_system: constant and other forces add up, and end where nothing is left of them",
          "[network]") {
    auto system = triangle();
    const auto alone = [&] {
        taut::Points<double, 2> f;
        system.external_force(system.initial_state(), f);
        return f;
    };
    taut::Points<double, 2> expected = taut::Points<double, 2>::Zero(2, 3);
    auto revision = system.force_revision();
    const auto changed = [&] {
        return std::exchange(revision, system.force_revision()) != revision;
    };
    const auto set = [&](Index i, const Eigen::Vector2d& force) {
        const auto others = system.revision();
        system.set_constant_force(i, force);
        CHECK(changed());
        CHECK(system.revision() == others);
        expected.col(i) = force;
        CHECK((alone() == expected));
        CHECK(system.has_external_force() == !expected.isZero(0));
    };
    CHECK((alone() == expected));
    set(0, {1, 0});
    set(2, {0, 1});
    set(2, {0, 2});
    set(0, {0, 0});
    set(2, {0, 0});
    set(1, {3, 4});
    for (const double x : {7, 8})
        system.add_particle({x, 0}, 1);  // they have no force of their own
    CHECK(changed());
    expected.conservativeResize(2, 5);
    expected.rightCols(2).setZero();
    set(4, {5, 6});
    system.set_external_force([](const auto& state, auto& f) { f += 2 * state.x; });
    CHECK(changed());
    CHECK((alone() == expected + 2 * system.initial_state().x));
    system.set_external_force({});
    CHECK((alone() == expected));
    system.set_gravity({0, -1});
    CHECK(changed());
    system.set_mass(1, 9);
    CHECK(changed());
    system.add_spring(0, 2, 1);
    CHECK(changed());
    CHECK_FALSE(changed());
}

TEST_CASE("spring_system: a system without particles has a force and an energy of nothing",
          "[network]") {
    const SpringSystem<double, 3> system;
    const auto state = system.initial_state();
    taut::Points<double, 3> f;
    system.force(state, f);
    CHECK(f.cols() == 0);
    CHECK(system.energy(state) == 0);
    CHECK(system.spring_count() == 0);
}

TEST_CASE("spring_system: a copy is independent of its original", "[network]") {
    const auto original = triangle();
    auto copy = original;
    copy.add_spring(0, 2, 5);
    copy.pin(0);
    CHECK(original.spring_count() == 2);
    CHECK(original.pinned_count() == 0);
}

TEST_CASE("spring_system: long double works too", "[network]") {
    SpringSystem<long double, 2> system;
    system.add_particle({0, 0}, 1);
    system.add_particle({0, 2}, 1);
    system.pin(0);
    system.add_spring(Spring<long double, Hookean>{0, 1, {10}, 1});
    taut::Points<long double, 2> f;
    system.force(system.initial_state(), f);
    CHECK(f(1, 1) == -10);
}

TEST_CASE("spring_system: its matrices have one block for each joined pair of free particles",
          "[network]") {
    taut::SpringSystem<double, 3> system;
    for (int i = 0; i < 5; ++i) system.add_particle({double(i), 0, 0}, 1);
    system.add_spring(0, 1, 10);
    system.add_spring(1, 0, 10);  // a duplicate
    system.add_spring(1, 2, 10);  // to a pinned one
    system.add_spring(3, 0, 10);
    system.pin(2);
    const auto sum = taut::matrices::M + taut::matrices::D + taut::matrices::K_plus;
    const taut::TangentMatrix<double, 3> tangent(system);
    const auto& free = tangent.free();
    CHECK(std::vector<Index>(free.begin(), free.end()) == std::vector<Index>{0, 1, 3, 4});
    CHECK(tangent.size() == 12);
    auto A = tangent.zero();
    CHECK(A.isCompressed());
    CHECK(A.rows() == 12);
    CHECK(A.nonZeros() == 9 * (4 + 2 * 2));
    CHECK(A.squaredNorm() == 0);
    for (Index j = 0; j < A.outerSize(); ++j) {  // row indices ascend, as factorisations expect
        for (int e = A.outerIndexPtr()[j] + 1; e < A.outerIndexPtr()[j + 1]; ++e) {
            CHECK(A.innerIndexPtr()[e - 1] < A.innerIndexPtr()[e]);
        }
    }
    const double* values = A.valuePtr();
    tangent.assemble(system, system.initial_state().x, sum, A);
    CHECK(A.valuePtr() == values);
    CHECK(A.nonZeros() == 9 * (4 + 2 * 2));
    for (Index i = 0; i < 5; ++i) system.pin(i);
    const taut::TangentMatrix<double, 3> nothing(system);
    auto none = nothing.zero();
    nothing.assemble(system, system.initial_state().x, sum, none);
    CHECK(none.rows() == 0);
    CHECK(none.nonZeros() == 0);
    CHECK(taut::TangentMatrix<double, 3>(taut::SpringSystem<double, 3>()).zero().rows() == 0);
}

}  // namespace taut_test::spring_system_test
