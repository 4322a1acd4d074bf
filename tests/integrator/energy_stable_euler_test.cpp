// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include <cmath>

#include "../support/catch.hpp"
#include "../support/scene_energy.hpp"

// [T42]: at energy_limit no step raises the energy by more than the work.

namespace taut_test::energy_stable_euler_test {

namespace {

std::unique_ptr<AnyStepper> make(const Scene& scene) {
    return scene.stepper(taut::Method::energy_stable_euler);
}

/// Of the size of what a step feels, on the free particles.
RealMatrix some_forces(Random& random, Scene& scene, double size) {
    RealMatrix forces = RealMatrix::Zero(scene.dim(), scene.size());
    for (Index i = 0; i < scene.size(); ++i) {
        Eigen::MatrixXd force = size * random_vector(random, scene.dim(), -1, 1);
        force = rounded(scene, force);
        scene.set_constant_force(i, force);
        if (!scene.is_pinned(i)) forces.col(i) = force.cast<Real>();
    }
    return forces;
}

Real farthest(const Eigen::MatrixXd& found, const RealMatrix& exact) {
    return (found.cast<Real>() - exact).cwiseAbs().maxCoeff();
}

/// By the sweep, and by the plain force: the step of the theory's formula.
void check_written_out(Random& random, const Kind& kind, int repeat) {
    RandomOptions options;
    options.particles = 40;
    options.springs = 60;
    options.dampers = repeat % 3 == 0;
    options.rayleigh = repeat % 4 < 2;
    Scene scene = random_scene(random, kind, options);
    // Where a tension falls, φ hangs on what is left of a difference of energies.
    const bool falls = repeat % 2 == 1;
    for (Index s = options.springs; s > 0 && !falls; --s) scene.remove_spring(LawOf::glue, s - 1);
    auto state = random_state(random, scene);  // of pins that move, too
    for (Index i = 0; i < 4; ++i) state.x.col(9 + i) = state.x.col(20 + i);
    scene.add_spring({9, 20, 100, 1, 0, LawOf::tension_only});
    const auto forces = some_forces(random, scene, repeat % 5 == 0 ? 10 : 0);
    const double h = scene.rounded(0.05);
    const StepAhead exact(scene, state, static_cast<Real>(h), forces);
    auto swept = state;
    REQUIRE(make(scene)->step(swept, h));
    const Eigen::MatrixXd f = scene.force_ahead(state, h);
    auto plain = state;
    for (Index i = 0; i < scene.size(); ++i) {
        if (!scene.is_pinned(i)) plain.v.col(i) += h / scene.mass(i) * f.col(i);
    }
    plain.x += h * plain.v;
    const Real tolerance =
        static_cast<Real>((falls ? 4096 : 64) * kind.epsilon()) * exact.v.cwiseAbs().maxCoeff();
    for (const auto* found : {&swept, &plain}) {
        CHECK(farthest(found->v, exact.v) <= tolerance);
        CHECK(farthest(found->x, exact.x) <= tolerance);
    }
}

/// A violent network stepped at exactly what is certified.
void check_never_rises(const Kind& kind, std::uint32_t seed) {
    Random random(seed);
    Scene scene = random_network(random, kind, seed % 3 == 0 ? 12 : 3, seed % 4 == 1);
    const double feels = scene.energy_limit().certified;
    if (feels < 1e30 && seed % 5 == 1) scene.set_rayleigh(log_uniform(random, 1e-2, 1) / feels, 0);
    if (feels < 1e30 && seed % 5 == 2) scene.set_rayleigh(0, log_uniform(random, 1e-2, 1) * feels);
    const auto limit = scene.energy_limit(seed % 2 == 0 ? 0.0 : 1e-3);
    if (limit.unbounded()) return;
    const double h = limit.certified;
    INFO(kind << ", seed " << seed << ", h " << h);
    REQUIRE(h > 0);
    auto state = thrown(random, scene);
    const double speed = state.v.cwiseAbs().maxCoeff();
    const auto stepper = make(scene);
    RealMatrix forces = RealMatrix::Zero(scene.dim(), scene.size());
    for (int i = 0; i < 60; ++i) {
        for (Index p = 0; p < scene.size() && seed % 3 == 1 && i % 7 == 0; ++p) {
            if (scene.is_pinned(p)) state.v.col(p) = speed * random_vector(random, kind.dim, -1, 1);
        }
        if (seed % 4 == 2 && i % 5 == 0)
            forces = some_forces(random, scene, random.uniform(0, 1) * speed * scene.mass(0) / h);
        const Books books = book_step(*stepper, scene, state, h, forces);
        INFO("step " << i << ": " << books.gain << " J of " << books.kinetic << ", slack "
                     << books.slack);
        REQUIRE_FALSE(books.rises());
    }
}

/// Hill climbing for a step that gains, at what is certified or beyond it. Damping is strong, so
/// that it is what holds the step down: with springs as strong only rare steps meet the condition,
/// see the next test.
Climb climb_all(Random& random, const Kind& kind, LawOf law, Beside beside, double beyond) {
    Climb found;
    for (int repeat = 0; repeat < 8 && !found.rises; ++repeat) {
        AnySpring spring;
        spring.law = law;
        spring.stiffness = 100;
        spring.second = law == LawOf::glue ? 2 : 0;
        spring.third = law == LawOf::buckling ? 100 : 0;
        Scene scene = line(
            random, kind, 2 + random.below(2), [&] { return spring; }, beside, 300, 600);
        if (random.below(2) == 0 && beside != Beside::drag)
            scene.set_gravity(random_vector(random, kind.dim, -1, 1));
        const auto limit = scene.energy_limit(1e-3);
        REQUIRE(limit.refuted <= 1.0011 * limit.certified);
        const double h = beyond > 1 ? scene.rounded(beyond * limit.refuted) : limit.certified;
        const auto stepper = make(scene);
        const Climb here = climb(random, scene, h, beside == Beside::forces, 700,
                                 [&](AnyState& state, const RealMatrix& forces) {
                                     return book_step(*stepper, scene, state, h, forces);
                                 });
        found.best = std::max(found.best, here.best);
        found.rises = here.rises;
    }
    return found;
}

/// A pressed spring that turns by 60° and, by a force from outside, collapses: spring and damping
/// give all that the condition allows at once.
Books collapse(const Kind& kind, double damping, double alpha, double share) {
    Scene scene(kind);
    scene.add_particle(Eigen::VectorXd::Zero(kind.dim), 1);
    scene.add_particle(0.5 * Eigen::VectorXd::Unit(kind.dim, 0), 1);
    scene.add_spring({0, 1, 100, 2, damping});
    scene.pin(0);
    scene.set_rayleigh(0, alpha);
    const double h = scene.rounded(share * scene.energy_limit(1e-6).certified);
    auto state = scene.initial_state();
    state.v(0, 1) = -0.25 / h;
    state.v(1, 1) = std::sqrt(0.1875) / h;
    state = rounded(scene, state);
    // What leaves x⁺ = 0.
    RealMatrix forces = RealMatrix::Zero(kind.dim, 2);
    const auto time = static_cast<Real>(h);
    const StepAhead free(scene, state, time, forces);
    forces.col(1) = -free.x.col(1) / (time * time);
    forces = rounded(scene, forces.cast<double>()).cast<Real>();
    scene.set_constant_force(1, forces.col(1).cast<double>());
    return book_step(*make(scene), scene, state, h, forces);
}

}  // namespace

TEST_CASE("energy_stable_euler: the limit counts springs and damping together, and is sharp",
          "[integrator]") {
    for (const Kind& kind : kinds_of(Laws::any)) {
        if (kind.dim == 1) continue;
        for (const double size : {0.0, 0.1, 1.0, 10.0}) {
            for (const bool dampers : {false, true}) {
                const double c = dampers ? 10 * size : 0, alpha = dampers ? 0 : 0.1 * size;
                INFO(kind << ", damping " << c << ", alpha " << alpha);
                CHECK_FALSE(collapse(kind, c, alpha, 1).rises());
                CHECK(collapse(kind, c, alpha, 1.001).rises());
            }
        }
    }
}

TEST_CASE("energy_stable_euler: a step is that of T42 written out", "[integrator]") {
    for (const Kind& kind : kinds_of(Laws::any)) {
        const std::uint32_t seed = 4200 + static_cast<std::uint32_t>(kind.dim);
        Random random(seed);
        for (int repeat = 0; repeat < 24; ++repeat) {
            INFO(kind << ", seed " << seed << ", system " << repeat);
            check_written_out(random, kind, repeat);
        }
    }
}

TEST_CASE("energy_stable_euler: at what is certified no step raises the energy", "[integrator]") {
    for (const Kind& kind : kinds_of(Laws::any)) {
        for (std::uint32_t seed = 5000; seed < 5160; ++seed) check_never_rises(kind, seed);
    }
    for (const Kind& kind : kinds_of(Laws::strings)) {
        for (std::uint32_t seed = 5200; seed < 5240; ++seed) check_never_rises(kind, seed);
    }
}

TEST_CASE("energy_stable_euler: hill climbing finds no gain at the edge, and one above it",
          "[integrator][slow]") {
    std::uint32_t seed = 4230;
    for (const Kind& kind : kinds_of(Laws::any)) {
        for (const Beside beside : everything) {
            for (const LawOf law : laws_of(kind)) {
                Random random(++seed);
                INFO(kind << ", beside " << static_cast<int>(beside) << ", law "
                          << static_cast<int>(law) << ", seed " << seed);
                const Climb at = climb_all(random, kind, law, beside, 1);
                INFO("best " << at.best);
                CHECK_FALSE(at.rises);
                const Climb above = climb_all(random, kind, law, beside, 1.02);
                INFO("above: best " << above.best);
                CHECK(above.rises);
            }
        }
    }
}

}  // namespace taut_test::energy_stable_euler_test
