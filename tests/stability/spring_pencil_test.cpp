// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/stability/lanczos.hpp>
#include <taut/stability/spring_pencil.hpp>

#include "../support/catch.hpp"
#include "../support/tolerance.hpp"
#include "wild_system.hpp"

namespace taut_test::spring_pencil_test {

namespace matrices = taut::matrices;

using taut::Combination;
using taut::SpringPencil;

namespace {

template <int Dim>
using Dimension = std::integral_constant<int, Dim>;

/// visit(system, pencil, exact) for random systems, poses as their particles were placed.
template <int Dim, class Visit>
void for_each_wild(int count, std::uint32_t seed, const WildOptions& options, Visit&& visit) {
    Random random(seed);
    for (int i = 0; i < count; ++i) {
        const auto system = wild_system<double, Dim>(random, options);
        const auto x = system.initial_state().x;
        INFO("system " << i << " of seed " << seed);
        visit(random, system, SpringPencil<Dim>::at_pose(system, x), exact_matrices(system, x));
    }
}

/// How much of the true step 2/√k the bound certifies; the truth from above by a sharp Ritz value.
double tightness(const taut::SpringSystem<double, 3>& cloth, const taut::State<double, 3>& state) {
    const auto pencil = SpringPencil<3>::at_pose(cloth, state.x);
    taut::LanczosOptions options;
    options.basis = 40;
    options.restarts = 50;
    options.tolerance = 1e-4;
    const double k = taut::largest_ritz_pair(pencil, matrices::K_plus, options).value;
    return std::sqrt(k / pencil.upper_bound(matrices::K_plus));
}

taut::SpringSystem<double, 3> cloth_of(Index size) {
    taut::ClothOptions options;
    options.rows = options.columns = size;
    return taut::hanging_cloth<double>(options);
}

}  // namespace

TEMPLATE_TEST_CASE("spring_pencil: upper_bound is never below the largest eigenvalue",
                   "[stability][slow]", Dimension<1>, Dimension<2>, Dimension<3>) {
    for (const double decades : {0.5, 3.0, 6.0}) {
        WildOptions options;
        options.decades = decades;
        for_each_wild<TestType::value>(
            1000, 100, options, [](Random& random, const auto&, const auto& pencil, const auto& e) {
                for (int repeat = 0; repeat < 4; ++repeat) {
                    const Combination c = repeat == 0 ? matrices::K_plus : wild_combination(random);
                    const RealVector all = exact_eigenvalues(e, c);
                    const Real noise = 64 * real_epsilon * all.cwiseAbs().maxCoeff();
                    const double bound = pencil.upper_bound(c);
                    INFO("mass " << c.mass() << ", damping " << c.damping() << ", K "
                                 << c.stiffness() << ", K_plus " << c.projected());
                    CHECK(static_cast<Real>(bound) >= all[all.size() - 1] - noise);
                    CHECK(bound >= c.mass() + c.damping() * pencil.rayleigh().mass_proportional);
                    // A bound that may stop early is still a bound.
                    CHECK(static_cast<Real>(pencil.upper_bound(c, 2 * bound)) >=
                          all[all.size() - 1] - noise);
                }
            });
    }
}

TEMPLATE_TEST_CASE("spring_pencil: the bound holds for any weights of the particles", "[stability]",
                   Dimension<1>, Dimension<2>, Dimension<3>) {
    constexpr int Dim = TestType::value;
    for_each_wild<Dim>(
        300, 101, {}, [](Random& random, const auto&, const auto& pencil, const auto& e) {
            const Index n = pencil.size() / Dim;
            std::vector<double> p;
            for (Index i = 0; i < n; ++i) p.push_back(over_decades(random, 3));
            const RealVector all = exact_eigenvalues(e, matrices::K_plus);
            const auto loads = pencil.particle_loads(matrices::K_plus, p);
            double largest = 0;
            for (Index i = 0; i < n; ++i) {
                largest =
                    std::max(largest, loads[static_cast<std::size_t>(i)] / pencil.mass()[Dim * i]);
            }
            CHECK(static_cast<Real>(largest) * (1 + 1e-15L) >= all[all.size() - 1]);
        });
}

TEST_CASE("spring_pencil: the bound keeps 0.92 of the true step of a cloth", "[stability][slow]") {
    for (const Index size : {8, 12, 20, 32}) {
        const auto cloth = cloth_of(size);
        const double noise = 0.1 / static_cast<double>(size);
        INFO(size << " x " << size);
        CHECK(tightness(cloth, cloth.initial_state()) >= 0.92);
        CHECK(tightness(cloth, deformed(cloth, 1.1, 0, 1)) >= 0.92);
        CHECK(tightness(cloth, deformed(cloth, 1.1, noise, 2)) >= 0.92);
        CHECK(tightness(cloth, deformed(cloth, 0.95, noise, 3)) >= 0.92);
    }
}

TEMPLATE_TEST_CASE("spring_pencil: multiply, quadratic, assemble and linearize() tell the same",
                   "[stability]", Dimension<1>, Dimension<2>, Dimension<3>) {
    constexpr double rounding = Tolerance<double>::rounding;
    for_each_wild<TestType::value>(
        200, 102, {}, [](Random& random, const auto& system, const auto& pencil, const auto& e) {
            const Combination c = wild_combination(random);
            const Eigen::MatrixXd S(pencil.assemble(c));
            CHECK((S == S.transpose()));
            const RealMatrix exact = exact_sum(e, c);
            const Combination sizes = std::abs(c.mass()) * matrices::M +
                                      std::abs(c.damping()) * matrices::D +
                                      std::abs(c.stiffness() + c.projected()) * matrices::K_plus;
            // A compressed spring may be far stiffer across than its stiffness.
            const double norm = largest(exact_sum(e, sizes)) + largest(exact);
            CHECK(distance(S, exact) <= rounding * norm);

            const Eigen::VectorXd u = random_vector(random, pencil.size());
            Eigen::VectorXd y;
            pencil.multiply(c, u, y);
            CHECK(distance(y, S * u) <= rounding * norm);
            const auto q = pencil.quadratic(c, u);
            const RealVector v = u.cast<Real>();
            CHECK(static_cast<Real>(q.error) >=
                  std::abs(v.dot(exact * v) - static_cast<Real>(q.value)));
            CHECK(q.lower() <= q.upper());

            const auto linear = taut::linearize(system, system.initial_state());
            CHECK((linear.mass() == pencil.mass()));
            const Eigen::MatrixXd K(linear.stiffness());
            const Eigen::MatrixXd D(linear.damping());
            CHECK(distance(K, Eigen::MatrixXd(pencil.assemble(matrices::K))) <=
                  rounding * largest(K));
            CHECK(distance(D, Eigen::MatrixXd(pencil.assemble(matrices::D))) <=
                  rounding * largest(D));
        });
}

TEMPLATE_TEST_CASE(
    "spring_pencil: assembly_error and quadratic errors cover a long double assembly",
    "[stability]", Dimension<1>, Dimension<2>, Dimension<3>) {
    WildOptions options;
    options.decades = 5;
    for_each_wild<TestType::value>(
        500, 103, options, [](Random& random, const auto&, const auto& pencil, const auto& e) {
            const Combination c = wild_combination(random);
            Eigen::VectorXd s(pencil.size());
            for (Index i = 0; i < s.size(); ++i) s[i] = over_decades(random, 4);
            const RealMatrix exact = exact_sum(e, c);
            const RealMatrix E =
                (Eigen::MatrixXd(pencil.assemble(c)).template cast<Real>() - exact).cwiseAbs();
            const RealVector row = s.cast<Real>().cwiseProduct(E * s.cast<Real>());
            CHECK(row.maxCoeff() <= static_cast<Real>(pencil.assembly_error(c, s)));

            const Eigen::VectorXd u = s.cwiseProduct(random_vector(random, pencil.size()));
            const auto q = pencil.quadratic(c, u);
            const RealVector v = u.cast<Real>();
            // The long double sum has rounding of its own, a thousandth of what is allowed.
            CHECK(std::abs(v.dot(exact * v) - static_cast<Real>(q.value)) <=
                  static_cast<Real>(q.error) +
                      real_epsilon * 64 * v.cwiseAbs().dot(exact.cwiseAbs() * v.cwiseAbs()));
        });
}

TEMPLATE_TEST_CASE("spring_pencil: scaled() is the pencil of the scaled system", "[stability]",
                   Dimension<1>, Dimension<2>, Dimension<3>) {
    constexpr int Dim = TestType::value;
    for_each_wild<Dim>(
        100, 104, {}, [](Random& random, const auto& system, const auto& pencil, const auto& e) {
            const double stiffness = over_decades(random, 2);
            const double mass = over_decades(random, 2);
            const auto scaled = pencil.scaled(stiffness, mass);
            Exact expected = e;
            expected.K *= static_cast<Real>(stiffness);
            expected.K_plus *= static_cast<Real>(stiffness);
            expected.mass *= static_cast<Real>(mass);
            // Rayleigh damping follows M and K, dampers stay.
            const auto rayleigh = system.rayleigh();
            const auto alpha = static_cast<Real>(rayleigh.stiffness_proportional);
            const auto d0 = static_cast<Real>(rayleigh.mass_proportional);
            expected.D += alpha * (expected.K_plus - e.K_plus);
            expected.D.diagonal() += d0 * (expected.mass - e.mass);
            const Eigen::VectorXd s = pencil.mass().cwiseSqrt().cwiseInverse();
            for (const Combination& c : {matrices::M, matrices::K_plus, matrices::K, matrices::D}) {
                const RealMatrix exact = exact_sum(expected, c);
                const RealMatrix E =
                    (Eigen::MatrixXd(scaled->assemble(c)).template cast<Real>() - exact).cwiseAbs();
                CHECK(s.cast<Real>().cwiseProduct(E * s.cast<Real>()).maxCoeff() <=
                      2 * static_cast<Real>(scaled->assembly_error(c, s)) +
                          1e-14L * s.cast<Real>()
                                       .cwiseProduct(e.D.cwiseAbs() * s.cast<Real>())
                                       .maxCoeff());
                const RealVector all = exact_eigenvalues(expected, c);
                CHECK(static_cast<Real>(scaled->upper_bound(c)) * (1 + 1e-15L) >=
                      all[all.size() - 1]);
            }
            CHECK(scaled->stiffness_semidefinite() == pencil.stiffness_semidefinite());
            CHECK(scaled->is_rayleigh() == pencil.is_rayleigh());
            // The original is untouched.
            CHECK((pencil.mass() ==
                   SpringPencil<Dim>::at_pose(system, system.initial_state().x).mass()));
        });
}

TEMPLATE_TEST_CASE("spring_pencil: shares are those of the energies and add up to 1", "[stability]",
                   Dimension<1>, Dimension<2>, Dimension<3>) {
    constexpr int Dim = TestType::value;
    for_each_wild<Dim>(
        200, 105, {}, [](Random& random, const auto& system, const auto& pencil, const auto& e) {
            const Eigen::VectorXd u = random_vector(random, pencil.size());
            const RealVector v = u.cast<Real>();
            const auto energy = static_cast<double>(v.dot(e.K_plus * v));
            double sum = 0;
            const auto& set = system.springs();
            for (const auto& spring : pencil.spring_shares(u)) {
                sum += spring.share;
                REQUIRE(spring.index >= 0);
                REQUIRE(spring.index < system.spring_count());
                const auto s = static_cast<std::size_t>(spring.index);
                CHECK(spring.a == set.a[s]);
                CHECK(spring.b == set.b[s]);
                CHECK(!(system.is_pinned(spring.a) && system.is_pinned(spring.b)));
                // Alone in a system of the same particles it has that energy.
                taut::SpringSystem<double, Dim> alone;
                for (Index i = 0; i < system.size(); ++i) {
                    alone.add_particle(system.initial_state().x.col(i), system.mass(i));
                    if (system.is_pinned(i)) alone.pin(i);
                }
                alone.add_spring(taut::Spring<double, taut::Hookean>{
                    spring.a, spring.b, set.parameters[s], set.rest_length[s]});
                const Exact one = exact_matrices(alone, alone.initial_state().x);
                CHECK_THAT(spring.share * energy,
                           WithinAbs(static_cast<double>(v.dot(one.K_plus * v)),
                                     Tolerance<double>::rounding * energy));
            }
            CHECK_THAT(sum, WithinAbs(energy > 0 ? 1.0 : 0.0, Tolerance<double>::rounding));

            sum = 0;
            for (const auto& particle : pencil.particle_shares(u)) {
                sum += particle.share;
                CHECK(particle.share >= 0);
                CHECK_FALSE(system.is_pinned(particle.index));
            }
            CHECK_THAT(sum, WithinAbs(1.0, Tolerance<double>::rounding));
            for (const auto& particle :
                 pencil.particle_shares(Eigen::VectorXd::Zero(pencil.size()))) {
                CHECK(particle.share == 0);
            }
        });
}

TEMPLATE_TEST_CASE("spring_pencil: what is called semi-definite is so", "[stability]", Dimension<1>,
                   Dimension<2>, Dimension<3>) {
    int semidefinite = 0;
    int indefinite = 0;
    for_each_wild<TestType::value>(
        400, 106, {}, [&](Random&, const auto& system, const auto& pencil, const auto& e) {
            const RealVector k = exact_eigenvalues(e, matrices::K);
            const RealVector k_plus = exact_eigenvalues(e, matrices::K_plus);
            const RealVector d = exact_eigenvalues(e, matrices::D);
            const Real noise = 1e-13L * k.cwiseAbs().maxCoeff();
            if (pencil.stiffness_semidefinite()) CHECK(k[0] >= -noise);
            CHECK(k_plus[0] >= -noise);
            CHECK(pencil.damping_semidefinite());
            CHECK(d[0] >= -1e-13L * d.cwiseAbs().maxCoeff());
            ++(pencil.stiffness_semidefinite() ? semidefinite : indefinite);
            CHECK(pencil.projected_semidefinite());
            CHECK(pencil.resolution() > 0);
            const auto& damping = system.springs().damping;
            const bool damped =
                std::any_of(damping.begin(), damping.end(), [](double c) { return c > 0; });
            if (pencil.is_rayleigh()) {
                const auto rayleigh = system.rayleigh();
                RealMatrix D = static_cast<Real>(rayleigh.stiffness_proportional) * e.K_plus;
                D.diagonal() += static_cast<Real>(rayleigh.mass_proportional) * e.mass;
                CHECK((D - e.D).cwiseAbs().maxCoeff() <= 1e-15L * e.D.cwiseAbs().maxCoeff());
            } else {
                CHECK(damped);
            }
        });
    CHECK(semidefinite > 50);
    CHECK((indefinite > 50 || TestType::value == 1));
}

TEMPLATE_TEST_CASE("spring_pencil: a slight compression is no semi-definite stiffness",
                   "[stability]", (Case<double, 2>), (Case<double, 3>), (Case<float, 2>),
                   (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    constexpr bool is_double = std::is_same_v<Scalar, double>;
    constexpr auto epsilon = static_cast<double>(std::numeric_limits<Scalar>::epsilon());
    Random random(107);
    for (int repeat = 0; repeat < 60; ++repeat) {
        // One spring from a pin, at random in space, with T/l = −share of its stiffness k.
        const double k = log_uniform(random, 1e-3, 1e6);
        const double m = log_uniform(random, 1e-3, 1e3);
        const auto squeezed = [&](double share) {
            taut::SpringSystem<Scalar, Dim> system;
            const auto end = random.vector<Scalar, Dim>(0.5, 1);
            system.add_particle(Eigen::Matrix<Scalar, Dim, 1>::Zero(), 1);
            system.add_particle(end, static_cast<Scalar>(m));
            const double rest = end.template cast<double>().norm() * (1 + share);
            system.add_spring(taut::Spring<Scalar, taut::Hookean>{
                0, 1, {static_cast<Scalar>(k)}, static_cast<Scalar>(rest), 0});
            system.pin(0);
            return system;
        };
        const auto semidefinite = [&](const auto& system) {
            const auto x = system.initial_state().x.template cast<double>().eval();
            return taut::SpringPencil<Dim>::at_pose(system, x).stiffness_semidefinite();
        };
        for (const double share : {1e-1, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12}) {
            if (share < 4 * epsilon) continue;
            INFO("repeat " << repeat << ", share " << share);
            const auto system = squeezed(share);
            CHECK_FALSE(semidefinite(system));
            CHECK(semidefinite(squeezed(-share)));
            const auto limit = taut::Stability<Scalar>(system, system.initial_state())
                                   .max_step(taut::Method::symplectic_euler);
            // What rounding to Scalar explains is no statement about physics.
            if (share < 100 * epsilon) continue;
            CHECK(limit.cause == taut::Cause::buckling);
            const double rate = std::sqrt(share * k / m);
            CHECK_THAT(limit.growth_rate, WithinRel(rate, is_double ? 1e-3 : 0.1));
        }
        if (is_double) CHECK(semidefinite(squeezed(0)));
    }
}

}  // namespace taut_test::spring_pencil_test
