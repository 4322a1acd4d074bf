// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/model/free_particles.hpp>

#include "../support/catch.hpp"
#include "../support/dense.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::free_particles_test {

using taut::FreeParticles;
using taut::VectorX;

/// A random system in which each particle is pinned or not.
template <class Scalar, int Dim>
auto pinned_anywhere(Random& random) {
    RandomOptions options;
    options.particles = 1 + random.below(12) + 1;
    options.pinned = 0;
    auto system = random_system<Scalar, Dim>(random, options);
    for (Index i = 0; i < system.size(); ++i) {
        if (random.below(3) == 0) system.pin(i);
    }
    return system;
}

TEMPLATE_TEST_CASE("free_particles: place and operator[] are inverse to each other, and ascend",
                   "[model]", (Case<float, 1>), (Case<double, 3>)) {
    Random random(2101);
    for (int trial = 0; trial < 50; ++trial) {
        const auto system = pinned_anywhere<typename TestType::Scalar, TestType::Dim>(random);
        const FreeParticles free(system);
        CHECK(free.particles() == system.size());
        CHECK(free.count() == system.size() - system.pinned_count());
        Index next = 0;
        for (Index i = 0; i < system.size(); ++i) {
            CHECK(free.place(i) == (system.is_pinned(i) ? -1 : next));
            if (system.is_pinned(i)) continue;
            CHECK(free[next] == i);
            CHECK(*(free.begin() + next) == i);
            ++next;
        }
        CHECK(free.end() - free.begin() == next);
    }
}

TEMPLATE_TEST_CASE("free_particles: gather takes the free degrees of freedom, scatter returns them",
                   "[model]", (Case<float, 1>), (Case<float, 2>), (Case<float, 3>),
                   (Case<double, 1>), (Case<double, 2>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(2102);
    for (int trial = 0; trial < 50; ++trial) {
        const auto system = pinned_anywhere<Scalar, Dim>(random);
        const FreeParticles free(system);
        const auto points = random.points<Scalar, Dim>(system.size(), -1, 1);
        VectorX<Scalar> values;
        free.gather(points, values);
        const Eigen::Map<const VectorX<Scalar>> all(points.data(), points.size());
        CHECK(values == VectorX<Scalar>(all(free_dofs(system))));

        // scatter keeps the columns of pinned particles; add is linear.
        auto other = random.points<Scalar, Dim>(system.size(), -1, 1);
        const auto before = other;
        free.add(Scalar(2), values, other);
        for (Index i = 0; i < system.size(); ++i) {
            const taut::Points<Scalar, Dim> sum = before.col(i) + Scalar(2) * points.col(i);
            CHECK(other.col(i) == (system.is_pinned(i) ? before.col(i).eval() : sum.col(0).eval()));
        }
        free.scatter(values, other);
        for (Index i = 0; i < system.size(); ++i) {
            CHECK(other.col(i) == (system.is_pinned(i) ? before.col(i) : points.col(i)));
        }
    }
}

TEST_CASE("free_particles: all are free where none is pinned", "[model]") {
    CHECK(FreeParticles().count() == 0);
    CHECK(FreeParticles::all(0).count() == 0);
    const auto free = FreeParticles::all(3);
    CHECK(std::vector<Index>(free.begin(), free.end()) == std::vector<Index>{0, 1, 2});
    CHECK(free.particles() == 3);
    CHECK(free.place(2) == 2);
}

}  // namespace taut_test::free_particles_test
