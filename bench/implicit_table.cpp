// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT

// Implicit steps of h = 1/60 s on the hanging cloth, beside what one would write with Eigen and
// CHOLMOD alone, and what conjugate gradients cost: time and outcome. Prints Markdown; times are
// CPU ms of this process, so run it with OPENBLAS_NUM_THREADS=1.

#include <Eigen/CholmodSupport>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <string>
#include <taut/bdf2/bdf2.hpp>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/lattice/chain.hpp>
#include <taut/own_matrices/own_matrices.hpp>
#include <taut/projective/projective.hpp>
#include <taut/solver/sparse_cholesky.hpp>
#include <taut/suitesparse/suitesparse.hpp>
#include <taut/taut.hpp>
#include <vector>

#include "measure.hpp"
#include "mesh_in.hpp"
#include "outcome.hpp"
#include "triplet_step.hpp"

namespace {

using bench::Stopwatch;
using bench::Times;
using taut::Index;
using Cloth = taut::SpringSystem<double, 3>;
using State = Cloth::State;
using Sparse = taut::SparseMatrix<double>;
using Gradients = taut::ConjugateGradient<double, 3>;
using Projective = taut::ProjectiveDynamics<Cloth>;

constexpr double h = 1.0 / 60;
constexpr double budget = 60;  // s of CPU that a row may take
constexpr clockid_t clock_used = bench::process_time;

/// One row: a second of free swing, or as much of it as the budget allows.
void row(const char* name, const Cloth& cloth, const std::function<bool(State&)>& step) {
    State state = cloth.initial_state();
    bench::Outcome outcome(cloth);
    Stopwatch watch(clock_used);
    const double start = bench::now(clock_used);
    int frames = 0;
    while (frames < 60 && !outcome.lost() && bench::now(clock_used) - start < 1e3 * budget) {
        bool alive = false;
        watch.run([&] { alive = step(state); });
        ++frames;
        if (alive) {
            outcome.see(frames * h, state);
        } else {
            outcome.explode();
        }
    }
    const Times times = watch.times();
    std::printf("| %s | %.2f | %.2f | %d | %s |\n", name, times.least, times.median, frames,
                outcome.cells().c_str());
    std::fflush(stdout);
}

template <class Stepper>
auto by(Stepper& stepper) {
    return [&stepper](State& state) { return static_cast<bool>(stepper.step(state, h)); };
}

struct Scene {
    std::string name;
    Cloth cloth;
};

void steps(const std::vector<Scene>& scenes) {
    for (const auto& [name, cloth] : scenes) {
        std::printf(
            "## %s, a second of free swing in steps of 1/60 s\n\n"
            "| step | ms: min | median | steps | %s |\n|---|---|---|---|---|---|---|\n",
            name.c_str(), bench::Outcome::columns);
        row("Eigen: triplets, LDLT.compute, plain K", cloth, bench::TripletStep(cloth, h, false));
        row("Eigen: triplets, LDLT.compute, K⁺", cloth, bench::TripletStep(cloth, h, true));
        taut::ImplicitEuler<Cloth, Eigen::SimplicialLDLT<Sparse>> ldlt(cloth);
        row("pattern analysed once, SimplicialLDLT", cloth, by(ldlt));
        taut::ImplicitEuler<Cloth, taut::SparseCholesky<double>> llt(cloth);
        row("ImplicitEuler, SparseCholesky", cloth, by(llt));
        taut::ImplicitEuler<Cloth, taut::Cholmod<>> cholmod(cloth);
        row("ImplicitEuler, Cholmod", cloth, by(cholmod));
        taut::ImplicitEuler<Cloth, taut::Umfpack<>> umfpack(cloth);
        row("ImplicitEuler, Umfpack", cloth, by(umfpack));
        taut::ImplicitEuler<Cloth> gradients(cloth);
        row("ImplicitEuler (ConjugateGradient 1e-3)", cloth, by(gradients));
        gradients.configure([](auto& solver) { solver.setTolerance(1e-6); });
        row("ImplicitEuler, ConjugateGradient 1e-6", cloth, by(gradients));
        taut::Bdf2<Cloth> bdf2(cloth);
        row("Bdf2 (ConjugateGradient 1e-3)", cloth, by(bdf2));
        taut::Bdf2<Cloth, taut::Cholmod<>> bdf2_cholmod(cloth);
        row("Bdf2, Cholmod", cloth, by(bdf2_cholmod));
        Projective::Options options;
        options.window = 0;
        Projective plain(cloth, options);
        row("ProjectiveDynamics, 10 iterations, window 0", cloth, by(plain));
        Projective fast(cloth);
        row("ProjectiveDynamics, 10 iterations", cloth, by(fast));
        std::printf("\n");
    }
}

/// The matrix of a step, assembled in place and solved by Eigen's SimplicialLDLT.
struct DirectSolve {
    const Cloth& cloth;
    taut::TangentMatrix<double, 3> tangent;
    Sparse A;
    Eigen::SimplicialLDLT<Sparse> ldlt;
    Eigen::VectorXd b, x;
    Stopwatch assembly{clock_used}, by_ldlt{clock_used};

