// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/model/spring_system.hpp>

#include "../support/catch.hpp"
#include "../support/decompositions.hpp"
#include "../support/random_system.hpp"
#include "../support/tolerance.hpp"

namespace taut_test::spring_mechanics_test {

using taut::Hookean;
using taut::Spring;

/// A spring of the law with a damper, between 1/8 and 3 times its rest length.
template <class Scalar, class Law>
struct Drawn {
    Spring<Scalar, Law> spring;
    double length;

    Drawn(Random& random, Law law)
        : spring{0, 1, draw_parameters<Scalar>(random, law),
                 static_cast<Scalar>(random.uniform(0.2, 1.4)),
                 static_cast<Scalar>(random.uniform(0.1, 1))},
          length(static_cast<double>(spring.rest_length) * log_uniform(random, 0.125, 3)) {}
    template <int Dim>
    Eigen::Matrix<Scalar, Dim, 1> dx(Random& random) const {
        const auto d = random.vector<double, Dim>(-1, 1).normalized().eval();
        return (length * d).template cast<Scalar>();
    }
};

template <class Visitor>
void for_each_law(Visitor&& visit) {
    visit(Hookean{});
    visit(TensionOnly{});
    visit(Buckling{});
    visit(Glue{});
}

TEMPLATE_TEST_CASE("spring_mechanics: the pull is the slope of the energy", "[model]",
                   (Case<float, 1>), (Case<float, 2>), (Case<float, 3>), (Case<double, 1>),
                   (Case<double, 2>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(2001);
    for_each_law([&](auto law) {
        for (int trial = 0; trial < 50; ++trial) {
            const Drawn<Scalar, decltype(law)> drawn(random, law);
            const auto dx = drawn.template dx<Dim>(random);
            const auto exact = drawn.spring.template cast<double>();
            const Eigen::Matrix<double, Dim, 1> at = dx.template cast<double>();
            const double l = at.norm();
            // At a kink of T the energy has no second derivative for differences to use.
            const double kink = static_cast<double>(drawn.spring.rest_length);
            if (std::abs(l - kink) < 1e-3) continue;
            const double slope = (exact.energy(l + 1e-5) - exact.energy(l - 1e-5)) / 2e-5;
            const double size = exact.stiffness_bound() * (l + kink);
            CHECK(distance(pull(drawn.spring, dx), slope / l * at) <=
                  (Tolerance<double>::difference + Tolerance<Scalar>::rounding) * size);
        }
    });
}

TEMPLATE_TEST_CASE("spring_mechanics: damping is D of the tangent's blocks", "[model]",
                   (Case<float, 1>), (Case<float, 2>), (Case<float, 3>), (Case<double, 1>),
                   (Case<double, 2>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;
    Random random(2002);
    for_each_law([&](auto law) {
        using Law = decltype(law);
        for (int trial = 0; trial < 50; ++trial) {
            const Drawn<Scalar, Law> drawn(random, law);
            // The last ones coincide.
            const Vector dx = trial < 45 ? drawn.template dx<Dim>(random) : Vector(Vector::Zero());
            const Vector dv = random.vector<Scalar, Dim>(-2, 2);
            const auto alpha = static_cast<Scalar>(random.uniform(0, 0.1));
            taut::SpringSet<Scalar, Law> set;
            set.add(drawn.spring);
            taut::Points<Scalar, Dim> x = taut::Points<Scalar, Dim>::Zero(Dim, 2);
            x.col(1) = dx;
            const auto t = set.tangent(0, x);
            const auto plus = t.projected();
            CHECK(plus.axial >= 0);
            CHECK(plus.transverse >= 0);
            const Vector projected = taut::spring_product(t.d, plus.axial, plus.transverse, dv);
            CHECK(distance(projected, taut::spring_block(t.d, plus.axial, plus.transverse) * dv) <=
                  Tolerance<Scalar>::rounding * static_cast<double>(t.bound) * 4);
            const Vector damper = taut::spring_product(t.d, t.damping, Scalar(0), dv);
            const auto own = pull(drawn.spring, dx);
            const double rounding = Tolerance<Scalar>::rounding *
                                    (largest(own) + static_cast<double>(t.bound + t.damping) * 4);
            auto undamped = drawn.spring;
            undamped.damping = 0;
            const auto of = [&](const Spring<Scalar, Law>& spring, Scalar factor) {
                return Vector(pull(spring, dx, dv, factor) - own);
            };
            const Vector rayleigh = alpha * projected;
            CHECK(largest(of(undamped, 0)) == 0);
            CHECK(distance(of(drawn.spring, 0), damper) <= rounding);
            CHECK(distance(of(undamped, alpha), rayleigh) <= rounding);
            CHECK(distance(of(drawn.spring, alpha), rayleigh + damper) <= rounding);
        }
    });
}

TEMPLATE_TEST_CASE("spring_mechanics: K+ is the nearest block without negative eigenvalues",
                   "[model]", (Case<float, 2>), (Case<double, 1>), (Case<double, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(2003);
    for (int trial = 0; trial < 100; ++trial) {
        const auto d = random.vector<Scalar, Dim>(-1, 1).normalized().eval();
        const auto axial = static_cast<Scalar>(random.uniform(-100, 100));
        const auto transverse = static_cast<Scalar>(random.uniform(-100, 100));
        const Eigen::MatrixXd H = taut::spring_block(d, axial, transverse).template cast<double>();
        CHECK(H == H.transpose());
        const auto eigen = symmetric_modes(H);
        const Eigen::MatrixXd nearest =
            eigen.vectors * eigen.values.cwiseMax(0).asDiagonal() * eigen.vectors.transpose();
        CHECK(distance(taut::spring_block(d, taut::k_plus(axial), taut::k_plus(transverse)),
                       nearest) <= Tolerance<Scalar>::rounding * 100);
    }
}

TEMPLATE_TEST_CASE("spring_mechanics: ends that coincide pull by no force but that of damping",
                   "[model]", float, double) {
    using Vector = Eigen::Matrix<TestType, 3, 1>;
    Random random(2004);
    for_each_law([&](auto law) {
        const Drawn<TestType, decltype(law)> drawn(random, law);
        const Vector nothing = Vector::Zero();
        const Vector dv = random.vector<TestType, 3>(-1, 1);
        CHECK(pull(drawn.spring, nothing) == nothing);
        const auto force = pull(drawn.spring, nothing, dv, TestType(5));
        CHECK(distance(force, 5 * drawn.spring.stiffness_bound() * dv) <=
              Tolerance<TestType>::rounding * largest(force));
    });
    CHECK(taut::spring_length(Vector(Vector::Zero())) > 0);
}

TEST_CASE("spring_mechanics: a system gives its springs in the order of their indices", "[model]") {
    Random random(2005);
    RandomOptions options;
    options.dampers = true;
    const auto system = random_system<double, 2, Hookean, Glue>(random, options);
    std::vector<std::pair<Index, Index>> ends;
    system.for_each_spring([&](Index a, Index b) { ends.emplace_back(a, b); });
    std::size_t s = 0;
    const auto state = random_state(random, system);
    double energy = 0;
    system.visit_springs([&](const auto& spring) {
        CHECK(ends[s++] == std::pair(spring.a, spring.b));
        energy += spring.energy((state.x.col(spring.b) - state.x.col(spring.a)).norm());
    });
    CHECK(s == ends.size());
    const auto& hookean = system.springs<Hookean>();
    CHECK(hookean[3].damping == hookean.damping[3]);
    CHECK(hookean[3].rest_length == hookean.rest_length[3]);
    CHECK(hookean[3].parameters.stiffness == hookean.parameters[3].stiffness);
    for (Index i = 0; i < system.size(); ++i) {
        energy -= system.mass(i) * system.gravity().dot(state.x.col(i));
    }
    CHECK_THAT(system.potential_energy(state),
               Catch::Matchers::WithinRel(energy, Tolerance<double>::rounding * 100));
}

}  // namespace taut_test::spring_mechanics_test
