// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/scene/cloth.hpp>
#include <vector>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/decompositions.hpp"
#include "../support/random.hpp"
#include "../support/tolerance.hpp"
#include "../support/zero_rest_length.hpp"

namespace taut_test::cloth_test {

using taut::ClothOptions;
using taut::hanging_cloth;
using taut::Index;

namespace {

/// Eigenvalues of n free masses in a row, joined by n − 1 springs, 1/s².
std::vector<double> row(Index n, double k_over_m) {
    const double pi = std::acos(-1.0);
    std::vector<double> values;
    for (Index j = 0; j < n; ++j) {
        const double sine = std::sin(static_cast<double>(j) * pi / (2 * static_cast<double>(n)));
        values.push_back(4 * k_over_m * sine * sine);
    }
    return values;
}

}  // namespace

TEMPLATE_TEST_CASE("cloth: the reference scene has its known size, mass, pins and springs",
                   "[scene]", float, double) {
    const Index N = 100;
    const auto cloth = hanging_cloth<TestType>({N, N});
    CHECK(cloth.size() == N * N);
    CHECK(cloth.spring_count() == 59002);
    CHECK(cloth.pinned_count() == 2);
    CHECK(cloth.is_pinned(0));
    CHECK(cloth.is_pinned(N - 1));
    CHECK((cloth.gravity() == Eigen::Matrix<TestType, 3, 1>(0, 0, TestType(-9.81))));
    CHECK(cloth.springs().damping.empty());
    CHECK(cloth.rayleigh().mass_proportional == 0);
    CHECK(cloth.rayleigh().stiffness_proportional == 0);

    double mass = 0;
    for (Index i = 0; i < cloth.size(); ++i) mass += static_cast<double>(cloth.mass(i));
    CHECK_THAT(mass, Catch::Matchers::WithinRel(0.3, Tolerance<TestType>::accumulated));

    const auto state = cloth.initial_state();
    CHECK(state.x.row(2).isZero(0));
    CHECK_THAT(static_cast<double>(state.x(0, N * N - 1)),
               Catch::Matchers::WithinRel(1.0, Tolerance<TestType>::rounding));
    CHECK_THAT(static_cast<double>(state.x(1, N * N - 1)),
               Catch::Matchers::WithinRel(1.0, Tolerance<TestType>::rounding));
    CHECK(state.x(0, N - 1) == state.x(0, N * N - 1));  // particle row·columns + column
}

TEMPLATE_TEST_CASE("cloth: every spring is as long as its rest length, to the bit", "[scene]",
                   float, double) {
    const auto cloth = hanging_cloth<TestType>({40, 31});
    const auto state = cloth.initial_state();
    const auto& set = cloth.springs();
    Index off = 0;
    for (std::size_t s = 0; s < set.a.size(); ++s) {
        const Eigen::Matrix<TestType, 3, 1> d = state.x.col(set.b[s]) - state.x.col(set.a[s]);
        off += d.norm() == set.rest_length[s] ? 0 : 1;
    }
    CHECK(off == 0);
    auto weightless = cloth;
    weightless.set_gravity({0, 0, 0});
    taut::Points<TestType, 3> f;
    weightless.force(state, f);
    CHECK(f.isZero(0));
}

TEST_CASE("cloth: springs are counted by kind for any shape", "[scene]") {
    for (const Index rows : {2, 3, 5}) {
        for (const Index columns : {2, 4, 7}) {
            const auto cloth = hanging_cloth<double>({rows, columns});
            const Index edges = rows * (columns - 1) + columns * (rows - 1);
            const Index diagonals = 2 * (rows - 1) * (columns - 1);
            const Index bends = rows * (columns - 2) + columns * (rows - 2);
            Index soft = 0;
            for (const auto& p : cloth.springs().parameters) soft += p.stiffness == 100 ? 1 : 0;
            CHECK(soft == bends);
            CHECK(cloth.spring_count() == edges + diagonals + bends);
            // No pair is joined twice, and none is further apart than its kind allows.
            std::vector<std::pair<Index, Index>> pairs;
            cloth.for_each_spring([&](Index a, Index b) {
                pairs.emplace_back(std::min(a, b), std::max(a, b));
                CHECK(std::abs(a / columns - b / columns) + std::abs(a % columns - b % columns) <=
                      2);
            });
            std::sort(pairs.begin(), pairs.end());
            CHECK(std::adjacent_find(pairs.begin(), pairs.end()) == pairs.end());
        }
    }
}

TEST_CASE("cloth: options leave out what they say", "[scene]") {
    ClothOptions options{3, 4};
    options.bend = 0;
    CHECK(hanging_cloth<double>(options).spring_count() == 17 + 12);
    options.diagonals = false;
    CHECK(hanging_cloth<double>(options).spring_count() == 17);
    options.pin_corners = false;
    CHECK(hanging_cloth<double>(options).pinned_count() == 0);
    options.width = 6;
    options.height = 4;
    const auto x = hanging_cloth<double>(options).initial_state().x;
    CHECK((x.col(1) == Eigen::Vector3d(2, 0, 0)));
    CHECK((x.col(4) == Eigen::Vector3d(0, 2, 0)));
}

TEST_CASE("cloth: a zero-rest-length grid has the sums of two rows' eigenvalues, three times each",
          "[scene]") {
    ClothOptions options{4, 6};
    options.mass = 48;
    options.stretch = 30;
    options.bend = 0;
    options.diagonals = false;
    options.pin_corners = false;
    std::vector<double> expected;
    for (const double a : row(4, 15)) {
        for (const double b : row(6, 15)) expected.insert(expected.end(), 3, a + b);
    }
    std::sort(expected.begin(), expected.end());
    const auto cloth = at_zero_rest_length(hanging_cloth<double>(options));
    const auto k = stiffness_eigenvalues(taut::linearize(cloth, cloth.initial_state()));
    REQUIRE(k.size() == static_cast<Index>(expected.size()));
    for (Index j = 0; j < k.size(); ++j) {
        CHECK_THAT(k[j], Catch::Matchers::WithinAbs(
                             expected[static_cast<std::size_t>(j)],
                             1e-12 * expected[static_cast<std::size_t>(j < 3 ? 71 : j)]));
    }
}

TEMPLATE_TEST_CASE("cloth: its damping is the one asked for and changes nothing else", "[scene]",
                   float, double) {
    Random random(5);
    for (int trial = 0; trial < 20; ++trial) {
        ClothOptions options{2 + random.below(6), 2 + random.below(6)};
        auto declared = hanging_cloth<TestType>(options);
        options.rayleigh = {random.uniform(0, 5), random.uniform(0, 1e-2)};
        const auto cloth = hanging_cloth<TestType>(options);
        CHECK(cloth.rayleigh().mass_proportional == options.rayleigh.mass_proportional);
        CHECK(cloth.rayleigh().stiffness_proportional == options.rayleigh.stiffness_proportional);
        declared.set_rayleigh(options.rayleigh);
        auto state = cloth.initial_state();
        state.v = random.points<TestType, 3>(cloth.size(), -1, 1);
        taut::Points<TestType, 3> f, g;
        cloth.force(state, f);
        declared.force(state, g);
        CHECK(f == g);
    }
}

TEST_CASE("cloth: bad input", "[scene][bad_input]") {
    const auto refused = [](auto&& change, std::initializer_list<const char*> words) {
        ClothOptions options{4, 4};
        change(options);
        return missing(message_of([&] { static_cast<void>(hanging_cloth<double>(options)); }),
                       words);
    };
    const double not_a_number = std::numeric_limits<double>::quiet_NaN();
    CHECK(refused([](auto& o) { o.rows = 1; },
                  {"hanging_cloth", "1 rows", "4 columns", "at least 2"}) == "");
    CHECK(refused([](auto& o) { o.columns = -1; }, {"hanging_cloth", "-1 columns", "at least 2"}) ==
          "");
    for (const double bad : {0.0, -0.3, not_a_number}) {
        CHECK(refused([&](auto& o) { o.mass = bad; }, {"mass", "finite and > 0"}) == "");
    }
    for (const double bad : {-1.0, not_a_number, std::numeric_limits<double>::infinity()}) {
        CHECK(refused([&](auto& o) { o.stretch = bad; }, {"st", " is ", ">= 0"}) == "");
        CHECK(refused([&](auto& o) { o.bend = bad; }, {" is ", ">= 0"}) == "");
    }
    for (const double bad : {-1.0, not_a_number, std::numeric_limits<double>::infinity()}) {
        CHECK(refused([&](auto& o) { o.rayleigh.mass_proportional = bad; },
                      {"mass_proportional is ", ">= 0"}) == "");
        CHECK(refused([&](auto& o) { o.rayleigh.stiffness_proportional = bad; },
                      {"stiffness_proportional is ", ">= 0"}) == "");
    }
    CHECK(refused([&](auto& o) { o.width = not_a_number; }, {"finite"}) == "");
    CHECK(refused([&](auto& o) { o.gravity = not_a_number; }, {"gravity", "finite"}) == "");
}

}  // namespace taut_test::cloth_test
