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
    Planes<Scalar> x, new_x;                // m; the same memory where springs look ahead and
                                            // nothing else reads another place's x
    Planes<Scalar> spring_x, new_spring_x;  // m, where springs take the particles to be: x, or
                                            // x + ahead·v
    Planes<Scalar> v, new_v;  // m/s; the same memory where nothing reads another place's v

    void swap() {
        std::swap(x, new_x);
        std::swap(spring_x, new_spring_x);
        std::swap(v, new_v);
    }
};

/// What a step reads of any place, beside the positions that springs see.
struct ReadAnywhere {
    bool velocities;  // by damped springs, or an outside force
    bool positions;   // by an outside force
};

/// The memory of StatePlanes.
template <class Scalar>
class StateMemory {
public:
    /// Makes room for vectors of so many planes, `size` scalars in each, `stride` apart.
    /// @param looks_ahead  whether springs look ahead
    void resize(int planes, Index size, Index stride, bool looks_ahead, const ReadAnywhere& read) {
        planes_of_vector_ = planes;
        size_ = size;
        stride_ = stride;
        Index vectors = 3;
        const Index old_x = looks_ahead ? vectors++ : 0;
        const Index new_x = !looks_ahead ? 1 : read.positions ? vectors++ : old_x;
        const Index new_v = read.velocities ? vectors++ : 2;
        memory_.resize(vectors * planes * stride);
        // The padding takes part in the steps: from rest.
        const Index padding = stride - size;
        for (Index end = stride; end <= memory_.size(); end += stride) {
            memory_.segment(end - padding, padding).setZero();
        }
        planes_ = {vector(old_x), vector(new_x), vector(0), vector(1), vector(2), vector(new_v)};
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
