// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <taut/model/tension_only.hpp>
#include <taut/resolution/coarsen.hpp>
#include <taut/wind/wind.hpp>
#include <utility>
#include <vector>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::coarsen_test {

using taut::coarsen;

#define TAUT_COARSEN_CASES                                                                       \
    (Case<double, 1>), (Case<double, 2>), (Case<double, 3>), (Case<float, 1>), (Case<float, 2>), \
        (Case<float, 3>)

namespace {

/// A connected random network of all three laws, some particles pinned, the first of them not.
template <class Scalar, int Dim>
using Mixed = taut::SpringSystem<Scalar, Dim, taut::Hookean, taut::TensionOnly, taut::Buckling>;

template <class Scalar, int Dim>
Mixed<Scalar, Dim> random_network(Random& random, Index n, Index pins) {
    Mixed<Scalar, Dim> system;
    for (Index i = 0; i < n; ++i)
        system.add_particle(random.vector<Scalar, Dim>(-1, 1),
                            static_cast<Scalar>(random.uniform(0.1, 1)));
    const auto x = system.initial_state().x;
    const auto join = [&](Index a, Index b) {
        const auto k = static_cast<Scalar>(random.uniform(10, 100));
        const Scalar rest =
            (x.col(b) - x.col(a)).norm() * static_cast<Scalar>(random.uniform(0.8, 1.2));
        const auto damping =
            static_cast<Scalar>(static_cast<double>(random.below(2)) * random.uniform(0, 1));
        switch (random.below(3)) {
            case 0:
                system.add_spring(taut::Spring<Scalar, taut::Hookean>{a, b, {k}, rest, damping});
                break;
            case 1:
                system.add_spring(
                    taut::Spring<Scalar, taut::TensionOnly>{a, b, {k}, rest, damping});
                break;
            default:
                system.add_spring(taut::Spring<Scalar, taut::Buckling>{
                    a, b, {k, Scalar(0.01) * k * rest * rest * rest, k}, rest, damping});
        }
    };
    for (Index i = 1; i < n; ++i) join(random.below(i), i);
    for (Index s = 0; s < 2 * n; ++s) {
        const Index a = random.below(n), b = random.below(n);
        if (a != b) join(a, b);
    }
    for (Index p = 0; p < pins; ++p) system.pin(1 + (p * 7) % (n - 1));
    return system;
}

}  // namespace

TEST_CASE("coarsen: seeds are the farthest along the springs, clusters the nearest to them",
          "[scene]") {
    Random random(3);
    for (int trial = 0; trial < 20; ++trial) {
        const Index n = 5 + random.below(30);
        const auto system = random_network<double, 3>(random, n, 1 + random.below(3));
        const auto x = system.initial_state().x;
        // Every pair's distance, by Floyd and Warshall.
        Eigen::MatrixXd length =
            Eigen::MatrixXd::Constant(n, n, std::numeric_limits<double>::infinity());
        length.diagonal().setZero();
        // A spring of half the median's k l leads √2 times as far.
        std::vector<double> strengths;
        const auto strength = [&](const auto& spring) {
            return spring.stiffness_bound() * (x.col(spring.b) - x.col(spring.a)).norm();
        };
        system.visit_springs([&](const auto& spring) { strengths.push_back(strength(spring)); });
        std::sort(strengths.begin(), strengths.end());
        const double median = strengths[strengths.size() / 2];
        system.visit_springs([&](const auto& spring) {
            const double softer = std::sqrt(std::max(1.0, median / strength(spring)));
            const double l = softer * (x.col(spring.b) - x.col(spring.a)).norm();
            double& known = length(spring.a, spring.b);
            known = length(spring.b, spring.a) = std::min(known, l);
        });
        for (Index via = 0; via < n; ++via)
            for (Index i = 0; i < n; ++i)
                for (Index j = 0; j < n; ++j)
                    length(i, j) = std::min(length(i, j), length(i, via) + length(via, j));
        const auto coarse = coarsen(system, 3 + random.below(n - 3));
        const Index pins = system.pinned_count();
        Eigen::VectorXd nearest =
            Eigen::VectorXd::Constant(n, std::numeric_limits<double>::infinity());
        for (std::size_t s = 0; s < coarse.seeds.size(); ++s) {
            const int seed = coarse.seeds[s];
            CHECK(coarse.system.is_pinned(static_cast<Index>(s)) == (static_cast<Index>(s) < pins));
            if (static_cast<Index>(s) >= pins) CHECK(nearest[seed] >= nearest.maxCoeff() - 1e-12);
            nearest = nearest.cwiseMin(length.col(seed));
        }
        for (Index i = 0; i < n; ++i) {
            const int seed = coarse.seeds[coarse.cluster[i]];
            CHECK(length(i, seed) <= nearest[i] + 1e-12);
        }
    }
}

