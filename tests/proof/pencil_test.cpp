// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/proof/bracket.hpp>
#include <taut/proof/pencil_matrix.hpp>

#include "../support/catch.hpp"
#include "../support/proof_scenes.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::pencil_test {

namespace matrices = taut::matrices;

using taut::Combination;

namespace {

constexpr double rounding = Tolerance<double>::rounding;

struct Wild {
    Random& random;
    Scene scene;
    Analysis analysis;
    const taut::Pencil& pencil;
    Exact exact;
};

/// visit(wild) for `count` random systems of each kind, in the poses that their particles were
/// placed in.
template <class Visit>
void for_each_wild(int count, std::uint32_t seed, double decades, Visit&& visit) {
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        Random random(seed);
        for (int i = 0; i < count; ++i) {
            WildOptions options;
            options.decades = decades;
            const auto scene = wild_scene(random, kind, options);
            const auto state = scene.initial_state();
            const Analysis analysis(scene, state);
            INFO(kind << ", system " << i << " of seed " << seed);
            visit(Wild{random, scene, analysis, analysis.pencil(), exact_matrices(scene, state.x)});
        }
    }
}

/// Σ over a row of s_i |E_ij| s_j, at most.
Real largest_row(const RealMatrix& E, const Eigen::VectorXd& s) {
    const RealVector t = s.cast<Real>();
    return t.cwiseProduct(E.cwiseAbs() * t).maxCoeff();
}

RealMatrix dense(const Eigen::SparseMatrix<double>& A) { return A.toDense().cast<Real>(); }

}  // namespace

TEST_CASE("pencil: upper_bound is never below the largest eigenvalue", "[proof][slow]") {
    for (const double decades : {0.5, 3.0, 6.0}) {
        for_each_wild(300, 100, decades, [](const Wild& w) {
            for (int repeat = 0; repeat < 4; ++repeat) {
                const Combination c = repeat == 0 ? matrices::K_plus : wild_combination(w.random);
                const RealVector all = exact_eigenvalues(w.exact, c);
                const Real noise = 64 * real_epsilon * all.cwiseAbs().maxCoeff();
                const double bound = w.pencil.upper_bound(c);
                INFO("mass " << c.mass() << ", damping " << c.damping() << ", K " << c.stiffness()
                             << ", K_plus " << c.projected());
                CHECK(static_cast<Real>(bound) >= all[all.size() - 1] - noise);
                CHECK(bound >= c.mass() + c.damping() * w.pencil.rayleigh().mass_proportional);
            }
        });
    }
}

TEST_CASE("pencil: the bound holds for any weights of the particles", "[proof]") {
    for_each_wild(150, 101, 3, [](const Wild& w) {
        const Index dim = w.scene.dim();
        const Index n = w.pencil.size() / dim;
        std::vector<double> p;
        for (Index i = 0; i < n; ++i) p.push_back(over_decades(w.random, 3));
        const RealVector all = exact_eigenvalues(w.exact, matrices::K_plus);
        const auto loads = w.pencil.particle_loads(matrices::K_plus, p);
        double largest = 0;
        for (Index i = 0; i < n; ++i)
            largest =
                std::max(largest, loads[static_cast<std::size_t>(i)] / w.pencil.mass()[dim * i]);
        CHECK(static_cast<Real>(largest) * (1 + 1e-15L) >= all[all.size() - 1]);
    });
}

TEST_CASE("pencil: multiply, quadratic, assemble and linearize() tell the same", "[proof]") {
    for_each_wild(100, 102, 3, [](const Wild& w) {
        const Combination c = wild_combination(w.random);
        const Eigen::MatrixXd S(w.pencil.assemble(c));
        CHECK((S == S.transpose()));
        const RealMatrix exact = exact_sum(w.exact, c);
        const Combination sizes = std::abs(c.mass()) * matrices::M +
                                  std::abs(c.damping()) * matrices::D +
                                  std::abs(c.stiffness() + c.projected()) * matrices::K_plus;
        // A compressed spring may be far stiffer across than its stiffness.
        const double norm = largest(exact_sum(w.exact, sizes)) + largest(exact);
        CHECK(distance(S, exact) <= rounding * norm);

        const Eigen::VectorXd u = random_vector(w.random, w.pencil.size());
        Eigen::VectorXd y;
        w.pencil.multiply(c, u, y);
        CHECK(distance(y, S * u) <= rounding * norm);
        const auto q = w.pencil.quadratic(c, u);
        const RealVector v = u.cast<Real>();
        CHECK(static_cast<Real>(q.error) >=
              std::abs(v.dot(exact * v) - static_cast<Real>(q.value)));
        CHECK(q.lower() <= q.upper());

        const auto linear = linearized(w.scene, w.scene.initial_state());
        const double within = w.scene.kind().rounding();
        CHECK((linear.mass == w.pencil.mass()));
        CHECK(distance(linear.stiffness, w.pencil.assemble(matrices::K).toDense()) <=
              within * largest(linear.stiffness));
        CHECK(distance(linear.damping, w.pencil.assemble(matrices::D).toDense()) <=
              within * largest(linear.damping));
    });
}

