// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/core/method.hpp>

namespace taut_test {

inline constexpr taut::Method all_methods[] = {
    taut::Method::explicit_euler, taut::Method::symplectic_euler, taut::Method::velocity_verlet,
    taut::Method::implicit_euler};

}  // namespace taut_test
