// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

#include "layout.hpp"

namespace taut {

/// A scene between two steps of one call, where it lies in the stepper's memory: what a stepper's
/// step(state, h, count, between) gives to between(now).
///
/// Particles are those of the system, by index, in [0, size()). What is set holds from the next
/// step on, for pins, too.
template <class Scalar, int Dim>
class BetweenSteps {
public:
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;  // of Dim

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

namespace step_detail {

/// The caller's between(now), of whatever type.
template <class Scalar, int Dim>
class BetweenCall {
public:
    virtual void call(BetweenSteps<Scalar, Dim>& now) = 0;

protected:
    ~BetweenCall() = default;
};

template <class Scalar, int Dim, class Between>
class CallOf final : public BetweenCall<Scalar, Dim> {
    static_assert(std::is_invocable_v<Between&, BetweenSteps<Scalar, Dim>&>,
                  "taut: between(now) must take a taut::BetweenSteps<Scalar, Dim>&, or auto&");

public:
    explicit CallOf(Between& between) : between_(between) {}
    void call(BetweenSteps<Scalar, Dim>& now) override { between_(now); }

private:
    Between& between_;
};

}  // namespace step_detail
}  // namespace taut
