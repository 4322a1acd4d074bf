// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "../support/message.hpp"
#include "account.hpp"

namespace taut_test::mass_scaling_test {

namespace matrices = taut::matrices;

namespace {

template <class System>
double free_mass(const System& system) {
    double sum = 0;
    for (Index i = 0; i < system.size(); ++i) {
        if (!system.is_pinned(i)) sum += static_cast<double>(system.mass(i));
    }
    return sum;
}

taut::SpringSystem<double, 3> cloth_with_stiff_springs(Index count) {
    taut::ClothOptions options;
    options.rows = options.columns = 7;
    auto cloth = taut::hanging_cloth<double>(options);
    for (Index s = 0; s < count; ++s) cloth.add_spring(8 + 5 * s, 9 + 5 * s, 1e5);
    return cloth;
}

}  // namespace

TEMPLATE_TEST_CASE("mass_scaling: by the referee the step is safe, over many decades",
                   "[mass_scaling]", float, double) {
    Random random(1400);
    for (int repeat = 0; repeat < 150; ++repeat) {
        const auto system = wild_system<TestType, 3>(random);
        const auto state = system.initial_state();
        const auto limit = static_cast<double>(
            Stability<TestType>(system, state).max_step(Method::symplectic_euler).certified);
        if (!std::isfinite(limit)) continue;
        const double h = limit * log_uniform(random, 0.5, 30);
        const auto added = added_mass(system, state, h);
        INFO("system " << repeat << ", " << h / limit);
        check_account(system, added);
        if (!added.reached) {
            CHECK(h * system.rayleigh().mass_proportional >= 2);
            continue;
        }
        const Exact e = exact_matrices(with_added(system, added), state.x);
        CHECK(exact_eigenvalues(e, 4 * matrices::M - 2 * h * matrices::D -
                                       h * h * matrices::K_plus)[0] >= -1e-15L);
    }
}

TEST_CASE("mass_scaling: selective scaling asks for less than uniform scaling", "[mass_scaling]") {
    for (const Index count : {1, 3, 6}) {
        const auto cloth = cloth_with_stiff_springs(count);
        const auto state = deformed(cloth, 1.01, 0.002, 9);
        const Stability<double> stability(cloth, state);
        for (const double factor : {1.5, 3.0, 8.0}) {
            const double h = factor * stability.max_step(Method::symplectic_euler).certified;
            const double uniform =
                (stability.min_mass_scale(Method::symplectic_euler, h) - 1) * free_mass(cloth);
            const auto added = added_mass(cloth, state, h);
            INFO(count << " stiff springs, " << factor << " times the step");
            CHECK(added.reached);
            CHECK(added.total > 0);
            CHECK(added.total < 0.5 * uniform);
            // The slow modes hardly notice: that is the point.
            REQUIRE(added.frequency_change.size() == 10);
            for (const double change : added.frequency_change) {
                CHECK(change <= 1e-9);
                CHECK(change > -0.9);
            }
            double touched = 0;
            for (const double mass : added.mass) touched += mass > 0 ? 1 : 0;
            CHECK(touched < static_cast<double>(cloth.size()));
        }
    }
    // Where every particle is alike the two come close.
    const auto plain = cloth_with_stiff_springs(0);
    const Stability<double> stability(plain, plain.initial_state());
    const double h = 2 * stability.max_step(Method::symplectic_euler).certified;
    CHECK(added_mass(plain, plain.initial_state(), h).total <
          (stability.min_mass_scale(Method::symplectic_euler, h) - 1) * free_mass(plain));
}

TEST_CASE("mass_scaling: wrong input is refused", "[mass_scaling]") {
    const auto cloth = cloth_with_stiff_springs(1);
    auto state = cloth.initial_state();
    for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        CHECK(missing(message_of([&] { added_mass(cloth, state, bad); }), {"added_mass", "h is"}) ==
              "");
    }
    state.x.conservativeResize(Eigen::NoChange, 3);
    CHECK(missing(message_of([&] { added_mass(cloth, state, 0.1); }),
                  {"added_mass", "3 positions", "49 particles"}) == "");
    state = cloth.initial_state();
    state.x(1, 4) = std::nan("");
    CHECK_THROWS_AS(added_mass(cloth, state, 0.1), std::invalid_argument);
}

TEST_CASE("mass_scaling: frequencies of a large cloth change as those of a dense analysis",
          "[mass_scaling][slow]") {
    Random random(95);
    // Enough unknowns for the sparse path; a dense referee is still affordable.
    auto cloth = taut::hanging_cloth<double>({13, 17});
    for (int s = 0; s < 12; ++s) {
        const Index i = random.below(cloth.size() - 1);
        cloth.add_spring(i, i + 1, 1e5);
    }
    const auto state = deformed(cloth, 1.01, 0, 3);
    const auto pencil = taut::Pencil::at_pose(cloth, state.x);
    REQUIRE(pencil.size() > taut::proof_detail::dense_low_modes);
    const double h =
        3 * Stability<double>(cloth, state).max_step(Method::symplectic_euler).certified;
    const auto added = added_mass(cloth, state, h);
    REQUIRE(added.frequency_change.size() == 10);
    const auto frequencies = [&](const auto& system) {
        const taut::DenseAnalysis<> dense(taut::Pencil::at_pose(system, state.x));
        std::vector<double> omega;
        for (const double k : dense.stiffness_eigenvalues()) {
            if (k > dense.zero_tolerance()) omega.push_back(std::sqrt(k));
        }
        return omega;
    };
    const auto before = frequencies(cloth);
    const auto after = frequencies(with_added(cloth, added));
    for (std::size_t j = 0; j < 10; ++j) {
        INFO("mode " << j);
        CHECK_THAT(added.frequency_change[j], WithinAbs(after[j] / before[j] - 1, 1e-3));
    }
}

TEST_CASE("mass_scaling: in float the step is certified but for the rounding of the masses",
          "[mass_scaling]") {
    const auto cloth = taut::hanging_cloth<float>({4, 4});
    const auto state = cloth.initial_state();
    const auto limit = Stability<float>(cloth, state).max_step(Method::symplectic_euler).certified;
    const double h = 3 * static_cast<double>(limit);
    const auto heavier = with_added(cloth, added_mass(cloth, state, h));
    CHECK(taut::certify(Stability<float>(heavier, state), Method::symplectic_euler, h * (1 - 1e-6))
              .proved);
}

TEST_CASE("mass_scaling: masses beyond float are not reached, and pins need none",
          "[mass_scaling]") {
    auto cloth = taut::hanging_cloth<float>({4, 4});
    const auto added = added_mass(cloth, cloth.initial_state(), 1e21);
    CHECK_FALSE(added.reached);
    for (const double mass : added.mass) CHECK(mass == 0);
    for (Index i = 0; i < cloth.size(); ++i) cloth.pin(i);
    const auto none = added_mass(cloth, cloth.initial_state(), 1);
    CHECK(none.reached);
    CHECK(none.total == 0);
    CHECK(none.frequency_change.empty());
}

}  // namespace taut_test::mass_scaling_test
