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
# Without JavaScript of emscripten's own, which needs more packages.
# shellcheck disable=SC2046  # a list of words
em++ -std=c++17 -O3 $(scripts/wasm_simd.sh $into/headers) -fno-exceptions -fno-rtti -DNDEBUG -Iinclude \
    -isystem "${EIGEN3_INCLUDE_DIR:-/usr/include/eigen3}" bench/jolt/taut_cloth.cpp \
    --no-entry -s ALLOW_MEMORY_GROWTH=1 -o $into/taut_cloth.wasm
exec node bench/jolt/cloth.mjs $into/taut_cloth.wasm $into/node_modules/jolt-physics "$@"
