// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <type_traits>
#include <utility>

#include "../core/buffer.hpp"
#include "../core/detail/finite.hpp"
#include "register.hpp"
#include "tile.hpp"
#include "triples.hpp"

namespace taut::step_detail {

/// `count` places from the first one.
struct Places {
    Index first, count;
};

/// Where the vectors of particles lie in planes.
template <class Scalar>
class Layout {
public:
    Layout() = default;
    /// @param order  the particle at each place; empty: particle i at place i
    /// @param stars  whether springs are in stars: then one plane holds points, x y z 0
    Layout(Index size, int dim, Buffer<int> order, bool stars)
        : order_(std::move(order)),
          size_(size),
          blocks_(size),
          planes_(stars ? 1 : dim),
          stars_(stars) {
        // No two planes of one vector begin at the same byte of a page: a store to one would hold
        // up loads of the other.
        const Index page = static_cast<Index>(4096 / sizeof(Scalar));
        stride_ = (size_ * grain() + 2 * max_width + page - 1) / page * page + page / 8;
    }

    /// n, the number of particles and of places.
    Index size() const { return size_; }
    Places all() const { return {0, size_}; }
    const Blocks& blocks() const { return blocks_; }
    bool has_stars() const { return stars_; }
    /// Whether particle i is at place i, its coordinates in planes.
    bool side_by_side() const { return order_.empty() && !stars_; }
    /// Of one vector.
    int planes() const { return planes_; }
    /// Scalars of a place in a plane.
    Index grain() const { return stars_ ? 4 : 1; }
    /// Scalars from one plane to the next: size()·grain() and the padding.
    Index stride() const { return stride_; }

    /// Planes ← points, Dim × size(), converted where they hold another number type: those of a
    /// tile's places, where planes begin, or all.
    template <class Matrix>
    void to_planes(const Matrix& points, const Planes<Scalar>& planes, Places of) const {
        TAUT_BY_KERNEL(to_planes(points), this, points.data(), &planes, &of);
        constexpr int Dim = Matrix::RowsAtCompileTime;
        if (side_by_side() && points.colStride() == Dim) {
            return split<Dim>(points.data() + Dim * of.first, planes, of.count);
        }
        for_each_place(of, [&](Index i, Index place) {
            for (int d = 0; d < Dim; ++d) at(planes, d, place) = static_cast<Scalar>(points(d, i));
            for (int d = Dim; d < 4 && stars_; ++d) at(planes, d, place) = 0;
        });
    }
    /// Points ← planes.
    template <class Matrix>
    void from_planes(const Planes<Scalar>& planes, Matrix& points, Places of) const {
        TAUT_BY_KERNEL(from_planes(points), this, &planes, points.data(), &of);
        constexpr int Dim = Matrix::RowsAtCompileTime;
        if (side_by_side() && points.colStride() == Dim) {
            return join<Dim>(planes, points.data() + Dim * of.first, of.count);
        }
        for_each_place(of, [&](Index i, Index place) {
            for (int d = 0; d < Dim; ++d) {
                points(d, i) = static_cast<typename Matrix::Scalar>(at(planes, d, place));
            }
        });
    }

    /// Plane ← values, one a particle; with stars, one for each scalar of its point.
    void to_plane(const Scalar* values, Scalar* plane) const {
        for_each_place(all(), [&](Index i, Index place) {
            std::fill_n(plane + grain() * place, grain(), values[i]);
        });
    }

    /// Of each particle.
    EIGEN_ALWAYS_INLINE Buffer<int> places() const {
        Buffer<int> result(static_cast<std::size_t>(size_));
        for_each_place(all(), [&](Index i, Index place) { result[i] = static_cast<int>(place); });
        return result;
    }
    /// The scalar of one axis at a place of planes.
    Scalar& at(const Planes<Scalar>& planes, int d, Index place) const {
        return planes.first[d * (stars_ ? 1 : planes.stride) + place * grain()];
    }

private:
    template <int Dim, class Number>
    static constexpr bool in_triples =
        Dim == 3 && std::is_same_v<Number, Scalar>&& Triples<Scalar>::exist;
    /// to_planes of points side by side, and from_planes: compilers make registers of these loops.
    template <int Dim, class From>
    void split(const From* EIGEN_RESTRICT points, const Planes<Scalar>& planes, Index count) const {
        Scalar* EIGEN_RESTRICT x = planes[0];
        Scalar* EIGEN_RESTRICT y = planes[Dim > 1];
        Scalar* EIGEN_RESTRICT z = planes[Dim > 2 ? 2 : 0];
        Index i = 0;
        if constexpr (in_triples<Dim, From>) {
            for (; i + Triples<Scalar>::n <= count; i += Triples<Scalar>::n)
                Triples<Scalar>::split(points + 3 * i, x + i, y + i, z + i);
        }
        for (; i < count; ++i) {
            x[i] = static_cast<Scalar>(points[Dim * i]);
            if constexpr (Dim > 1) y[i] = static_cast<Scalar>(points[Dim * i + 1]);
            if constexpr (Dim > 2) z[i] = static_cast<Scalar>(points[Dim * i + 2]);
        }
    }
    template <int Dim, class To>
    void join(const Planes<Scalar>& planes, To* EIGEN_RESTRICT points, Index count) const {
        const Scalar* EIGEN_RESTRICT x = planes[0];
        const Scalar* EIGEN_RESTRICT y = planes[Dim > 1];
        const Scalar* EIGEN_RESTRICT z = planes[Dim > 2 ? 2 : 0];
        Index i = 0;
        if constexpr (in_triples<Dim, To>) {
            for (; i + Triples<Scalar>::n <= count; i += Triples<Scalar>::n)
                Triples<Scalar>::join(x + i, y + i, z + i, points + 3 * i);
        }
        for (; i < count; ++i) {
            points[Dim * i] = static_cast<To>(x[i]);
            if constexpr (Dim > 1) points[Dim * i + 1] = static_cast<To>(y[i]);
            if constexpr (Dim > 2) points[Dim * i + 2] = static_cast<To>(z[i]);
        }
    }
    /// visit(particle, place), with places counted from the first one.
    template <class Visitor>
    void for_each_place(Places of, Visitor&& visit) const {
        if (order_.empty()) {
            for (Index i = 0; i < of.count; ++i) visit(of.first + i, i);
        } else {
            const int* order = order_.data() + of.first;
            for (Index i = 0; i < of.count; ++i) visit(order[i], i);
        }
    }

