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

/// The widest kernels that Taut::Compiled has for this processor, "avx512" or "avx2" if it was
/// built with TAUT_KERNELS, or those of its own flags, such as "sse2". By headers alone: those of
/// the program's flags.
///
/// Wide kernels fuse what the rest of the library rounds twice: n steps of velocity Verlet together
/// and one by one, which differ by what lies between them, are the same to rounding only.
/// They are of the laws and scalars that compiled.hpp and compiled_laws.hpp list. A law of your own
/// is compiled with your program, for the registers of your program's flags.
TAUT_INLINE const char* kernels();
/// Takes others, for all steps from now on: for tests, or for the same rounding on unlike
/// processors. TAUT_SAME_BITS does without: all kernels give the same bits then.
/// @returns whether there are such and the processor can; if not, nothing changes
TAUT_INLINE bool set_kernels(const char* name);

#if !defined(TAUT_COMPILED)
inline const char* kernels() { return detail::kernels_of_flags(); }
inline bool set_kernels(const char* name) { return std::strcmp(name, kernels()) == 0; }
#endif

}  // namespace taut
