#!/bin/sh
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# Installs what the build, the tests and the examples need. `--ci` adds what only .ci/run needs, `--deep` what
# only the other platforms of the preset deep need, `--bench` what only the benchmarks need.
set -eu

# libopenblas-dev comes with SuiteSparse: on the reference BLAS, CHOLMOD is slower than Eigen.
packages="cmake ninja-build g++ libeigen3-dev libsuitesparse-dev libopenblas-dev libspectra-dev catch2
libcli11-dev nlohmann-json3-dev"

case "${1-}" in
    '') ;;
    --ci) packages="$packages git clang-format-14 clang-16 libclang-rt-16-dev chromium pkgconf doxygen
libjs-mathjax libboost-dev libmpfr-dev time" ;;
    --deep) packages="$packages g++-mingw-w64-x86-64-posix wine wine64 g++-aarch64-linux-gnu qemu-user
g++-i686-linux-gnu clang-16 libc++-16-dev libc++abi-16-dev emscripten nodejs python3" ;;
    --bench) packages="$packages libboost-dev libmpfr-dev libbullet-dev libsundials-dev
python3-matplotlib valgrind lammps openmpi-bin" ;;
    *) echo "install-deps: unknown option '$1'; there are --ci, --deep and --bench" >&2; exit 1 ;;
esac
if [ "${1-}" = --ci ]; then
    # The lab, and a reader of meshes. Node reads the system's certificates, which it only recommends.
    packages="$packages emscripten nodejs ca-certificates python3 libassimp-dev zlib1g-dev"
    # What steps a network beyond one machine, on two ranks.
    packages="$packages lammps openmpi-bin"
    # A nodejs from elsewhere brings npm, and Debian's will not go beside it.
    command -v npm >/dev/null || packages="$packages npm"
fi

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
    cat >&2 <<'END'
install-deps: there is no apt-get here. Install these yourself, then run the cmake command:
  brew install cmake ninja eigen suite-sparse openblas spectra catch2 cli11 nlohmann-json
  vcpkg install eigen3 suitesparse openblas spectra catch2 cli11 nlohmann-json
END
    exit 1
fi

missing=
for package in $packages; do
    status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) || status=
    [ "$status" = installed ] || missing="$missing $package"
done
if [ -z "$missing" ]; then
    echo "install-deps: nothing is missing"
    exit 0
fi

as_root=
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || {
        echo "install-deps: run it as root, there is no sudo here. Missing:$missing" >&2
        exit 1
    }
    as_root=sudo
fi

echo "install-deps: installing$missing"
# shellcheck disable=SC2086  # lists of words
$as_root apt-get update -qq </dev/null &&
    $as_root env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends $missing </dev/null || {
    echo "install-deps: apt-get could not install:$missing" >&2
    exit 1
}
