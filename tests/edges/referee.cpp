// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

#include "referee.hpp"

#include <Eigen/Dense>
#include <cfenv>
#include <cmath>
#include <cstdio>
#include <limits>

#if defined(__FAST_MATH__)
#error "the referee must be compiled strictly"
#endif

namespace referee {

namespace {

using Real = long double;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

int failed = 0;

/// The usual floating-point modes, as long as it lives.
class UsualModes {
public:
    UsualModes() {
        std::fegetenv(&before_);
        std::fesetenv(FE_DFL_ENV);
    }
    ~UsualModes() { std::fesetenv(&before_); }
    UsualModes(const UsualModes&) = delete;

private:
    std::fenv_t before_;
};

template <class Number>
bool all_finite(const Number* numbers, long count) {
    for (long i = 0; i < count; ++i) {
        if (!std::isfinite(numbers[i])) return false;
    }
    return true;
}

}  // namespace

long double smallest(const Scene& scene, Matrices which, Real on_M, Real on_D, Real on_K) {
    const UsualModes modes;
    const int dim = which == Matrices::any_pose ? 1 : scene.dim;
    const auto n = static_cast<int>(scene.inverse_mass.size());
    std::vector<int> place(scene.inverse_mass.size(), -1);
    int free = 0;
    for (int i = 0; i < n; ++i) {
        if (scene.inverse_mass[i] != 0) place[i] = free++;
    }
    if (free == 0) return 1;
    Matrix S = Matrix::Zero(dim * free, dim * free);
    S.diagonal().setConstant(on_M + on_D * Real(scene.d0));
    for (const Spring& spring : scene.springs) {
        const Real k = spring.k, c = spring.c;
        Matrix elastic = Matrix::Constant(1, 1, k), plus = elastic,
               damper = Matrix::Constant(1, 1, c);
        if (which != Matrices::any_pose) {
            Eigen::Matrix<Real, Eigen::Dynamic, 1> d(dim);
            for (int j = 0; j < dim; ++j) {
                d[j] = Real(scene.x[dim * spring.b + j]) - Real(scene.x[dim * spring.a + j]);
            }
            const Real l = d.norm();
            d /= l;
            const Matrix along = d * d.transpose();
            const Matrix across = Matrix::Identity(dim, dim) - along;
            const Real transverse = dim == 1 ? 0 : k * (1 - Real(spring.L) / l);
            elastic = k * along + transverse * across;
            plus = k * along + (transverse > 0 ? transverse : 0) * across;
            damper = c * along;
        }
        const Matrix P = on_D * (damper + Real(scene.alpha) * plus) +
                         on_K * (which == Matrices::pose ? elastic : plus);
        const int a = place[spring.a], b = place[spring.b];
        const Real at_a = std::sqrt(Real(scene.inverse_mass[spring.a]));
        const Real at_b = std::sqrt(Real(scene.inverse_mass[spring.b]));
        if (a >= 0) S.block(dim * a, dim * a, dim, dim) += at_a * at_a * P;
        if (b >= 0) S.block(dim * b, dim * b, dim, dim) += at_b * at_b * P;
        if (a < 0 || b < 0) continue;
        S.block(dim * a, dim * b, dim, dim) -= at_a * at_b * P;
        S.block(dim * b, dim * a, dim, dim) -= at_a * at_b * P;
    }
    return Eigen::SelfAdjointEigenSolver<Matrix>(S, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

double not_finite(int which) {
    const double infinity = std::numeric_limits<double>::infinity();
    return which == 0   ? std::numeric_limits<double>::quiet_NaN()
           : which == 1 ? infinity
                        : -infinity;
}

bool is_finite(const double* numbers, long count) { return all_finite(numbers, count); }
bool is_finite(const float* numbers, long count) { return all_finite(numbers, count); }

bool check(bool well, const char* what, int number) {
    if (well) return true;
    ++failed;
    if (failed <= 20) std::fprintf(stderr, "%s (%d)\n", what, number);
    return false;
}

int failures() { return failed; }

}  // namespace referee
