#!/bin/sh
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# Builds the stability lab into build/lab/site and serves it on this machine alone.
#   scripts/lab.sh [port]    builds what has changed and serves, on port 8000 unless told
#   scripts/lab.sh --build   builds only
#   scripts/lab.sh --test    builds, compares with a native program, and clicks through the page
set -eu
cd "$(dirname "$0")/.."

port=8000
task=serve
case "${1-}" in
    '') ;;
    --build) task=build ;;
    --test) task=test ;;
    *[!0-9]*) echo "lab: '$1' is neither a port nor --build nor --test" >&2; exit 1 ;;
    *) port=$1 ;;
esac

missing=
need() {  # command, Debian's package
    command -v "$1" >/dev/null || missing="$missing $2"
}
need em++ emscripten
need npm npm
[ "$task" = build ] || need python3 python3
if [ "$task" = test ]; then
    need g++ g++
    need node nodejs
    need chromium chromium
fi
eigen=${EIGEN3_INCLUDE_DIR:-/usr/include/eigen3}
[ -f "$eigen/Eigen/Core" ] || missing="$missing libeigen3-dev"
if [ -n "$missing" ]; then
    echo "lab: not here yet:$missing. On Debian, as root:" >&2
    echo "  apt-get install$missing" >&2
    [ -f "$eigen/Eigen/Core" ] || echo "or EIGEN3_INCLUDE_DIR=… for an Eigen elsewhere" >&2
    exit 1
fi

site=build/lab/site
packages=build/lab/packages
mkdir -p "$site/three" "$packages"

# newer FILE: whether anything that it is made from is newer than it, or it is not there.
newer() {
    [ ! -f "$1" ] || [ -n "$(find include lab/*.cpp lab/*.hpp scripts/lab.sh -newer "$1" -print -quit)" ]
}
flags="-std=c++17 -fno-exceptions -fno-rtti -DNDEBUG -Iinclude -isystem $eigen"
flags="$flags -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror"

if ! cmp -s lab/package-lock.json "$packages/package-lock.json"; then
    echo "lab: npm installs three and playwright-core, as pinned in lab/, into $packages"
    cp lab/package.json "$packages"
    (cd "$packages" && cp ../../../lab/package-lock.json wanted.json && mv wanted.json package-lock.json &&
        npm ci --silent --no-audit --no-fund) || { rm -f "$packages/package-lock.json"; exit 1; }
fi
if newer "$site/lab.wasm"; then
    echo "lab: compiling the library to WebAssembly, a minute"
    # shellcheck disable=SC2086  # a list of words
    em++ $flags -O3 -msimd128 lab/lab.cpp --no-entry -s ALLOW_MEMORY_GROWTH=1 -o "$site/lab.wasm"
fi
three=$packages/node_modules/three
cp "$three/build/three.module.js" "$three/build/three.core.js" "$three/LICENSE" \
    "$three/examples/jsm/controls/OrbitControls.js" "$site/three"
cp lab/index.html lab/lab.css lab/*.js examples/report/style.css examples/report/draw.js "$site"

case $task in
    serve)
        echo "lab: http://127.0.0.1:$port/ until you press Ctrl-C"
        exec python3 -m http.server --bind 127.0.0.1 --directory "$site" "$port"
        ;;
    test)
        if newer build/lab/positions; then
            echo "lab: compiling the same natively"
            # shellcheck disable=SC2086  # a list of words
            g++ $flags -O1 lab/lab.cpp lab/positions.cpp -o build/lab/positions
        fi
        node lab/check_same.mjs "$site/lab.wasm" build/lab/positions
        node lab/check_page.mjs "$site" "$packages" build/lab
        ;;
esac
