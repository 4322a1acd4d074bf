// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Whether what is certified is true, and how near it comes: badly conditioned matrices with spectra
// in closed form, random systems judged in long double, and random systems up to the ends of double
// judged by proofs in several hundred bits. Prints Markdown.

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/taut.hpp>
#include <taut/tight/dense.hpp>
#include <taut/tight/tight.hpp>
#include <taut/proof/bracket.hpp>
#include <tuple>
#include <vector>

#include "soundness/search.hpp"

namespace {

using taut::Index;
using taut::Method;

/// Eigenvalues 4 sin²((2j − 1)π/(2(2n + 1))) of the fixed–free chain's matrix.
taut::SparseMatrix<double> chain_matrix(Index n) {
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < n; ++i) {
        entries.emplace_back(i, i, i + 1 < n ? 2 : 1);
        if (i > 0) entries.emplace_back(i, i - 1, -1);
        if (i > 0) entries.emplace_back(i - 1, i, -1);
    }
    taut::SparseMatrix<double> T(n, n);
    T.setFromTriplets(entries.begin(), entries.end());
    return T;
}

taut::SparseMatrix<double> kronecker(const taut::SparseMatrix<double>& A,
                                     const taut::SparseMatrix<double>& B) {
    using Entry = taut::SparseMatrix<double>::InnerIterator;
    std::vector<Eigen::Triplet<double>> entries;
    for (Index ja = 0; ja < A.outerSize(); ++ja) {
        for (Entry a(A, ja); a; ++a) {
            for (Index jb = 0; jb < B.outerSize(); ++jb) {
                for (Entry b(B, jb); b; ++b) {
                    entries.emplace_back(static_cast<int>(a.row() * B.rows() + b.row()),
                                         static_cast<int>(ja * B.cols() + jb),
                                         a.value() * b.value());
                }
            }
        }
    }
    taut::SparseMatrix<double> product(A.rows() * B.rows(), A.cols() * B.cols());
    product.setFromTriplets(entries.begin(), entries.end());
    return product;
}

/// K = S(Tᵃ ⊗ Tᵃ)S, M = S² with S a diagonal of powers of two: M^-½KM^-½ = Tᵃ ⊗ Tᵃ exactly,
/// integers whose spectrum is known in closed form.
void conditioned_pairs() {
    std::printf(
        "## Bare matrices: closed-form spectra, masses over 1e9\n\n"
        "| unknowns | condition of K' | tightness asked | answer | lower/truth | refuted/truth | "
        "admitted growth × h |\n|---|---|---|---|---|---|---|\n");
    std::mt19937 random(7);
    for (const auto& [p, q, power] : {std::tuple<Index, Index, int>{32, 32, 1},
                                      {100, 100, 1},
                                      {141, 141, 1},
                                      {32, 32, 2},
                                      {100, 100, 2},
                                      {50, 50, 3}}) {
        const auto raise = [power = power](const taut::SparseMatrix<double>& T) {
            taut::SparseMatrix<double> result = T;
            for (int i = 1; i < power; ++i) result = taut::SparseMatrix<double>(result * T);
            return result;
        };
        const auto A = kronecker(raise(chain_matrix(p)), raise(chain_matrix(q)));
        Eigen::VectorXd scale(A.rows());
        for (auto& s : scale) s = std::exp2(static_cast<int>(random() % 16) - 7);
        const taut::LinearSystem<double> system(scale.cwiseAbs2(), {},
                                                scale.asDiagonal() * A * scale.asDiagonal());
        const auto extreme = [power = power](Index n, Index j) {
            const double s = std::sin(static_cast<double>(2 * j - 1) * M_PI /
                                      static_cast<double>(2 * (2 * n + 1)));
            return std::pow(4 * s * s, power);
        };
        const double truth = 2 / std::sqrt(extreme(p, p) * extreme(q, q));
        const double condition = extreme(p, p) * extreme(q, q) / (extreme(p, 1) * extreme(q, 1));
        const taut::Stability<double> stability(system);
        for (const double tightness : {0.0, 1e-4}) {
            const auto limit = taut::max_step(stability, Method::symplectic_euler, tightness);
            const double lower = std::max(limit.certified, limit.certified_up_to);
            std::printf("| %lld | %.1e | %g | %s | %.6f | %.6f | %.1e |\n",
                        static_cast<long long>(A.rows()), condition, tightness,
                        limit.certified > 0 ? "certified" : "certified_up_to", lower / truth,
                        limit.refuted / truth, limit.admitted_growth * lower);
            std::fflush(stdout);
        }
    }
    std::printf("\n");
}

