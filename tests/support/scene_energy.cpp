// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "scene_energy.hpp"

#include <algorithm>
#include <cmath>

#include "scene_dense.hpp"

namespace taut_test {

namespace {

using Point = Eigen::Matrix<Real, Eigen::Dynamic, 1, 0, 3, 1>;

Real column_norm(const Eigen::MatrixXd& points, Index i) {
    return points.col(i).cast<Real>().norm();
}

/// What one spring does in a step.
struct SpringAhead {
    Point force;  ///< on its end a, damping included, N
    Real most;    ///< what rounding errors of it are relative to, N
};

/// @param r  x_b − x_a, m   @param w  v_b − v_a, m/s   @param alpha  Rayleigh's, s
SpringAhead spring_ahead(const AnySpring& spring, const Point& r, const Point& w, Real h,
                         Real alpha) {
    const Real tiny = std::sqrt(std::numeric_limits<Real>::min());
    const Point y = r + h * w;
    const Real lr = std::max(r.norm(), tiny), ly = std::max(y.norm(), tiny);
    const LawAt from = law_at(spring, lr), to = law_at(spring, ly);
    const Real k = to.bound;
    Real phi = to.tension;
    const Real below = to.energy + phi * (lr - ly) - from.energy;
    if (spring.law == LawOf::glue && below > 0) {
        const Real square = k * (ly - lr) * (ly - lr) / 2;
        phi = (square * phi + below * (from.tension + k * (ly - lr))) / (square + below);
    }
    const Point n = y / ly;
    Point force = phi < 0 ? Point(phi * r / lr) : Point(phi * n);
    const Real rate = n.dot(w);
    force += static_cast<Real>(spring.damping) * rate * n;
    const Real across = y.isZero(0) ? k : std::max(to.tension / ly, Real(0));
    const Real along = y.isZero(0) ? k : std::max(to.slope, Real(0));
    force += alpha * (across * (w - rate * n) + along * rate * n);
    const Real length = lr + ly + static_cast<Real>(spring.rest_length);
    const Real most = std::abs(from.tension) + std::abs(to.tension) + k * length;
    return {force, most + (static_cast<Real>(spring.damping) + alpha * k) * w.norm()};
}

}  // namespace

Eigen::MatrixXd rounded(const Scene& scene, const Eigen::MatrixXd& points) {
    return scene.kind().single ? Eigen::MatrixXd(points.cast<float>().cast<double>()) : points;
}
AnyState rounded(const Scene& scene, const AnyState& state) {
    return {rounded(scene, state.x), rounded(scene, state.v), state.time};
}

Scene random_network(Random& random, const Kind& kind, double decades, bool dampers) {
    Scene scene(kind);
    const double side = std::pow(10, decades / 2);
    const auto any = [&] { return scene.rounded(log_uniform(random, 1 / side, side)); };
    const Index particles = 2 + random.below(7);
    for (Index i = 0; i < particles; ++i) {
        const auto place = random_vector(random, kind.dim, -1, 1);
        scene.add_particle(place, any());
    }
    for (const LawOf law : laws_of(kind)) {
        const Index springs = 1 + random.below(2 * particles);
        for (Index s = 0; s < springs; ++s) {
            const Index a = random.below(particles);
            const Index b = (a + 1 + random.below(particles - 1)) % particles;
            const double rest = random.below(6) == 0 ? 0 : random.uniform(0.1, 1.5);
            auto spring = draw_spring(random, law);
            spring.a = a;
            spring.b = b;
            spring.rest_length = rest;
            spring.stiffness = any();
            if (dampers && s % 2 == 0)
                spring.damping = log_uniform(random, 1e-2, 1) * std::sqrt(spring.stiffness);
            scene.add_spring(spring);
        }
    }
    for (Index pins = random.below(3); pins > 0; --pins) scene.pin(random.below(particles));
    if (random.below(2) == 0) scene.set_gravity(random_vector(random, kind.dim, -10, 10));
    return scene;
}

AnyState thrown(Random& random, const Scene& scene) {
    auto state = random_state(random, scene);
    const double speed = scene.rounded(log_uniform(random, 0.01, 100));
    for (Index i = 0; i < scene.size(); ++i) {
        if (i > 0 && random.below(8) == 0) state.x.col(i) = state.x.col(i - 1);
        state.v.col(i) *= scene.is_pinned(i) ? 0 : speed;
    }
    return rounded(scene, state);
}

Real total_energy(const Scene& scene, const AnyState& state) {
    const RealMatrix x = state.x.cast<Real>(), v = state.v.cast<Real>();
    const Point gravity = scene.gravity().cast<Real>();
    Real sum = 0;
    for (Index i = 0; i < scene.size(); ++i) {
        if (scene.is_pinned(i)) continue;
        const auto m = static_cast<Real>(scene.mass(i));
        sum += m * v.col(i).squaredNorm() / 2 - m * gravity.dot(x.col(i));
    }
    for (const AnySpring& spring : scene.springs())
        sum += law_at(spring, (x.col(spring.b) - x.col(spring.a)).norm()).energy;
    return sum;
}

double rounding(const Scene& scene, const AnyState& state, double h) {
    const double eps = scene.kind().epsilon();
    const double reach = state.x.cwiseAbs().maxCoeff();
    double sum = 0;
    for (const AnySpring& spring : scene.springs()) {
        const double dv = (state.v.col(spring.b) - state.v.col(spring.a)).norm();
        const double l = std::max((state.x.col(spring.b) - state.x.col(spring.a)).norm(), 1e-30);
        const LawAt law = law_at(spring, l);
        const auto k = static_cast<double>(law.bound);
        const double size = reach + l + spring.rest_length + h * dv;
        const double pull = static_cast<double>(std::abs(law.tension)) + h * k * dv;
        // A force is off by eps of what it is made of, and moves its ends at their speed.
        sum += eps * (pull + k * size) * (size + h * dv);
    }
    const double g = scene.gravity().norm();
    for (Index i = 0; i < scene.size(); ++i) {
        if (scene.is_pinned(i)) continue;
        const double fastest = state.v.col(i).norm() + h * g;
        sum += eps * scene.mass(i) * (fastest * fastest + g * reach);
    }
    return 32 * sum;
}

Real step_objective(const Scene& scene, const AnyState& start, const AnyState& end, double h) {
    const auto time = static_cast<Real>(h);
    const RealMatrix u = end.x.cast<Real>() - start.x.cast<Real>();
    const RealVector move = Eigen::Map<const RealVector>(u.data(), u.size());
    auto still = end;
    still.v.setZero();
    Real value = time * time * total_energy(scene, still);  // gravity's, too
    for (Index i = 0; i < scene.size(); ++i) {
        if (scene.is_pinned(i)) continue;
        const Point off = u.col(i) - time * start.v.col(i).cast<Real>();
        value += static_cast<Real>(scene.mass(i)) * off.squaredNorm() / 2;
    }
    const RealMatrix D = dense_matrices(scene, start).D.cast<Real>();
    return value + time / 2 * move.dot(D * move);
}

Eigen::VectorXd open_impulse(const Scene& scene, const AnyState& before, const AnyState& after,
                             double h) {
    const auto dense = dense_matrices(scene, before);
    auto still = after;
    still.v.setZero();
    const Eigen::VectorXd open = dense.M * (flat(after.v) - flat(before.v)) -
                                 h * (flat_force(scene, still) - dense.D * flat(after.v));
    return open(free_dofs(scene));
}

int rises(const Scene& scene, AnyStepper& stepper, AnyState state, double h, int steps) {
    int count = 0;
    Real energy = total_energy(scene, state);
    for (int i = 0; i < steps; ++i) {
        const double allowed = rounding(scene, state, h);
        if (!stepper.step(state, h)) return steps;
        const Real next = total_energy(scene, state);
        count += next > energy + static_cast<Real>(allowed);
        energy = next;
    }
    return count;
}

StepAhead::StepAhead(const Scene& scene, const AnyState& state, Real h, const RealMatrix& F)
    : x(state.x.cast<Real>()),
      v(state.v.cast<Real>()),
      springs(RealMatrix::Zero(scene.dim(), scene.size())),
      noise(RealVector::Zero(scene.size())) {
    const auto alpha = static_cast<Real>(scene.stiffness_proportional());
    const auto d0 = static_cast<Real>(scene.mass_proportional());
    const Point gravity = scene.gravity().cast<Real>();
    for (const AnySpring& spring : scene.springs()) {
        const Index a = spring.a, b = spring.b;
        const auto ahead = spring_ahead(spring, x.col(b) - x.col(a), v.col(b) - v.col(a), h, alpha);
        springs.col(a) += ahead.force;
        springs.col(b) -= ahead.force;
        noise[a] += ahead.most;
        noise[b] += ahead.most;
    }
    for (Index i = 0; i < scene.size(); ++i) {
        const auto m = static_cast<Real>(scene.mass(i));
        const Real speed = v.col(i).norm();
        if (!scene.is_pinned(i)) {
            noise[i] += m * gravity.norm() + F.col(i).norm();
            v.col(i) += h * ((springs.col(i) + F.col(i)) / m + gravity - d0 * v.col(i));
            size += m * (speed * speed + v.col(i).squaredNorm());
        }
        size += noise[i] * (x.col(i).norm() + h * (speed + v.col(i).norm()));
        x.col(i) += h * v.col(i);
    }
}

Real work_of_step(const Scene& scene, const AnyState& after, Real h, const RealMatrix& springs,
                  const RealMatrix& F) {
    Real work = 0;
    for (Index i = 0; i < scene.size(); ++i) {
        const Point v = after.v.col(i).cast<Real>();
        work += h * (scene.is_pinned(i) ? -v.dot(springs.col(i)) : v.dot(F.col(i)));
    }
    return work;
}

Books book_step(AnyStepper& stepper, const Scene& scene, AnyState& state, double h,
                const RealMatrix& F) {
    state = rounded(scene, state);
    const auto time = static_cast<Real>(scene.rounded(h));
    const StepAhead exact(scene, state, time, F);
    const AnyState before = state;
    Books books;
    if (!stepper.step(state, h)) {
        books.gain = std::numeric_limits<Real>::infinity();
        return books;
    }
    for (Index i = 0; i < scene.size(); ++i) {
        const Real change = column_norm(state.v - before.v, i);
        books.kinetic += static_cast<Real>(scene.mass(i)) * change * change / 2;
    }
    books.gain = total_energy(scene, state) - total_energy(scene, before) -
                 work_of_step(scene, state, time, exact.springs, F);
    books.slack = 8 * static_cast<Real>(scene.kind().epsilon()) * exact.size;
    return books;
}

Scene line(Random& random, const Kind& kind, Index particles,
           const std::function<AnySpring()>& draw, Beside beside, double least, double most) {
    Scene scene(kind);
    for (Index i = 0; i < particles; ++i) {
        const Eigen::VectorXd x = static_cast<double>(i) * Eigen::VectorXd::Unit(kind.dim, 0);
        scene.add_particle(x, random.uniform(0.5, 2));
    }
    const double damping = beside == Beside::dampers ? random.uniform(least, most) : 0;
    for (Index i = 0; i + 1 < particles; ++i) {
        AnySpring spring = draw();
        spring.a = i;
        spring.b = i + 1;
        spring.rest_length = 1;
        spring.damping = damping;
        scene.add_spring(spring);
    }
    if (beside == Beside::pins) scene.pin(particles - 1);
    if (beside == Beside::rayleigh) scene.set_rayleigh(0, random.uniform(least, most) / 75);
    if (beside == Beside::drag) scene.set_rayleigh(random.uniform(least, most), 0);
    return scene;
}

Climb climb(Random& random, Scene& scene, double h, bool forced, int tries,
            const std::function<Books(AnyState&, const RealMatrix&)>& take) {
    const auto points = [&](double size) {
        return Eigen::MatrixXd(random_points(random, scene.dim(), scene.size(), -size, size));
    };
    AnyState best = scene.initial_state();
    best.x += points(0.1);
    best.v = points(1);
    Eigen::MatrixXd best_force = Eigen::MatrixXd::Zero(scene.dim(), scene.size());
    Climb found;
    double stride = 0.3;
    for (int i = 0; i < tries && !found.rises; ++i) {
        AnyState next = best;
        Eigen::MatrixXd force = best_force;
        next.x += stride * points(1);
        next.v += stride / h * points(1);
        if (forced) force = rounded(scene, force + stride / (h * h) * points(1));
        for (Index p = 0; forced && p < scene.size(); ++p)
            scene.set_constant_force(p, force.col(p));
        next = rounded(scene, next);
        AnyState state = next;
        const Books books = take(state, force.cast<Real>());
        found.rises = books.rises();
        const Real here = (books.gain - books.slack) / books.kinetic;
        if (here > found.best) {
            found.best = here;
            best = next;
            best_force = force;
            stride *= 1.6;
        } else {
            stride = std::max(stride * 0.92, 1e-7);
        }
    }
    return found;
}

}  // namespace taut_test
