#!/bin/sh
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# Builds the stability lab: a folder of static files that any web server can host, and beside it the
# same as one HTML file that a browser opens by itself.
#   scripts/lab.sh [port]         builds what has changed and serves, on port 8000 unless told
#   scripts/lab.sh --build [DIR]  builds only: DIR and DIR.html, build/lab/site unless told
#   scripts/lab.sh --test         builds, compares with a native program, and clicks through the page
#   scripts/lab.sh --picture      builds, and makes docs/images/lab.png anew
set -eu
from=$(pwd)
cd "$(dirname "$0")/.."

port=8000
task=serve
site=build/lab/site
case "${1-}" in
    '') ;;
    --build)
        task=build
        case "${2-}" in
            '') ;;
            -*) echo "lab: '$2' is no folder" >&2; exit 1 ;;
            /*) site=$2 ;;
            *) site=$from/$2 ;;
        esac
        site=${site%/}
        ;;
    --test) task=test ;;
    --picture) task=picture ;;
    *[!0-9]*) echo "lab: '$1' is neither a port nor --build, --test or --picture" >&2; exit 1 ;;
    *) port=$1 ;;
esac

missing=
need() {  # command, Debian's package
    command -v "$1" >/dev/null || missing="$missing $2"
}
need em++ emscripten
need node nodejs
need npm npm
[ "$task" = build ] || need python3 python3
[ "$task" != test ] || need g++ g++
case $task in test | picture) need chromium chromium ;; esac
eigen=${EIGEN3_INCLUDE_DIR:-/usr/include/eigen3}
[ -f "$eigen/Eigen/Core" ] || missing="$missing libeigen3-dev"
if [ -n "$missing" ]; then
    echo "lab: not here yet:$missing. On Debian, as root:" >&2
    echo "  apt-get install$missing" >&2
    [ -f "$eigen/Eigen/Core" ] || echo "or EIGEN3_INCLUDE_DIR=… for an Eigen elsewhere" >&2
    exit 1
fi

work=build/lab
packages=$work/packages
mkdir -p "$packages" "$work/wasm" "$work/native"

# newer FILE WHERE…: whether anything in these folders and files is newer than it, or it is not there.
newer() {
    file=$1
    shift
    [ ! -f "$file" ] || [ -n "$(find "$@" -newer "$file" -print -quit)" ]
}
flags="-std=c++17 -fno-exceptions -fno-rtti -DNDEBUG -Iinclude -isystem $eigen"
flags="$flags -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror"
headers="include examples/common lab/lab.hpp lab/scene.hpp scripts/lab.sh"
parts="scene motion pair limits advice resolve beside"

# compile COMPILER FOLDER OPTION…: the parts that have changed, to objects in the folder.
compile() {
    compiler=$1
    objects=$2
    shift 2
    for part in $parts; do
        # shellcheck disable=SC2086  # lists of words
        if newer "$objects/$part.o" $headers "lab/$part.cpp"; then
            "$compiler" $flags "$@" -c "lab/$part.cpp" -o "$objects/$part.o"
        fi
    done
}

if ! cmp -s lab/package-lock.json "$packages/package-lock.json"; then
    echo "lab: npm installs three, esbuild and playwright-core, as pinned in lab/, into $packages"
    cp lab/package.json "$packages"
    (cd "$packages" && cp ../../../lab/package-lock.json wanted.json && mv wanted.json package-lock.json &&
        npm ci --silent --no-audit --no-fund) || { rm -f "$packages/package-lock.json"; exit 1; }
fi
# shellcheck disable=SC2086  # a list of words
if newer "$work/lab.wasm" $headers lab/*.cpp; then
    echo "lab: compiling the library to WebAssembly, two minutes"
    # shellcheck disable=SC2046  # a list of words
    compile em++ "$work/wasm" -O3 $(scripts/wasm_simd.sh "$work/headers")
    em++ -O3 "$work"/wasm/*.o --no-entry -s ALLOW_MEMORY_GROWTH=1 -s MAXIMUM_MEMORY=4GB -o "$work/lab.wasm"
fi
node lab/build_site.mjs "$work/lab.wasm" "$packages" "$site"

case $task in
    build) echo "lab: $site, to be put on any web server, and $site.html, one file that a browser opens" ;;
    serve)
        echo "lab: http://127.0.0.1:$port/ until you press Ctrl-C"
        exec python3 -m http.server --bind 127.0.0.1 --directory "$site" "$port"
        ;;
    picture)
        node lab/check_page.mjs "$site" "$packages" "$work" skirt
        cp "$work/skirt_beyond.png" docs/images/lab.png
        ;;
    test)
        # shellcheck disable=SC2086  # a list of words
        if newer "$work/native/lab" $headers lab/*.cpp; then
            echo "lab: compiling the same natively, two minutes"
            compile g++ "$work/native" -O1
            g++ $flags -O1 lab/native.cpp "$work"/native/*.o -o "$work/native/lab"
        fi
        node lab/check_same.mjs "$work/lab.wasm" "$work/native/lab" examples/data/skirt.obj
        node lab/check_page.mjs "$site" "$packages" "$work"
        ;;
esac
