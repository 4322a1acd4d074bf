#!/bin/sh
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# scripts/wasm_simd.sh DIR: prints em++'s flags by which Eigen 3.4 steps in registers in WebAssembly.
# Eigen has SSE, but not WebAssembly's SIMD; emscripten 3.1.6 translates the one to the other. It
# lacks a header, which may be empty: in DIR. What Eigen says in assembler are hints, and detours
# around mistakes of an older GCC.
set -eu
mkdir -p "$1"
: >"$1/mmintrin.h"
echo "-msimd128 -msse4.1 -fgnuc-version=7.0 -D__asm__(...)= -I$1"
