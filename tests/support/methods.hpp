// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/conditions/visit.hpp>
#include <vector>

namespace taut_test {

inline const std::vector<taut::Method> all_methods = [] {
    std::vector<taut::Method> found;
    for (int i = 0; i <= static_cast<int>(taut::Method::last); ++i)
        found.push_back(static_cast<taut::Method>(i));
    return found;
}();

/// Those that Stability has a proof for.
inline const std::vector<taut::Method> limited_methods = [] {
    std::vector<taut::Method> found;
    for (const auto method : all_methods)
        if (!taut::method::is_limited_by<taut::method::Absent>(method)) found.push_back(method);
    return found;
}();

}  // namespace taut_test
