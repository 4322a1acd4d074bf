// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <taut/integrator/implicit_euler.hpp>
#include <taut/solver/sparse_cholesky.hpp>
#include <taut/taut.hpp>
#include <utility>
#ifdef DRAPE_CHOLMOD
#include <taut/suitesparse/cholmod.hpp>
#endif

namespace drape {

/// The solver of --solver behind one type, so that each stepper is compiled once.
class AnySolver {
public:
    enum { UpLo = Eigen::Lower | Eigen::Upper };
    using Matrix = taut::SparseMatrix<double>;
    using Vector = Eigen::VectorXd;

    AnySolver() { hold<taut::SparseCholesky<double>>(); }
    /// @param name       as of the option; one that this program has
    /// @param tolerance  of conjugate gradients
    void choose(const std::string& name, std::optional<double> tolerance) {
        if (name == "conjugate_gradient") {
            auto& solver = hold<taut::ConjugateGradient<double, 3>>();
            if (tolerance) solver.setTolerance(*tolerance);
        }
#ifdef DRAPE_CHOLMOD
        if (name == "cholmod") hold<taut::Cholmod<double>>();
#endif
    }

    void analyzePattern(const Matrix& A) { held_->analyze(A); }
    void factorize(const Matrix& A) { held_->factorize(A); }
    Vector solve(const Vector& b) const { return held_->solve(b); }
    Eigen::ComputationInfo info() const { return held_->info(); }

private:
    struct Held {
        virtual ~Held() = default;
        virtual void analyze(const Matrix& A) = 0;
        virtual void factorize(const Matrix& A) = 0;
        virtual Vector solve(const Vector& b) = 0;
        virtual Eigen::ComputationInfo info() const = 0;
    };
    template <class Solver>
    struct HeldAs final : Held {
        void analyze(const Matrix& A) override { solver.analyzePattern(A); }
        void factorize(const Matrix& A) override { solver.factorize(A); }
        Vector solve(const Vector& b) override { return solver.solve(b); }
        Eigen::ComputationInfo info() const override { return solver.info(); }
        Solver solver;
    };
    template <class Solver>
    Solver& hold() {
        auto held = std::make_unique<HeldAs<Solver>>();
        Solver& solver = held->solver;
        held_ = std::move(held);
        return solver;
    }

    std::unique_ptr<Held> held_;
};

}  // namespace drape
