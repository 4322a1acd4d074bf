// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include "planes.hpp"

namespace taut::integrator_detail::sweep {

/// The planes of a state between two steps. What springs read of any place has a copy for the old
/// step and one for the new; the rest is stepped where it is.
template <class Scalar>
struct StatePlanes {
    Planes<Scalar> x, new_x;                // m; one and the same where springs look ahead
    Planes<Scalar> spring_x, new_spring_x;  // m, where springs take the particles to be: x, or
                                            // x + ahead·v
    Planes<Scalar> v, new_v;  // m/s; one and the same where no spring asks for velocities

    void swap() {
        std::swap(x, new_x);
        std::swap(spring_x, new_spring_x);
        std::swap(v, new_v);
    }
};

/// The memory of StatePlanes.
template <class Scalar>
class StateMemory {
public:
    /// Makes room for vectors of so many planes, `size` scalars in each, `stride` apart.
    /// @param looks_ahead      whether springs look ahead
    /// @param with_velocities  whether springs ask for velocities
    void resize(int planes, Index size, Index stride, bool looks_ahead, bool with_velocities) {
        planes_of_vector_ = planes;
        size_ = size;
        stride_ = stride;
        const Index vectors = 3 + (with_velocities ? 1 : 0) + (looks_ahead ? 1 : 0);
        memory_.resize(vectors * planes * stride);
        // The padding takes part in the steps: from rest.
        const Index padding = stride - size;
        for (Index end = stride; end <= memory_.size(); end += stride) {
            memory_.segment(end - padding, padding).setZero();
        }
        const Planes<Scalar> spring_x = vector(0);
        const Planes<Scalar> x = looks_ahead ? vector(3) : spring_x;
        const Index new_v = with_velocities ? (looks_ahead ? 4 : 3) : 2;
        planes_ = {x, looks_ahead ? x : vector(1), spring_x, vector(1), vector(2), vector(new_v)};
    }
    /// Sets spring_x to x + ahead·v, with `ahead` in s.
    void look_ahead(Scalar ahead) {
        whole(planes_.spring_x) = whole(planes_.x) + ahead * whole(planes_.v);
    }
    /// A vector's planes one after another, padding included.
    Eigen::Map<VectorX<Scalar>> whole(const Planes<Scalar>& of) const {
        return {of.first, planes_of_vector_ * stride_};
    }
    bool finite() const {
        // x − x is 0, or NaN where x is not finite; and so is the sum.
        const auto all = [&](const Planes<Scalar>& of) {
            Scalar sum = 0;
            for (int d = 0; d < planes_of_vector_; ++d) {
                const Eigen::Map<const VectorX<Scalar>> plane(of[d], size_);
                sum += (plane - plane).sum();
            }
            return sum == Scalar(0);
        };
        return all(planes_.x) && all(planes_.v);
    }

    const StatePlanes<Scalar>& planes() const { return planes_; }
    void swap() { planes_.swap(); }

private:
    Planes<Scalar> vector(Index number) {
        return {memory_.data() + number * planes_of_vector_ * stride_, stride_};
    }

    int planes_of_vector_ = 0;
    Index size_ = 0;
    Index stride_ = 0;
    VectorX<Scalar> memory_;
    StatePlanes<Scalar> planes_;
};

}  // namespace taut::integrator_detail::sweep
