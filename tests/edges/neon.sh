#!/bin/sh
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# neon.sh OBJDUMP PROGRAM: the springs' kernel adds and multiplies whole registers, and no single numbers.
"$1" -dC --no-show-raw-insn "$2" | awk '
/^[0-9a-f]+ </ { hot = /LawPlan<(float|double), 3, taut::Hookean>::add_segment/ }
hot && /\tf(mla|mls|add|sub|mul)\tv[0-9]+[.](4s|2d)/ { ++whole }
hot && /\tf(madd|msub|nmsub|add|sub|mul)\t[sd][0-9]/ { ++single }
END {
    print whole + 0 " vector instructions, " single + 0 " of single numbers"
    exit !(whole > 50 && single == 0)
}'
