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

public:
    /// The springs of one addition.
    struct Slice {
        Column rest_length;
        Column damping;
        Column parameters;                  // of a law that is not vectorizable
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

    /// `value` where there is a spring and 0 in the gaps.
    EIGEN_ALWAYS_INLINE Pack unless_gap(const Slice& slice, std::size_t i, const Pack& value) const {
        const Pack zero(Scalar(0));
        return where_less(load(slice.rest_length, i), zero, zero, value);
    }
    EIGEN_ALWAYS_INLINE Pack damping(const Slice& slice, std::size_t i) const { return load(slice.damping, i); }

    /// function(p, L, more…) of springs i, i + 1, … of a slice, one a lane.
    template <class Function, class... More>
    EIGEN_ALWAYS_INLINE Pack evaluate(const Slice& slice, std::size_t i, Function function, const More&... more) const {
        const Pack L = load(slice.rest_length, i);
        if constexpr (in_lanes) {
            std::array<Pack, fields> values;
            for (std::size_t f = 0; f < fields; ++f) values[f] = load(slice.field[f], i);
            PackParameters p;
            std::memcpy(&p, values.data(), sizeof p);
            return function(p, L, more...);
        } else {
            return one_by_one(slice, i, function, Lane(L), Lane(more)...);
        }
    }

private:
    /// A register as an array.
    struct Lane {
        std::array<Scalar, Pack::size> values;
        explicit Lane(const Pack& pack) { pack.store(values.data()); }
    };

    EIGEN_ALWAYS_INLINE Pack load(const Column& column, std::size_t i) const {
        return Pack::load(numbers_.data() + column.at + column.stride * i);
    }
    template <class Function, class... More>
    Pack one_by_one(const Slice& slice, std::size_t i, Function function, const More&... lanes) const {
        std::array<Scalar, Pack::size> result;
        for (std::size_t k = 0; k < result.size(); ++k) {
            result[k] = function(parameters_[slice.parameters.at + i + k], lanes.values[k]...);
        }
        return Pack::load(result.data());
    }
    template <class Value>
    Column add_column(std::size_t count, Value value) {
        bool same = true;
        for (std::size_t i = 1; i < count && same; ++i) same = value(i) == value(0);
        if (same && shared_ < numbers_.size() && numbers_[shared_] == value(0)) {
            return {shared_, 0};
        }
        const std::size_t at = numbers_.size();
        if (same) {
            numbers_.resize(at + most_lanes, value(0));
            shared_ = at;
        } else {
            for (std::size_t i = 0; i < count; ++i) numbers_.push_back(value(i));
        }
        return {at, same ? 0u : 1u};
    }

    std::vector<Scalar> numbers_;         // columns one after another
    std::vector<Parameters> parameters_;  // of a law that is not vectorizable
    std::size_t shared_ = std::size_t(-1);  // the last column of one value, or none
};

}  // namespace taut::detail
