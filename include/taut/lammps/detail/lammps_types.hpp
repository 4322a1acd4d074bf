// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <unordered_map>
#include <vector>

#include "../../core/types.hpp"

namespace taut::io_detail {

/// Distinct pairs of numbers, numbered from 1 in the order in which they are met. LAMMPS keeps
/// what bonds and atoms are made of once for each type, not once for each bond or atom.
class TypeTable {
public:
    struct Key {
        double first;
        double second;
        bool operator==(const Key& other) const {
            return first == other.first && second == other.second;
        }
    };

    /// @param most  no more types than these
    explicit TypeTable(Index most) : most_(most) {}

    /// The number of the key's type, which may be new; 0 where there is no room for it.
    Index add(const Key& key) {
        if (!keys_.empty() && keys_[last_ - 1] == key) return static_cast<Index>(last_);
        const auto found = number_.find(key);
        if (found == number_.end()) {
            if (size() >= most_) return 0;
            keys_.push_back(key);
            number_.emplace(key, size());
            last_ = keys_.size();
        } else {
            last_ = static_cast<std::size_t>(found->second);
        }
        return static_cast<Index>(last_);
    }
    Index size() const { return static_cast<Index>(keys_.size()); }
    /// Key of type t is keys()[t − 1].
    const std::vector<Key>& keys() const { return keys_; }

private:
    struct Hash {
        std::size_t operator()(const Key& key) const {
            return static_cast<std::size_t>(bits(key.first) * 0x9e3779b97f4a7c15U ^
                                            (bits(key.second) * 0xc2b2ae3d27d4eb4fU >> 7));
        }
        static std::uint64_t bits(double number) {
            number += 0.0;  // −0 equals 0, so it must have its bits
            std::uint64_t b = 0;
            std::memcpy(&b, &number, sizeof b);
            return b ^ b >> 29;
        }
    };

    Index most_;
    std::size_t last_ = 0;  // the type last asked for: neighbours in a file are often alike
    std::vector<Key> keys_;
    std::unordered_map<Key, Index, Hash> number_;
};

}  // namespace taut::io_detail
