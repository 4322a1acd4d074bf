// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/proof_scenes.hpp"

namespace taut_test::cloth_test {

using taut::ClothOptions;

TEST_CASE("cloth: the reference scene has its known size, mass, pins and springs, all at rest",
          "[scene]") {
    for (const bool single : {false, true}) {
        constexpr Index N = 100;
        Scene cloth = cloth_scene({N, N}, single);
        CHECK(cloth.size() == N * N);
        CHECK(cloth.spring_count() == 59002);
        CHECK(cloth.gravity() == Eigen::Vector3d(0, 0, cloth.rounded(-9.81)));
        CHECK(cloth.mass_proportional() == 0);
        CHECK(cloth.stiffness_proportional() == 0);
        double mass = 0;
        Index wrong = 0;
        for (Index i = 0; i < cloth.size(); ++i) {
            mass += cloth.mass(i);
            wrong += cloth.is_pinned(i) != (i == 0 || i == N - 1);
        }
        CHECK_THAT(mass, WithinRel(0.3, cloth.kind().accumulated()));
        const auto state = cloth.initial_state();
        CHECK(state.x.row(2).isZero(0));
        CHECK_THAT(state.x(0, N * N - 1), WithinRel(1.0, cloth.kind().rounding()));
        CHECK_THAT(state.x(1, N * N - 1), WithinRel(1.0, cloth.kind().rounding()));
        CHECK(state.x(0, N - 1) == state.x(0, N * N - 1));  // particle row·columns + column
        for (const auto& spring : cloth.springs()) wrong += spring.damping != 0;
        CHECK(wrong == 0);
        // To the bit.
        cloth = cloth_scene({40, 31}, single);
        cloth.set_gravity(Eigen::Vector3d::Zero());
        CHECK(cloth.force(cloth.initial_state()).isZero(0));
    }
}

TEST_CASE("cloth: springs are counted by kind for any shape", "[scene]") {
    for (const Index rows : {2, 3, 5}) {
        for (const Index columns : {2, 4, 7}) {
            const Scene cloth = cloth_scene({rows, columns});
            const Index edges = rows * (columns - 1) + columns * (rows - 1);
            const Index diagonals = 2 * (rows - 1) * (columns - 1);
            const Index bends = rows * (columns - 2) + columns * (rows - 2);
            Index soft = 0;
            // No pair is joined twice, and none is further apart than its kind allows.
            std::vector<std::pair<Index, Index>> pairs;
            for (const auto& spring : cloth.springs()) {
                soft += spring.stiffness == 100;
                pairs.push_back(std::minmax(spring.a, spring.b));
                CHECK(std::abs(spring.a / columns - spring.b / columns) +
                          std::abs(spring.a % columns - spring.b % columns) <=
                      2);
            }
            CHECK(soft == bends);
            CHECK(cloth.spring_count() == edges + diagonals + bends);
            std::sort(pairs.begin(), pairs.end());
            CHECK(std::adjacent_find(pairs.begin(), pairs.end()) == pairs.end());
        }
    }
}

TEST_CASE("cloth: options leave out what they say", "[scene]") {
    ClothOptions options{3, 4};
    options.bend = 0;
    CHECK(cloth_scene(options).spring_count() == 17 + 12);
    options.diagonals = false;
    options.width = 6;
    options.height = 4;
    Scene cloth = cloth_scene(options);
    CHECK(cloth.spring_count() == 17);
    CHECK(cloth.is_pinned(3));
    CHECK(cloth.initial_state().x.col(1) == Eigen::Vector3d(2, 0, 0));
    CHECK(cloth.initial_state().x.col(4) == Eigen::Vector3d(0, 2, 0));
    // Its triangles are the halves of its cells, all the same way round.
    const auto x = cloth.initial_state().x;
    const auto triangles = taut::cloth_triangles(options);
    CHECK(triangles.size() == 12);
    for (const auto& [a, b, c] : triangles) {
        const Eigen::Vector2d u = (x.col(b) - x.col(a)).head(2), w = (x.col(c) - x.col(a)).head(2);
        CHECK(u[0] * w[1] - u[1] * w[0] == 2 * 2);
    }
    options.pin_corners = false;
    cloth = cloth_scene(options);
    for (Index i = 0; i < 12; ++i) CHECK_FALSE(cloth.is_pinned(i));
}

TEST_CASE("cloth: a zero-rest-length grid has the sums of two rows' eigenvalues, three times each",
          "[scene]") {
    ClothOptions options{4, 6};
    options.mass = 48;
    options.stretch = 30;
    options.bend = 0;
    options.diagonals = false;
    options.pin_corners = false;
    // Of n free masses in a row, 1/s².
    const auto row = [&](Index j, Index n) {
        const Real sine =
            std::sin(static_cast<Real>(j) * std::acos(-1.0L) / static_cast<Real>(2 * n));
        return 4 * 15 * sine * sine;
    };
    std::vector<Real> expected;
    for (Index a = 0; a < 4; ++a)
        for (Index b = 0; b < 6; ++b) expected.insert(expected.end(), 3, row(a, 4) + row(b, 6));
    std::sort(expected.begin(), expected.end());
    const Scene cloth = at_zero_length(cloth_scene(options));
    const RealVector k =
        eigenvalues(exact_matrices(cloth, cloth.initial_state().x).scaled(0, 1, 0, false));
    REQUIRE(k.size() == static_cast<Index>(expected.size()));
    for (std::size_t j = 0; j < expected.size(); ++j)
        CHECK(std::abs(k[static_cast<Index>(j)] - expected[j]) <=
              1e-12L * expected[j < 3 ? expected.size() - 1 : j]);
}

TEST_CASE("cloth: its damping is the one asked for and changes nothing else", "[scene]") {
    for (const bool single : {false, true}) {
        Random random(5);
        for (int trial = 0; trial < 20; ++trial) {
            CAPTURE(single, trial);
            ClothOptions options{2 + random.below(6), 2 + random.below(6)};
            Scene declared = cloth_scene(options, single);
            options.rayleigh = {random.uniform(0, 5), random.uniform(0, 1e-2)};
            const Scene cloth = cloth_scene(options, single);
            CHECK(cloth.mass_proportional() == options.rayleigh.mass_proportional);
            CHECK(cloth.stiffness_proportional() == options.rayleigh.stiffness_proportional);
            declared.set_rayleigh(options.rayleigh.mass_proportional,
                                  options.rayleigh.stiffness_proportional);
            auto state = cloth.initial_state();
            state.v = random_points(random, 3, cloth.size(), -1, 1);
            CHECK(cloth.force(state) == declared.force(state));
        }
    }
}

TEST_CASE("cloth: bad input", "[scene][bad_input]") {
    const auto refused = [](auto&& change, std::initializer_list<const char*> words) {
        ClothOptions options{4, 4};
        change(options);
        return missing(message_of([&] { cloth_scene(options); }), words);
    };
    const double not_a_number = std::numeric_limits<double>::quiet_NaN();
    CHECK(refused([](auto& o) { o.rows = 1; },
                  {"hanging_cloth", "1 rows", "4 columns", "at least 2"}) == "");
    CHECK(refused([](auto& o) { o.columns = -1; }, {"hanging_cloth", "-1 columns", "at least 2"}) ==
          "");
    for (const double bad : {-1.0, not_a_number, std::numeric_limits<double>::infinity()}) {
        CHECK(refused([&](auto& o) { o.mass = bad; }, {"mass", "finite and > 0"}) == "");
        CHECK(refused([&](auto& o) { o.stretch = bad; }, {"st", " is ", ">= 0"}) == "");
        CHECK(refused([&](auto& o) { o.bend = bad; }, {" is ", ">= 0"}) == "");
        CHECK(refused([&](auto& o) { o.rayleigh.mass_proportional = bad; },
                      {"mass_proportional is ", ">= 0"}) == "");
        CHECK(refused([&](auto& o) { o.rayleigh.stiffness_proportional = bad; },
                      {"stiffness_proportional is ", ">= 0"}) == "");
    }
    CHECK(refused([&](auto& o) { o.mass = 0; }, {"mass", "finite and > 0"}) == "");
    CHECK(refused([&](auto& o) { o.width = not_a_number; }, {"finite"}) == "");
    CHECK(refused([&](auto& o) { o.gravity = not_a_number; }, {"gravity", "finite"}) == "");
}

}  // namespace taut_test::cloth_test
