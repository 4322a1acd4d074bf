// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>

#include "../core/detail/fits.hpp"
#include "../core/status.hpp"
#include "../own_matrices/linear_system.hpp"
#include "modal_basis.hpp"
#include "../network/state.hpp"
#include "detail/mode_propagator.hpp"

namespace taut {

/// Modal dynamics (D. James, D. Pai, "DyRT", SIGGRAPH 2002): a scene in its lowest modes, each
/// stepped by its exact recurrence [T32]. Stable and exact in time at every h; what is lost is the
/// modes left out, and whatever is not linear.
///
/// A step costs O(r), the positions one pass over the shapes: Dim·n·r numbers of type Shape, which
/// is what bounds it, so float shapes halve the time.
///
///     static_equilibrium(net, state);
///     const auto linear = taut::linearize(net, state);
///     if (auto report = modal_analysis(linear, 50, basis); !report) return fail(report);
///     ModalDynamics<float, 3> modal(linear, state, basis);
/// @tparam Shape  of the shapes and the positions
/// @tparam Dim    of the spring system; 1 for matrices of the user's own
template <class Shape, int Dim>
class ModalDynamics {
public:
    using Scalar = Shape;
    using State = taut::State<Shape, Dim>;

    /// @param linear  the system that `basis` was made of
    /// @param pose    the state it was linearised at, Dim × n; for matrices of the user's own what
    ///                displacements are measured from
    template <class Real>
    ModalDynamics(const LinearSystem<Real>& linear, const taut::State<Real, Dim>& pose,
                  const ModalBasis& basis);

    /// Advances q and its rate by `count` steps of h, s, finite and > 0, under the constant load
    /// and the force last set. On failure nothing changes.
    Report step(double h, Index count = 1);
    /// Takes over a state: the modal part of its displacement and velocity.
    void set_state(const State& state);
    /// A force on every particle, Dim × n, N, from now on; what acts on pinned ones is ignored.
    void set_force(const Points<Shape, Dim>& force);

    /// r, the number of modes.
    Index size() const { return q_.size(); }
    /// s; the pose's, plus the steps since.
    double time() const { return time_; }
    const Eigen::ArrayXd& amplitudes() const { return q_; }       ///< r, m·√kg
    const Eigen::ArrayXd& amplitude_rates() const { return v_; }  ///< r, m·√kg/s
    /// x ← pose + Φq, m, Dim × n; allocates r numbers.
    void positions(Points<Shape, Dim>& x) const { expand(q_, &pose_, x); }
    /// v ← Φq̇, m/s, Dim × n.
    void velocities(Points<Shape, Dim>& v) const { expand(v_, nullptr, v); }
    /// positions() and velocities() of all particles, and time().
    State state() const;

private:
    using Shapes = Eigen::Matrix<Shape, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    using Flat = Eigen::Matrix<Shape, Eigen::Dynamic, 1>;

    void expand(const Eigen::ArrayXd& amplitudes, const Points<Shape, Dim>* offset,
                Points<Shape, Dim>& out) const;
    void set_step(double h);
    /// ΦᵀM of `values`, or Φᵀ alone.
    Eigen::ArrayXd project(const Points<Shape, Dim>& values, bool with_mass) const;

