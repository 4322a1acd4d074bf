// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "../core/detail/fits.hpp"
#include "../core/error.hpp"
#include "../core/revision.hpp"
#include "../integrator/detail/step_equation.hpp"
#include "../network/free_particles.hpp"
#include "../network/state.hpp"
#include "../solver/sparse_cholesky.hpp"

namespace taut {

namespace solver_detail {

/// visit(row, column, value) of the entries that are stored.
template <class Scalar, class Visit>
void for_each_entry(const SparseMatrix<Scalar>& A, Visit&& visit) {
    for (Index j = 0; j < A.outerSize(); ++j) {
        for (typename SparseMatrix<Scalar>::InnerIterator entry(A, j); entry; ++entry) {
            visit(entry.row(), j, entry.value());
        }
    }
}

}  // namespace solver_detail

/// Where a linearised system's degrees of freedom come from: those of the free particles of a
/// spring system. Empty for a system of the user's own matrices.
template <class Scalar>
struct FreeMap {
    int dim = 0;
    FreeParticles free;
    VectorX<Scalar> pose;  ///< N, m: the free coordinates that u = 0 stands for
};

/// The linear system M ü + D u̇ + K u = f [T1] with any sparse D and K, symmetric or not
/// (gyroscopic, follower or wind forces). M is diagonal, given as the vector of its diagonal.
template <class Scalar_>
class GeneralLinearSystem {
public:
    using Scalar = Scalar_;
    static constexpr int Dim = 1;
    using State = taut::State<Scalar, 1>;
    using Matrix = SparseMatrix<Scalar>;
    using Vector = VectorX<Scalar>;

    /// @param mass       N, kg, each finite and > 0
    /// @param damping    N × N, N·s/m; 0 × 0 means none
    /// @param stiffness  N × N, N/m
    /// @param load       N, N; of size 0 means none
    GeneralLinearSystem(Vector mass, Matrix damping, Matrix stiffness, Vector load = {});

    /// N, degrees of freedom.
    Index size() const { return mass_.size(); }
    /// N, kg: the diagonal of M.
    const Vector& mass() const { return mass_; }
    /// N, 1/kg.
    const Vector& inverse_mass() const { return inverse_mass_; }
    /// D, N × N, N·s/m; without nonzeros if none was given.
    const Matrix& damping() const { return damping_; }
    /// K, N × N, N/m.
    const Matrix& stiffness() const { return stiffness_; }
    /// f, N, N; zeros if none was given.
    const Vector& load() const { return load_; }
    /// Changes when another system is assigned to this one; nothing else changes the matrices.
    std::uint64_t revision() const { return revision_; }
    /// The same: the matrices are all that the force depends on.
    std::uint64_t force_revision() const { return revision_; }

    /// u = 0 and u̇ = 0 at time 0: the pose of linearisation, at rest.
    State initial_state() const { return {State::zero(size()), State::zero(size()), Scalar(0)}; }

    /// f ← load − K u − D u̇, N; f is resized to 1 × N.
    void force(const State& state, Points<Scalar, 1>& f) const;
    /// ½ u̇ᵀMu̇ + ½ uᵀKu − loadᵀu, J; meaningful for a symmetric K.
    Scalar energy(const State& state) const;

    /// The displacements and velocities of the free particles of `state`: 1 × N each.
    template <int SpringDim>
    State to_free(const taut::State<Scalar, SpringDim>& state) const;
    /// Writes them back; pinned particles keep what `state` has.
    template <int SpringDim>
    void from_free(const State& u, taut::State<Scalar, SpringDim>& state) const;
    /// What to_free() and from_free() go by; linearize() sets it.
    void set_free_map(FreeMap<Scalar> map) { map_ = std::move(map); }
    /// Empty for matrices of the user's own.
    const FreeMap<Scalar>& free_map() const { return map_; }

private:
    void require_state(const State& state) const;
    template <int SpringDim>
    void require_free_map(const taut::State<Scalar, SpringDim>& state) const;

