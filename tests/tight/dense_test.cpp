// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/tight/dense.hpp>

#include "../support/catch.hpp"
#include "../support/methods.hpp"
#include "../support/tolerance.hpp"
#include "../stability/wild_system.hpp"

namespace taut_test::dense_test {

namespace matrices = taut::matrices;

using taut::DenseAnalysis;
using taut::Method;

namespace {

/// The largest h with every multiplier inside the circle, by bisection on the radius in long
/// double; only for scenes whose radius is below 1 for small steps.
double bisected_limit(const Multipliers& multipliers, double from) {
    const auto stable = [&](double h) {
        return multipliers.induced_radius(Method::explicit_euler, h) <= 1 + 1e-16L;  // rounding
    };
    double low = from;
    double high = from;
    while (stable(high)) high *= 2;
    while (!stable(low)) low /= 2;
    for (int repeat = 0; repeat < 60; ++repeat) {
        const double middle = (low + high) / 2;
        (stable(middle) ? low : high) = middle;
    }
    return low;
}

}  // namespace

TEST_CASE("dense: the explicit limit is where the spectral radius passes 1", "[stability][slow]") {
    int compared = 0;
    for (const auto& c : stability_cases<double>(true)) {
        const Multipliers multipliers = c.multipliers();
        if (c.exact.size() == 0 || multipliers.buckled()) continue;
        const double truth = multipliers.explicit_limit();
        const DenseAnalysis dense(c.stability.pencil());
        INFO(c.text << ": " << dense.explicit_limit() << ", " << dense.explicit_limit_above()
                    << ", truth " << truth);
        // The referee's own formula agrees with a bisection that knows nothing of it.
        if (std::isfinite(truth) && truth * multipliers.omega() > 1e-2) {
            CHECK_THAT(bisected_limit(multipliers, truth), WithinRel(truth, 1e-7));
            CHECK_THAT(dense.explicit_limit(), WithinRel(truth, 1e-7));
            ++compared;
        } else if (std::isfinite(truth)) {
            CHECK(dense.explicit_limit() * multipliers.omega() < 1e-2 * (1 + 1e-6));
        } else {
            CHECK(std::isinf(dense.explicit_limit()));
        }
        CHECK(dense.explicit_limit_above() >= truth * (1 - 1e-12));
        if (std::isfinite(truth) && truth > 0)
            CHECK(dense.explicit_limit_above() >= dense.explicit_limit() * (1 - 1e-12));
    }
    CHECK(compared > 50);
}

TEST_CASE("dense: explicit_limit_above is never below the truth, over many decades",
          "[stability][slow]") {
    Random random(1000);
    int finite = 0;
    for (int repeat = 0; repeat < 200; ++repeat) {
        WildOptions options;
        options.decades = repeat % 2 == 0 ? 0.5 : 1.5;
        options.most_particles = 5;
        const auto system = wild_system<double, 2>(random, options);
        const auto state = system.initial_state();
        const Exact e = exact_matrices(system, state.x);
        const Multipliers multipliers(e);
        const auto pencil = taut::SpringPencil<2>::at_pose(system, state.x);
        const double above = DenseAnalysis(pencil, taut::matrices::K).explicit_limit_above();
        const double truth = multipliers.explicit_limit();
        INFO("system " << repeat << ": " << above << ", truth " << truth);
        CHECK(above >= truth * (1 - 1e-9));
        finite += std::isfinite(above) && above > 0 ? 1 : 0;
    }
    CHECK(finite > 50);
}

TEST_CASE("dense: the slow growth of a buckled mode refutes no step", "[stability]") {
    // Compressed springs from pins to masses of their own: along its axis each is a mode of the
    // stiffness k, across it two of the same -T/l, from rates beside the stiffest down to rounding.
    Random random(1021);
    for (int repeat = 0; repeat < 200; ++repeat) {
        taut::SpringSystem<double, 3, taut::Hookean> system;
        const double d0 = random.uniform(1, 20);
        const double alpha = random.uniform(0, 0.1);
        system.set_rayleigh({d0, alpha});
        Real truth = std::numeric_limits<double>::infinity();
        const auto count = static_cast<int>(random.uniform(2, 8));
        for (int i = 0; i < count; ++i) {
            const double k = i == 0 ? 30 : 30 * std::pow(10, random.uniform(-13, 0));
            const double l = random.uniform(0.2, 0.9);
            const Eigen::Vector3d at(3.0 * i, 0, 0);
            Eigen::Vector3d axis(random.uniform(-1, 1), random.uniform(-1, 1), 1);
            const auto pin = system.add_particle(at, 1);
            const auto mass = system.add_particle(at + l * axis.normalized(), 1);
            system.pin(pin);
            system.add_spring(taut::Spring<double, taut::Hookean>{pin, mass, {k}, 1.0});
            const Real across = k * (1 - 1 / Real(l));
            const Real push = (d0 + std::sqrt(Real(d0) * d0 - 4 * across)) / 2;
            const Real d = d0 + alpha * Real(k);
            const Real square = d * d - 4 * Real(k);
            const Real along = square < 0 ? d / k : 2 / ((d + std::sqrt(square)) / 2);
            truth = std::min({truth, 2 / push, along});
        }
        const auto pencil = taut::SpringPencil<3>::at_pose(system, system.initial_state().x);
        const DenseAnalysis dense(pencil, taut::matrices::K);
        INFO("system " << repeat << ": " << dense.explicit_limit() << ", "
                       << dense.explicit_limit_above() << ", truth " << truth);
        CHECK(dense.explicit_limit_above() >= truth * (1 - 1e-12));
        CHECK(dense.explicit_limit_above() < truth * (1 + 1e-3));
        CHECK_THAT(dense.explicit_limit(), WithinRel(static_cast<double>(truth), 1e-6));
    }
}

TEST_CASE("dense: eigenvalues, modes and zero modes", "[stability]") {
    for (const auto& c : stability_cases<double>(false)) {
        if (c.exact.size() == 0) continue;
        INFO(c.text);
        const DenseAnalysis dense(c.stability.pencil());
        const RealVector k = exact_eigenvalues(c.exact, matrices::K_plus);
        const double size = static_cast<double>(k.cwiseAbs().maxCoeff());
        CHECK(distance(dense.stiffness_eigenvalues(), k) <=
              10 * Tolerance<double>::rounding * size);
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
        CHECK(distance(DenseAnalysis(c.stability.pencil(), matrices::K).stiffness_eigenvalues(),
                       raw) <=
              10 * Tolerance<double>::rounding * static_cast<double>(raw.cwiseAbs().maxCoeff()));
    }
}

TEST_CASE("dense: zero modes are counted by hand", "[stability]") {
    // A flat cloth: one mechanism a free particle; a free chain in the plane: its line's length
    // counts, everything across does not.
    taut::ClothOptions options;
    options.rows = options.columns = 4;
    const auto cloth = taut::hanging_cloth<double>(options);
    const auto flat = taut::SpringPencil<3>::at_pose(cloth, cloth.initial_state().x);
    CHECK(DenseAnalysis(flat).zero_modes() == 14);
    taut::ChainOptions row;
    row.masses = 5;
    row.ends = taut::ChainEnds::free_free;
    const auto chain = taut::chain<double, 2>(row);
    const auto line = taut::SpringPencil<2>::at_pose(chain, chain.initial_state().x);
    CHECK(DenseAnalysis(line).zero_modes() == 6);
    CHECK(DenseAnalysis(line).explicit_limit() == 0);
    // Damped by d0 alone, zero modes must not exceed 2/d0; nothing but zero modes limits nothing.
    auto damped = chain;
    damped.set_rayleigh({0.5, 0});
    const auto with = taut::SpringPencil<2>::at_pose(damped, damped.initial_state().x);
    const double k = 4 * std::pow(std::sin(4 * std::acos(-1.0) / 10), 2);
    CHECK_THAT(DenseAnalysis(with).explicit_limit(), WithinRel(0.5 / k, 1e-9));
    row.stiffness = 0;
    const auto loose = taut::chain<double, 2>(row);
    const auto none = taut::SpringPencil<2>::at_pose(loose, loose.initial_state().x);
    CHECK(std::isinf(DenseAnalysis(none).explicit_limit()));
    CHECK(std::isinf(DenseAnalysis(none).explicit_limit_above()));
}

TEST_CASE("dense: spectral_radius is that of the long double transition matrix",
          "[stability][slow]") {
    for (const auto& c : stability_cases<double>(true)) {
        const Multipliers multipliers = c.multipliers();
        if (c.exact.size() == 0 || multipliers.buckled()) continue;
        const DenseAnalysis dense(c.stability.pencil());
        for (const Method method : limited_methods) {
            for (const double z : {0.1, 1.5, 10.0}) {
                const double h = z / multipliers.omega();
                const auto truth = static_cast<double>(multipliers.radius(method, h));
                INFO(c.text << ", " << name(method) << ", z = " << z << ", truth " << truth);
                const double radius = dense.spectral_radius(method, h);
                // The velocity of an undamped zero mode has the multiplier 1 and is left out.
                if (truth > 1 + 1e-6 || multipliers.zero_modes() == 0) {
                    CHECK_THAT(radius, WithinRel(truth, 1e-6));
                } else {
                    CHECK(radius <= 1 + 1e-6);
                }
            }
        }
    }
}

}  // namespace taut_test::dense_test
