// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <taut/mass_scaling/detail/low_modes.hpp>

#include "compiled_once.hpp"

namespace taut::stability_detail {
extern template MatrixX<double> low_modes<double>(const Pencil&);
}  // namespace taut::stability_detail
