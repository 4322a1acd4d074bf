#!/bin/sh
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# bench/jolt_cloth.sh [SIDE]: the hanging cloth by Taut and by the soft body of Jolt Physics, in
# node. Installs jolt-physics from npm into build/jolt. Debian: emscripten nodejs npm libeigen3-dev.
set -eu
cd "$(dirname "$0")/.."
into=build/jolt
mkdir -p $into
npm install --silent --no-audit --no-fund --prefix $into jolt-physics@1.1.0
# Eigen 3.4 has SSE, but not WebAssembly's SIMD; emscripten 3.1.6 translates the one to the other.
# It lacks a header, which may be empty. What Eigen says in assembler are hints, and detours around
# mistakes of an older GCC. Without JavaScript of emscripten's own, which needs more packages.
mkdir -p $into/headers
: >$into/headers/mmintrin.h
em++ -std=c++17 -O3 -msimd128 -msse4.1 -fgnuc-version=7.0 '-D__asm__(...)=' -I$into/headers \
    -fno-exceptions -fno-rtti -DNDEBUG -Iinclude \
    -isystem "${EIGEN3_INCLUDE_DIR:-/usr/include/eigen3}" bench/jolt/taut_cloth.cpp \
    --no-entry -s ALLOW_MEMORY_GROWTH=1 -o $into/taut_cloth.wasm
exec node bench/jolt/cloth.mjs $into/taut_cloth.wasm $into/node_modules/jolt-physics "$@"
