// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "../proof/pencil.hpp"
#include "../tight/certificate.hpp"
#include "detail/unproved.hpp"
#include "linear_system.hpp"

namespace taut {

/// The matrices of a LinearSystem in double, and what is known of them.
/// @tparam Scalar  the system's
template <class Scalar>
class MatrixPencil final : public BareMatrices {
public:
    /// Copies M, D and K.
    static Pencil of(const LinearSystem<Scalar>& system);

    void multiply(const Combination& c, const Eigen::VectorXd& u,
                  Eigen::VectorXd& y) const override {
        y = c.mass() * mass_.cwiseProduct(u);
        if (on_K(c) != 0) y.noalias() += on_K(c) * (K_ * u);
        if (c.damping() != 0) y.noalias() += c.damping() * (D_ * u);
    }
    Enclosed quadratic(const Combination& c, const Eigen::VectorXd& u) const override;
    double upper_bound(const Combination& c) const override;
    double deficit(const Pencil& pencil, const Combination& c, double known) const override {
        Prover prover;
        return (std::min)(known, proved_deficit(prover, pencil, c, known));
    }
    SparseMatrix<double> assemble(const Combination& c) const override;
    double assembly_error(const Combination& c, const Eigen::VectorXd& s) const override;
    std::shared_ptr<const BareMatrices> scaled(double stiffness, double mass,
                                               bool rayleigh) const override;
    void amend(Method method, const Pencil& pencil,
               proof_detail::UnroundedLimit& limit) const override {
        proof_detail::amend_for_matrices(method, pencil, limit);
    }

private:
    using Matrix = SparseMatrix<double>;

    // K⁺ = K.
    static double on_K(const Combination& c) { return c.stiffness() + c.projected(); }
    /// The sizes of what S is added up from, the mass term apart: its rounding errors are relative
    /// to these.
    Matrix magnitudes(const Combination& c) const {
        return (std::abs)(on_K(c)) * K_.cwiseAbs() + (std::abs)(c.damping()) * D_.cwiseAbs();
    }
    using Real = TangentReal<Scalar>;

    explicit MatrixPencil(const LinearSystem<Scalar>& system)
        : K_(system.stiffness().template cast<double>()),
          D_(system.damping().template cast<double>()),
          mass_(system.mass().template cast<double>()) {}
    Index size() const { return mass_.size(); }
    /// The Rayleigh form of D, if it has one.
    std::optional<double> mass_proportional() const;
    static bool diagonally_dominant(const SparseMatrix<Real>& A);
    static bool proves_semidefinite(const SparseMatrix<Scalar>& A);

