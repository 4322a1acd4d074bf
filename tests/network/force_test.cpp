// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "../support/catch.hpp"
#include "../support/scene_dense.hpp"
#include "../support/tolerance.hpp"

// Forces and energies of systems. Their derivatives: tangent_test.cpp.

namespace taut_test::force_test {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

AnyState still(AnyState state) {
    state.v.setZero();
    return state;
}

/// One spring of a law between particles at 0 and at `state.x.col(1)`, 1/8 to 3 times its length.
struct OneSpring {
    AnySpring spring;
    Scene scene;
    AnyState state;

    OneSpring(Random& random, const Kind& kind, LawOf law, bool coincide)
        : spring(draw_spring(random, law)), scene(kind) {
        spring.rest_length = random.uniform(0.2, 1.4);
        spring.damping = random.uniform(0.1, 1);
        const double length = coincide ? 0 : spring.rest_length * log_uniform(random, 0.125, 3);
        const Eigen::VectorXd d = random_vector(random, kind.dim, -1, 1).normalized() * length;
        const auto rounded = [&](double y) { return scene.rounded(y); };
        scene.add_particle(Eigen::VectorXd::Zero(kind.dim), 1);
        scene.add_particle(d.unaryExpr(rounded), 1);
        state = scene.initial_state();
        state.v = random_points(random, kind.dim, 2, -2, 2);
    }
    Scene with(double damping, double alpha) const {
        Scene copy = scene;
        AnySpring damped = spring;
        damped.damping = damping;
        copy.add_spring(damped);
        copy.set_rayleigh(0, alpha);
        return copy;
    }
    Eigen::VectorXd dx() const { return state.x.col(1) - state.x.col(0); }
    Eigen::VectorXd dv() const { return state.v.col(1) - state.v.col(0); }
    LawAt at(double length) const { return law_at(spring, length); }
};

/// visit(spring) for springs of every law of every kind; every tenth one's ends coincide.
template <class Visit>
void for_each_spring(std::uint32_t seed, Visit&& visit) {
    for (const Kind& kind : all_kinds()) {
        for (const LawOf law : laws_of(kind)) {
            Random random(seed);
            for (int trial = 0; trial < 40; ++trial) {
                INFO(kind << ", law " << static_cast<int>(law) << ", seed " << seed << ", trial "
                          << trial);
                visit(random, OneSpring(random, kind, law, trial % 10 == 9));
            }
        }
    }
}

double of(long double y) { return static_cast<double>(y); }

}  // namespace

TEST_CASE("force: a spring pulls by its law's tension, and is damped by its block of D",
          "[network]") {
    for_each_spring(2001, [](Random& random, const OneSpring& one) {
        const double l = one.dx().norm();
        const LawAt law = one.at(l);
        const double size = of(law.bound) * (l + one.spring.rest_length);
        const double rounding = one.scene.kind().rounding();
        const Scene undamped = one.with(0, 0);
        const auto pull = undamped.force(one.state);
        CHECK((pull.col(0) == -pull.col(1)));
        const double over_l = l > 0 ? of(law.tension) / l : 0;
        CHECK(distance(pull.col(0), over_l * one.dx()) <= rounding * size);
        CHECK_THAT(undamped.potential_energy(one.state),
                   WithinAbs(of(law.energy), rounding * size * (l + one.spring.rest_length)));
        if (l == 0) CHECK(pull.isZero(0));
        const double alpha = random.uniform(0, 0.1);
        for (const double damping : {0.0, one.spring.damping}) {
            for (const double rayleigh : {0.0, alpha}) {
                const Scene scene = one.with(damping, rayleigh);
                CHECK((scene.force(still(one.state)) == pull));
                const Eigen::VectorXd drag = flat_force(scene, one.state) - flat(pull);
                const auto D = dense_matrices(scene, one.state).D;
                CHECK(distance(drag, -D * flat(one.state.v)) <=
                      rounding * (largest(pull) + 4 * (of(law.bound) + damping)));
            }
        }
    });
}

