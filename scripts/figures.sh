#!/bin/sh
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# scripts/figures.sh: whether each time and size that README and docs state comes from a measurement. A number with
# ms, µs, MB or GB, or a table's cell of seconds, is one unless = or ≤ stands before it, as in α = 100 µs.
# In the part of a page under one heading, each such number must stand in a file of bench/results that this part links,
# digit for digit. Or the part, or the page before its first heading, must name what measures it (a program
# ..._table, the preset bench or tradeoff, .ci/run): then it is the record itself. Minutes and seconds in sentences are not
# read: they are rounded, and for orientation alone.
set -eu
cd "$(dirname "$0")/.."
git ls-files README.md 'docs/*.md' | LC_ALL=C xargs awk '
    function complain(text) { printf "%s:%d: %s\n", page, row, text; wrong = 1 }
    # Whether one of the files holds the number.
    function recorded(number, files,    list, n, i, line, found) {
        n = split(files, list, "\n")
        for (i = 1; i <= n; ++i) {
            if (list[i] == "") continue
            found = 0
            while ((getline line < list[i]) > 0) {
                while (match(line, /[0-9]+([.][0-9]+)?/)) {
                    if (substr(line, RSTART, RLENGTH) "" == number "") found = 1
                    line = substr(line, RSTART + RLENGTH)
                }
            }
            close(list[i])
            if (found) return 1
        }
        return 0
    }
    function close_part(    i) {
        for (i = 1; i <= count; ++i) {
            row = rows[i]
            if (named || named_page) continue
            if (results == "") complain(numbers[i] " " units[i] ": this part links no file of bench/results, and names no command that measures it")
            else if (!recorded(numbers[i], results)) complain(numbers[i] " " units[i] " is in none of " list_of(results))
        }
        if (headings == 1) named_page = named
        count = 0; named = 0; results = ""
    }
    function list_of(files) { gsub(/\n/, " ", files); return files }
    function note(number, unit) { ++count; ++all; numbers[count] = number; units[count] = unit; rows[count] = FNR }
    FNR == 1 { if (page != "") close_part(); page = FILENAME; fenced = 0; headings = 0; named_page = 0 }
    /^```/ { fenced = !fenced; next }
    fenced || /^    / { if ($0 ~ /[a-z_]+_table|--preset (bench|tradeoff)/) named = 1; next }
    /^#/ { close_part(); ++headings }
    {
        if ($0 ~ /`[a-z_]+_table|work_precision|--preset `?(bench|tradeoff)|preset `bench`|\.ci\/run/) named = 1
        rest = $0
        while (match(rest, /bench\/results\/[-0-9a-z]+\.md/)) {
            results = results substr(rest, RSTART, RLENGTH) "\n"
            rest = substr(rest, RSTART + RLENGTH)
        }
        rest = $0
        while (match(rest, /[0-9]+([.][0-9]+)?( |\302\240)(ms|µs|MB|GB)([^a-zA-Z]|$)/)) {
            before = substr(rest, 1, RSTART - 1)
            text = substr(rest, RSTART, RLENGTH)
            rest = substr(rest, RSTART + RLENGTH - 1)
            split(text, word, /[ ]|\302\240/)
            gsub(/[^a-zA-Zµ]/, "", word[2])
            if (before !~ /(=|≤) ?$/) note(word[1], word[2])
        }
        if ($0 ~ /^\|/) {
            n = split($0, cells, "|")
            for (i = 2; i < n; ++i) if (cells[i] ~ /^ *[0-9]+([.][0-9]+)? s *$/) { split(cells[i], word, " "); note(word[1], "s") }
        }
    }
    END {
        close_part()
        if (all < 5) { print "figures: " all " times and sizes alone were found"; wrong = 1 }
        exit wrong
    }'