    Vector mass_;          // N, kg
    Vector inverse_mass_;  // N, 1/kg
    Matrix damping_;       // N × N, N·s/m
    Matrix stiffness_;     // N × N, N/m
    Vector load_;          // N, N
    FreeMap<Scalar> map_;
    Revision revision_;
};

/// The paper's M, D, K, f with symmetric D and K, checked at construction [T1].
///
/// An asymmetry of a few ulp of the largest entry in either row of a pair, as assembly leaves it,
/// is averaged away; more is refused, with the entry named. Bring your own matrices, or call
/// linearize() springs.
template <class Scalar>
class LinearSystem : public GeneralLinearSystem<Scalar> {
public:
    using typename GeneralLinearSystem<Scalar>::Matrix;
    using typename GeneralLinearSystem<Scalar>::Vector;

    /// Arguments as for GeneralLinearSystem; an unsymmetric D or K goes to fail().
    LinearSystem(Vector mass, Matrix damping, Matrix stiffness, Vector load = {})
        : GeneralLinearSystem<Scalar>(std::move(mass), symmetric("damping", std::move(damping)),
                                      symmetric("stiffness", std::move(stiffness)),
                                      std::move(load)) {}

private:
    static Matrix symmetric(const char* argument, Matrix matrix);
};

/// The diagonal of M, refused unless M is square and diagonal; for matrices that come from files.
template <class Scalar>
VectorX<Scalar> diagonal_mass(const SparseMatrix<Scalar>& M) {
    if (M.rows() != M.cols()) {
        fail("diagonal_mass: M is ", M.rows(), " by ", M.cols(), "; it must be square");
    }
    VectorX<Scalar> mass = VectorX<Scalar>::Zero(M.rows());
    solver_detail::for_each_entry(M, [&](Index i, Index j, Scalar m) {
        if (i == j) {
            mass[j] = m;
        } else if (m != Scalar(0)) {
            fail("diagonal_mass: M(", i, ", ", j, ") is ", m, "; M must be diagonal");
        }
    });
    return mass;
}

template <class Scalar>
GeneralLinearSystem<Scalar>::GeneralLinearSystem(Vector mass, Matrix damping, Matrix stiffness,
                                                 Vector load)
    : mass_(std::move(mass)),
      damping_(std::move(damping)),
      stiffness_(std::move(stiffness)),
      load_(std::move(load)) {
    const Index N = mass_.size();
    if (N == 0) fail("LinearSystem: mass is empty; at least one degree of freedom is needed");
    for (Index i = 0; i < N; ++i) {
        // 1/mass must be finite too, or a step would divide by zero.
        if (!(mass_[i] > 0) || !detail::is_finite(mass_[i]) || !detail::is_finite(1 / mass_[i])) {
            fail("LinearSystem: mass[", i, "] is ", mass_[i], "; it must be finite and > 0");
        }
    }
    if (damping_.rows() == 0 && damping_.cols() == 0) damping_.resize(N, N);
    if (load_.size() == 0) load_ = Vector::Zero(N);
    if (load_.size() != N) {
        fail("LinearSystem: load has ", load_.size(), " entries; mass has ", N);
    }
    const auto require_fit = [N](const char* argument, Matrix& matrix) {
        if (matrix.rows() != N || matrix.cols() != N) {
            fail("LinearSystem: ", argument, " is ", matrix.rows(), " by ", matrix.cols(),
                 "; mass asks for ", N, " by ", N);
        }
        matrix.makeCompressed();
        solver_detail::for_each_entry(matrix, [&](Index i, Index j, Scalar value) {
            if (detail::is_finite(value)) return;
            fail("LinearSystem: ", argument, "(", i, ", ", j, ") is ", value,
                 "; it must be finite");
        });
    };
    require_fit("damping", damping_);
    require_fit("stiffness", stiffness_);
    for (Index i = 0; i < N; ++i) {
        if (!detail::is_finite(load_[i])) {
            fail("LinearSystem: load[", i, "] is ", load_[i], "; it must be finite");
        }
    }
    inverse_mass_ = mass_.cwiseInverse();
}

template <class Scalar>
void GeneralLinearSystem<Scalar>::require_state(const State& state) const {
    detail::require_fits("LinearSystem", state, size(), "the system has", "degrees of freedom");
}

template <class Scalar>
void GeneralLinearSystem<Scalar>::force(const State& state, Points<Scalar, 1>& f) const {
    require_state(state);
    f.resize(1, size());
    f = load_.transpose();
    f.transpose().noalias() -= stiffness_ * state.x.transpose();
    if (damping_.nonZeros() > 0) f.transpose().noalias() -= damping_ * state.v.transpose();
}

template <class Scalar>
Scalar GeneralLinearSystem<Scalar>::energy(const State& state) const {
    require_state(state);
    const Vector u = state.x.transpose();
    const Vector v = state.v.transpose();
    return Scalar(0.5) * v.dot(mass_.cwiseProduct(v)) + Scalar(0.5) * u.dot(stiffness_ * u) -
           load_.dot(u);
}

template <class Scalar>
template <int SpringDim>
void GeneralLinearSystem<Scalar>::require_free_map(
    const taut::State<Scalar, SpringDim>& state) const {
    if (map_.dim != SpringDim) {
        fail("LinearSystem: the system was not linearised from a SpringSystem of dimension ",
             SpringDim);
    }
    detail::require_fits("LinearSystem", state, map_.free.particles(), "the spring system has");
}

template <class Scalar>
template <int SpringDim>
auto GeneralLinearSystem<Scalar>::to_free(const taut::State<Scalar, SpringDim>& state) const
    -> State {
    require_free_map(state);
    State u = initial_state();
    u.time = state.time;
    Vector values;
    map_.free.gather(state.x, values);
    u.x = (values - map_.pose).transpose();
    map_.free.gather(state.v, values);
    u.v = values.transpose();
    return u;
}

template <class Scalar>
template <int SpringDim>
void GeneralLinearSystem<Scalar>::from_free(const State& u,
                                            taut::State<Scalar, SpringDim>& state) const {
    require_state(u);
    require_free_map(state);
    map_.free.scatter(Vector(map_.pose + u.x.transpose()), state.x);
    map_.free.scatter(Vector(u.v.transpose()), state.v);
    state.time = u.time;
}

template <class Scalar>
auto LinearSystem<Scalar>::symmetric(const char* argument, Matrix matrix) -> Matrix {
    if (matrix.rows() != matrix.cols()) return matrix;  // its shape is refused by the base class
    const Matrix transposed = matrix.transpose();
    const Matrix difference = matrix - transposed;
    Vector largest = Vector::Zero(matrix.rows());  // of each row and its column
    solver_detail::for_each_entry(matrix, [&](Index i, Index j, Scalar value) {
        for (const Index of : {i, j}) largest[of] = (std::max)(largest[of], (std::abs)(value));
    });
    // What a stiff row rounds is no excuse for a soft one.
    const auto rounding = [&](Index i, Index j) {
        return 16 * std::numeric_limits<Scalar>::epsilon() * (std::min)(largest[i], largest[j]);
    };
    bool exact = true;
    solver_detail::for_each_entry(difference, [&](Index i, Index j, Scalar value) {
        if ((std::abs)(value) > rounding(i, j)) {
            fail("LinearSystem: ", argument, "(", i, ", ", j, ") is ", matrix.coeff(i, j), " but (",
                 j, ", ", i, ") is ", matrix.coeff(j, i),
                 "; it must be symmetric (GeneralLinearSystem admits others)");
        }
        exact = exact && value == Scalar(0);
    });
    return exact ? matrix : Matrix(Scalar(0.5) * (matrix + transposed));
}

}  // namespace taut

#include "detail/matrix_equation.ipp"
