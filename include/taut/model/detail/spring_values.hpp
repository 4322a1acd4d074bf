// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstring>
#include <type_traits>
#include <vector>

#include "../spring_set.hpp"
#include "lanes.hpp"

namespace taut::detail {

template <class Law, class = void>
inline constexpr bool is_vectorizable_v = false;
/// Whether a law says that its functions are plain arithmetic, which Lanes can do as well as a
/// number (docs/concepts.md).
template <class Law>
inline constexpr bool is_vectorizable_v<Law, std::void_t<decltype(Law::vectorizable)>> =
    Law::vectorizable;

/// Rest lengths, dampings and parameters of one law's springs, in whatever order they were added.
/// What all springs of an addition share is kept once.
template <class Scalar, class Law>
class SpringValues {
    using Parameters = typename Law::template Parameters<Scalar>;
    using Pack = Lanes<Scalar>;
    using PackParameters = typename Law::template Parameters<Pack>;
    static constexpr bool in_lanes = is_vectorizable_v<Law>;
    static constexpr std::size_t fields = in_lanes ? sizeof(Parameters) / sizeof(Scalar) : 0;
    static_assert(!in_lanes || (std::is_trivially_copyable_v<Parameters> &&
                                sizeof(Parameters) == fields * sizeof(Scalar)),
                  "taut::SpringSystem: the Parameters of a vectorizable law hold Scalars only");

    struct Column {
        std::size_t at = 0;
        std::size_t stride = 0;  // 0: one value for all
    };
    struct Stream {
        const Scalar* at;
        std::size_t step;
        EIGEN_ALWAYS_INLINE Pack load() const { return Pack::load(at); }
        EIGEN_ALWAYS_INLINE void next() { at += step; }
    };

public:
    /// The springs of one addition.
    struct Slice {
        Column rest_length;
        Column damping;
        Column parameters;                 // of a law that is not vectorizable
        std::array<Column, fields> field;  // of one that is
    };

    /// In the place of an index: no spring, with parameters that a law can take.
    static int gap(int neighbour) { return -1 - neighbour; }

    /// Takes springs and gaps of `set`. Call finish() after the last addition.
    Slice add(const SpringSet<Scalar, Law>& set, const std::vector<int>& index) {
        const auto spring = [&](std::size_t i) { return index[i] < 0 ? gap(index[i]) : index[i]; };
        Slice slice;
        slice.rest_length = add_column(index.size(), [&](std::size_t i) {
            return index[i] < 0 ? Scalar(-1) : set.rest_length[index[i]];
        });
        if (!set.damping.empty()) {
            slice.damping =
                add_column(index.size(), [&](std::size_t i) { return set.damping[spring(i)]; });
        }
        if constexpr (in_lanes) {
            for (std::size_t f = 0; f < fields; ++f) {
                slice.field[f] = add_column(index.size(), [&](std::size_t i) {
                    std::array<Scalar, fields> values;
                    std::memcpy(values.data(), &set.parameters[spring(i)], sizeof values);
                    return values[f];
                });
            }
        } else {
            slice.parameters = {parameters_.size(), 1};
            for (std::size_t i = 0; i < index.size(); ++i) {
                parameters_.push_back(set.parameters[spring(i)]);
            }
        }
        return slice;
    }
    /// Lets the last springs be read a whole register at a time.
    void finish() {
        numbers_.resize(numbers_.size() + most_lanes, Scalar(0));
        if (!parameters_.empty()) {
            parameters_.resize(parameters_.size() + most_lanes, Parameters(parameters_.back()));
        }
        numbers_.shrink_to_fit();
        parameters_.shrink_to_fit();
    }

    /// Springs of a slice, as many as a register has lanes, going forward.
    class Cursor {
    public:
        /// At spring i of the slice.
        Cursor(const SpringValues& values, const Slice& slice, std::size_t i)
            : rest_length_(values.stream(slice.rest_length, i)),
              damping_(values.stream(slice.damping, i)) {
            if constexpr (!in_lanes) {
                parameters_ = values.parameters_.data() + slice.parameters.at + i;
            }
            for (std::size_t f = 0; f < fields; ++f) field_[f] = values.stream(slice.field[f], i);
        }
        EIGEN_ALWAYS_INLINE void next() {
            rest_length_.next();
            damping_.next();
            for (auto& field : field_) field.next();
            if constexpr (!in_lanes) parameters_ += Pack::size;
        }
        EIGEN_ALWAYS_INLINE Pack damping() const { return damping_.load(); }
        /// `value` where there is a spring and 0 in the gaps.
        EIGEN_ALWAYS_INLINE Pack unless_gap(const Pack& value) const {
            return unless_negative(rest_length_.load(), value);
        }
        /// function(p, L, more…) of each spring.
        template <class Function, class... More>
        EIGEN_ALWAYS_INLINE Pack evaluate(Function function, const More&... more) const {
            const Pack L = rest_length_.load();
            if constexpr (in_lanes) {
                std::array<Pack, fields> values;
                for (std::size_t f = 0; f < fields; ++f) values[f] = field_[f].load();
                PackParameters p;
                std::memcpy(&p, values.data(), sizeof p);
                return function(p, L, more...);
            } else {
                // A gap has a length that no spring has; a law must not see it.
                return one_by_one(function, Register(max(L, Pack(Scalar(0)))), Register(more)...);
            }
        }

    private:
        template <class Function, class... More>
        Pack one_by_one(Function function, const More&... lanes) const {
            std::array<Scalar, Pack::size> result;
            for (std::size_t k = 0; k < result.size(); ++k) {
                result[k] = function(parameters_[k], lanes.values[k]...);
            }
            return Pack::load(result.data());
        }

        Stream rest_length_;
        Stream damping_;
        std::array<Stream, fields> field_;
        const Parameters* parameters_ = nullptr;
    };

private:
    /// A register as an array.
    struct Register {
        std::array<Scalar, Pack::size> values;
        explicit Register(const Pack& pack) { pack.store(values.data()); }
    };

    Stream stream(const Column& column, std::size_t i) const {
        return {numbers_.data() + column.at + column.stride * i, column.stride * Pack::size};
    }
    template <class Value>
    Column add_column(std::size_t count, Value value) {
        bool same = true;
        for (std::size_t i = 1; i < count && same; ++i) same = value(i) == value(0);
        if (same && shared_ < numbers_.size() && numbers_[shared_] == value(0)) {
            return {shared_, 0};
        }
        // Aligned like the particles' planes, a register never lies across two cache lines.
        const std::size_t at = (numbers_.size() + most_lanes - 1) / most_lanes * most_lanes;
        numbers_.resize(at, Scalar(0));
        if (same) {
            numbers_.resize(at + most_lanes, value(0));
            shared_ = at;
        } else {
            for (std::size_t i = 0; i < count; ++i) numbers_.push_back(value(i));
        }
        return {at, same ? 0u : 1u};
    }

    std::vector<Scalar, Eigen::aligned_allocator<Scalar>> numbers_;  // columns one after another
    std::vector<Parameters> parameters_;    // of a law that is not vectorizable
    std::size_t shared_ = std::size_t(-1);  // the last column of one value, or none
};

}  // namespace taut::detail