TEMPLATE_TEST_CASE("coarsen: mass, momentum, constant forces and factors are kept", "[scene]",
                   TAUT_COARSEN_CASES) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(5);
    for (int trial = 0; trial < 10; ++trial) {
        const Index n = 10 + random.below(50);
        auto system = random_network<Scalar, Dim>(random, n, trial % 3);
        system.set_gravity(random.vector<Scalar, Dim>(-10, 10));
        system.set_rayleigh({0.3, 2e-3});
        for (int f = 0; f < 5; ++f)
            system.set_constant_force(random.below(n), random.vector<Scalar, Dim>(-1, 1));
        const auto coarse = coarsen(system, 4 + random.below(n - 4));
        auto state = system.initial_state();
        state.v = random.points<Scalar, Dim>(n, -1, 1);
        state.time = Scalar(0.5);
        const auto reduced = coarse.restricted(state);
        Eigen::Matrix<double, Dim, 1> momentum = Eigen::Matrix<double, Dim, 1>::Zero();
        auto force = momentum;
        double mass = 0;
        const auto& constant = system.external_forces().constant;
        for (Index i = 0; i < n; ++i) {
            mass += static_cast<double>(system.mass(i));
            if (i < constant.cols()) force += constant.col(i).template cast<double>();
            if (coarse.system.is_pinned(coarse.cluster[i])) continue;
            momentum +=
                static_cast<double>(system.mass(i)) * state.v.col(i).template cast<double>();
        }
        const auto& carried = coarse.system.external_forces().constant;
        for (Index c = 0; c < coarse.system.size(); ++c) {
            mass -= static_cast<double>(coarse.system.mass(c));
            if (c < carried.cols()) force -= carried.col(c).template cast<double>();
            CHECK(reduced.x.col(c) == state.x.col(coarse.seeds[c]));
            if (coarse.system.is_pinned(c)) {
                CHECK(reduced.v.col(c) == state.v.col(coarse.seeds[c]));
            } else {
                momentum -= static_cast<double>(coarse.system.mass(c)) *
                            reduced.v.col(c).template cast<double>();
            }
        }
        const double tolerance = static_cast<double>(n) * Tolerance<Scalar>::rounding;
        CHECK(std::abs(mass) < tolerance);
        CHECK(force.norm() < tolerance);
        CHECK(momentum.norm() < tolerance);
        CHECK(reduced.time == state.time);
        CHECK(coarse.system.gravity() == system.gravity());
        CHECK(coarse.system.rayleigh().stiffness_proportional == 2e-3);
        CHECK(coarse.system.rayleigh().mass_proportional == 0.3);
    }
}

TEMPLATE_TEST_CASE("coarsen: all particles are the same network in another order", "[scene]",
                   TAUT_COARSEN_CASES) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(7);
    for (int trial = 0; trial < 10; ++trial) {
        const Index n = 5 + random.below(20);
        // No two springs of one law join the same pair: their rest lengths would be averaged.
        taut::SpringSystem<Scalar, Dim, taut::TensionOnly, taut::Buckling> system;
        for (Index i = 0; i < n; ++i)
            system.add_particle(random.vector<Scalar, Dim>(-1, 1), Scalar(0.1));
        const auto x = system.initial_state().x;
        for (Index a = 0; a < n; ++a) {
            for (Index b = a + 1; b < n; ++b) {
                if (b != a + 1 && random.below(3) > 0) continue;
                const Scalar rest = (x.col(b) - x.col(a)).norm() * Scalar(0.9);
                const Scalar unit = Scalar(0.01) * rest * rest * rest;
                system.add_spring(taut::Spring<Scalar, taut::Buckling>{
                    a, b, {7, 20 * unit, 9}, rest * Scalar(1.3), 2});
                system.add_spring(taut::Spring<Scalar, taut::TensionOnly>{a, b, {3}, rest, 1});
            }
        }
        const auto coarse = coarsen(system, n);
        const auto state = system.initial_state();
        auto moving = state;
        moving.v = random.points<Scalar, Dim>(n, -1, 1);
        taut::Points<Scalar, Dim> fine_force, force;
        system.force(moving, fine_force);
        coarse.system.force(coarse.restricted(moving), force);
        const double scale = largest(fine_force);
        for (Index c = 0; c < n; ++c)
            CHECK(distance(force.col(c), fine_force.col(coarse.seeds[c])) <
                  Tolerance<Scalar>::accumulated * scale);
    }
}

