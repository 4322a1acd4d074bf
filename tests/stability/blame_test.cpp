// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <set>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/scene/with_law.hpp>
#include <taut/stability/stability.hpp>
#include <taut/tight/tight.hpp>

#include "../support/catch.hpp"
#include "../support/tolerance.hpp"
#include "wild_system.hpp"

namespace taut_test::blame_test {

using taut::Method;
using taut::Stability;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Method stepping[] = {Method::explicit_euler, Method::symplectic_euler,
                               Method::velocity_verlet};

taut::SpringSystem<double, 3> cloth_of(Index size) {
    taut::ClothOptions options;
    options.rows = options.columns = size;
    return taut::hanging_cloth<double>(options);
}

/// The same with its stiffnesses and masses multiplied; dampers stay.
template <int Dim>
taut::SpringSystem<double, Dim> scaled(const taut::SpringSystem<double, Dim>& system,
                                       double stiffness, double mass) {
    using System = taut::SpringSystem<double, Dim>;
    auto copy = taut::with_springs<System>(system, [&](System& to, auto spring, Index) {
        spring.parameters.stiffness *= stiffness;
        to.add_spring(spring);
    });
    for (Index i = 0; i < copy.size(); ++i) copy.set_mass(i, mass * system.mass(i));
    return copy;
}

/// visit(system) undamped and with each kind of damping that explicit Euler can use as well.
template <class Visit>
void for_each_damped(Visit&& visit) {
    auto cloth = cloth_of(4);
    visit("undamped", cloth);
    visit("dampers", with_dampers(cloth, 1e-3));
    cloth.set_rayleigh({3, 0});
    visit("d0", cloth);
    cloth.set_rayleigh({3, 2e-4});
    visit("d0 and alpha", cloth);
    auto both = with_dampers(cloth, 1e-3);
    both.set_rayleigh({5, 1e-4});
    visit("all", both);
}

}  // namespace

TEST_CASE("blame: a planted stiff spring is named", "[stability]") {
    Random random(1300);
    for (int repeat = 0; repeat < 20; ++repeat) {
        auto cloth = cloth_of(6);
        const Index a = 6 + random.below(24);
        const Index b = a + 6;
        const Index planted = cloth.add_spring(a, b, 1e6);
        cloth.add_spring(0, 35, 1);  // not the last one
        const Stability<double> stability(cloth, deformed(cloth, 1.02, 0.005, 5));
        const auto blamed = stability.limiting_springs(3);
        REQUIRE(blamed.size() == 3);
        CHECK(blamed[0].index == planted);
        CHECK(blamed[0].a == a);
        CHECK(blamed[0].b == b);
        CHECK(blamed[0].share > 0.95);
        CHECK(blamed[0].share <= 1 + 1e-12);
        CHECK(blamed[0].share >= blamed[1].share);
        CHECK(blamed[1].share >= blamed[2].share);
        // Its ends move most.
        const auto moving = stability.limiting_particles(2);
        REQUIRE(moving.size() == 2);
        CHECK(std::set<Index>{moving[0].index, moving[1].index} == std::set<Index>{a, b});
    }
}

TEST_CASE("blame: a planted light particle is named", "[stability][slow]") {
    Random random(1301);
    for (int repeat = 0; repeat < 20; ++repeat) {
        auto cloth = cloth_of(6);
        const Index light = 6 + random.below(30);
        cloth.set_mass(light, 1e-3 * cloth.mass(light));
        const Stability<double> stability(cloth, deformed(cloth, 1.02, 0.005, 6));
        const auto moving = stability.limiting_particles(1);
        REQUIRE(moving.size() == 1);
        CHECK(moving[0].index == light);
        CHECK(moving[0].share > 0.95);
        for (const auto& spring : stability.limiting_springs(1)) {
            CHECK((spring.a == light || spring.b == light));
        }
        // Undoing the plant moves the limit.
        const double with = stability.max_step(Method::symplectic_euler).certified;
        cloth.set_mass(light, cloth.mass(6 + (light + 1) % 30));
        const double without = Stability<double>(cloth, deformed(cloth, 1.02, 0.005, 6))
                                   .max_step(Method::symplectic_euler)
                                   .certified;
        CHECK(without > 10 * with);
    }
}

