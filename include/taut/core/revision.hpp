// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>

namespace taut {

/// A number that an object changes with its content: each of its values is larger than the ones
/// before, whether the object was edited or assigned to. A copy begins with the value of what it
/// copies.
class Revision {
public:
    Revision() = default;
    /// Begins with the value of the other.
    Revision(const Revision&) = default;
    /// Moves beyond both values.
    Revision& operator=(const Revision& other) {
        value_ = (std::max)(value_, other.value_) + 1;
        return *this;
    }
    ~Revision() = default;
    /// To be called after every edit.
    Revision& operator++() {
        ++value_;
        return *this;
    }
    /// 0 before the first edit.
    operator std::uint64_t() const { return value_; }

private:
    std::uint64_t value_ = 0;
};

}  // namespace taut
