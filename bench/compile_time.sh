#!/bin/sh
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# Processor seconds to compile README's first example, header-only and by Taut::Compiled, beside what its
# headers alone take and what Eigen's alone take: the least and the median of five runs, taken in turn.
# Usage: bench/compile_time.sh [COMPILER [FLAG...]], by default g++ -O2
set -eu
cd "$(dirname "$0")/.."
compiler=${1-g++}
[ $# -eq 0 ] || shift
[ $# -gt 0 ] || set -- -O2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cp examples/01_first_step.cpp "$work/first_step.cpp"
{ echo '#define TAUT_COMPILED'; cat examples/01_first_step.cpp; } >"$work/by_compiled.cpp"
echo '#include <taut/taut.hpp>' >"$work/headers.cpp"
printf '#include <Eigen/Dense>\n#include <Eigen/Sparse>\n' >"$work/eigen.cpp"

for _ in 1 2 3 4 5; do
    for name in eigen headers by_compiled first_step; do
        (
            "$compiler" -std=c++17 "$@" -Iinclude -isystem "${EIGEN3_INCLUDE_DIR:-/usr/include/eigen3}" \
                -c "$work/$name.cpp" -o "$work/out.o"
            # Of the children: minutes and seconds of user time, then of system time.
            times >"$work/times"
            sed -n '2s/[ms]/ /gp' "$work/times" | awk '{print 60 * $1 + $2 + 60 * $3 + $4}' >>"$work/$name"
        )
    done
done

echo "least, median, s: $compiler $*"
for name in eigen headers by_compiled first_step; do
    sort -n "$work/$name" | awk -v name="$name" '{t[NR] = $1} END {printf "%6.2f %6.2f  %s\n", t[1], t[3], name}'
done
