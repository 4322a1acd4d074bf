// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/stability/any_pose.hpp>
#include <taut/stability/stability.hpp>
#include <taut/tight/tight.hpp>

#include "../support/catch.hpp"
#include "../support/message.hpp"
#include "../support/random_system.hpp"
#include "../support/stability_scenes.hpp"
#include "../support/tolerance.hpp"

// The ends of double, and of Scalar: what vanishes, overflows or is rounded on the way from a scene
// to its limit. An answer is right there too, or refused by name.

namespace taut_test::ends_test {

using taut::Hookean;
using taut::Method;
using taut::Spring;
using taut::SpringSystem;
using taut::Stability;

namespace {

constexpr Real no_limit = std::numeric_limits<Real>::infinity();

/// The limit of one mode, from [T9] and [T10] in long double, whose range squares stay within.
Real limit_of(Method method, Real k, Real d) {
    if (k == 0 && d == 0) return no_limit;
    if (method != Method::explicit_euler) return 4 / (d + std::sqrt(d * d + 4 * k));
    return d * d < 4 * k ? d / k : 4 / (d + std::sqrt(d * d - 4 * k));
}

template <class Scalar, int Dim>
Eigen::Matrix<Scalar, Dim, 1> axis(Scalar length) {
    return length * Eigen::Matrix<Scalar, Dim, 1>::Unit(0);
}

/// A pinned particle at the origin, and one of mass m at x.
template <class Scalar, int Dim, class... Laws>
SpringSystem<Scalar, Dim, Laws...> two_particles(const Eigen::Matrix<Scalar, Dim, 1>& x, Scalar m) {
    SpringSystem<Scalar, Dim, Laws...> system;
    system.add_particle(Eigen::Matrix<Scalar, Dim, 1>::Zero(), 1);
    system.add_particle(x, m);
    system.pin(0);
    return system;
}

template <class Scalar>
void check_contains(const taut::StepLimit<Scalar>& limit, Real truth, double width) {
    INFO(static_cast<double>(limit.certified)
         << ", " << static_cast<double>(limit.refuted) << " around " << static_cast<double>(truth));
    CHECK(static_cast<Real>(limit.certified) <= truth);
    CHECK(static_cast<Real>(limit.refuted) >= truth);
    CHECK(static_cast<Real>(limit.certified) >= truth * static_cast<Real>(1 - width));
    CHECK(static_cast<Real>(limit.refuted) <= truth * static_cast<Real>(1 + width));
}

/// A random unit vector.
template <class Scalar, int Dim>
Eigen::Matrix<Scalar, Dim, 1> direction(Random& random) {
    Eigen::Matrix<double, Dim, 1> d = random.vector<double, Dim>(-1, 1);
    while (!(d.norm() > 0.1)) d = random.vector<double, Dim>(-1, 1);
    return d.normalized().template cast<Scalar>();
}

}  // namespace

TEMPLATE_TEST_CASE("ends: damping whose square vanishes or overflows", "[extremes]",
                   (Case<double, 1>), (Case<double, 2>), (Case<double, 3>), (Case<float, 1>),
                   (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    // Of d0 and of the limit, which must be normal numbers of Scalar.
    const double most = std::is_same_v<Scalar, float> ? 1e36 : 1e300;
    Random random(1600 + Dim);
    for (int repeat = 0; repeat < 60; ++repeat) {
        const double d0 = taut::held_as<Scalar>(log_uniform(random, 1 / most, most));
        INFO("d0 = " << d0);
        auto system = two_particles<Scalar, Dim>(axis<Scalar, Dim>(1), Scalar(0.5));
        if (repeat % 2 == 0) system.add_spring(0, 1, 0);
        system.set_rayleigh({d0, 0});
        const Stability<Scalar> springs(system, system.initial_state());
        const taut::SparseMatrix<Scalar> none(1, 1);
        Eigen::MatrixXd D(1, 1);
        D << d0;
        const taut::LinearSystem<Scalar> bare(taut::VectorX<Scalar>::Ones(1), sparse<Scalar>(D),
                                              none);
        // An entry of a matrix is no factor: its square must be a normal number, too.
        const bool in_range = d0 > 1e-150 && d0 < 1e150;
        if (!in_range) {
            const auto message = message_of([&] { (void)Stability<Scalar>(bare).size(); });
            CHECK(missing(message, {"damping in row 0"}) == "");
        }
        const double width = 1e-12 + 8 * Tolerance<Scalar>::epsilon;
        for (const double tightness : {0.0, 1e-6}) {
            for (const Method method : {Method::explicit_euler, Method::symplectic_euler}) {
                INFO(name(method) << ", tightness " << tightness);
                const Real truth = limit_of(method, 0, static_cast<Real>(d0));
                check_contains(taut::max_step(springs, method, tightness), truth, width);
                if (!in_range) continue;
                const Stability<Scalar> matrices(bare);
                check_contains(taut::max_step(matrices, method, tightness), truth, width);
            }
            check_contains(taut::any_pose_limit(system, tightness), 2 / static_cast<Real>(d0),
                           width);
        }
    }
}

TEMPLATE_TEST_CASE("ends: springs whose squared length vanishes", "[extremes]", (Case<double, 1>),
                   (Case<double, 2>), (Case<double, 3>), (Case<float, 2>), (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    const bool is_float = std::is_same_v<Scalar, float>;
    Random random(1610 + Dim);
    for (int repeat = 0; repeat < 200; ++repeat) {
        const auto length = static_cast<Scalar>(is_float ? log_uniform(random, 1e-26, 1e-15)
                                                         : log_uniform(random, 1e-167, 1e-150));
        auto system = two_particles<Scalar, Dim>(
            Eigen::Matrix<Scalar, Dim, 1>(length * direction<Scalar, Dim>(random)), Scalar(0.25));
        const auto k = static_cast<Scalar>(random.uniform(1, 100));
        // At rest, stretched, or without rest length: k along the spring, and no more across it.
        const auto d = (system.initial_state().x.col(1)).eval();
        switch (repeat % 3) {
            case 0: system.add_spring(0, 1, k); break;
            case 1:
                system.add_spring(Spring<Scalar, Hookean>{0, 1, {k}, d.stableNorm() / 3});
                break;
            default: system.add_spring(Spring<Scalar, Hookean>{0, 1, {k}, 0});
        }
        INFO("system " << repeat << ", length " << static_cast<double>(length));
        const Real truth = 2 / std::sqrt(4 * static_cast<Real>(k));
        const Stability<Scalar> stability(system, system.initial_state());
        for (const double tightness : {0.0, 1e-6}) {
            check_contains(taut::max_step(stability, Method::symplectic_euler, tightness), truth,
                           1e-5);
        }
    }
}

TEMPLATE_TEST_CASE("ends: a damper of any length slows by no more than its factor", "[extremes]",
                   (Case<double, 1>), (Case<double, 2>), (Case<double, 3>), (Case<float, 2>),
                   (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    const bool is_float = std::is_same_v<Scalar, float>;
    Random random(1620 + Dim);
    for (int repeat = 0; repeat < 300; ++repeat) {
        const auto length = static_cast<Scalar>(is_float ? log_uniform(random, 1e-26, 1e-15)
                                                         : log_uniform(random, 1e-167, 1e-150));
        const auto c = static_cast<Scalar>(random.uniform(1, 100));
        auto system = two_particles<Scalar, Dim>(
            Eigen::Matrix<Scalar, Dim, 1>(length * direction<Scalar, Dim>(random)), Scalar(1));
        system.add_spring(Spring<Scalar, Hookean>{0, 1, {Scalar(0)}, Scalar(1), c});
        auto state = system.initial_state();
        state.v.col(1) = direction<Scalar, Dim>(random);
        taut::Points<Scalar, Dim> f;
        system.force(state, f);
        CHECK(static_cast<double>(f.col(1).norm()) <=
              static_cast<double>(c) * (1 + Tolerance<Scalar>::rounding));
    }
}

namespace {

/// The system at rest with Hooke's springs of the given stiffness in place of its own.
template <class System, class Stiffness>
auto with_hookean(const System& system, Stiffness&& stiffness) {
    SpringSystem<double, System::Dim> copy;
    const auto x = system.initial_state().x.template cast<double>().eval();
    for (Index i = 0; i < system.size(); ++i) {
        copy.add_particle(x.col(i), static_cast<double>(system.mass(i)));
        if (system.is_pinned(i)) copy.pin(i);
    }
    system.for_each_set([&](const auto& set) {
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            copy.add_spring(set.a[s], set.b[s], static_cast<double>(stiffness(set.parameters[s])));
        }
    });
    return copy;
}

}  // namespace

TEMPLATE_TEST_CASE("ends: nets at rest are certified on both sides of every kink", "[extremes]",
                   (Case<double, 1>), (Case<double, 2>), (Case<double, 3>), (Case<float, 1>),
                   (Case<float, 2>), (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    Random random(1630 + Dim);
    for (int repeat = 0; repeat < 60; ++repeat) {
        SpringSystem<Scalar, Dim, TensionOnly, Buckling> system;
        // At, or far from, the origin: there the positions' rounding is the larger one.
        const double off = repeat % 3 == 0 ? 100 : 0;
        for (int i = 0; i < 5; ++i) {
            const auto place = random.vector<double, Dim>(off - 1, off + 1);
            system.add_particle(place.template cast<Scalar>(),
                                static_cast<Scalar>(random.uniform(0.5, 2)));
        }
        for (Index a = 0; a < 5; ++a) {
            const Index b = (a + 1 + random.below(4)) % 5;
            system.template add_spring<TensionOnly>(a, b,
                                                    draw_parameters<Scalar>(random, TensionOnly{}));
            system.template add_spring<Buckling>(b, (b + 1) % 5,
                                                 draw_parameters<Scalar>(random, Buckling{}));
        }
        system.pin(random.below(5));
        const auto stiff = with_hookean(system, [](const auto& p) {
            using Parameters = std::decay_t<decltype(p)>;
            if constexpr (std::is_same_v<Parameters, Buckling::Parameters<Scalar>>) {
                return std::max(p.stiffness, p.onset);
            } else {
                return p.stiffness;
            }
        });
        const auto k =
            eigenvalues(exact_matrices(stiff, stiff.initial_state().x).scaled(0, 1, 0, false));
        const Real truth = 2 / std::sqrt(k[k.size() - 1]);
        auto state = system.initial_state();
        const Stability<Scalar> stability(system, state);
        for (const double tightness : {0.0, 1e-6}) {
            const auto limit = taut::max_step(stability, Method::symplectic_euler, tightness);
            INFO("system " << repeat << ", tightness " << tightness << ": "
                           << static_cast<double>(limit.certified) << ", "
                           << static_cast<double>(limit.refuted));
            CHECK(static_cast<Real>(limit.certified) <= truth * (1 + 1e-12L));
            CHECK(limit.refuted >= limit.certified);
            CHECK(static_cast<Real>(limit.refuted) <= truth * 2);
        }
        const auto beyond = static_cast<double>(truth * 1.0001L);
        CHECK_FALSE(taut::certify(stability, Method::symplectic_euler, beyond).proved);
    }
}

TEMPLATE_TEST_CASE("ends: explicit Euler at a kink holds on the slack side, too", "[extremes]",
                   float, double) {
    Random random(1640);
    for (int repeat = 0; repeat < 400; ++repeat) {
        auto system = two_particles<TestType, 1, TensionOnly>(axis<TestType, 1>(1), TestType(1));
        const auto k = static_cast<TestType>(log_uniform(random, 1, 1e4));
        const auto c = static_cast<TestType>(std::sqrt(k) * log_uniform(random, 0.1, 10));
        system.add_spring(Spring<TestType, TensionOnly>{0, 1, {k}, 1, c});
        system.set_rayleigh({repeat % 2 == 0 ? 0 : random.uniform(0, 1), 0});
        auto state = system.initial_state();
        for (Index ulps = random.below(4); ulps > 0; --ulps) {
            state.x(0, 1) = std::nextafter(state.x(0, 1), TestType(repeat % 3 == 0 ? 0 : 2));
        }
        const Real d =
            static_cast<Real>(c) +
            static_cast<Real>(taut::held_as<TestType>(system.rayleigh().mass_proportional));
        const Real slack = limit_of(Method::explicit_euler, 0, d);
        const Real taut = limit_of(Method::explicit_euler, static_cast<Real>(k), d);
        const Stability<TestType> stability(system, state);
        for (const double tightness : {0.0, 1e-6}) {
            const auto limit = taut::max_step(stability, Method::explicit_euler, tightness);
            INFO("system " << repeat << ", tightness " << tightness << ": "
                           << static_cast<double>(limit.certified) << " of "
                           << static_cast<double>(slack) << " slack, " << static_cast<double>(taut)
                           << " taut");
            CHECK(static_cast<Real>(limit.certified) <= std::min(slack, taut));
            CHECK(static_cast<Real>(limit.refuted) >= std::min(slack, taut));
            // Without drag the bound alone cannot tell D − hK⁺ ⪰ 0 from its rounding.
            if (tightness > 0 || repeat % 2 == 1) CHECK(limit.certified > 0);
        }
    }
}

TEMPLATE_TEST_CASE("ends: a stepper's own 1/m and d0 stay within the certified step", "[extremes]",
                   float, double) {
    Random random(1650);
    for (int repeat = 0; repeat < 2000; ++repeat) {
        const auto m = static_cast<TestType>(0.1 + random.uniform(0, 3));
        const auto k = static_cast<TestType>(10 + random.uniform(0, 1000));
        const double d0 = repeat % 2 == 0 ? 0 : random.uniform(0, 1) + random.uniform(0, 1) / 3e7;
        auto system = two_particles<TestType, 1>(axis<TestType, 1>(1), m);
        system.add_spring(0, 1, k);
        system.set_rayleigh({d0, 0});
        const Real held_k = static_cast<Real>(k) * static_cast<Real>(system.inverse_mass()[1]);
        const Real held_d = static_cast<Real>(taut::held_as<TestType>(d0));
        const Real truth = limit_of(Method::symplectic_euler, held_k, held_d);
        const Stability<TestType> stability(system, system.initial_state());
        for (const double tightness : {0.0, 1e-6}) {
            check_contains(taut::max_step(stability, Method::symplectic_euler, tightness), truth,
                           1e-5);
        }
        CHECK(static_cast<Real>(taut::any_pose_limit(system).certified) <= truth);
        const auto beyond = static_cast<double>(truth * (1 + 1e-15L));
        CHECK_FALSE(taut::certify(stability, Method::symplectic_euler, beyond).proved);
    }
}

TEST_CASE("ends: long double poses are not rounded to double before they are analysed",
          "[extremes]") {
    using Long = long double;
    if constexpr (std::numeric_limits<Long>::digits <= std::numeric_limits<double>::digits) return;
    Random random(1660);
    for (int repeat = 0; repeat < 40; ++repeat) {
        // Two springs at a right angle whose lengths are lost beside their distance from 0.
        const auto gap = static_cast<Long>(log_uniform(random, 0.03, 30)) * 0x1p-53L;
        const Eigen::Matrix<Long, 2, 1> corner(1, 1);
        SpringSystem<Long, 2> system;
        const auto m = static_cast<Long>(random.uniform(0.5, 2));
        system.add_particle(corner, m);
        system.add_particle(corner + Eigen::Matrix<Long, 2, 1>(gap, 0), 1);
        system.add_particle(corner + Eigen::Matrix<Long, 2, 1>(0, gap), 1);
        const auto k = static_cast<Long>(random.uniform(10, 100));
        system.add_spring(0, 1, k);
        system.add_spring(0, 2, k / 2);
        system.pin(1);
        system.pin(2);
        const Stability<Long> stability(system, system.initial_state());
        check_contains(stability.max_step(Method::symplectic_euler), 2 / std::sqrt(k / m), 1e-9);

        // A spring pressed from 1 m to that gap: −κ = T/(l·m).
        auto pressed = two_particles<Long, 2>({1 + gap, 0}, m);
        pressed.add_spring(Spring<Long, Hookean>{0, 1, {k}, 1});
        auto state = pressed.initial_state();
        state.x(0, 0) = 1;
        const Long l = state.x(0, 1) - state.x(0, 0);
        const auto limit = Stability<Long>(pressed, state).max_step(Method::symplectic_euler);
        CHECK_THAT(limit.growth_rate,
                   WithinRel(static_cast<double>(std::sqrt(k * (1 / l - 1) / m)), 1e-6));
        CHECK(limit.cause == taut::Cause::buckling);
    }
}

TEST_CASE("ends: numbers that double does not hold are refused by name", "[extremes][bad_input]") {
    using Long = long double;
    if constexpr (std::numeric_limits<Long>::max_exponent <= 2048) {
        return;
    } else {
        const auto refused = [](Long m, Long k, Long c) {
            auto system = two_particles<Long, 2>({1, 0}, m);
            system.add_spring(0, 1, k, c);
            const auto any = taut::any_pose_limit(system);
            CHECK(any.certified == 0);
            CHECK(any.refuted == no_limit);
            CHECK(any.cause == taut::Cause::overflow);
            return message_of(
                [&] { (void)Stability<Long>(system, system.initial_state()).size(); });
        };
        CHECK(missing(refused(1, 1e-4000L, 0), {"stiffness of spring 0", "1e-4000"}) == "");
        CHECK(missing(refused(1, 1e4000L, 0), {"stiffness of spring 0", "1e+4000"}) == "");
        CHECK(missing(refused(1, 1, 1e-400L), {"damping of spring 0", "1e-400"}) == "");
        CHECK(missing(refused(1e-4000L, 1, 0), {"mass of particle 1", "1e-4000"}) == "");
        CHECK(missing(refused(1e4000L, 1, 0), {"mass of particle 1", "1e+4000"}) == "");
        const auto matrices = [](Long m, Long d, Long k) {
            taut::SparseMatrix<Long> D(2, 2);
            taut::SparseMatrix<Long> K(2, 2);
            D.insert(1, 1) = d;
            K.insert(1, 1) = k;
            const taut::LinearSystem<Long> system(taut::VectorX<Long>::Constant(2, m), D, K);
            return message_of([&] { (void)Stability<Long>(system).size(); });
        };
        CHECK(missing(matrices(1, 1, 1e-4000L), {"stiffness in row 1", "1e-4000"}) == "");
        CHECK(missing(matrices(1, 1e4000L, 1), {"damping in row 1", "1e+4000"}) == "");
        CHECK(missing(matrices(1e4000L, 1, 1), {"mass in row 0", "1e+4000"}) == "");
        CHECK(matrices(1, 0, 1) == "");
    }
}

TEST_CASE("ends: long double matrices are semi-definite as they are, not as they round",
          "[extremes]") {
    using Long = long double;
    if constexpr (std::numeric_limits<Long>::digits <= std::numeric_limits<double>::digits) return;
    const auto analysed = [](Long diagonal) {
        taut::SparseMatrix<Long> K(2, 2);
        K.insert(0, 0) = diagonal;
        K.insert(0, 1) = -1;
        K.insert(1, 0) = -1;
        K.insert(1, 1) = 1;
        const taut::LinearSystem<Long> system(taut::VectorX<Long>::Ones(2), {}, K);
        return Stability<Long>(system).max_step(Method::symplectic_euler);
    };
    // In double all three are the same matrix, [1, −1; −1, 1].
    CHECK(analysed(1).certified > 0);
    CHECK(analysed(1 + 0x1p-62L).certified > 0);
    const auto indefinite = analysed(1 - 0x1p-62L);
    CHECK(indefinite.certified == 0);
    CHECK(indefinite.certified_up_to > 0);
    CHECK(indefinite.cause == taut::Cause::rounding);
    CHECK(indefinite.admitted_growth >= std::sqrt(0x1p-63));
}

}  // namespace taut_test::ends_test
