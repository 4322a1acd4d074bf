#!/bin/sh
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# Instructions that one step takes, by callgrind: the difference of two runs, so that building the
# scene does not count. Usage: bench/lean_step.sh PROGRAM (build/bench/bench/lean_step)
set -eu
program=$1

instructions() {
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$program" "$1" "$2" 2>&1 |
        sed -n 's/.*Collected : \([0-9]*\).*/\1/p'
}

for how in plain taut; do
    few=$(instructions $how 10)
    many=$(instructions $how 110)
    echo "$how: $(((many - few) / 100)) instructions a step"
done