TEST_CASE("blame: counts, and shares of all of them", "[stability]") {
    const auto cloth = cloth_of(5);
    const Stability<double> stability(cloth, cloth.initial_state());
    CHECK(stability.limiting_springs(0).empty());
    CHECK(stability.limiting_springs(-3).empty());
    CHECK(stability.limiting_particles(0).empty());
    double sum = 0;
    for (const auto& spring : stability.limiting_springs(100000)) sum += spring.share;
    CHECK_THAT(sum, WithinAbs(1.0, Tolerance<double>::rounding));
    CHECK(static_cast<Index>(stability.limiting_particles(100000).size()) == 23);
    auto held = cloth;
    for (Index i = 0; i < held.size(); ++i) held.pin(i);
    const Stability<double> nothing(held, held.initial_state());
    CHECK(nothing.limiting_springs(5).empty());
    CHECK(nothing.limiting_particles(5).empty());
    CHECK(nothing.max_stiffness_scale(Method::symplectic_euler, 1) == infinity);
    CHECK(nothing.min_mass_scale(Method::symplectic_euler, 1) == 0);
}

TEST_CASE("blame: max_stiffness_scale is certified, and little more is", "[stability][slow]") {
    for_each_damped([](const char* text, const auto& system) {
        const auto state = system.initial_state();
        const Stability<double> stability(system, state);
        for (const Method method : stepping) {
            const auto limit = stability.max_step(method);
            for (const double part : {0.05, 0.5, 0.99, 1.5}) {
                const double base =
                    limit.certified > 0 && std::isfinite(limit.certified) ? limit.certified : 1e-4;
                const double h = part * base;
                const double scale = stability.max_stiffness_scale(method, h);
                INFO(text << ", " << name(method) << ", h = " << h << ", scale = " << scale);
                CHECK(scale >= 0);
                if (scale == 0) {
                    CHECK((limit.certified == 0 || part > 1));
                    continue;
                }
                REQUIRE(std::isfinite(scale));
                const auto softer = scaled(system, 0.999 * scale, 1);
                CHECK(taut::certify(Stability<double>(softer, state), method, h).proved);
                const auto stiffer = scaled(system, 1.05 * scale, 1);
                CHECK(Stability<double>(stiffer, state).max_step(method).certified < h);
                if (part < 1) CHECK(scale >= 1 - 1e-6);
                if (part > 1) CHECK(scale < 1);
            }
        }
    });
}

TEST_CASE("blame: min_mass_scale is certified, and little less is", "[stability][slow]") {
    for_each_damped([](const char* text, const auto& system) {
        const auto state = system.initial_state();
        const Stability<double> stability(system, state);
        for (const Method method : {Method::symplectic_euler, Method::velocity_verlet}) {
            const double certified = stability.max_step(method).certified;
            for (const double part : {0.05, 0.5, 0.99, 1.5}) {
                const double h = part * certified;
                const double scale = stability.min_mass_scale(method, h);
                INFO(text << ", " << name(method) << ", h = " << h << ", scale = " << scale);
                if (std::isinf(scale)) {
                    CHECK(2 * h * system.rayleigh().mass_proportional >= 4 * (1 - 1e-6));
                    continue;
                }
                REQUIRE(scale > 0);
                CHECK(taut::certify(Stability<double>(scaled(system, 1, 1.001 * scale), state),
                                    method, h)
                          .proved);
                CHECK(Stability<double>(scaled(system, 1, scale / 1.05), state)
                          .max_step(method)
                          .certified < h);
                CHECK((part < 1 ? scale <= 1 + 1e-6 : scale > 1));
            }
        }
    });
}

TEST_CASE("blame: beyond the refuted ratio no scale is certified", "[stability]") {
    // Undamped, h² k/m is all there is.
    const auto cloth = cloth_of(5);
    const auto state = deformed(cloth, 1.1, 0.01, 7);
    const Stability<double> stability(cloth, state);
    const auto limit = stability.max_step(Method::symplectic_euler);
    const double ratio = std::pow(limit.refuted / limit.certified, 2);
    const double h = 0.8 * limit.certified;
    const double stiffer = stability.max_stiffness_scale(Method::symplectic_euler, h);
    CHECK_THAT(stiffer, WithinRel(1 / 0.64, 1e-3));
    CHECK_FALSE(taut::certify(Stability<double>(scaled(cloth, 1.01 * ratio * stiffer, 1), state),
                              Method::symplectic_euler, h)
                    .proved);
    const double lighter = stability.min_mass_scale(Method::symplectic_euler, h);
    CHECK_THAT(lighter, WithinRel(0.64, 1e-3));
    CHECK_FALSE(taut::certify(Stability<double>(scaled(cloth, 1, lighter / ratio / 1.01), state),
                              Method::symplectic_euler, h)
                    .proved);
}