    explicit DirectSolve(const Cloth& system)
        : cloth(system), tangent(system), A(tangent.zero()), b(Eigen::VectorXd::Ones(A.rows())) {
        ldlt.analyzePattern(A);
    }
    void run(const State& state) {
        assembly.run([&] {
            tangent.assemble(
                cloth, state.x,
                taut::matrices::M + h * taut::matrices::D + h * h * taut::matrices::K_plus, A);
        });
        by_ldlt.run([&] {
            ldlt.factorize(A);
            x = ldlt.solve(b);
        });
    }
};

/// A second of free swing: what a step costs.
void gradients_table(const std::vector<Scene>& scenes) {
    std::printf(
        "## Conjugate gradients to 1e-3, a second of free swing in steps of 1/60 s\n\n"
        "| scene | preconditioner | iterations a step | step, ms: min (median) | assembly "
        "| SimplicialLDLT factorise + solve | ratio |\n|---|---|---|---|---|---|---|\n");
    for (const auto& [name, cloth] : scenes) {
        State state = cloth.initial_state();
        DirectSolve baseline(cloth);
        const double start = bench::now(clock_used);
        for (int k = 0; k < 5 && bench::now(clock_used) - start < 1e3 * budget; ++k) {
            baseline.run(state);
        }
        const Times direct = baseline.by_ldlt.times();
        const auto by_gradients = [&](const char* preconditioner, auto&& stepper) {
            state = cloth.initial_state();
            Stopwatch watch(clock_used);
            Index iterations = 0;
            for (int k = 0; k < 60; ++k) {
                bool good = true;
                watch.run([&] { good = bool(stepper.step(state, h)); });
                if (!good) return;
                iterations += stepper.solver().iterations();
            }
            const Times times = watch.times();
            std::printf("| %s | %s | %.1f | %.2f (%.2f) | %.2f | %.1f (%.1f) | %.3f (%.3f) |\n",
                        name.c_str(), preconditioner, static_cast<double>(iterations) / 60,
                        times.least, times.median, baseline.assembly.times().median, direct.least,
                        direct.median, times.least / direct.least, times.median / direct.median);
            std::fflush(stdout);
        };
        by_gradients("TwoLevel", taut::ImplicitEuler<Cloth, Gradients>(cloth));
    }
    std::printf("\n");
}

/// The same poses for all: each way solves the step from every pose of one trajectory.
void ratios() {
    const Cloth cloth = taut::hanging_cloth<double>({100, 100});
    State state = cloth.initial_state();
    taut::ImplicitEuler<Cloth, taut::Cholmod<>> leader(cloth);
    taut::ImplicitEuler<Cloth, taut::Cholmod<>> cholmod(cloth);
    taut::ImplicitEuler<Cloth, Gradients> gradients(cloth);
    DirectSolve direct(cloth);
    Eigen::CholmodSupernodalLLT<Sparse> bare;
    bare.analyzePattern(direct.A);
    Stopwatch by_bare(clock_used), by_cholmod(clock_used), by_gradients(clock_used);
    double residual = 0;
    Index iterations = 0;
    for (int k = 0; k < 60; ++k) {
        State copy = state;
        by_gradients.run([&] {
            const auto report = gradients.step(copy, h);
            residual = std::max(residual, report ? report.residual : 1);
        });
        iterations = std::max(iterations, gradients.solver().iterations());
        if (k % 6 == 3) {
            direct.run(state);
            for (int repeat = 0; repeat < 2; ++repeat) {
                by_bare.run([&] {
                    bare.factorize(direct.A);
                    direct.x = bare.solve(direct.b);
                });
                copy = state;
                by_cholmod.run([&] { residual += cholmod.step(copy, h) ? 0 : 1; });
            }
        }
        if (!leader.step(state, h)) return;
    }
    const auto print = [](const char* what, const Stopwatch& us, const Stopwatch& them) {
        const Times ours = us.times();
        const Times theirs = them.times();
        std::printf("| %s | %.2f (%.2f) | %.2f (%.2f) | %.3f (%.3f) |\n", what, ours.least,
                    ours.median, theirs.least, theirs.median, ours.least / theirs.least,
                    ours.median / theirs.median);
        std::fflush(stdout);
    };
    std::printf(
        "## Ratios in one run, hanging_cloth 100, poses of one trajectory\n\n"
        "| | ms: min (median) | baseline | ratio |\n|---|---|---|---|\n");
    print("whole step with Cholmod / bare CHOLMOD factorise + solve", by_cholmod, by_bare);
    print("whole step with ConjugateGradient / SimplicialLDLT factorise + solve", by_gradients,
          direct.by_ldlt);
    print("assembly / whole step with Cholmod", direct.assembly, by_cholmod);
    print("assembly / whole step with ConjugateGradient", direct.assembly, by_gradients);
    std::printf("\nConjugateGradient: true relative residual ≤ %.1e, at most %lld iterations.\n\n",
                residual, static_cast<long long>(iterations));
}

/// Where a direct solver is the faster one, beside where it is not.
void direct_table() {
    std::printf(
        "## A direct solver or conjugate gradients, 60 steps of 1/60 s\n\n"
        "| scene | SparseCholesky, ms: min (median) | ConjugateGradient 1e-3 | ratio |\n"
        "|---|---|---|---|\n");
    const auto compare = [](const std::string& name, const auto& system) {
        using System = std::decay_t<decltype(system)>;
        const auto times = [&](auto stepper) {
            auto state = system.initial_state();
            Stopwatch watch(clock_used);
            bool good = true;
            for (int k = 0; k < 60; ++k) {
                watch.run([&] { good = bool(stepper.step(state, h)) && good; });
            }
            return good ? watch.times() : Times{};
        };
        using Solver = taut::ConjugateGradient<double, System::Dim>;
        const Times direct =
            times(taut::ImplicitEuler<System, taut::SparseCholesky<double>>(system));
        const Times gradients = times(taut::ImplicitEuler<System, Solver>(system));
        std::printf("| %s | %.4f (%.4f) | %.4f (%.4f) | %.2f (%.2f) |\n", name.c_str(),
                    direct.least, direct.median, gradients.least, gradients.median,
                    direct.least / gradients.least, direct.median / gradients.median);
        std::fflush(stdout);
    };
    for (const Index n : {4, 8, 16, 32, 64}) {
        compare("hanging_cloth " + std::to_string(n), taut::hanging_cloth<double>({n, n}));
    }
    for (const Index n : {100, 1000}) {
        auto row = taut::chain<double, 1>({n, taut::ChainEnds::fixed_fixed, 1e-3, 1e4});
        row.set_gravity(Eigen::Matrix<double, 1, 1>(9.81));
        compare("chain of " + std::to_string(n) + ", in one dimension", row);
    }
    const Cloth cloth = taut::hanging_cloth<double>({32, 32});
    compare("the matrices of hanging_cloth 32: one factor",
            taut::linearize(cloth, cloth.initial_state()));
    std::printf("\n");
}

/// One iteration of projective dynamics beside a plain local step and three of Eigen's solves.
void projective() {
    const Cloth cloth = taut::hanging_cloth<double>({100, 100});
    const Sparse P = taut::Pencil::any_pose(cloth).assemble(
        taut::matrices::M + h * taut::matrices::D + h * h * taut::matrices::K_plus);
    const Eigen::SimplicialLLT<Sparse> llt(P);
    const auto& set = cloth.springs();
    State state = cloth.initial_state();
    Eigen::Matrix3Xd rhs(3, cloth.size());
    Eigen::MatrixXd columns(P.rows(), 3), solution(P.rows(), 3);
    const auto plain_iteration = [&] {
        rhs.setZero();
        for (std::size_t s = 0; s < set.a.size(); ++s) {
            const double* a = state.x.data() + 3 * set.a[s];
            const double* b = state.x.data() + 3 * set.b[s];
            const double dx = b[0] - a[0];
            const double dy = b[1] - a[1];
            const double dz = b[2] - a[2];
            const double pull = h * h * set.parameters[s].stiffness * set.rest_length[s] /
                                std::sqrt(dx * dx + dy * dy + dz * dz);
            double* at_a = rhs.data() + 3 * set.a[s];
            double* at_b = rhs.data() + 3 * set.b[s];
            at_a[0] -= pull * dx;
            at_a[1] -= pull * dy;
            at_a[2] -= pull * dz;
            at_b[0] += pull * dx;
            at_b[1] += pull * dy;
            at_b[2] += pull * dz;
        }
        Index j = 0;
        for (Index i = 0; i < cloth.size(); ++i) {
            if (!cloth.is_pinned(i)) columns.row(j++) = rhs.col(i).transpose();
        }
        for (int c = 0; c < 3; ++c) solution.col(c) = llt.solve(columns.col(c));
    };
    std::printf(
        "## One iteration of projective dynamics, hanging_cloth 100\n\n"
        "| | ms: min (median) | three LLT solves and a local step | ratio |\n|---|---|---|---|\n");
    for (const int window : {0, 5}) {
        Projective::Options options;
        options.window = window;
        options.iterations = 20;
        Projective long_steps(cloth, options);
        options.iterations = 10;
        Projective short_steps(cloth, options);
        state = cloth.initial_state();
        Stopwatch ten(clock_used), twenty(clock_used), baseline(clock_used);
        for (int k = 0; k < 60; ++k) {
            for (int repeat = 0; repeat < 5; ++repeat) baseline.run(plain_iteration);
            State copy = state;
            bool good = true;
            twenty.run([&] { good = bool(long_steps.step(copy, h)); });
            ten.run([&] { good = bool(short_steps.step(state, h)) && good; });
            if (!good) return;
        }
        // The difference leaves out what a step costs apart from its iterations.
        const double least = (twenty.times().least - ten.times().least) / 10;
        const double median = (twenty.times().median - ten.times().median) / 10;
        const Times theirs = baseline.times();
        std::printf("| window %d | %.2f (%.2f) | %.2f (%.2f) | %.3f (%.3f) |\n", window, least,
                    median, theirs.least, theirs.median, least / theirs.least,
                    median / theirs.median);
        std::fflush(stdout);
    }
    std::printf("\n");
}

}  // namespace

/// Arguments: sizes of the cloth, 32 64 100 200 if there are none, and an OBJ file.
int main(int argc, char** argv) try {
    std::vector<Scene> scenes;
    const char* mesh = nullptr;
    std::vector<Index> sizes;
    for (int i = 1; i < argc; ++i) {
        if (const int size = std::atoi(argv[i]); size > 0) {
            sizes.push_back(size);
        } else {
            mesh = argv[i];
        }
    }
    for (const Index n : sizes.empty() ? std::vector<Index>{32, 64, 100, 200} : sizes) {
        scenes.push_back(
            {"hanging_cloth " + std::to_string(n), taut::hanging_cloth<double>({n, n})});
    }
    if (mesh != nullptr) {
        scenes.push_back({"mesh", bench::mesh_in<double>(example::read_obj(mesh)).system});
    }
    ratios();
    direct_table();
    gradients_table(scenes);
    projective();
    steps(scenes);
} catch (const std::exception& error) {
    std::fprintf(stderr, "implicit_table: %s\n", error.what());
    return 1;
}