TEMPLATE_TEST_CASE("coarsen: a rope of equal k L keeps it, its strain and its dampers", "[scene]",
                   TAUT_COARSEN_CASES) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(11);
    for (int trial = 0; trial < 10; ++trial) {
        const Index n = 20 + random.below(40);
        const auto direction = random.vector<double, Dim>(0.2, 1).normalized().eval();
        taut::SpringSystem<Scalar, Dim> rope;
        double along = 0;
        for (Index i = 0; i < n; ++i) {
            rope.add_particle((along * direction).template cast<Scalar>(), Scalar(0.1));
            along += random.uniform(0.01, 0.05);
        }
        const auto x = rope.initial_state().x;
        for (Index i = 0; i + 1 < n; ++i) {
            const Scalar l = (x.col(i + 1) - x.col(i)).norm();
            rope.add_spring(taut::Spring<Scalar, taut::Hookean>{
                i, i + 1, {Scalar(30) / l}, l / Scalar(1.25), Scalar(2) / l});
        }
        const auto coarse = coarsen(rope, 2 + random.below(n - 2));
        const auto at = coarse.system.initial_state().x;
        const double tolerance = Tolerance<Scalar>::accumulated;
        CHECK(coarse.system.spring_count() == coarse.system.size() - 1);
        coarse.system.visit_springs([&](const auto& spring) {
            const auto l = static_cast<double>((at.col(spring.b) - at.col(spring.a)).norm());
            using Catch::Matchers::WithinRel;
            CHECK_THAT(static_cast<double>(spring.parameters.stiffness) * l,
                       WithinRel(30, tolerance));
            CHECK_THAT(static_cast<double>(spring.damping) * l, WithinRel(2, tolerance));
            CHECK_THAT(l / static_cast<double>(spring.rest_length), WithinRel(1.25, tolerance));
        });
    }
}

TEMPLATE_TEST_CASE("coarsen: under a stretch along AB a coarse spring stores what it stands for",
                   "[scene]", TAUT_COARSEN_CASES) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(13);
    for (int trial = 0; trial < 6; ++trial) {
        const Index n = 30 + random.below(30);
        taut::SpringSystem<Scalar, Dim> system;
        for (Index i = 0; i < n; ++i)
            system.add_particle(random.vector<Scalar, Dim>(-1, 1), Scalar(0.1));
        for (Index i = 1; i < n; ++i)
            system.add_spring(random.below(i), i, static_cast<Scalar>(random.uniform(10, 100)));
        const auto coarse = coarsen(system, 5 + random.below(10));
        const auto x = system.initial_state().x;
        // Between A and B each crossing spring stands for L_AB/(l |cos θ|) of its kind, since those
        // of a volume cross a plane in proportion to l |cos θ|. A strain ε along AB stretches it by
        // ε l cos² θ.
        std::map<std::pair<int, int>, double> energy;  // J/ε²
        system.visit_springs([&](const auto& spring) {
            const int a = coarse.cluster[spring.a], b = coarse.cluster[spring.b];
            if (a == b) return;
            const Eigen::Matrix<double, Dim, 1> d =
                (x.col(spring.b) - x.col(spring.a)).template cast<double>();
            const Eigen::Matrix<double, Dim, 1> AB =
                (x.col(coarse.seeds[b]) - x.col(coarse.seeds[a])).template cast<double>();
            const double along = std::abs(d.dot(AB)) / AB.norm();
            const double stretch = along * along / d.norm();
            energy[std::minmax(a, b)] += static_cast<double>(spring.parameters.stiffness) *
                                         stretch * stretch / 2 * (AB.norm() / along);
        });
        std::size_t springs = 0;
        coarse.system.visit_springs([&](const auto& spring) {
            const auto a = static_cast<int>(spring.a), b = static_cast<int>(spring.b);
            const auto L =
                static_cast<double>((x.col(coarse.seeds[b]) - x.col(coarse.seeds[a])).norm());
            REQUIRE(energy.count(std::minmax(a, b)) == 1);
            CHECK_THAT(static_cast<double>(spring.parameters.stiffness) * L * L / 2,
                       Catch::Matchers::WithinRel(energy[std::minmax(a, b)],
                                                  Tolerance<Scalar>::accumulated));
            ++springs;
        });
        CHECK(springs == energy.size());
    }
}