    Buffer<int> order_;
    Index size_ = 0;
    Blocks blocks_;
    Index stride_ = 0;
    int planes_ = 0;
    bool stars_ = false;
};

/// The vectors of planes by particle.
template <class Scalar, int Dim>
class PlaceVectors {
public:
    using Vector = Eigen::Matrix<Scalar, Dim, 1>;

    PlaceVectors(const Layout<Scalar>& layout, const Buffer<int>& places,
                 const Planes<Scalar>& planes)
        : places_(places),
          first_(planes.first),
          axis_(layout.has_stars() ? 1 : planes.stride),
          grain_(layout.grain()) {}

    Vector operator()(Index i) const {
        const Scalar* at = first_ + places_[i] * grain_;
        Vector vector;
        for (int d = 0; d < Dim; ++d) vector[d] = at[d * axis_];
        return vector;
    }
    void set(Index i, const Vector& vector) const {
        Scalar* at = first_ + places_[i] * grain_;
        for (int d = 0; d < Dim; ++d) at[d * axis_] = vector[d];
    }

private:
    const Buffer<int>& places_;
    Scalar* first_;
    Index axis_, grain_;
};

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
        swap_positions();
        std::swap(v, new_v);
    }
    void swap_positions() {
        std::swap(x, new_x);
        std::swap(spring_x, new_spring_x);
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
        Index vectors = 3;
        const Index old_x = looks_ahead ? vectors++ : 0;
        const Index new_x = !looks_ahead ? 1 : read.positions ? vectors++ : old_x;
        const Index new_v = read.velocities ? vectors++ : 2;
        const auto needed = static_cast<std::size_t>(vectors * planes * stride);
        if (!padded_ || memory_.size() != needed || size_ != size || stride_ != stride) {
            memory_.resize(needed);
            // The padding takes part in the steps: from rest.
            for (Index plane = 0; plane < vectors * planes; ++plane) {
                detail::set_zero(memory_.data() + plane * stride + size, stride - size);
            }
            padded_ = true;
        }
        planes_of_vector_ = planes;
        size_ = size;
        stride_ = stride;
        planes_ = {vector(old_x), vector(new_x), vector(0), vector(1), vector(2), vector(new_v)};
    }
    /// Sets spring_x to x + ahead·v, with `ahead` in s.
    void look_ahead(Scalar ahead) {
        TAUT_BY_KERNEL(look_ahead(), this, ahead);
        const Register step(ahead);
        for_each_register([&](Index i) {
            const Register x = Register::load(planes_.x.first + i);
            (x + step * Register::load(planes_.v.first + i)).store(planes_.spring_x.first + i);
        });
    }
    /// The length of a vector's planes one after another, padding included.
    Index whole() const { return planes_of_vector_ * stride_; }
    /// visit(i) for the first scalar of each register of these.
    template <class Visitor>
    void for_each_register(Visitor&& visit) const {
        for (Index i = 0; i < whole(); i += Register::width) visit(i);
    }
    bool finite() {
        padded_ = finite(planes_.x) && finite(planes_.v);  // else what is not may have spread there
        return padded_;
    }

    const StatePlanes<Scalar>& planes() const { return planes_; }
    void swap() { planes_.swap(); }
    void swap_positions() { planes_.swap_positions(); }

private:
    using Register = VectorRegister<Scalar>;

    bool finite(const Planes<Scalar>& of) const {
        for (int d = 0; d < planes_of_vector_; ++d) {
            if (!detail::all_finite(of[d], size_)) return false;
        }
        return true;
    }
    Planes<Scalar> vector(Index number) {
        return {memory_.data() + number * planes_of_vector_ * stride_, stride_};
    }

    int planes_of_vector_ = 0;
    bool padded_ = false;  // whether the padding is at rest
    Index size_ = 0;
    Index stride_ = 0;
    Buffer<Scalar> memory_;
    StatePlanes<Scalar> planes_;
};

}  // namespace taut::step_detail