TEST_CASE("blame: scales where every step is safe, and where none is", "[stability]") {
    const auto cloth = cloth_of(4);
    const Stability<double> stability(cloth, cloth.initial_state());
    CHECK(stability.max_stiffness_scale(Method::implicit_euler, 1e6) == infinity);
    CHECK(stability.min_mass_scale(Method::implicit_euler, 1e6) == 0);
    CHECK(stability.max_stiffness_scale(Method::explicit_euler, 1e-6) == 0);  // undamped
    CHECK(stability.min_mass_scale(Method::explicit_euler, 1e-6) == infinity);
    // A damping matrix that is not positive semi-definite.
    const Eigen::Vector2d mass(1, 1);
    Eigen::Matrix2d D, K;
    D << 1, 2, 2, 1;
    K << 2, -1, -1, 2;
    const Stability<double> active(taut::LinearSystem<double>(mass, sparse(D), sparse(K)));
    CHECK(active.max_stiffness_scale(Method::symplectic_euler, 1e-3) == 0);
    CHECK(active.min_mass_scale(Method::symplectic_euler, 1e-3) == infinity);
}

TEMPLATE_TEST_CASE("blame: scales are those of one mode, however far from 1", "[stability][slow]",
                   (Case<double, 1>), (Case<double, 2>), (Case<double, 3>), (Case<float, 1>),
                   (Case<float, 3>)) {
    using Scalar = typename TestType::Scalar;
    constexpr int Dim = TestType::Dim;
    constexpr bool is_double = std::is_same_v<Scalar, double>;
    const auto held = [](double value) { return taut::held_as<Scalar>(value); };
    Random random(1302);
    for (int repeat = 0; repeat < 120; ++repeat) {
        const auto k = static_cast<Scalar>(log_uniform(random, 1e-4, 1e6));
        const auto m = static_cast<Scalar>(log_uniform(random, 1e-4, 1e4));
        const double h =
            is_double ? log_uniform(random, 1e-140, 1e140) : log_uniform(random, 1e-30, 1e30);
        const Index kind = random.below(3);  // undamped, d0, α
        const double d0 = held(kind == 1 ? random.uniform(0.1, 2.2) / h : 0);
        const double alpha = held(kind == 2 ? random.uniform(0.1, 4) * h : 0);
        taut::SpringSystem<Scalar, Dim> system;
        using Vector = Eigen::Matrix<Scalar, Dim, 1>;
        system.add_particle(Vector::Zero(), 1);
        system.add_particle(Vector::Unit(0), m);
        system.add_spring(0, 1, k);
        system.pin(0);
        system.set_rayleigh({d0, alpha});
        const Stability<double> stability = [&] {
            if (repeat % 2 == 1 && kind == 0) {
                const Eigen::VectorXd mass = Eigen::VectorXd::Constant(1, static_cast<double>(m));
                const Eigen::MatrixXd K = Eigen::MatrixXd::Constant(1, 1, static_cast<double>(k));
                return Stability<double>(taut::LinearSystem<double>(mass, {}, sparse(K)));
            }
            taut::SpringSystem<double, Dim> copy;
            copy.add_particle(Eigen::Matrix<double, Dim, 1>::Zero(), 1);
            copy.add_particle(Eigen::Matrix<double, Dim, 1>::Unit(0), static_cast<double>(m));
            copy.add_spring(0, 1, static_cast<double>(k));
            copy.pin(0);
            copy.set_rayleigh({d0, alpha});
            return Stability<double>(copy, copy.initial_state());
        }();
        const Stability<Scalar> own(system, system.initial_state());
        for (const Method method : stepping) {
            const bool is_explicit = method == Method::explicit_euler;
            // The largest z = h²k/m by [T8] and [T10], with d = d0 + αk.
            const double a = alpha / h;
            double z = is_explicit ? (a > 1        ? 2 / (a - 0.5)
                                      : d0 * h < 2 ? d0 * h / (1 - a)
                                                   : 0)
                                   : (4 - 2 * h * d0) / (1 + 2 * a);
            if (!(z > 0)) z = 0;
            const double stiffer = z / h * (static_cast<double>(m) / static_cast<double>(k)) / h;
            INFO(name(method) << ", k = " << k << ", m = " << m << ", h = " << h << ", d0 = " << d0
                              << ", alpha = " << alpha);
            const auto check = [&](double scale, double expected) {
                if (expected == 0 || std::isinf(expected)) {
                    CHECK(scale == expected);
                } else {
                    CHECK_THAT(scale, WithinRel(expected, 1e-7));
                }
            };
            check(stability.max_stiffness_scale(method, h), stiffer);
            check(stability.min_mass_scale(method, h), 1 / stiffer);
            check(own.max_stiffness_scale(method, h), stiffer);
            check(own.min_mass_scale(method, h), 1 / stiffer);
        }
    }
}

