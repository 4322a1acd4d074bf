// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/tradeoff/mode_probe.hpp>

namespace taut_test {

/// A damped chain without load, and all its modes.
template <class Scalar>
struct ChainModes {
    taut::LinearSystem<Scalar> linear;
    std::vector<taut::Mode> modes;
};

/// Of float and double; compiled apart from the steppers.
template <class Scalar>
ChainModes<Scalar> chain_modes();

}  // namespace taut_test
