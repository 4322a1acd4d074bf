#!/bin/sh
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# Bytes of machine code of the steps that lean_step.sh counts: of two object files that take a scene
# already built and step it, by the plain loop and by Taut, and what Taut's are made of.
# Usage: bench/lean_size.sh [COMPILER [FLAG...]], by default g++ -O2
set -eu
cd "$(dirname "$0")/.."
compiler=${1-g++}
[ $# -eq 0 ] || shift
[ $# -gt 0 ] || set -- -O2
objects=$(mktemp -d)
trap 'rm -rf "$objects"' EXIT

for how in plain taut; do
    "$compiler" -std=c++17 -DNDEBUG "$@" -ffunction-sections -Iinclude \
        -isystem "${EIGEN3_INCLUDE_DIR:-/usr/include/eigen3}" \
        -c bench/lean/${how}_steps.cpp -o "$objects/$how.o"
    # Each function has a section, .text.NAME; .text.unlikely.NAME is its part for exceptions.
    size -A "$objects/$how.o" | sed -n 's/^\.text\.\{0,1\}\([^ ]*\) *\([0-9]*\).*/\2 \1/p' |
        sed 's/ \(unlikely\|startup\)\./ /' | c++filt >"$objects/$how"
done

awk '
    FILENAME ~ /plain$/ { plain += $1; next }
    { taut += $1 }
    /::(add_forces|add_segment|add_batch)<(false, )?\([a-z:]*Proportional\)0>/ { step += $1; next }
    /::(steps|step_block|move)<false, false[,>]|StateMemory<.*::finite\(/ { step += $1; next }
    /::(add_forces|add_segment|add_batch)<.*Proportional\)[012]>/ { others += $1; next }
    /::(steps|step_block|move)<(true|false), / { others += $1; next }
    / taut::fail|::message|to_string|basic_string|require_/ { words += $1; next }
    / bench::taut_steps|::Sweep<.*::run<|StepLoop|SpringSystem<.*>::force\(|SpringSet<.*::pull</ {
        ways += $1
        next
    }
    { plan += $1 }
    function row(bytes, text) { printf "%7d  %5.1f  %s\n", bytes, bytes / plain, text }
    END {
        print "  bytes  times"
        row(plain, "the plain loop")
        row(taut, "Taut, of which")
        row(step, "  the step of this scene: all that repeats")
        row(others, "  the same step with pins, drag or dampers: not run here")
        row(plan, "  springs and state into planes, once a call")
        row(ways, "  entry, checks, back to the state; System::force, for what planes do not serve")
        row(words, "  error messages")
        print "within 5 % of the plain loop: " (taut <= 1.05 * plain ? "yes" : "no")
    }' "$objects/plain" "$objects/taut"