    Shapes shapes_;         // Φ with a row for every coordinate, zero where pinned; row-major, so
                            // that positions read it once and write once
    Eigen::VectorXd mass_;  // Dim·n, kg, 0 where pinned
    Points<Shape, Dim> pose_;              // m
    Eigen::ArrayXd k_, d_;                 // r, 1/s² and 1/s
    Eigen::ArrayXd load_, p_;              // r, of the load alone and with the force, m·√kg/s²
    Eigen::ArrayXd q_, v_;                 // r
    Eigen::ArrayXd next_, old_q_, old_v_;  // r
    double time_ = 0;                      // s
    double h_ = 0;                         // of the propagators, s
    Eigen::ArrayXd a11_, a12_, a21_, a22_, b1_, b2_;
};

template <class Shape, int Dim>
template <class Real>
ModalDynamics<Shape, Dim>::ModalDynamics(const LinearSystem<Real>& linear,
                                         const taut::State<Real, Dim>& pose,
                                         const ModalBasis& basis)
    : k_(basis.k), d_(basis.d), load_(basis.p) {
    const auto& map = linear.free_map();
    const bool springs = map.dim != 0;
    const FreeParticles free = springs ? map.free : FreeParticles::all(linear.size());
    const Index particles = free.particles();
    if ((springs ? map.dim : 1) != Dim || pose.x.cols() != particles ||
        basis.shapes.rows() != linear.size() || basis.shapes.cols() != basis.size() ||
        basis.d.size() != basis.size() || basis.p.size() != basis.size()) {
        fail("ModalDynamics: a pose of ", pose.x.cols(), " particles in ", Dim,
             " dimensions and shapes of ", basis.shapes.rows(), " rows; the system has ", particles,
             " particles and ", linear.size(), " degrees of freedom");
    }
    shapes_ = Shapes::Zero(Dim * particles, basis.size());
    mass_ = Eigen::VectorXd::Zero(Dim * particles);
    for (Index row = 0; row < linear.size(); ++row) {
        const Index to = Dim * free[row / Dim] + row % Dim;
        shapes_.row(to) = basis.shapes.row(row).template cast<Shape>();
        mass_[to] = static_cast<double>(linear.mass()[row]);
    }
    // What is below the rounding of its mode is noise, and slow where it meets denormal numbers.
    constexpr auto epsilon = static_cast<Shape>(std::numeric_limits<double>::epsilon());
    for (Index j = 0; j < basis.size(); ++j) {
        const Shape noise = epsilon * shapes_.col(j).cwiseAbs().maxCoeff();
        shapes_.col(j) =
            (shapes_.col(j).cwiseAbs().array() < noise).select(Shape(0), shapes_.col(j));
    }
    pose_ = pose.x.template cast<Shape>();
    p_ = load_;
    q_ = v_ = Eigen::ArrayXd::Zero(basis.size());
    time_ = static_cast<double>(pose.time);
}

template <class Shape, int Dim>
Report ModalDynamics<Shape, Dim>::step(double h, Index count) {
    if (!(h > 0) || !detail::is_finite(h)) return {Status::invalid_step};
    if (count <= 0) return {};
    set_step(h);
    old_q_ = q_;
    old_v_ = v_;
    for (Index i = 0; i < count; ++i) {
        next_ = a11_ * q_ + a12_ * v_ + b1_ * p_;
        v_ = a21_ * q_ + a22_ * v_ + b2_ * p_;
        q_.swap(next_);
    }
    if (!detail::all_finite(q_) || !detail::all_finite(v_)) {
        q_ = old_q_;
        v_ = old_v_;
        return {Status::diverged};
    }
    time_ += h * static_cast<double>(count);
    Report report;
    report.iterations = static_cast<int>(count);
    return report;
}

template <class Shape, int Dim>
void ModalDynamics<Shape, Dim>::set_step(double h) {
    if (h == h_) return;
    for (auto* a : {&a11_, &a12_, &a21_, &a22_, &b1_, &b2_}) a->resize(size());
    for (Index i = 0; i < size(); ++i) {
        const auto m = integrator_detail::ModePropagator::over(h, k_[i], d_[i]);
        a11_[i] = m.a11;
        a12_[i] = m.a12;
        a21_[i] = m.a21;
        a22_[i] = m.a22;
        b1_[i] = m.b1;
        b2_[i] = m.b2;
    }
    h_ = h;
}

template <class Shape, int Dim>
Eigen::ArrayXd ModalDynamics<Shape, Dim>::project(const Points<Shape, Dim>& values,
                                                  bool with_mass) const {
    const Eigen::Map<const Flat> flat(values.data(), values.size());
    Eigen::VectorXd weighted = flat.template cast<double>();
    if (with_mass) weighted = weighted.cwiseProduct(mass_).eval();
    return (shapes_.transpose().template cast<double>() * weighted).array();
}

template <class Shape, int Dim>
void ModalDynamics<Shape, Dim>::set_state(const State& state) {
    detail::require_fits("ModalDynamics::set_state", state, pose_.cols(), "the scene has");
    if (!state.finite()) {
        fail("ModalDynamics::set_state: particle ", state.first_not_finite(),
             " has a position or velocity that is not finite");
    }
    q_ = project(state.x - pose_, true);
    v_ = project(state.v, true);
    time_ = static_cast<double>(state.time);
}

template <class Shape, int Dim>
void ModalDynamics<Shape, Dim>::set_force(const Points<Shape, Dim>& force) {
    if (force.cols() != pose_.cols()) {
        fail("ModalDynamics::set_force: ", force.cols(), " particles; the scene has ",
             pose_.cols());
    }
    if (!detail::all_finite(force)) fail("ModalDynamics::set_force: a force is not finite");
    p_ = load_ + project(force, false);
}

template <class Shape, int Dim>
void ModalDynamics<Shape, Dim>::expand(const Eigen::ArrayXd& amplitudes,
                                       const Points<Shape, Dim>* offset,
                                       Points<Shape, Dim>& out) const {
    out.resize(Dim, pose_.cols());
    Eigen::Map<Flat> flat(out.data(), out.size());
    // A scene that has come to rest must not go on in denormal numbers.
    const double rest = std::sqrt(static_cast<double>((std::numeric_limits<Shape>::min)()));
    const Flat q =
        (amplitudes.cwiseAbs() < rest).select(0, amplitudes).matrix().template cast<Shape>();
    flat.noalias() = shapes_ * q;
    if (offset != nullptr) out += *offset;
}

template <class Shape, int Dim>
auto ModalDynamics<Shape, Dim>::state() const -> State {
    State state;
    positions(state.x);
    velocities(state.v);
    state.time = static_cast<Shape>(time_);
    return state;
}

}  // namespace taut
