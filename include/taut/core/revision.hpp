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
    Revision(const Revision&) = default;
    Revision& operator=(const Revision& other) {
        value_ = std::max(value_, other.value_) + 1;
        return *this;
    }
    ~Revision() = default;
    Revision& operator++() {
        ++value_;
        return *this;
    }
    operator std::uint64_t() const { return value_; }

private:
    std::uint64_t value_ = 0;
};

}  // namespace taut