TEST_CASE("blame: a scale that double does not hold is none, and none is ever too generous",
          "[stability][slow]") {
    Random random(1303);
    for (int repeat = 0; repeat < 400; ++repeat) {
        const double k = log_uniform(random, 1e-150, 1e150);
        const double m = log_uniform(random, 1e-150, 1e150);
        const double h = log_uniform(random, 1e-300, 1e300);
        const Eigen::VectorXd mass = Eigen::VectorXd::Constant(1, m);
        const Eigen::MatrixXd K = Eigen::MatrixXd::Constant(1, 1, k);
        taut::SpringSystem<double, 1> system;
        using Vector = Eigen::Matrix<double, 1, 1>;
        system.add_particle(Vector(0.0), 1);
        system.add_particle(Vector(1.0), m);
        system.add_spring(0, 1, k);
        system.pin(0);
        const Real truth = 4 * (static_cast<Real>(m) / k) / h / h;
        for (const auto& stability :
             {Stability<double>(taut::LinearSystem<double>(mass, {}, sparse(K))),
              Stability<double>(system, system.initial_state())}) {
            const double stiffer = stability.max_stiffness_scale(Method::symplectic_euler, h);
            const double lighter = stability.min_mass_scale(Method::symplectic_euler, h);
            INFO("k = " << k << ", m = " << m << ", h = " << h);
            if (std::isfinite(stiffer)) CHECK(static_cast<Real>(stiffer) <= truth);
            if (std::isinf(stiffer)) CHECK(truth >= std::numeric_limits<double>::max());
            if (lighter > 0) CHECK(static_cast<Real>(lighter) >= 1 / truth);
            if (lighter == 0)
                CHECK(1 / truth <=
                      1.001 * std::max(1.0, 1 / m) * std::numeric_limits<double>::min());
        }
    }
}

TEST_CASE("blame: substeps", "[stability]") {
    const auto cloth = cloth_of(5);
    const Stability<double> stability(cloth, cloth.initial_state());
    const double certified = stability.max_step(Method::symplectic_euler).certified;
    for (const double frame : {1.0 / 60, 0.5, 3.7 * certified, certified, 0.3 * certified, 1e-12}) {
        const auto count = stability.substeps(Method::symplectic_euler, frame);
        REQUIRE(count.has_value());
        CHECK(*count >= 1);
        CHECK(frame / static_cast<double>(*count) <= certified * (1 + 1e-15));
        if (*count > 1) CHECK(frame / static_cast<double>(*count - 1) > certified * (1 - 1e-12));
        const double h = frame / static_cast<double>(*count) * (1 - 1e-15);
        CHECK(taut::certify(stability, Method::symplectic_euler, h).proved);
    }
    CHECK(*stability.substeps(Method::implicit_euler, 10) == 1);
    CHECK_FALSE(stability.substeps(Method::explicit_euler, 0.01).has_value());
    for (const double bad : {0.0, -1.0, infinity, std::nan("")}) {
        CHECK_THROWS_AS(stability.substeps(Method::symplectic_euler, bad), std::invalid_argument);
    }
}

}  // namespace taut_test::blame_test
