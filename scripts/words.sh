#!/bin/sh
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# What a reader is asked to read, in words as wc counts them, each against its budget; fails above one.
set -eu
export LC_ALL=C.UTF-8  # or what wc takes for a word depends on the machine
cd "$(dirname "$0")/.."

over=0
hold() { # NAME BUDGET PAGE...
    name=$1 budget=$2
    shift 2
    words=$(cat "$@" | wc -w)
    printf '%-32s %6d words, at most %6d\n' "$name" "$words" "$budget"
    [ "$words" -le "$budget" ] || over=1
}

# shellcheck disable=SC2046  # lists of pages, whose names have no blanks
{
    hold README.md 1500 README.md
    hold "docs, but for theory and papers" 15000 \
        $(find docs -name '*.md' ! -path 'docs/theory*' ! -path 'docs/papers/*')
    hold theory 9000 $(find docs -path 'docs/theory*.md')
}
exit $over