// With r = dx, y = dx + h dv: a pull f of [T42] has E(|s|) − E(|r|) − f·(s − r) ≤ ½k|s − y|² for
// every s.
TEST_CASE("force: one step ahead a spring pulls as [T42] says, and changes energy by no more",
          "[network]") {
    for_each_spring(2002, [](Random& random, const OneSpring& one) {
        const double h = random.uniform(0.01, 1);
        const Eigen::VectorXd y = one.dx() + h * one.dv();
        const double l = one.dx().norm();
        const double ahead = y.norm();
        const LawAt here = one.at(l);
        const LawAt there = one.at(ahead);
        const long double k = here.bound;
        long double phi = there.tension;
        const long double below =
            there.energy + phi * static_cast<long double>(l - ahead) - here.energy;
        const long double square = k * static_cast<long double>((l - ahead) * (l - ahead)) / 2;
        if (one.spring.law == LawOf::glue && below > 0)
            phi += below / (square + below) * (here.tension + k * (ahead - l) - phi);
        Eigen::VectorXd expected = Eigen::VectorXd::Zero(one.scene.dim());
        if (phi >= 0) expected = of(phi) / ahead * y;
        if (phi < 0 && l > 0) expected = of(phi) / l * one.dx();
        const Scene scene = one.with(0, 0);
        const Eigen::VectorXd f = scene.force_ahead(one.state, h).col(0);
        const double rounding =
            one.scene.kind().rounding() * of(k) * (l + ahead + one.spring.rest_length);
        // What lies below a tangent is a small difference of energies.
        CHECK(distance(f, expected) <= (one.spring.law == LawOf::glue ? 100 : 1) * rounding);
        for (int other = 0; other < 20; ++other) {
            const Eigen::VectorXd s =
                y + random_vector(random, one.scene.dim(), -1, 1) * log_uniform(random, 1e-3, 3);
            const double energy = of(one.at(s.norm()).energy - here.energy);
            CHECK(energy - f.dot(s - one.dx()) <=
                  of(k) / 2 * (s - y).squaredNorm() + 100 * rounding * (1 + s.norm()));
        }
        const double alpha = random.uniform(0, 0.1);
        const Scene damped = one.with(one.spring.damping, alpha);
        AnyState moved = one.state;
        moved.x.col(0).setZero();
        moved.x.col(1) = y;
        const Eigen::VectorXd drag =
            flat(damped.force_ahead(one.state, h) - scene.force_ahead(one.state, h));
        const auto D = dense_matrices(damped, moved).D;
        CHECK(distance(drag, -D * flat(one.state.v)) <= 4 * rounding / ahead + 4 * rounding);
    });
}

TEST_CASE("force: internal forces sum to zero, springs and axial dampers exert no torque",
          "[network]") {
    for (const Kind& kind : all_kinds()) {
        Random random(6);
        CAPTURE(kind);
        RandomOptions options;
        options.dampers = true;
        options.gravity = false;
        auto scene = random_scene(random, kind, options);
        for (const double alpha : {0.0, 0.0078125}) {
            scene.set_rayleigh(0, alpha);
            for (int trial = 0; trial < 20; ++trial) {
                const auto state = random_state(random, scene);
                const auto f = scene.force(state);
                const double rounding = kind.rounding() * largest(f);
                CHECK(largest(f.rowwise().sum()) <= rounding);
                if (alpha > 0) continue;
                const Eigen::MatrixXd torque = state.x * f.transpose();
                CHECK(distance(torque, torque.transpose()) <= rounding);
            }
        }
    }
}

TEST_CASE("force: damping takes energy away at any velocity", "[network]") {
    for (const Kind& kind : all_kinds()) {
        Random random(8);
        CAPTURE(kind);
        RandomOptions options;
        options.dampers = true;
        options.rayleigh = true;
        const auto scene = random_scene(random, kind, options);
        for (int trial = 0; trial < 50; ++trial) {
            const auto state = random_state(random, scene);
            const Eigen::VectorXd drag = flat_force(scene, state) - flat_force(scene, still(state));
            CHECK(drag.dot(flat(state.v)) < 0);
        }
    }
}

TEST_CASE("force: springs so short that their squared length underflows are finite", "[network]") {
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        for (const double length : {1e-150, 1e-161, 1e-170, 1e-300, 1e-19, 1e-24, 1e-38}) {
            CAPTURE(kind, length);
            Scene scene(kind);
            const Eigen::VectorXd axis = Eigen::VectorXd::Unit(kind.dim, 0);
            scene.add_particle(0 * axis, 1);
            scene.add_particle(scene.rounded(length) * axis, 1);
            scene.add_spring({0, 1, 1000, 1, 2});
            scene.set_rayleigh(0, 0.125);
            auto state = scene.initial_state();
            state.v(kind.dim - 1, 1) = 1;
            const auto f = scene.force(state);
            CHECK(f.allFinite());
            CHECK(largest(f) <= 2000);
        }
    }
}

TEST_CASE("force: float and double agree", "[network]") {
    for (const Kind& kind : all_kinds()) {
        if (!kind.single) continue;
        for (std::uint32_t seed = 1; seed <= 5; ++seed) {
            CAPTURE(kind, seed);
            RandomOptions options;
            options.dampers = true;
            options.rayleigh = true;
            Random random(seed);
            Random same(seed);
            const auto narrow = random_scene(random, kind, options);
            const auto wide = random_scene(same, {false, kind.dim, kind.laws}, options);
            const auto state = random_state(random, narrow);
            // A short spring magnifies rounding by rest length over length.
            double shortest = 1;
            for (const auto& spring : wide.springs())
                shortest =
                    std::min(shortest, (state.x.col(spring.a) - state.x.col(spring.b)).norm());
            const auto f = wide.force(state);
            CHECK(distance(narrow.force(state), f) < kind.rounding() / shortest * largest(f));
            CHECK_THAT(narrow.energy(state), WithinRel(wide.energy(state), kind.rounding()));
        }
    }
}

