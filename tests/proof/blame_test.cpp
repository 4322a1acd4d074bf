// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <set>
#include <taut/proof/bracket.hpp>

#include "../support/catch.hpp"
#include "../support/proof_scenes.hpp"
#include "../support/tolerance.hpp"

// Who limits the step, and what less stiffness, more mass or more substeps would do.

namespace taut_test::blame_test {

using taut::Method;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Scene cloth_of(Index size) { return cloth_scene({size, size}); }

/// The same with its stiffnesses and masses multiplied; dampers stay.
Scene scaled(const Scene& scene, double stiffness, double mass) {
    auto copy = with_springs(scene, [&](AnySpring& s) { s.stiffness *= stiffness; });
    for (Index i = 0; i < copy.size(); ++i) copy.set_mass(i, mass * scene.mass(i));
    return copy;
}

/// visit(cloth) undamped and with each kind of damping that explicit Euler can use as well.
template <class Visit>
void for_each_damped(Visit&& visit) {
    struct Damping {
        const char* text;
        double dampers, d0, alpha;
    };
    for (const auto& [text, dampers, d0, alpha] : {Damping{"undamped", 0, 0, 0},
                                                   {"dampers", 1e-3, 0, 0},
                                                   {"d0", 0, 3, 0},
                                                   {"d0 and alpha", 0, 3, 2e-4},
                                                   {"all", 1e-3, 5, 1e-4}}) {
        auto cloth = with_dampers(cloth_of(4), dampers);
        cloth.set_rayleigh(d0, alpha);
        INFO(text);
        visit(cloth);
    }
}

}  // namespace

TEST_CASE("blame: a planted stiff spring is named, and a planted light particle", "[proof]") {
    Random random(1300);
    for (int repeat = 0; repeat < 10; ++repeat) {
        INFO("repeat " << repeat << " of seed 1300");
        auto cloth = cloth_of(6);
        const Index a = 6 + random.below(24);
        const Index b = a + 6;
        const Index planted = cloth.add_spring({a, b, 1e6, 0.2});
        cloth.add_spring({0, 35, 1, 1});  // not the last one
        const Analysis analysis(cloth, deformed(cloth, 1.02, 0.005, 5));
        const auto blamed = taut::limiting_springs(analysis.in_double(), 3);
        REQUIRE(blamed.size() == 3);
        CHECK(blamed[0].index == planted);
        CHECK(blamed[0].a == a);
        CHECK(blamed[0].b == b);
        CHECK(blamed[0].share > 0.95);
        CHECK(blamed[0].share <= 1 + 1e-12);
        CHECK(blamed[0].share >= blamed[1].share);
        CHECK(blamed[1].share >= blamed[2].share);
        // Its ends move most.
        const auto moving = taut::limiting_particles(analysis.in_double(), 2);
        REQUIRE(moving.size() == 2);
        CHECK(std::set<Index>{moving[0].index, moving[1].index} == std::set<Index>{a, b});
    }
    for (int repeat = 0; repeat < 10; ++repeat) {
        INFO("repeat " << repeat << ", light");
        auto cloth = cloth_of(6);
        const auto state = deformed(cloth, 1.02, 0.005, 6);
        const auto limit = [&] { return cloth.limit(Method::symplectic_euler, state).certified; };
        const double without = limit();
        const Index light = 6 + random.below(30);
        cloth.set_mass(light, 1e-3 * cloth.mass(light));
        const Analysis analysis(cloth, state);
        const auto moving = taut::limiting_particles(analysis.in_double(), 1);
        REQUIRE(moving.size() == 1);
        CHECK(moving[0].index == light);
        CHECK(moving[0].share > 0.95);
        for (const auto& spring : taut::limiting_springs(analysis.in_double(), 1)) {
            CHECK((spring.a == light || spring.b == light));
        }
        CHECK(without > 10 * limit());
    }
}

TEST_CASE("blame: counts, and shares of all of them", "[proof]") {
    auto cloth = cloth_of(5);
    const Analysis analysis(cloth, cloth.initial_state());
    const auto& stability = analysis.in_double();
    CHECK(taut::limiting_springs(stability, 0).empty());
    CHECK(taut::limiting_springs(stability, -3).empty());
    CHECK(taut::limiting_particles(stability, 0).empty());
    double sum = 0;
    for (const auto& spring : taut::limiting_springs(stability, 100000)) sum += spring.share;
    CHECK_THAT(sum, WithinAbs(1.0, Tolerance<double>::rounding));
    CHECK(static_cast<Index>(taut::limiting_particles(stability, 100000).size()) == 23);
    for (Index i = 0; i < cloth.size(); ++i) cloth.pin(i);
    const Analysis held(cloth, cloth.initial_state());
    CHECK(taut::limiting_springs(held.in_double(), 5).empty());
    CHECK(taut::limiting_particles(held.in_double(), 5).empty());
    CHECK(held.max_stiffness_scale(Method::symplectic_euler, 1) == infinity);
    CHECK(held.min_mass_scale(Method::symplectic_euler, 1) == 0);
}

