// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>

#include "assert.hpp"

namespace taut {
namespace detail {

/// Memory for `bytes`, as Eigen aligns it, that begins with what `old` held, and which takes the
/// place of `old`. Plain: all element types share it.
#if defined(TAUT_COMPILED)  // there it begins with a cache line
TAUT_COLD void* regrow(void* old, std::size_t used, std::size_t bytes);
#else
TAUT_COLD TAUT_NOINLINE inline void* regrow(void* old, std::size_t used, std::size_t bytes) {
    void* grown = bytes > 0 ? Eigen::internal::aligned_malloc(bytes) : nullptr;
    if (used > 0) std::memcpy(grown, old, used);
    Eigen::internal::aligned_free(old);
    return grown;
}
#endif

/// Ends a debug build with an index beyond the end. Plain: all element types share it.
TAUT_COLD TAUT_NOINLINE inline void bad_index() { eigen_assert(false && "index out of range"); }

/// Sets numbers to 0.
template <class Number>
void set_zero(Number* numbers, Eigen::Index count) {
    static_assert(std::is_arithmetic_v<Number>);
    if (count > 0) std::memset(numbers, 0, static_cast<std::size_t>(count) * sizeof(Number));
}

/// Element i of a std::vector or std::array, counted by whatever integer.
template <class Elements, class Number>
decltype(auto) at(Elements& elements, Number i) {
    return elements[static_cast<std::size_t>(i)];
}

/// A std::array counted by int, as the lanes of registers are.
template <class T, int size>
struct Few {
    T items[static_cast<std::size_t>(size)];

    EIGEN_ALWAYS_INLINE T& operator[](int i) { return items[i]; }
    EIGEN_ALWAYS_INLINE const T& operator[](int i) const { return items[i]; }
    T* data() { return items; }
    const T* data() const { return items; }
    T* begin() { return items; }
    void fill(const T& value) {
        for (T& item : items) item = value;
    }
};

}  // namespace detail

/// A std::vector of plain numbers, as far as plans need one; it costs a program a tenth of the
/// code. Elements added without a value hold anything; sizes and indices are whatever integers.
template <class T>
class Buffer {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    Buffer() = default;
    /// `size` elements that hold anything.
    template <class Number>
    explicit Buffer(Number size) {
        resize(size);
    }
    /// `size` elements, each `value`.
    template <class Number>
    Buffer(Number size, const T& value) {
        assign(size, value);
    }
    /// The same elements.
    Buffer(const Buffer& other) { copy(other); }
    /// Takes the elements of `other`.
    Buffer(Buffer&& other) noexcept { swap(other); }
    /// The same elements, in place of these.
    Buffer& operator=(const Buffer& other) {
        if (this != &other) copy(other);
        return *this;
    }
    /// Exchanges the elements with those of `other`.
    Buffer& operator=(Buffer&& other) noexcept {
        swap(other);
        return *this;
    }
    ~Buffer() { Eigen::internal::aligned_free(data_); }

    /// The number of elements.
    std::size_t size() const { return size_; }
    /// Whether there is none.
    bool empty() const { return size_ == 0; }
    /// The first of them, in one piece.
    T* data() { return data_; }
    /// The first of them, in one piece.
    const T* data() const { return data_; }
    /// For loops over them.
    T* begin() { return data_; }
    /// Behind the last one.
    T* end() { return data_ + size_; }
    /// For loops over them.
    const T* begin() const { return data_; }
    /// Behind the last one.
    const T* end() const { return data_ + size_; }
    /// Element i; checked where Eigen checks its own.
    template <class Number>
    T& operator[](Number i) {
        require_index(static_cast<std::size_t>(i));
        return data_[i];
    }
    /// Element i.
    template <class Number>
    const T& operator[](Number i) const {
        require_index(static_cast<std::size_t>(i));
        return data_[i];
    }
    /// The last one.
    const T& back() const { return (*this)[size_ - 1]; }
    /// The last one.
    T& back() { return (*this)[size_ - 1]; }

    /// Takes memory for `capacity` elements.
    void reserve(std::size_t capacity) {
        if (capacity > capacity_) set_capacity(capacity);
    }
    /// Has `size` elements; those that are new hold anything.
    template <class Number>
    void resize(Number size) {
        reserve(static_cast<std::size_t>(size));
        size_ = static_cast<std::size_t>(size);
    }
    /// Has `size` elements; those that are new are `value`.
    template <class Number>
    void resize(Number size, const T& value) {
        const T all = value;  // which may lie in this buffer
        const std::size_t old = size_, now = static_cast<std::size_t>(size);
        if (now > capacity_) set_capacity((std::max)(now, 2 * capacity_));
        size_ = now;
        if (now > old) std::fill(data_ + old, data_ + now, all);
    }
    /// `size` elements, each `value`, in place of these.
    template <class Number>
    void assign(Number size, const T& value) {
        const T all = value;
        size_ = 0;
        resize(size, all);
    }
    /// Adds an element behind the last one.
    void push_back(const T& value) {
        const T added = value;
        if (size_ == capacity_) set_capacity(2 * capacity_ + 8);
        data_[size_++] = added;
    }
    /// Removes all, and keeps their memory.
    void clear() { size_ = 0; }
    /// Gives back what is not used.
    void fit() {
        if (size_ < capacity_) set_capacity(size_);
    }

private:
    void require_index([[maybe_unused]] std::size_t i) const {
#if !defined(EIGEN_NO_DEBUG)
        if (i >= size_) detail::bad_index();
#endif
    }
    void set_capacity(std::size_t capacity) {
        data_ = static_cast<T*>(detail::regrow(data_, size_ * sizeof(T), capacity * sizeof(T)));
        capacity_ = capacity;
    }
    void copy(const Buffer& other) {
        resize(other.size_);
        if (size_ > 0) std::memcpy(static_cast<void*>(data_), other.data_, size_ * sizeof(T));
    }
    void swap(Buffer& other) noexcept {
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
        std::swap(capacity_, other.capacity_);
    }

    T* data_ = nullptr;
    std::size_t size_ = 0;
    std::size_t capacity_ = 0;
};

}  // namespace taut
