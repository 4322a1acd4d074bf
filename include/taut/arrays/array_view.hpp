// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <type_traits>

#include "../core/types.hpp"

namespace taut {

/// Rows of Width numbers that lie in the memory of someone else, or one number for all of them.
template <class T, int Width>
class ArrayView {
public:
    /// 0 for all.
    ArrayView() = default;
    /// The same number for all. A template, or 0 might be a pointer too.
    template <class Number, class = std::enable_if_t<std::is_arithmetic_v<Number>>>
    ArrayView(Number number) : number_(static_cast<T>(number)) {}
    /// @param first  of the first row   @param stride  bytes from row to row
    ArrayView(const T* first, std::size_t stride = Width * sizeof(T))
        : first_(first), stride_(stride) {}

    /// Whether there is an array.
    explicit operator bool() const { return first_ != nullptr; }
    /// Number k of row i.
    T operator()(Index i, int k = 0) const {
        if (!first_) return number_;
        const auto* row = reinterpret_cast<const std::byte*>(first_) + std::size_t(i) * stride_;
        return reinterpret_cast<const T*>(row)[k];
    }

private:
    const T* first_ = nullptr;
    std::size_t stride_ = 0;
    T number_ = 0;
};

}  // namespace taut