TEST_CASE("pencil: assembly_error and quadratic errors cover a long double assembly", "[proof]") {
    for_each_wild(250, 103, 5, [](const Wild& w) {
        const Combination c = wild_combination(w.random);
        Eigen::VectorXd s(w.pencil.size());
        for (Index i = 0; i < s.size(); ++i) s[i] = over_decades(w.random, 4);
        const RealMatrix exact = exact_sum(w.exact, c);
        CHECK(largest_row(dense(w.pencil.assemble(c)) - exact, s) <=
              static_cast<Real>(w.pencil.assembly_error(c, s)));

        // Compressed a million times, a spring is far stiffer across than its bound.
        const auto pressed = with_springs(w.scene, [](AnySpring& t) { t.rest_length *= 1e6; });
        const auto state = pressed.initial_state();
        const Analysis analysis(pressed, state);
        const RealMatrix of_pressed = exact_sum(exact_matrices(pressed, state.x), c);
        CHECK(largest_row(dense(analysis.pencil().assemble(c)) - of_pressed, s) <=
              static_cast<Real>(analysis.pencil().assembly_error(c, s)));

        const Eigen::VectorXd u = s.cwiseProduct(random_vector(w.random, w.pencil.size()));
        const auto q = w.pencil.quadratic(c, u);
        const RealVector v = u.cast<Real>();
        // The long double sum has rounding of its own, a thousandth of what is allowed.
        CHECK(std::abs(v.dot(exact * v) - static_cast<Real>(q.value)) <=
              static_cast<Real>(q.error) +
                  real_epsilon * 64 * v.cwiseAbs().dot(exact.cwiseAbs() * v.cwiseAbs()));
    });
}

TEST_CASE("pencil: scaled() is the pencil of the scaled system", "[proof]") {
    for_each_wild(60, 104, 3, [](const Wild& w) {
        const double stiffness = over_decades(w.random, 2);
        const double mass = over_decades(w.random, 2);
        const auto before = w.pencil.mass();
        const auto scaled = w.pencil.scaled(stiffness, mass);
        Exact expected = w.exact;
        expected.K *= static_cast<Real>(stiffness);
        expected.K_plus *= static_cast<Real>(stiffness);
        expected.mass *= static_cast<Real>(mass);
        // Rayleigh damping follows M and K, dampers stay.
        const auto [d0, alpha] = w.pencil.rayleigh();
        expected.D += alpha * (expected.K_plus - w.exact.K_plus);
        expected.D.diagonal() += d0 * (expected.mass - w.exact.mass);
        const Eigen::VectorXd s = w.pencil.mass().cwiseSqrt().cwiseInverse();
        for (const Combination& c : {matrices::M, matrices::K_plus, matrices::K, matrices::D}) {
            CHECK(largest_row(dense(scaled.assemble(c)) - exact_sum(expected, c), s) <=
                  2 * static_cast<Real>(scaled.assembly_error(c, s)) +
                      1e-14L * largest_row(w.exact.D, s));
            const RealVector all = exact_eigenvalues(expected, c);
            CHECK(static_cast<Real>(scaled.upper_bound(c)) * (1 + 1e-15L) >= all[all.size() - 1]);
        }
        CHECK(scaled.stiffness_semidefinite() == w.pencil.stiffness_semidefinite());
        CHECK(scaled.is_rayleigh() == w.pencil.is_rayleigh());
        CHECK((w.pencil.mass() == before));
    });
}