TEMPLATE_TEST_CASE("coarsen: a lift is a mean of near seeds, exact at seeds", "[scene]",
                   TAUT_COARSEN_CASES) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(17);
    for (int trial = 0; trial < 6; ++trial) {
        const Index n = 20 + random.below(80);
        const auto system = random_network<Scalar, Dim>(random, n, 2);
        const Index count = 4 + random.below(n - 4);
        const auto coarse = coarsen(system, count);
        const auto u = random.points<Scalar, Dim>(count, -1, 1);
        const auto fine = coarse.lifted(u);
        for (Index c = 0; c < count; ++c) CHECK(fine.col(coarse.seeds[c]) == u.col(c));
        const auto shift = random.vector<Scalar, Dim>(-1, 1);
        const taut::Points<Scalar, Dim> same = shift.replicate(1, count);
        CHECK(distance(coarse.lifted(same), shift.replicate(1, n)) < Tolerance<Scalar>::rounding);
        // A mean: never outside of the values.
        for (int d = 0; d < Dim; ++d) {
            CHECK(fine.row(d).maxCoeff() <= u.row(d).maxCoeff() + Tolerance<Scalar>::rounding);
            CHECK(fine.row(d).minCoeff() >= u.row(d).minCoeff() - Tolerance<Scalar>::rounding);
        }
        // Of four at the most, and near: no weight beyond the cluster's own and joined ones.
        std::vector<int> used(static_cast<std::size_t>(n), 0);
        for (Index c = 0; c < count; ++c) {
            taut::Points<Scalar, Dim> one = taut::Points<Scalar, Dim>::Zero(Dim, count);
            one(0, c) = 1;
            const auto reach = coarse.lifted(one);
            for (Index i = 0; i < n; ++i) used[i] += reach(0, i) > 0;
        }
        CHECK(*std::max_element(used.begin(), used.end()) <= 4);
        CHECK(*std::min_element(used.begin(), used.end()) >= 1);
    }
}

TEST_CASE("coarsen: a smaller count's seeds come first among a larger one's", "[scene]") {
    Random random(19);
    const auto system = random_network<double, 2>(random, 200, 5);
    const auto most = coarsen(system, 200).seeds;
    CHECK(std::set<int>(most.begin(), most.end()).size() == 200);
    for (const Index count : {5, 6, 20, 100, 199}) {
        const auto seeds = coarsen(system, count).seeds;
        CHECK(std::equal(seeds.begin(), seeds.end(), most.begin()));
    }
}

TEST_CASE("coarsen: bad input: counts and forces that cannot be carried over",
          "[scene][bad_input]") {
    Random random(23);
    auto system = random_network<double, 3>(random, 30, 4);
    const auto refused = [&](Index count, std::initializer_list<const char*> words) {
        return missing(message_of([&] { coarsen(system, count); }), words);
    };
    CHECK(refused(0, {"coarsen", "count is 0", "30 particles"}) == "");
    CHECK(refused(-3, {"count is -3"}) == "");
    CHECK(refused(31, {"count is 31", "30 particles"}) == "");
    CHECK(refused(3, {"count is 3", "4 pins"}) == "");
    using System = Mixed<double, 3>;
    system.set_external_force([](const System::State&, System::Force&) {});
    CHECK(refused(10, {"coarsen", "set_external_force"}) == "");
    system.set_external_force({});
    taut::Wind<double> wind;
    wind.triangles.push_back({0, 1, 2});
    taut::set_wind(system, wind);
    CHECK(refused(10, {"coarsen", "set_wind"}) == "");
    taut::set_wind(system, {});
    CHECK(refused(10, {}) == "");
    const auto coarse = coarsen(system, 10);
    CHECK(missing(message_of([&] { coarse.lifted(System::Force::Zero(3, 9)); }),
                  {"lifted", "9 columns", "10 particles"}) == "");
    auto state = system.initial_state();
    state.x.conservativeResize(3, 29);
    CHECK(missing(message_of([&] { coarse.restricted(state); }), {"restricted", "29"}) == "");
    taut::SpringSystem<double, 3> stacked;
    for (int i = 0; i < 3; ++i) stacked.add_particle({0, 0, 0}, 1);
    stacked.add_spring(taut::Spring<double, taut::Hookean>{0, 2, {10}, 0.5, 0});
    CHECK(missing(message_of([&] { coarsen(stacked, 3); }),
                  {"particles 0 and 2", "initial_state", "0.5 m"}) == "");
    const taut::SpringSystem<double, 3> empty;
    CHECK(missing(message_of([&] { coarsen(empty, 1); }), {"no particles"}) == "");
}

}  // namespace taut_test::coarsen_test
