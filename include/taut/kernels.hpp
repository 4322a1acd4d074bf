// SPDX-FileCopyrightText: 2026 Taut contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstring>

#include "core/assert.hpp"

// Which vector instructions the explicit steps of springs take.

namespace taut {

namespace detail {

/// What the compiler's flags allow.
constexpr const char* kernels_of_flags() {
#if defined(EIGEN_VECTORIZE_AVX512)
    return "avx512";
#elif defined(EIGEN_VECTORIZE_AVX2) && defined(EIGEN_VECTORIZE_FMA)
    return "avx2";
#elif defined(EIGEN_VECTORIZE_AVX)
    return "avx";
#elif defined(EIGEN_VECTORIZE_SSE2)
    return "sse2";
#elif defined(EIGEN_VECTORIZE_NEON)
    return "neon";
#elif defined(EIGEN_VECTORIZE)
    return "vector";
#else
    return "scalar";
#endif
}

}  // namespace detail

/// The kernels that steps take: the widest that Taut::Compiled has for this processor, "avx512" or
/// "avx2", or those that the environment variable TAUT_KERNELS names; where it has none, not on
/// x86-64 or by the CMake option, and by headers alone, those of the flags, such as "sse2".
///
/// Wide kernels fuse what narrow ones round twice: unlike processors give the same to rounding
/// only, but with TAUT_SAME_BITS, where all kernels give the same bits.
/// They are of the laws and scalars that compiled.hpp and compiled_laws.hpp list. A law of your own
/// is compiled with your program, for the registers of your program's flags.
TAUT_INLINE const char* kernels();
/// Takes others, for all steps from now on: for tests, or for the same rounding everywhere.
/// @returns whether there are such, the processor can, and they are no wider than what kernels()
///          said at first; if not, nothing changes
TAUT_INLINE bool set_kernels(const char* name);

#if !defined(TAUT_COMPILED)
inline const char* kernels() { return detail::kernels_of_flags(); }
inline bool set_kernels(const char* name) { return std::strcmp(name, kernels()) == 0; }
#endif

}  // namespace taut