    Matrix K_;
    Matrix D_;
    Eigen::VectorXd mass_;
};

template <class Scalar>
Pencil MatrixPencil<Scalar>::of(const LinearSystem<Scalar>& system) {
    std::shared_ptr<MatrixPencil> own(new MatrixPencil(system));
    proof_detail::RangeCheck check;
    const auto check_entries = [&](const SparseMatrix<Scalar>& A, const char* what) {
        solver_detail::for_each_entry(
            A, [&](Index row, Index, Scalar value) { check.in_range(value, what, row); });
    };
    check_entries(system.stiffness(), "stiffness in row");
    check_entries(system.damping(), "damping in row");
    for (Index i = 0; i < system.size(); ++i) check.in_range(system.mass()[i], "mass in row", i);
    Pencil::Facts facts;
    RayleighDamping rayleigh;
    if (check.lost().empty()) {
        const auto d0 = own->mass_proportional();
        if (d0) rayleigh.mass_proportional = *d0;
        facts.is_rayleigh = d0.has_value();
        facts.stiffness_semidefinite = facts.projected_semidefinite =
            proves_semidefinite(system.stiffness());
        facts.damping_semidefinite = facts.is_rayleigh || proves_semidefinite(system.damping());
    }
    return {own->mass_, rayleigh, facts, check.lost(), own};
}

/// D = d0·M is the one Rayleigh form that bare matrices show; α·K is not looked for, since rounding
/// would hide it. Every entry has its say: d0 is what all quotients agree on to the rounding of a
/// product, of a quotient and of both to double. A D that is 0 anywhere on its diagonal, or whose
/// quotients vanish or overflow, is not of this form.
template <class Scalar>
std::optional<double> MatrixPencil<Scalar>::mass_proportional() const {
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
    double least = std::numeric_limits<double>::infinity();
    double most = 0;
    bool diagonal = true;
    for (Index j = 0; j < size(); ++j) {
        double d = 0;
        for (Matrix::InnerIterator entry(D_, j); entry; ++entry) {
            if (entry.row() == j) {
                d = entry.value();
            } else {
                diagonal = diagonal && entry.value() == 0;
            }
        }
        const double quotient = d / mass_[j];
        least = (std::min)(least, d != 0 && !std::isnormal(quotient) ? -1 : quotient);
        most = (std::max)(most, quotient);
    }
    if (diagonal && least >= 0 && most <= least * (1 + rounding) && detail::is_finite(most))
        return most;
    return std::nullopt;
}

/// a_ii ≥ Σ|a_ij| in every row; where the sum rounds, with room for it.
template <class Scalar>
bool MatrixPencil<Scalar>::diagonally_dominant(const SparseMatrix<Real>& A) {
    for (Index j = 0; j < A.outerSize(); ++j) {
        Real diagonal = 0;
        Real others = 0;
        bool exact = true;
        int count = 0;
        for (typename SparseMatrix<Real>::InnerIterator entry(A, j); entry; ++entry, ++count) {
            if (entry.row() == j) {
                diagonal = entry.value();
            } else {
                // Knuth's two-sum: the residue of this addition.
                const Real term = (std::abs)(entry.value());
                const Real sum = others + term;
                const Real back = sum - others;
                exact = exact && (others - (sum - back)) + (term - back) == 0;
                others = sum;
            }
        }
        const Real rounding = exact ? 0 : count * std::numeric_limits<Real>::epsilon() * others;
        if (!(diagonal >= others + rounding)) return false;
    }
    return true;
}

/// By its own numbers, or in double, and then with what the conversion may have changed.
template <class Scalar>
bool MatrixPencil<Scalar>::proves_semidefinite(const SparseMatrix<Scalar>& A) {
    if (A.nonZeros() == 0 || diagonally_dominant(A.template cast<Real>())) return true;
    constexpr bool rounds =
        std::numeric_limits<Scalar>::digits > std::numeric_limits<double>::digits;
    const double rounding = rounds ? std::numeric_limits<double>::epsilon() : 0;
    const Matrix rounded = A.template cast<double>();
    const auto error = [&](const Eigen::VectorXd& s) {
        return rounding * s.cwiseProduct(rounded.cwiseAbs() * s).maxCoeff();
    };
    return Prover{}(Matrix(rounded), error).proved;
}

template <class Scalar>
Enclosed MatrixPencil<Scalar>::quadratic(const Combination& c, const Eigen::VectorXd& u) const {
    Enclosed sum;
    for (Index i = 0; i < size(); ++i) {
        const double term = c.mass() * mass_[i] * u[i] * u[i];
        sum.value += term;
        sum.error += (std::abs)(term);
    }
    const auto add = [&](const Matrix& A, double factor) {
        if (factor == 0) return;
        solver_detail::for_each_entry(A, [&](Index i, Index j, double value) {
            const double term = factor * value * u[i] * u[j];
            sum.value += term;
            sum.error += (std::abs)(term);
        });
    };
    add(K_, on_K(c));
    add(D_, c.damping());
    const double terms = static_cast<double>(size() + K_.nonZeros() + D_.nonZeros()) + 8;
    sum.error *= terms * std::numeric_limits<double>::epsilon();
    return sum;
}

/// Collatz–Wielandt: λ_max(A) ≤ max_i (a_ii + Σ_{j≠i} |a_ij| p_j/p_i) for every p > 0; the power
/// iteration on |A| improves p.
template <class Scalar>
double MatrixPencil<Scalar>::upper_bound(const Combination& c) const {
    constexpr int most_repeats = 60;
    const Matrix S = assemble(c);
    const Matrix sizes = magnitudes(c);
    Index widest = 1;
    for (Index j = 0; j < size(); ++j) {
        widest = std::max<Index>(widest, S.outerIndexPtr()[j + 1] - S.outerIndexPtr()[j]);
    }
    const double rounding =
        static_cast<double>(widest + 8) * std::numeric_limits<double>::epsilon();
    // Products that underflow lose less than this in a row; rows without entries lose nothing.
    const Eigen::VectorXd entries =
        sizes * Eigen::VectorXd::Ones(size()) + (std::abs)(c.mass()) * mass_;
    const Eigen::VectorXd underflow =
        (entries.array() > 0)
            .select(static_cast<double>(widest + 8) * (std::numeric_limits<double>::min)(),
                    Eigen::VectorXd::Zero(size()));
    Eigen::VectorXd p = mass_.cwiseSqrt().cwiseInverse();
    Eigen::VectorXd others(size());
    double best = std::numeric_limits<double>::infinity();
    for (int repeat = 0; repeat < most_repeats && best > 0; ++repeat) {
        others.setZero();
        solver_detail::for_each_entry(S, [&](Index i, Index j, double value) {
            if (i != j) others[i] += (std::abs)(value)*p[j];
        });
        const Eigen::VectorXd diagonal = S.diagonal().cwiseProduct(p);
        const Eigen::VectorXd error =
            rounding * (sizes * p + (std::abs)(c.mass()) * mass_.cwiseProduct(p)) + underflow;
        const Eigen::VectorXd weight = mass_.cwiseProduct(p);
        const Eigen::VectorXd quotient = (others + diagonal + error).cwiseQuotient(weight);
        // maxCoeff may pass over what is not a number: a weight that vanished, or overflow.
        const bool finite = detail::all_finite(quotient);
        if (!(weight.minCoeff() > 0) || !finite) break;
        best = (std::min)(best, quotient.maxCoeff());
        const Eigen::VectorXd powered = (others + diagonal.cwiseAbs()).cwiseQuotient(mass_);
        const double growth = powered.cwiseQuotient(p).maxCoeff();
        if (!(growth > 0)) break;
        // Averaging with the old p keeps a bipartite pattern from alternating.
        p = 0.5 * p + (0.5 / growth) * powered;
    }
    // A quotient that vanished by underflow is not zero.
    const double least = (std::numeric_limits<double>::min)();
    if (best >= 0 && best < least && sizes.nonZeros() > 0 && sizes.coeffs().maxCoeff() > 0)
        best = least;
    return best + 8 * std::numeric_limits<double>::epsilon() * (std::abs)(best);
}

template <class Scalar>
SparseMatrix<double> MatrixPencil<Scalar>::assemble(const Combination& c) const {
    Matrix S = on_K(c) * K_ + c.damping() * D_;
    Matrix mass(size(), size());
    mass.setIdentity();
    mass.diagonal() = c.mass() * mass_;
    S += mass;
    S.makeCompressed();
    return S;
}

/// Two products and two sums an entry.
template <class Scalar>
double MatrixPencil<Scalar>::assembly_error(const Combination& c, const Eigen::VectorXd& s) const {
    const Eigen::VectorXd row = magnitudes(c) * s + (std::abs)(c.mass()) * mass_.cwiseProduct(s);
    return 4 * std::numeric_limits<double>::epsilon() * s.cwiseProduct(row).maxCoeff();
}

/// D has no known part that follows K; its part d0·M follows M where it was recognised.
template <class Scalar>
std::shared_ptr<const BareMatrices> MatrixPencil<Scalar>::scaled(double stiffness, double mass,
                                                                 bool rayleigh) const {
    auto own = std::make_shared<MatrixPencil>(*this);
    own->mass_ *= mass;
    // An entry that vanished would take the allowance for its row's underflow with it.
    constexpr double least = (std::numeric_limits<double>::min)();
    own->K_ = K_.unaryExpr([&](double entry) {
        const double product = stiffness * entry;
        const bool zero = entry == 0 || stiffness == 0;
        return zero ? 0 : std::copysign((std::max)((std::abs)(product), least), product);
    });
    if (rayleigh) own->D_ *= mass;
    return own;
}

/// By which Stability(system) finds its pencil.
template <class Scalar>
std::shared_ptr<const Pencil> make_pencil(const LinearSystem<Scalar>& system) {
    return std::make_shared<const Pencil>(MatrixPencil<Scalar>::of(system));
}

}  // namespace taut
