// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#include "compiled_modes.hpp"

namespace taut::stability_detail {
template MatrixX<double> low_modes<double>(const Pencil&);
}  // namespace taut::stability_detail
