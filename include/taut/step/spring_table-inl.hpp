// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstring>

#include "spring_table.hpp"

namespace taut::step_detail {

template <class Scalar>
void ColumnTable<Scalar>::add_column(const void* values, std::size_t apart,
                                     const Buffer<int>& index, int first, int end, bool gaps) {
    const auto count = static_cast<std::size_t>(end - first);
    columns_.push_back({});
    if (count == 0) return;
    const std::size_t size = numbers_.size();
    // Aligned like the planes, a register never lies across two cache lines.
    const std::size_t begin = (size + max_width - 1) / max_width * max_width;
    numbers_.resize(begin + count, Scalar(0));
    Scalar* column = numbers_.data() + begin;
    bool same = true;
    for (std::size_t i = 0; i < count; ++i) {
        const int at = index[static_cast<std::size_t>(first) + i];
        const int spring = at < 0 ? gap(at) : at;
        std::memcpy(column + i,
                    static_cast<const char*>(values) + apart * static_cast<std::size_t>(spring),
                    sizeof(Scalar));
        if (gaps && at < 0) column[i] = Scalar(-1);
        same = same && column[i] == column[0];
    }
    if (!same) {
        columns_.back() = {begin, 1};
        return;
    }
    const Scalar value = column[0];
    if (shared_ < size && numbers_[shared_] == value) {
        numbers_.resize(size);
    } else {
        numbers_.resize(begin);
        numbers_.resize(begin + max_width, value);
        shared_ = begin;
    }
    columns_.back() = {shared_, 0};
}

}  // namespace taut::step_detail