double uniform(std::mt19937& random, double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) * 0x1p-32);
}

/// 1–20 particles in one to three dimensions: N up to 60.
template <int Dim>
taut::SpringSystem<double, Dim> random_system(std::mt19937& random) {
    taut::SpringSystem<double, Dim> system;
    using Vector = Eigen::Matrix<double, Dim, 1>;
    const auto decades = [&] { return std::pow(10, uniform(random, -6, 6)); };
    const Index n = 1 + static_cast<Index>(random() % 20);
    for (Index i = 0; i < n; ++i) {
        system.add_particle(Vector::NullaryExpr([&] { return uniform(random, -1, 1); }), decades());
    }
    const Index springs = n > 1 ? static_cast<Index>(random() % static_cast<unsigned>(3 * n)) : 0;
    const bool dampers = random() % 2 == 0;
    for (Index s = 0; s < springs; ++s) {
        const auto a = static_cast<Index>(random() % static_cast<unsigned>(n));
        const auto b = static_cast<Index>(random() % static_cast<unsigned>(n));
        if (a != b) system.add_spring(a, b, decades(), dampers && random() % 2 ? decades() : 0);
    }
    for (Index i = 0; i < n; ++i) {
        if (random() % 6 == 0) system.pin(i);
    }
    if (random() % 2 == 0) {
        system.set_rayleigh({random() % 2 ? decades() : 0, random() % 2 ? 1e-3 * decades() : 0});
    }
    return system;
}

/// The symplectic limit in long double: the root of λ_min(4 − 2hD' − h²K') = 0 by bisection.
long double true_symplectic(const taut::Pencil& pencil) {
    using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
    const taut::VectorX<long double> scale =
        pencil.mass().cast<long double>().cwiseSqrt().cwiseInverse();
    const auto scaled = [&](const taut::Combination& c) {
        return Matrix(scale.asDiagonal() * pencil.assemble(c).toDense().cast<long double>() *
                      scale.asDiagonal());
    };
    const Matrix K = scaled(taut::matrices::K_plus);
    const Matrix D = scaled(taut::matrices::D);
    const auto stable = [&](long double h) {
        const Matrix S = 4 * Matrix::Identity(K.rows(), K.rows()) - 2 * h * D - h * h * K;
        return Eigen::SelfAdjointEigenSolver<Matrix>(S, Eigen::EigenvaluesOnly).eigenvalues()[0] >
               0;
    };
    long double low = 1e-18L;
    long double high = 1e18L;
    while (high > low * (1 + 1e-12L)) {
        const long double middle = std::sqrt(low * high);
        (stable(middle) ? low : high) = middle;
    }
    return low;
}

/// What the limit is, as far as the referee can tell.
struct Truth {
    long double lower;
    long double upper;
};

/// The explicit limit in long double. With Rayleigh damping by [T9] for every mode: from
/// eigenvalues of C the small ones of 12 decades could not be told from zero, and each must not
/// exceed α (or 2/d0).
Truth true_explicit(const taut::Pencil& pencil) {
    const taut::DenseAnalysis<long double> dense(pencil);
    const auto [d0, alpha] = pencil.rayleigh();
    if (!pencil.is_rayleigh()) {
        const Truth truth{dense.explicit_limit(), dense.explicit_limit_above()};
        // D ⪰ αK leaves no mode undamped: that 0 is D's rounding in double on the zero modes.
        if (truth.upper == 0 && alpha > 0) return {0, std::numeric_limits<long double>::infinity()};
        return truth;
    }
    double limit = d0 > 0 ? 2 / d0 : alpha;
    for (const long double k : dense.stiffness_eigenvalues()) {
        if (k <= dense.zero_tolerance()) continue;
        const double mode = static_cast<double>(k);
        limit =
            std::min(limit, taut::critical_step(Method::explicit_euler, mode, d0 + alpha * mode));
    }
    return {limit, limit};
}