TEST_CASE("pencil: shares are those of the energies and add up to 1", "[proof]") {
    for_each_wild(80, 105, 3, [](const Wild& w) {
        const Eigen::VectorXd u = random_vector(w.random, w.pencil.size());
        const RealVector v = u.cast<Real>();
        const auto energy = static_cast<double>(v.dot(w.exact.K_plus * v));
        const auto springs = w.scene.springs();
        double sum = 0;
        for (const auto& part : w.pencil.spring_shares(u)) {
            sum += part.share;
            REQUIRE(part.index >= 0);
            REQUIRE(part.index < w.scene.spring_count());
            const AnySpring& spring = springs[static_cast<std::size_t>(part.index)];
            CHECK(part.a == spring.a);
            CHECK(part.b == spring.b);
            CHECK(!(w.scene.is_pinned(part.a) && w.scene.is_pinned(part.b)));
            // Alone in a scene of the same particles it has that energy.
            Index place = 0;
            const auto alone = with_springs(w.scene, [&](AnySpring& s) {
                if (place++ != part.index) s.stiffness = 0;
            });
            const Exact one = exact_matrices(alone, alone.initial_state().x);
            CHECK_THAT(part.share * energy,
                       WithinAbs(static_cast<double>(v.dot(one.K_plus * v)), rounding * energy));
        }
        CHECK_THAT(sum, WithinAbs(energy > 0 ? 1.0 : 0.0, rounding));

        sum = 0;
        for (const auto& part : w.pencil.particle_shares(u)) {
            sum += part.share;
            CHECK(part.share >= 0);
            CHECK_FALSE(w.scene.is_pinned(part.index));
        }
        CHECK_THAT(sum, WithinAbs(1.0, rounding));
        for (const auto& part : w.pencil.particle_shares(Eigen::VectorXd::Zero(u.size())))
            CHECK(part.share == 0);
    });
}

TEST_CASE("pencil: what is called semi-definite is so", "[proof]") {
    int semidefinite = 0, indefinite = 0;
    for_each_wild(200, 106, 3, [&](const Wild& w) {
        const RealVector k = exact_eigenvalues(w.exact, matrices::K);
        const RealVector d = exact_eigenvalues(w.exact, matrices::D);
        const Real noise = 1e-13L * k.cwiseAbs().maxCoeff();
        if (w.pencil.stiffness_semidefinite()) CHECK(k[0] >= -noise);
        CHECK(exact_eigenvalues(w.exact, matrices::K_plus)[0] >= -noise);
        CHECK(w.pencil.damping_semidefinite());
        CHECK(d[0] >= -1e-13L * d.cwiseAbs().maxCoeff());
        if (w.scene.dim() > 1) ++(w.pencil.stiffness_semidefinite() ? semidefinite : indefinite);
        CHECK(w.pencil.projected_semidefinite());
        CHECK(w.pencil.resolution() > 0);
        if (w.pencil.is_rayleigh()) {
            Exact damped = w.exact;
            damped.D.setZero();
            const auto [d0, alpha] = w.pencil.rayleigh();
            damped.add_rayleigh(d0, alpha);
            CHECK((damped.D - w.exact.D).cwiseAbs().maxCoeff() <=
                  1e-15L * w.exact.D.cwiseAbs().maxCoeff());
        } else {
            const auto springs = w.scene.springs();
            CHECK(std::any_of(springs.begin(), springs.end(),
                              [](const AnySpring& s) { return s.damping > 0; }));
        }
    });
    CHECK(semidefinite > 100);
    CHECK(indefinite > 100);
}

TEST_CASE("pencil: a slight compression is no semi-definite stiffness", "[proof]") {
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        if (kind.dim == 1) continue;
        Random random(107);
        for (int repeat = 0; repeat < 40; ++repeat) {
            // One spring from a pin, at random in space, with T/l = −share of its stiffness k.
            const double k = log_uniform(random, 1e-3, 1e6);
            const double m = log_uniform(random, 1e-3, 1e3);
            const auto squeezed = [&](double share) {
                Scene scene(kind);
                const auto end = random_vector(random, kind.dim, 0.5, 1);
                scene.add_particle(Eigen::VectorXd::Zero(kind.dim), 1);
                scene.add_particle(end, m);
                scene.add_spring({0, 1, k, end.norm() * (1 + share)});
                scene.pin(0);
                return scene;
            };
            const auto semidefinite = [](const Scene& scene) {
                return Analysis(scene, scene.initial_state()).pencil().stiffness_semidefinite();
            };
            for (const double share : {1e-1, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12}) {
                if (share < 4 * kind.epsilon()) continue;
                INFO(kind << ", repeat " << repeat << " of seed 107, share " << share);
                const auto scene = squeezed(share);
                CHECK_FALSE(semidefinite(scene));
                CHECK(semidefinite(squeezed(-share)));
                // What rounding to the scalar explains is no statement about physics.
                if (share < 100 * kind.epsilon()) continue;
                const auto limit =
                    scene.limit(taut::Method::symplectic_euler, scene.initial_state());
                CHECK(limit.cause == taut::Cause::buckling);
                CHECK_THAT(limit.growth_rate,
                           WithinRel(std::sqrt(share * k / m), kind.single ? 0.1 : 1e-3));
            }
            // What is semi-definite but for rounding is covered by compression().
            const auto slight = squeezed(4 * kind.epsilon());
            const auto state = slight.initial_state();
            CHECK(Analysis(slight, state).pencil().compression() >=
                  -exact_eigenvalues(exact_matrices(slight, state.x), matrices::K)[0]);
            if (!kind.single) CHECK(semidefinite(squeezed(0)));
        }
    }
}