TEST_CASE("force: energy is that of springs, heights and free particles' motion", "[network]") {
    for (const Kind& kind : all_kinds()) {
        Random random(2005);
        CAPTURE(kind);
        auto scene = random_scene(random, kind);
        for (int trial = 0; trial < 10; ++trial) {
            const auto state = random_state(random, scene);
            double potential = 0;
            double size = 0;
            for (const auto& spring : scene.springs()) {
                const auto dx = state.x.col(spring.b) - state.x.col(spring.a);
                potential += of(law_at(spring, dx.norm()).energy);
            }
            double kinetic = 0;
            for (Index i = 0; i < scene.size(); ++i) {
                const double lift = -scene.mass(i) * scene.gravity().dot(state.x.col(i));
                potential += lift;
                size += std::abs(lift);
                if (!scene.is_pinned(i))
                    kinetic += 0.5 * scene.mass(i) * state.v.col(i).squaredNorm();
            }
            size += std::abs(potential) + kinetic;
            const double rounding = kind.rounding() * size;
            CHECK_THAT(scene.potential_energy(state), WithinAbs(potential, rounding));
            CHECK_THAT(scene.kinetic_energy(state), WithinAbs(kinetic, rounding));
            CHECK_THAT(scene.energy(state), WithinAbs(potential + kinetic, rounding));
        }
    }
}

TEST_CASE("force: gravity pulls every particle by its weight, drag by its momentum", "[network]") {
    for (const Kind& kind : all_kinds()) {
        CAPTURE(kind);
        Scene scene(kind);
        const Eigen::VectorXd down = -10 * Eigen::VectorXd::Unit(kind.dim, kind.dim - 1);
        scene.add_particle(0 * down, 2);
        scene.add_particle(-0.5 * down, 8);
        scene.set_gravity(down);
        scene.set_rayleigh(0.25, 0);
        CHECK((scene.gravity() == down));
        auto state = scene.initial_state();
        CHECK((scene.force(state).col(0) == 2 * down));
        CHECK((scene.force(state).col(1) == 8 * down));
        CHECK(scene.potential_energy(state) == 8 * 10 * 5);
        state.v.setConstant(4);
        const Eigen::MatrixXd drag = scene.force(state) - scene.force(still(state));
        CHECK((drag.col(0).array() == -2).all());
        CHECK((drag.col(1).array() == -8).all());
    }
}

TEST_CASE("force: an external force is added after all others, with the state at hand",
          "[network]") {
    for (const Kind& kind : all_kinds()) {
        Random random(10);
        CAPTURE(kind);
        auto scene = random_scene(random, kind);
        const auto state = random_state(random, scene);
        const auto before = scene.force(state);
        scene.set_external_force([&](const AnyState& given, Eigen::MatrixXd& f) {
            CHECK(given == state);
            f += 2 * given.v + given.x;
        });
        const Eigen::MatrixXd expected = before + (2 * state.v + state.x);
        CHECK(distance(scene.force(state), expected) <= kind.epsilon() * largest(expected));
        scene.set_external_force({});
        CHECK((scene.force(state) == before));
    }
}

TEST_CASE("force: what is not finite in a state is not in the forces either",
          "[network][bad_input]") {
    for (const Kind& kind : kinds_of(Laws::hookean)) {
        for (const bool damped : {false, true}) {
            CAPTURE(kind, damped);
            const Eigen::VectorXd axis = Eigen::VectorXd::Unit(kind.dim, 0);
            Scene scene(kind);
            for (int i = 0; i < 3; ++i) scene.add_particle(i * axis, 1);
            scene.add_spring({0, 1, 10, 1, 0.5});
            scene.add_spring({1, 2, 10, 0.5, damped ? 1.0 : 0.0});
            const auto start = scene.initial_state();
            for (const double bad : {std::numeric_limits<double>::quiet_NaN(), infinity}) {
                auto state = start;
                state.x(0, 1) = bad;
                auto f = scene.force(state);
                for (Index i = 0; i < 3; ++i) CHECK_FALSE(f.col(i).allFinite());
                state = start;
                state.v(0, 2) = bad;
                f = scene.force(state);
                CHECK(f.col(0).allFinite());
                CHECK(f.col(1).allFinite() == !damped);
                CHECK(f.col(2).allFinite() == !damped);
            }
            // Finite velocities whose difference is not.
            const double most = kind.single ? static_cast<double>(std::numeric_limits<float>::max())
                                            : std::numeric_limits<double>::max();
            auto state = start;
            state.v(0, 1) = -most / 2;
            state.v(0, 2) = most;
            const auto f = scene.force(state);
            CHECK(f.col(0).allFinite());
            CHECK(f.col(2).allFinite() == !damped);
        }
    }
}

}  // namespace taut_test::force_test