struct Tally {
    int systems = 0;
    int none = 0;       // nothing certified
    int wrong = 0;      // certified above the truth, or refuted below it
    int undecided = 0;  // by the referee
    std::vector<double> tightness;

    void add(double certified, double refuted, const Truth& truth) {
        ++systems;
        if (!(truth.upper < std::numeric_limits<long double>::infinity())) {
            ++undecided;
            return;
        }
        if (!(certified > 0)) ++none;
        // The truth itself is good to about this.
        if (certified > truth.upper * (1 + 1e-9L) || refuted < truth.lower * (1 - 1e-9L)) ++wrong;
        if (certified > 0) tightness.push_back(static_cast<double>(certified / truth.upper));
    }
    void print(const char* label) {
        std::sort(tightness.begin(), tightness.end());
        std::printf("| %s | %d | %d | %d | %d | %.4f | %.4f |\n", label, systems, wrong, undecided,
                    none, tightness.empty() ? 0 : tightness[tightness.size() / 2],
                    tightness.empty() ? 0 : tightness.front());
    }
};

template <int Dim>
void random_trial(std::mt19937& random, Tally& symplectic, Tally& narrowed, Tally& explicit_euler) {
    const auto system = random_system<Dim>(random);
    const taut::Stability<double> stability(system, system.initial_state());
    if (stability.size() == 0) return;
    const auto limit = taut::bracket(stability, Method::symplectic_euler);
    if (std::isfinite(limit.certified)) {
        const long double h = true_symplectic(stability.pencil());
        const Truth truth{h, h};
        symplectic.add(limit.certified, limit.refuted, truth);
        const auto narrow = taut::max_step(stability, Method::symplectic_euler, 1e-4);
        narrowed.add(narrow.certified, narrow.refuted, truth);
    }
    const auto by_explicit = taut::bracket(stability, Method::explicit_euler);
    if (std::isfinite(by_explicit.certified)) {
        const Truth truth = true_explicit(stability.pencil());
        explicit_euler.add(by_explicit.certified, by_explicit.refuted, truth);
    }
}

void random_systems(int count) {
    std::mt19937 random(2026);
    Tally symplectic, narrowed, explicit_euler;
    for (int i = 0; i < count; ++i) {
        switch (random() % 3) {
            case 0: random_trial<1>(random, symplectic, narrowed, explicit_euler); break;
            case 1: random_trial<2>(random, symplectic, narrowed, explicit_euler); break;
            default: random_trial<3>(random, symplectic, narrowed, explicit_euler); break;
        }
    }
    std::printf(
        "## %d random systems, 1 to 60 unknowns, masses and stiffnesses over 12 decades\n\n"
        "Truth by dense eigenvalues in long double.\n\n"
        "| limit | with one | wrong | truth unknown | none certified | certified/truth: median | "
        "least |\n|---|---|---|---|---|---|---|\n",
        count);
    symplectic.print("symplectic, by bounds");
    narrowed.print("symplectic, narrowed to 1e-4");
    explicit_euler.print("explicit, by bounds");
}

}  // namespace

/// Usage: soundness_table [random systems, 10000 unless given], or soundness_table with the options
/// of soundness::search_main for the referee alone.
int main(int argc, char** argv) {
    if (argc > 1 && argv[1][0] == '-') return soundness::search_main(argc, argv);
    conditioned_pairs();
    const int count = argc > 1 ? std::atoi(argv[1]) : 10000;
    random_systems(count);
    soundness::Search search;
    search.count = count;
    return soundness::run(search) > 0 ? 1 : 0;
}
