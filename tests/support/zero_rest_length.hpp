// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/scene/with_law.hpp>

namespace taut_test {

/// The same system with springs of rest length 0, which are linear: their K is the same at every
/// pose.
template <class System>
System at_zero_rest_length(const System& system) {
    return taut::with_springs<System>(system, [](System& copy, auto spring, taut::Index) {
        spring.rest_length = 0;
        copy.add_spring(std::move(spring));
    });
}

}  // namespace taut_test