TEST_CASE("blame: both scales are certified, and little more is", "[proof][slow]") {
    for_each_damped([](const Scene& scene) {
        const auto state = scene.initial_state();
        const Analysis analysis(scene, state);
        for (const Method method : {Method::explicit_euler, Method::symplectic_euler}) {
            const auto limit = analysis.max_step(method);
            const double base =
                limit.certified > 0 && std::isfinite(limit.certified) ? limit.certified : 1e-4;
            for (const double part : {0.05, 0.5, 0.99, 1.5}) {
                const double h = part * base;
                const double stiffer = analysis.max_stiffness_scale(method, h);
                INFO(name(method) << ", h = " << h << ", scale = " << stiffer);
                CHECK(stiffer >= 0);
                if (stiffer == 0) {
                    CHECK((limit.certified == 0 || part > 1));
                } else {
                    REQUIRE(std::isfinite(stiffer));
                    CHECK(Analysis(scaled(scene, 0.999 * stiffer, 1), state).proves(method, h));
                    CHECK(scaled(scene, 1.05 * stiffer, 1).limit(method, state).certified < h);
                    CHECK((part < 1 ? stiffer >= 1 - 1e-6 : stiffer < 1));
                }
                if (method == Method::explicit_euler) continue;
                CHECK(analysis.max_stiffness_scale(Method::velocity_verlet, h) == stiffer);
                const double heavier = analysis.min_mass_scale(method, h);
                INFO("mass scale " << heavier);
                CHECK(analysis.min_mass_scale(Method::velocity_verlet, h) == heavier);
                if (std::isinf(heavier)) {
                    CHECK(2 * h * scene.mass_proportional() >= 4 * (1 - 1e-6));
                    continue;
                }
                REQUIRE(heavier > 0);
                CHECK(Analysis(scaled(scene, 1, 1.001 * heavier), state).proves(method, h));
                CHECK(scaled(scene, 1, heavier / 1.05).limit(method, state).certified < h);
                CHECK((part < 1 ? heavier <= 1 + 1e-6 : heavier > 1));
            }
        }
    });
    // Undamped, h²k/m is all there is: beyond the refuted ratio no scale is certified.
    const auto cloth = cloth_of(5);
    const auto state = deformed(cloth, 1.1, 0.01, 7);
    const Analysis analysis(cloth, state);
    const auto limit = analysis.max_step(Method::symplectic_euler);
    const double ratio = std::pow(limit.refuted / limit.certified, 2);
    const double h = 0.8 * limit.certified;
    const double stiffer = analysis.max_stiffness_scale(Method::symplectic_euler, h);
    CHECK_THAT(stiffer, WithinRel(1 / 0.64, 1e-3));
    const auto proves = [&](double stiffness, double mass) {
        return Analysis(scaled(cloth, stiffness, mass), state).proves(Method::symplectic_euler, h);
    };
    CHECK_FALSE(proves(1.01 * ratio * stiffer, 1));
    const double lighter = analysis.min_mass_scale(Method::symplectic_euler, h);
    CHECK_THAT(lighter, WithinRel(0.64, 1e-3));
    CHECK_FALSE(proves(1, lighter / ratio / 1.01));
}

TEST_CASE("blame: scales where every step is safe, and where none is", "[proof]") {
    const auto cloth = cloth_of(4);
    const Analysis analysis(cloth, cloth.initial_state());
    CHECK(analysis.max_stiffness_scale(Method::implicit_euler, 1e6) == infinity);
    CHECK(analysis.min_mass_scale(Method::implicit_euler, 1e6) == 0);
    CHECK(analysis.max_stiffness_scale(Method::explicit_euler, 1e-6) == 0);  // undamped
    CHECK(analysis.min_mass_scale(Method::explicit_euler, 1e-6) == infinity);
}

