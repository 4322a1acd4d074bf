// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

// What the library's own units include before any header of Taut: there some functions ask
// kernels.hpp for one that is for this processor.

#if defined(TAUT_KERNELS)
namespace taut::detail {
template <class Scalar>
struct Kernels;
}  // namespace taut::detail
#define TAUT_BY_KERNEL(find, ...) \
    if (const auto kernel = detail::Kernels<Scalar>::find) return kernel(__VA_ARGS__)
#endif
