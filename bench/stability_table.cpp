// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// What an answer about stability costs and how tight it is, beside a plain symplectic step and
// Spectra. Prints Markdown; times are the minimum and the median of several runs, in ms.

#include <Spectra/SymEigsSolver.h>
#include <Spectra/MatOp/SparseSymMatProd.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <taut/taut.hpp>
#include <taut/tight/tight.hpp>
#include <taut/proof/bracket.hpp>
#include <vector>

#include "measure.hpp"
#include "memory.hpp"
#include "plain_loop.hpp"

namespace {

using Cloth = taut::SpringSystem<double, 3>;
using bench::measure;
using taut::Index;
using PlainLoop = bench::PlainLoop<double>;
using bench::Times;
using taut::Method;

/// M^-½ K M^-½ of the scene at rest.
taut::SparseMatrix<double> scaled_stiffness(const taut::Pencil& pencil) {
    const Eigen::VectorXd scale = pencil.mass().cwiseSqrt().cwiseInverse();
    return scale.asDiagonal() * pencil.assemble(taut::matrices::K_plus) * scale.asDiagonal();
}

double spectra_k_max(const taut::SparseMatrix<double>& A) {
    Spectra::SparseSymMatProd<double> product(A);
    Spectra::SymEigsSolver<Spectra::SparseSymMatProd<double>> solver(product, 1, 20);
    solver.init();
    solver.compute(Spectra::SortRule::LargestAlge, 1000, 1e-6);
    return solver.eigenvalues()[0];
}

void brackets_by_bounds() {
    std::printf(
        "## Bracket of the symplectic step by bounds, hanging_cloth\n\n"
        "| N | springs | plain step, ms | bracket, ms: min (median) | plain steps | Spectra to "
        "1e-6, ms | of Spectra | refuted/certified |\n|---|---|---|---|---|---|---|---|\n");
    std::vector<std::array<double, 2>> growth;
    for (const Index n : {50, 100, 200, 400}) {
        const Cloth cloth = taut::hanging_cloth<double>({n, n});
        const auto state = cloth.initial_state();
        PlainLoop plain(cloth);
        const Times step = measure(9, [&] {
            for (int i = 0; i < 20; ++i) plain.step(1e-5);
        });
        taut::StepLimit<double> limit;
        const Times bracket = measure(n > 200 ? 3 : 7, [&] {
            limit = taut::bracket(taut::Stability<double>(cloth, state), Method::symplectic_euler);
        });
        const auto A = scaled_stiffness(taut::Pencil::at_pose(cloth, state.x));
        const Times spectra = measure(n > 100 ? 1 : 3, [&] { spectra_k_max(A); });
        std::printf("| %lld | %lld | %.3f | %.2f (%.2f) | %.0f | %.0f | %.2f | %.4f |\n",
                    static_cast<long long>(n), static_cast<long long>(cloth.spring_count()),
                    step.least / 20, bracket.least, bracket.median, bracket.least / step.least * 20,
                    spectra.least, bracket.least / spectra.least, limit.refuted / limit.certified);
        std::fflush(stdout);
        growth.push_back(
            {std::log(static_cast<double>(cloth.spring_count())), std::log(bracket.least)});
    }
    const auto& [first, last] = std::pair(growth.front(), growth.back());
    std::printf("\nTime grows like springs to the power %.2f from N = 50 to 400.\n\n",
                (last[1] - first[1]) / (last[0] - first[0]));
}

void proof_to_1e6() {
    const Cloth cloth = taut::hanging_cloth<double>({100, 100});
    const auto state = cloth.initial_state();
    std::printf(
        "## Proof to 1e-6, hanging_cloth 100\n\n"
        "| factorisation (analysis included), ms | proof, ms | factorisations | "
        "refuted/certified - 1 |\n|---|---|---|---|\n");
    const taut::Stability<double> stability(cloth, state);
    taut::StepLimit<double> limit;
    const Times proof =
        measure(3, [&] { limit = taut::max_step(stability, Method::symplectic_euler, 1e-6); });
    const double h = limit.certified;
    const taut::SparseMatrix<double> A =
        stability.pencil().assemble(4 * taut::matrices::M - h * h * taut::matrices::K_plus);
    const Times factorisation =
        measure(3, [&] { Eigen::SimplicialLLT<taut::SparseMatrix<double>> llt(A); });
    std::printf("| %.0f | %.0f | %.2f | %.1e |\n\n", factorisation.least, proof.least,
                proof.least / factorisation.least, limit.refuted / limit.certified - 1);
}

/// Prints what an analysis of hanging_cloth 100 takes at its peak, bytes.
void print_peak(double tightness) {
    const Cloth cloth = taut::hanging_cloth<double>({100, 100});
    const auto state = cloth.initial_state();
    std::printf("%.0f\n", bench::peak_bytes([&] {
                    taut::max_step(taut::Stability<double>(cloth, state), Method::symplectic_euler,
                                   tightness);
                }));
}

void memory(const std::string& program) {
    const Cloth cloth = taut::hanging_cloth<double>({100, 100});
    const auto state = cloth.initial_state();
    const auto K = taut::Pencil::at_pose(cloth, state.x).assemble(taut::matrices::K_plus);
    const auto bytes = [](const taut::SparseMatrix<double>& A) {
        return static_cast<double>(A.nonZeros() * 12 + A.cols() * 4);
    };
    const double factor = [&] {
        const Eigen::SimplicialLLT<taut::SparseMatrix<double>> llt(
            taut::Pencil::at_pose(cloth, state.x)
                .assemble(1e9 * taut::matrices::M + taut::matrices::K_plus));
        const taut::SparseMatrix<double> L = llt.matrixL();
        return bytes(L);
    }();
    const double by_bounds = bench::number_from(program, "--peak 0");
    const double proof = bench::number_from(program, "--peak 1e-6");
    std::printf(
        "## Memory, hanging_cloth 100\n\n"
        "K takes %.1f MB, its factor %.1f MB. Peak of the analysis by bounds: %.1f MB, %.2f times "
        "K; with a proof: %.1f MB, %.2f times K beside the factor.\n\n",
        bytes(K) / 1e6, factor / 1e6, by_bounds / 1e6, by_bounds / bytes(K), proof / 1e6,
        (proof - factor) / bytes(K));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc == 3 && std::string(argv[1]) == "--peak") {
        print_peak(std::atof(argv[2]));
        return 0;
    }
    brackets_by_bounds();
    proof_to_1e6();
    memory(argv[0]);
}