TEST_CASE("blame: scales are those of one mode, however far from 1", "[proof][slow]") {
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        Random random(1302);
        for (int repeat = 0; repeat < 60; ++repeat) {
            const Index damping = random.below(3);  // undamped, d0, α
            Scene scene(kind);
            const double k = scene.rounded(log_uniform(random, 1e-4, 1e6));
            const double m = scene.rounded(log_uniform(random, 1e-4, 1e4));
            const double h =
                kind.single ? log_uniform(random, 1e-30, 1e30) : log_uniform(random, 1e-140, 1e140);
            const double d0 = scene.rounded(damping == 1 ? random.uniform(0.1, 2.2) / h : 0);
            const double alpha = scene.rounded(damping == 2 ? random.uniform(0.1, 4) * h : 0);
            scene.add_particle(Eigen::VectorXd::Zero(kind.dim), 1);
            scene.add_particle(Eigen::VectorXd::Unit(kind.dim, 0), m);
            scene.add_spring({0, 1, k, 1});
            scene.pin(0);
            scene.set_rayleigh(d0, alpha);
            std::vector<Analysis> of{Analysis(scene, scene.initial_state())};
            if (damping == 0)
                of.emplace_back(Matrices{Eigen::VectorXd::Constant(1, m),
                                         {},
                                         Eigen::MatrixXd::Constant(1, 1, k),
                                         kind.single});
            for (const Method method :
                 {Method::explicit_euler, Method::symplectic_euler, Method::velocity_verlet}) {
                // The largest z = h²k/m by [T8] and [T10], with d = d0 + αk.
                const double a = alpha / h;
                const double z = method == Method::explicit_euler ? (a > 1        ? 2 / (a - 0.5)
                                                                     : d0 * h < 2 ? d0 * h / (1 - a)
                                                                                  : 0)
                                                                  : (4 - 2 * h * d0) / (1 + 2 * a);
                const double stiffer = z > 0 ? z / h * (m / k) / h : 0;
                INFO(kind << ", " << name(method) << ", k = " << k << ", m = " << m << ", h = " << h
                          << ", d0 = " << d0 << ", alpha = " << alpha);
                const auto check = [&](double scale, double expected) {
                    if (expected == 0 || std::isinf(expected)) {
                        CHECK(scale == expected);
                    } else {
                        CHECK_THAT(scale, WithinRel(expected, 1e-7));
                    }
                };
                for (const Analysis& analysis : of) {
                    check(analysis.max_stiffness_scale(method, h), stiffer);
                    check(analysis.min_mass_scale(method, h), 1 / stiffer);
                }
            }
        }
    }
}

TEST_CASE("blame: a scale that double does not hold is none, and none is ever too generous",
          "[proof]") {
    Random random(1303);
    for (int repeat = 0; repeat < 300; ++repeat) {
        const double k = log_uniform(random, 1e-150, 1e150);
        const double m = log_uniform(random, 1e-150, 1e150);
        const double h = log_uniform(random, 1e-300, 1e300);
        Scene scene({false, 1, Laws::hookean});
        scene.add_particle(Eigen::VectorXd::Zero(1), 1);
        scene.add_particle(Eigen::VectorXd::Ones(1), m);
        scene.add_spring({0, 1, k, 1});
        scene.pin(0);
        const Real truth = 4 * (static_cast<Real>(m) / k) / h / h;
        const Matrices matrices{
            Eigen::VectorXd::Constant(1, m), {}, Eigen::MatrixXd::Constant(1, 1, k)};
        for (const auto& analysis : {Analysis(matrices), Analysis(scene, scene.initial_state())}) {
            const double stiffer = analysis.max_stiffness_scale(Method::symplectic_euler, h);
            const double lighter = analysis.min_mass_scale(Method::symplectic_euler, h);
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

TEST_CASE("blame: substeps", "[proof]") {
    const auto cloth = cloth_of(5);
    const Analysis analysis(cloth, cloth.initial_state());
    const auto& stability = analysis.in_double();
    const auto limit = stability.max_step(Method::symplectic_euler);
    const double certified = limit.certified;
    for (const double frame :
         {1.0 / 60, 0.5, 3.7 * certified, 3.2 * certified, certified, 0.3 * certified, 1e-12}) {
        for (const double safety : {0.95, 0.5, 1.0}) {
            const auto count =
                safety == 0.95 ? limit.substeps(frame) : limit.substeps(frame, safety);
            REQUIRE(count.has_value());
            CHECK(*count >= 1);
            const double most = safety * certified;
            CHECK(frame / static_cast<double>(*count) <= most * (1 + 1e-15));
            if (*count > 1) CHECK(frame / static_cast<double>(*count - 1) > most * (1 - 1e-12));
            const double h = frame / static_cast<double>(*count) * (1 - 1e-15);
            CHECK(analysis.proves(Method::symplectic_euler, h));
        }
    }
    for (const double safety : {0.0, -1.0, 1.1, std::nan("")}) {
        CHECK_FALSE(limit.substeps(0.01, safety).has_value());
    }
    for (const double frame : {0.0, -1.0, infinity, std::nan("")}) {
        CHECK_THROWS_AS(limit.substeps(frame), std::invalid_argument);
    }
    CHECK(*stability.max_step(Method::implicit_euler).substeps(10) == 1);
    CHECK_FALSE(stability.max_step(Method::explicit_euler).substeps(0.01).has_value());
}

}  // namespace taut_test::blame_test
