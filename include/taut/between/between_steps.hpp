// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include "../step/layout.hpp"

namespace taut {

/// A scene between two steps of step_between, where it lies in the stepper's memory.
///
/// Particles are those of the system, by index, in [0, size()). What is set holds from the next
/// step on, for pins, too.
template <class Scalar, int Dim>
class BetweenSteps {
public:
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;

    /// For steppers.
    BetweenSteps(const step_detail::Layout<Scalar>& layout, const Buffer<int>& places,
                 const step_detail::StatePlanes<Scalar>& planes, Scalar time)
        : size_(layout.size()),
          x_(layout, places, planes.x),
          v_(layout, places, planes.v),
          time_(time) {}

    /// The number of particles.
    Index size() const { return size_; }
    /// s.
    Scalar time() const { return time_; }
    /// A particle's position, m.
    Vector x(Index i) const { return x_(i); }
    /// A particle's velocity, m/s.
    Vector v(Index i) const { return v_(i); }
    /// Puts a particle somewhere, m.
    void set_x(Index i, const Vector& x) {
        x_.set(i, x);
        changed_ = true;
    }
    /// Gives a particle a velocity, m/s.
    void set_v(Index i, const Vector& v) {
        v_.set(i, v);
        changed_ = true;
    }
    /// Whether anything was set.
    bool changed() const { return changed_; }

private:
    Index size_;
    step_detail::PlaceVectors<Scalar, Dim> x_, v_;
    Scalar time_;
    bool changed_ = false;
};

}  // namespace taut
