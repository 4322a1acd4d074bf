// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <array>
#include <limits>
#include <set>
#include <taut/network/block_pattern.hpp>
#include <taut/network/combination.hpp>
#include <taut/network/free_particles.hpp>
#include <taut/network/state.hpp>

#include "../support/catch.hpp"
#include "../support/scene_dense.hpp"
#include "../support/tolerance.hpp"

// What systems and their matrices are made of.

namespace taut_test::parts_test {

using namespace taut::matrices;
using taut::FreeParticles;

namespace {

using Pairs = std::set<std::pair<Index, Index>>;

/// Adds the Dim × Dim blocks to zeros of the pattern.
template <int Dim>
taut::SparseMatrix<double> filled(const taut::BlockPattern& pattern, const Eigen::MatrixXd& dense,
                                  const Pairs& places) {
    auto A = pattern.zero<double, Dim>();
    for (const auto& [row, column] : places) {
        const Eigen::Matrix<double, Dim, Dim> block =
            dense.block<Dim, Dim>(Dim * row, Dim * column);
        pattern.add(A, pattern.place(row, column), column, block);
    }
    return A;
}

/// Free coordinates of `from`; `to` with twice these added, and with these in their place.
struct Moved {
    Eigen::MatrixXd gathered, added, scattered;
};
template <class Scalar, int Dim>
Moved moved(const FreeParticles& free, const Eigen::MatrixXd& from, const Eigen::MatrixXd& to) {
    taut::VectorX<Scalar> values;
    free.gather(taut::Points<Scalar, Dim>(from.cast<Scalar>()), values);
    taut::Points<Scalar, Dim> sum = to.cast<Scalar>();
    free.add(Scalar(2), values, sum);
    taut::Points<Scalar, Dim> exchanged = to.cast<Scalar>();
    free.scatter(values, exchanged);
    return {values.template cast<double>(), sum.template cast<double>(),
            exchanged.template cast<double>()};
}

std::array<double, 4> factors(const taut::Combination& c) {
    return {c.mass(), c.damping(), c.stiffness(), c.projected()};
}

}  // namespace

TEST_CASE("parts: block_pattern has the blocks of the pairs and of the diagonal, each once",
          "[network]") {
    Random random(60);
    for (int repeat = 0; repeat < 120; ++repeat) {
        const int dim = 1 + repeat % 3;
        CAPTURE(repeat);
        const Index n = 1 + random.below(12);
        taut::Buffer<taut::BlockPair> pairs;
        for (Index p = 0; n > 1 && p < random.below(30); ++p) {
            const Index a = random.below(n);
            const Index b = (a + 1 + random.below(n - 1)) % n;
            pairs.push_back({static_cast<int>(a), static_cast<int>(b)});
            if (p % 4 == 0) pairs.push_back({static_cast<int>(b), -1});  // a pinned end
        }
        const taut::BlockPattern pattern(n, pairs);
        Pairs places;
        for (Index i = 0; i < n; ++i) places.emplace(i, i);
        for (const auto& [a, b] : pairs) {
            if (b >= 0) places.insert({{a, b}, {b, a}});
        }
        REQUIRE(pattern.columns() == n);
        REQUIRE(pattern.blocks() == static_cast<Index>(places.size()));
        Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(dim * n, dim * n);
        for (const auto& [row, column] : places)
            dense.block(dim * row, dim * column, dim, dim) = random_points(random, dim, dim, -1, 1);
        const auto A = dim == 1   ? filled<1>(pattern, dense, places)
                       : dim == 2 ? filled<2>(pattern, dense, places)
                                  : filled<3>(pattern, dense, places);
        CHECK(A.isCompressed());
        CHECK(A.nonZeros() == dim * dim * pattern.blocks());
        CHECK((Eigen::MatrixXd(A) == dense));
    }
}

TEST_CASE("parts: free particles ascend, and gather, scatter and add know their coordinates",
          "[network]") {
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        Random random(2101);
        for (int trial = 0; trial < 50; ++trial) {
            CAPTURE(kind, trial);
            Scene scene(kind);
            for (Index i = 2 + random.below(12); i > 0; --i)
                scene.add_particle(Eigen::VectorXd::Zero(kind.dim), 1);
            Eigen::MatrixXd from = random_points(random, kind.dim, scene.size(), -1, 1);
            const Eigen::MatrixXd to = random_points(random, kind.dim, scene.size(), -1, 1);
            Eigen::MatrixXd expected = from;
            for (Index i = 0; i < scene.size(); ++i) {
                if (random.below(3) != 0) continue;
                scene.pin(i);
                expected.col(i) = to.col(i);
                from.col(i) *= 0;
            }
            const FreeParticles free(scene);
            CHECK(free.particles() == scene.size());
            std::vector<Index> ascending;
            for (Index i = 0; i < scene.size(); ++i) {
                const Index next = static_cast<Index>(ascending.size());
                CHECK(free.place(i) == (scene.is_pinned(i) ? -1 : next));
                if (scene.is_pinned(i)) continue;
                CHECK(free[next] == i);
                ascending.push_back(i);
            }
            CHECK(free.count() == static_cast<Index>(ascending.size()));
            CHECK(std::vector<Index>(free.begin(), free.end()) == ascending);
            auto* move = kind.single ? moved<float, 1> : moved<double, 1>;
            if (kind.dim == 2) move = kind.single ? moved<float, 2> : moved<double, 2>;
            if (kind.dim == 3) move = kind.single ? moved<float, 3> : moved<double, 3>;
            const auto got = move(free, from, to);
            CHECK((got.gathered == flat(from)(free_dofs(scene))));
            CHECK(distance(got.added, to + 2 * from) <= 4 * kind.epsilon());
            CHECK((got.scattered == expected));
        }
    }
}

