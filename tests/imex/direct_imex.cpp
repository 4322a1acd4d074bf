// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "direct_imex.hpp"

namespace taut_test {

ImexMatrices::ImexMatrices(const Scene& scene, double step,
                           const std::function<double(Index)>& share) {
    const Index n = scene.size();
    A = L = D = RealMatrix::Zero(n, n);
    const auto alpha = static_cast<Real>(scene.stiffness_proportional());
    const auto drag = static_cast<Real>(scene.mass_proportional());
    const double rounded = scene.kind().single ? taut::proof_detail::step_rounding<float>
                                               : taut::proof_detail::step_rounding<double>;
    const Real h = static_cast<Real>(step) * static_cast<Real>(1 + rounded);
    for (Index i = 0; i < n; ++i) {
        A(i, i) = static_cast<Real>(scene.mass(i));
        D(i, i) = drag * A(i, i);
        if (!scene.is_pinned(i)) free.push_back(i);
    }
    Index index = 0;
    for (const AnySpring& spring : scene.springs()) {
        const Real k = law_at(spring, 1).bound;
        const Real c = static_cast<Real>(spring.damping) + alpha * k;
        const auto add = [a = spring.a, b = spring.b](RealMatrix& to, Real weight) {
            to(a, a) += weight;
            to(b, b) += weight;
            to(a, b) -= weight;
            to(b, a) -= weight;
        };
        add(L, k);
        add(D, c);
        add(A, static_cast<Real>(share(index++)) * (h * h * k + h / 2 * c));
    }
}

bool ImexMatrices::holds(Real h) const {
    const RealMatrix rest = free_part(A - h * h * L - h / 2 * D);
    return rest.rows() == 0 || eigenvalues(rest)[0] >= 0;
}

Real ImexMatrices::edge(Real most) const {
    Real low = 0, high = most;
    for (int i = 0; i < 60; ++i) (holds((low + high) / 2) ? low : high) = (low + high) / 2;
    return low;
}

Real ImexMatrices::added_energy(const Scene& scene, const AnyState& state) const {
    RealMatrix added = A;
    for (Index i = 0; i < scene.size(); ++i) added(i, i) -= static_cast<Real>(scene.mass(i));
    const RealMatrix v = state.v(Eigen::all, free).transpose().cast<Real>();
    return (v.transpose() * free_part(added) * v).trace() / 2;
}

double edge_of_own(const Scene& scene, const std::function<double(Index)>& share) {
    double low = 0, high = 1e3;
    for (int i = 0; i < 60; ++i) {
        const double h = (low + high) / 2;
        (ImexMatrices(scene, h, share).holds(static_cast<Real>(h)) ? low : high) = h;
    }
    return low;
}

RealMatrix impulses(const Scene& scene, const ImexMatrices& matrices, const StepAhead& ahead,
                    const AnyState& state, Real h, const RealMatrix& F) {
    const auto d0 = static_cast<Real>(scene.mass_proportional());
    RealMatrix f = ahead.springs + F;
    for (Index i = 0; i < scene.size(); ++i) {
        f.col(i) += static_cast<Real>(scene.mass(i)) *
                    (scene.gravity().cast<Real>() - d0 * state.v.col(i).cast<Real>());
    }
    return h * f(Eigen::all, matrices.free).transpose();
}

Books book_imex(AnyStepper& stepper, const Scene& scene, const ImexMatrices& matrices,
                AnyState& state, double h, const RealMatrix& F) {
    state = rounded(scene, state);
    const auto time = static_cast<Real>(scene.rounded(h));
    const StepAhead ahead(scene, state, time, F);
    const auto energy = [&] {
        return total_energy(scene, state) + matrices.added_energy(scene, state);
    };
    const Real start = energy();
    const AnyState before = state;
    Books books;
    if (!stepper.step(state, h)) {
        books.gain = std::numeric_limits<Real>::infinity();
        return books;
    }
    books.gain = energy() - start - work_of_step(scene, state, time, ahead.springs, F);
    const auto of_free = [&](const Eigen::MatrixXd& v) {
        return RealMatrix(v(Eigen::all, matrices.free).transpose().cast<Real>());
    };
    const RealMatrix A = matrices.free_part(matrices.A), change = of_free(state.v - before.v);
    const RealMatrix speed = of_free(before.v.cwiseAbs() + state.v.cwiseAbs());
    Real size = 2 * (speed.transpose() * A.cwiseAbs() * speed).trace();
    for (Index i = 0; i < scene.size(); ++i) {
        const double speeds = before.v.col(i).norm() + state.v.col(i).norm();
        size += ahead.noise[i] * (before.x.col(i).norm() + time * speeds);
    }
    books.slack = 8 * static_cast<Real>(scene.kind().epsilon()) * size;
    books.kinetic = (change.transpose() * A * change).trace() / 2;
    return books;
}

}  // namespace taut_test
