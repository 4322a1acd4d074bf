// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

#include "../core/types.hpp"

namespace taut {

/// Rows of Width numbers that lie in the memory of someone else, or one number for all of them.
template <class T, int Width>
class ArrayView {
    template <class Container>
    using IfOfNumbers = std::enable_if_t<
        std::is_convertible_v<decltype(std::declval<const Container&>().data()), const T*>>;

public:
    /// 0 for all.
    ArrayView() = default;
    /// The same number for all. A template, or 0 might be a pointer too.
    template <class Number, std::enable_if_t<std::is_arithmetic_v<Number>, int> = 0>
    ArrayView(Number number) : number_(static_cast<T>(number)), given_(true) {}
    /// All numbers of a container with data() and size(), row after row: std::vector<T>, or a
    /// matrix of Eigen with a row in each column. It must live until the call is over.
    template <class Container, class = IfOfNumbers<Container>>
    ArrayView(Container&& numbers)
        : first_(numbers.data()),
          stride_(Width * sizeof(T)),
          rows_(static_cast<Index>(numbers.size()) / Width),
          given_(true) {
        static_assert(
            std::is_lvalue_reference_v<Container> ||
                std::is_trivially_copyable_v<std::remove_reference_t<Container>>,
            "taut::SpringArrays: a container without a name may be gone before it is read");
    }
    /// @param first  of the first row   @param stride  bytes from row to row
    ArrayView(const T* first, std::size_t stride)
        : first_(first), stride_(stride), given_(first != nullptr) {}
    /// A pointer alone may be one into a struct.
    template <class Pointer, std::enable_if_t<std::is_pointer_v<Pointer>, int> = 0>
    ArrayView(Pointer) {
        static_assert(!std::is_pointer_v<Pointer>,
                      "taut::SpringArrays: a pointer needs its stride in bytes, as in "
                      "{&body[0].mass, sizeof(Body)}; numbers side by side may be a container");
    }

    /// Whether there is anything: an array, or one number.
    explicit operator bool() const { return given_; }
    /// The rows of a container; −1 for a pointer and for one number.
    Index rows() const { return rows_; }
    /// Number k of row i.
    T operator()(Index i, int k = 0) const {
        if (!first_) return number_;
        const auto* row = reinterpret_cast<const std::byte*>(first_) + std::size_t(i) * stride_;
        return reinterpret_cast<const T*>(row)[k];
    }

private:
    const T* first_ = nullptr;
    std::size_t stride_ = 0;
    Index rows_ = -1;
    T number_ = 0;
    bool given_ = false;
};

}  // namespace taut