TEST_CASE("parts: all particles are free where none is pinned", "[network]") {
    CHECK(FreeParticles().count() == 0);
    CHECK(FreeParticles::all(0).count() == 0);
    const auto free = FreeParticles::all(3);
    CHECK(std::vector<Index>(free.begin(), free.end()) == std::vector<Index>{0, 1, 2});
    CHECK(free.particles() == 3);
    CHECK(free.place(2) == 2);
}

TEST_CASE("parts: a combination has the factors that it is written with", "[network]") {
    Random random(4100);
    for (int repeat = 0; repeat < 200; ++repeat) {
        CAPTURE(repeat);
        const double a = random.uniform(-9, 9);
        const double b = random.uniform(-9, 9);
        const double c = random.uniform(-9, 9);
        const double d = random.uniform(-9, 9);
        CHECK((factors(a * M + b * D + c * K + d * K_plus) == std::array{a, b, c, d}));
        CHECK((factors(a * M - b * D - c * K - d * K_plus) == std::array{a, -b, -c, -d}));
        CHECK((factors(-(a * M - b * K)) == std::array{-a, 0.0, b, 0.0}));
        CHECK((factors(b * (a * D + c * K_plus)) == std::array{0.0, b * a, 0.0, b * c}));
    }
    // What a sum leaves out stays out, at an infinite factor too.
    const double infinite = std::numeric_limits<double>::infinity();
    CHECK((factors(4 * M - infinite * K_plus) == std::array{4.0, 0.0, 0.0, -infinite}));
    CHECK((factors(infinite * D + K) == std::array{0.0, infinite, 1.0, 0.0}));
    CHECK_FALSE(std::is_constructible_v<taut::Combination, double, double, double, double>);
    CHECK_FALSE(std::is_constructible_v<taut::Combination, double, double, double>);
    CHECK_FALSE(std::is_convertible_v<double, taut::Combination>);
}

TEMPLATE_TEST_CASE("parts: a state names the first particle that is not finite", "[network]", float,
                   double) {
    using State = taut::State<TestType, 3>;
    const auto bad = GENERATE(std::numeric_limits<TestType>::quiet_NaN(),
                              std::numeric_limits<TestType>::infinity(),
                              -std::numeric_limits<TestType>::infinity());
    State state{State::zero(5), State::zero(5), TestType(0)};
    CHECK((state.x.isZero(0) && state.x.cols() == 5));
    CHECK(state.finite());
    CHECK(state.first_not_finite() == -1);
    state.v(2, 4) = bad;
    CHECK_FALSE(state.finite());
    CHECK(state.first_not_finite() == 4);
    state.x(0, 3) = bad;
    CHECK(state.first_not_finite() == 3);
    state.x(1, 0) = bad;
    CHECK(state.first_not_finite() == 0);
}

}  // namespace taut_test::parts_test
