// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "../support/catch.hpp"
#include "../support/methods.hpp"
#include "../support/proof_scenes.hpp"
#include "../support/tolerance.hpp"

// Dense eigensolvers, and the estimate for systems too large for them.

namespace taut_test::dense_test {

namespace matrices = taut::matrices;

using taut::explicit_estimate;
using taut::Method;
using DenseAnalysis = taut::DenseAnalysis<>;

namespace {

/// A cloth with dampers of many sizes: D commutes with nothing.
Scene damped_cloth(Random& random, Index rows, Index columns) {
    auto cloth = with_springs(cloth_scene({rows, columns}), [&](AnySpring& s) {
        s.stiffness *= log_uniform(random, 0.3, 3);
        s.damping = log_uniform(random, 0.05, 0.5);
    });
    for (Index i = 0; i < cloth.size(); ++i)
        cloth.set_mass(i, cloth.mass(i) * log_uniform(random, 0.5, 2));
    return cloth;
}

double estimate_of(const taut::Pencil& pencil) {
    return explicit_estimate(pencil, pencil.upper_bound(matrices::K_plus));
}

}  // namespace

TEST_CASE("dense: the explicit limit is where the spectral radius passes 1", "[tight][slow]") {
    int compared = 0;
    for (const auto& c : stability_cases(false, true)) {
        const Multipliers multipliers(c.exact);
        if (c.exact.size() == 0 || multipliers.buckled()) continue;
        const double truth = multipliers.explicit_limit();
        const DenseAnalysis dense(c.analysis.pencil());
        const double limit = dense.explicit_limit();
        INFO(c.text << ": " << limit << ", " << dense.explicit_limit_above() << ", truth "
                    << truth);
        CHECK(dense.explicit_limit_above() >= truth * (1 - 1e-12));
        if (std::isinf(truth)) {
            CHECK(std::isinf(limit));
            continue;
        }
        if (truth > 0) CHECK(dense.explicit_limit_above() >= limit * (1 - 1e-12));
        if (truth * multipliers.omega() <= 1e-2) {
            CHECK(limit * multipliers.omega() < 1e-2 * (1 + 1e-6));
            continue;
        }
        ++compared;
        CHECK_THAT(limit, WithinRel(truth, 1e-7));
        // The referee's own formula agrees with the radius, which knows nothing of it.
        const auto radius = [&](double h) {
            return multipliers.induced_radius(Method::explicit_euler, h);
        };
        CHECK(radius(truth * (1 - 1e-7)) <= 1 + 1e-16L);
        CHECK(radius(truth * (1 + 1e-7)) > 1 + 1e-16L);
    }
    CHECK(compared > 50);
}

TEST_CASE("dense: spectral_radius is that of the long double transition matrix", "[tight][slow]") {
    for (const auto& c : stability_cases(false, true)) {
        const Multipliers multipliers(c.exact);
        if (c.exact.size() == 0 || multipliers.buckled()) continue;
        const DenseAnalysis dense(c.analysis.pencil());
        for (const Method method : limited_methods) {
            for (const double z : {0.1, 3.0}) {
                const double h = z / multipliers.omega();
                const auto truth = static_cast<double>(multipliers.radius(method, h));
                INFO(c.text << ", " << name(method) << ", z = " << z << ", truth " << truth);
                const double radius = dense.spectral_radius(method, h);
                CHECK(taut::spectral_radius(c.analysis.in_double(), method, h) == radius);
                // √eps where two multipliers meet. The velocity of an undamped zero mode has the
                // multiplier 1 and is left out.
                if (truth > 1 + 1e-6 || multipliers.zero_modes() == 0) {
                    CHECK_THAT(radius, WithinRel(truth, 1e-6));
                } else {
                    CHECK(radius <= 1 + 1e-6);
                }
            }
        }
    }
}

TEST_CASE("dense: explicit_limit_above is never below the truth, over many decades", "[tight]") {
    Random random(1000);
    int finite = 0;
    for (int repeat = 0; repeat < 200; ++repeat) {
        WildOptions options;
        options.decades = repeat % 2 == 0 ? 0.5 : 1.5;
        options.most_particles = 5;
        const auto scene = wild_scene(random, {false, 2, Laws::hookean}, options);
        const auto state = scene.initial_state();
        const double truth = Multipliers(exact_matrices(scene, state.x)).explicit_limit();
        const Analysis analysis(scene, state);
        const double above = DenseAnalysis(analysis.pencil(), matrices::K).explicit_limit_above();
        INFO("system " << repeat << ": " << above << ", truth " << truth);
        CHECK(above >= truth * (1 - 1e-9));
        finite += std::isfinite(above) && above > 0 ? 1 : 0;
    }
    CHECK(finite > 50);
}

TEST_CASE("dense: the slow growth of a buckled mode refutes no step", "[tight]") {
    // Compressed springs from pins to masses of their own: along its axis each is a mode of the
    // stiffness k, across it two of the same -T/l, from rates beside the stiffest down to rounding.
    Random random(1021);
    for (int repeat = 0; repeat < 100; ++repeat) {
        Scene scene({false, 3, Laws::hookean});
        const double d0 = random.uniform(1, 20);
        const double alpha = random.uniform(0, 0.1);
        scene.set_rayleigh(d0, alpha);
        Real truth = std::numeric_limits<double>::infinity();
        const auto count = static_cast<int>(random.uniform(2, 8));
        for (int i = 0; i < count; ++i) {
            const double k = i == 0 ? 30 : 30 * std::pow(10, random.uniform(-13, 0));
            const double l = random.uniform(0.2, 0.9);
            const Eigen::Vector3d at(3.0 * i, 0, 0);
            const Eigen::Vector3d axis(random.uniform(-1, 1), random.uniform(-1, 1), 1);
            const Index pin = scene.add_particle(at, 1);
            const Index mass = scene.add_particle(at + l * axis / axis.norm(), 1);
            scene.pin(pin);
            scene.add_spring({pin, mass, k, 1});
            const Real across = k * (1 - 1 / Real(l));
            const Real push = (d0 + std::sqrt(Real(d0) * d0 - 4 * across)) / 2;
            const Real d = d0 + alpha * Real(k);
            const Real square = d * d - 4 * Real(k);
            const Real along = square < 0 ? d / k : 4 / (d + std::sqrt(square));
            truth = std::min({truth, 2 / push, along});
        }
        const Analysis analysis(scene, scene.initial_state());
        const DenseAnalysis dense(analysis.pencil(), matrices::K);
        INFO("system " << repeat << ": " << dense.explicit_limit() << ", "
                       << dense.explicit_limit_above() << ", truth " << truth);
        CHECK(dense.explicit_limit_above() >= truth * (1 - 1e-12));
        CHECK(dense.explicit_limit_above() < truth * (1 + 1e-3));
        CHECK_THAT(dense.explicit_limit(), WithinRel(static_cast<double>(truth), 1e-6));
    }
}

TEST_CASE("dense: eigenvalues, modes and zero modes", "[tight]") {
    for (const auto& c : stability_cases(false, false)) {
        if (c.exact.size() == 0) continue;
        INFO(c.text);
        const auto& pencil = c.analysis.pencil();
        const DenseAnalysis dense(pencil);
        const RealVector k = exact_eigenvalues(c.exact, matrices::K_plus);
        const auto size = static_cast<double>(k.cwiseAbs().maxCoeff());
        constexpr double rounding = 10 * Tolerance<double>::rounding;
        CHECK(distance(dense.stiffness_eigenvalues(), k) <= rounding * size);
        CHECK(dense.zero_modes() == (k.array().abs() <= 1e-12L * k.cwiseAbs().maxCoeff()).count());
        CHECK(dense.zero_tolerance() <= 1e-10 * size);
        for (Index j = 0; j < c.exact.size(); ++j) {
            const RealVector u = dense.mode(j).cast<Real>();
            CHECK_THAT(static_cast<double>(u.dot(c.exact.mass.cwiseProduct(u))),
                       WithinRel(1.0, 1e-12));
            CHECK_THAT(static_cast<double>(u.dot(c.exact.K_plus * u)),
                       WithinAbs(dense.stiffness_eigenvalues()[j], 1e-12 * size));
        }
        // With the true K as well.
        const RealVector raw = exact_eigenvalues(c.exact, matrices::K);
        CHECK(distance(DenseAnalysis(pencil, matrices::K).stiffness_eigenvalues(), raw) <=
              rounding * static_cast<double>(raw.cwiseAbs().maxCoeff()));
    }
}

TEST_CASE("dense: zero modes are counted by hand", "[tight]") {
    const auto dense = [](const Scene& scene) {
        return DenseAnalysis(Analysis(scene, scene.initial_state()).pencil());
    };
    // A flat cloth: one mechanism a free particle; a free chain in the plane: its line's length
    // counts, everything across does not.
    CHECK(dense(cloth_scene({4, 4})).zero_modes() == 14);
    taut::ChainOptions row;
    row.masses = 5;
    row.ends = taut::ChainEnds::free_free;
    auto chain = chain_scene(false, 2, row);
    CHECK(dense(chain).zero_modes() == 6);
    CHECK(dense(chain).explicit_limit() == 0);
    // Damped by d0 alone, zero modes must not exceed 2/d0; nothing but zero modes limits nothing.
    chain.set_rayleigh(0.5, 0);
    const double k = 4 * std::pow(std::sin(4 * std::acos(-1.0) / 10), 2);
    CHECK_THAT(dense(chain).explicit_limit(), WithinRel(0.5 / k, 1e-9));
    row.stiffness = 0;
    const auto none = dense(chain_scene(false, 2, row));
    CHECK(std::isinf(none.explicit_limit()));
    CHECK(std::isinf(none.explicit_limit_above()));
}

TEST_CASE("dense: explicit_estimate is near the dense answer, of Rayleigh damping and of dampers",
          "[tight]") {
    Random random(840);
    for (int repeat = 0; repeat < 4; ++repeat) {
        INFO("repeat " << repeat << " of seed 840");
        const bool rayleigh = repeat % 2 == 0;
        auto cloth = rayleigh ? cloth_scene({5 + random.below(3), 6}) : damped_cloth(random, 6, 7);
        if (rayleigh)
            cloth.set_rayleigh(repeat == 0 ? 0 : log_uniform(random, 1, 100),
                               log_uniform(random, 1e-6, 1e-4));
        const Analysis analysis(cloth, cloth.initial_state());
        const double truth = DenseAnalysis(analysis.pencil(), matrices::K).explicit_limit();
        const double estimate = estimate_of(analysis.pencil());
        CHECK(estimate > 0.95 * truth);
        CHECK(estimate < (rayleigh ? 1.05 : 1.3) * truth);
    }
    // No number where K is indefinite.
    const auto cloth = cloth_scene({6, 6});
    const Analysis buckled(cloth, deformed(cloth, 0.5, 0, 1));
    CHECK(std::isnan(estimate_of(buckled.pencil())));
}

TEST_CASE("dense: Stability gives the estimate beside the bracket, and only there", "[tight]") {
    Random random(842);
    const auto method = Method::explicit_euler;
    for (const Index size : {8, 4}) {  // larger than what is dense, and smaller
        const auto cloth = damped_cloth(random, size, size);
        const Analysis analysis(cloth, cloth.initial_state());
        CHECK(analysis.max_step(method).estimate == 0);
        const auto narrowed = analysis.max_step(method, 0.1);
        CHECK(narrowed.estimate > 0);
        CHECK(narrowed.estimate >= narrowed.certified * (1 - 1e-9));
        CHECK(narrowed.estimate <= narrowed.refuted * (1 + 1e-9));
        CHECK(analysis.max_step(Method::symplectic_euler, 0.1).estimate == 0);
    }
    auto rayleigh = cloth_scene({8, 8});
    rayleigh.set_rayleigh(1, 1e-5);
    CHECK(Analysis(rayleigh, rayleigh.initial_state()).max_step(method, 1e-3).estimate == 0);
}

}  // namespace taut_test::dense_test