TEST_CASE("pencil: rounding of a particle of many springs counts, whichever end it is", "[proof]") {
    // Each of these is nothing beside the first; together they are not.
    for (const bool first : {false, true}) {
        INFO("particle 0 is end " << (first ? 'a' : 'b'));
        Scene star({false, 1, Laws::hookean});
        star.add_particle(Eigen::VectorXd::Zero(1), 1);
        for (Index i = 1; i <= 4000; ++i) {
            star.add_particle(Eigen::VectorXd::Ones(1), 1);
            star.pin(i);
            star.add_spring({first ? 0 : i, first ? i : 0, i == 1 ? 1 : 0.99 * 0x1p-54, 1});
        }
        const Analysis analysis(star, star.initial_state());
        const auto& pencil = analysis.pencil();
        const Real exact = exact_matrices(star, star.initial_state().x).K(0, 0);
        const Real assembled = pencil.assemble(matrices::K).coeff(0, 0);
        CHECK(std::abs(assembled - exact) <=
              pencil.assembly_error(matrices::K, Eigen::VectorXd::Ones(1)));
        CHECK(pencil.upper_bound(matrices::K_plus) >= exact);
    }
}

TEST_CASE("pencil: at a kink of a law the bounds hold on both sides", "[proof]") {
    for (const Kind& kind : kinds_of(Laws::strings)) {
        INFO(kind);
        Scene scene(kind);
        scene.add_particle(Eigen::VectorXd::Zero(kind.dim), 1);
        scene.add_particle(Eigen::VectorXd::Unit(kind.dim, 0), 2);
        AnySpring string{0, 1, 50, 1};
        string.law = LawOf::tension_only;
        scene.add_spring(string);
        scene.pin(0);
        const Analysis analysis(scene, scene.initial_state());
        CHECK(analysis.pencil().upper_bound(matrices::K_plus) >= 25);
        CHECK(analysis.pencil().upper_bound(matrices::K) >= 25);
        CHECK(analysis.pencil().upper_bound(-matrices::K) >= 0);
        for (const double tightness : {0.0, 1e-6})
            CHECK(analysis.max_step(taut::Method::symplectic_euler, tightness).certified <= 0.4);
        CHECK_FALSE(analysis.proves(taut::Method::symplectic_euler, 0.41));
    }
}

TEST_CASE("pencil: where rounding hides whether T' is positive, a proof holds for T' = 0",
          "[proof]") {
    for (const Kind& kind : kinds_of(Laws::any)) {
        Random random(108);
        for (int repeat = 0; repeat < 20; ++repeat) {
            INFO(kind << ", repeat " << repeat << " of seed 108");
            AnySpring glue{0, 1, log_uniform(random, 1, 1e3), 1};
            glue.law = LawOf::glue;
            glue.second = random.uniform(0.1, 1);  // T is the largest at w/√2
            Scene scene(kind);
            scene.add_particle(Eigen::VectorXd::Zero(kind.dim), 1);
            scene.add_particle(
                Eigen::VectorXd::Unit(kind.dim, 0) * (1 + glue.second / std::sqrt(2.0)), 1);
            scene.add_spring(glue);
            scene.pin(0);
            const Analysis analysis(scene, scene.initial_state());
            // 2K⁺ − K is |T'| along the spring.
            CHECK(
                analysis.pencil().assemble_least(2 * matrices::K_plus - matrices::K).coeff(0, 0) <=
                0);
        }
    }
}

}  // namespace taut_test::pencil_test
