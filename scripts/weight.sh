#!/bin/sh
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# What a program pays for Taut: the units of scripts/weight/, each compiled alone, and the size of the tree.
#
#   scripts/weight.sh [RUNS]    prints it all, with seconds: the least of RUNS runs, by default 3
#   scripts/weight.sh --check   holds all but the seconds against scripts/weight/budget, and that file against
#                               its own past
#   scripts/weight.sh --update  writes the budget from what is measured
#   scripts/weight.sh --ratchet looks at the file's past alone
#   scripts/weight.sh --compare MEASURED BUDGET OLD_BUDGET MESSAGE   compares files, measures nothing
#
# CXX and CXXFLAGS choose the compiler (g++) and its flags (-O2). The budget is for g++ 12 -O2 on Debian 12.
#
# The core is what taut.hpp reaches; a module is a folder of include/taut, as far as taut.hpp does not reach it.
# core.unasked counts functions that taut.hpp, nothing called, compiles at -O0 and Eigen's headers do not;
# core.public_headers those headers that are in no detail/ or step/. x-inl.hpp is a part of x.hpp: its lines count.
#
# What is 3 % off its budget fails, above and below. A number of the budget may rise only with a line "Budget:
# REASON" in a message since, one of the core not at all; a module's may be dropped, any other only with such a
# line. The past is every version on HEAD's line of first parents: neither several commits at once nor a merge
# hides a rise, and what fell again is mended.
set -eu
export LC_ALL=C
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Complaints about numbers off their budget. A number that is "-" cannot be measured here. MEASURED BUDGET
off_budget() {
    awk '
        /^#/ || !NF { next }
        from == "measured" { measured[$1] = $2; next }
        { budget[$1] = $2 }
        END {
            for (name in measured)
                if (!(name in budget)) print name ": measured, but not in the budget: --update"
            for (name in budget) {
                is = measured[name]
                may = budget[name]
                by = may > 0 ? sprintf("%.1f %%", 100 * (is > may ? is - may : may - is) / may) : is
                if (is == "") print name ": in the budget, but no longer measured: --update"
                else if (is == "-") continue
                else if (is > 1.03 * may) print name ": " is " is " by " over its budget of " may
                else if (is < 0.97 * may)
                    print name ": " is " is " by " below its budget of " may "; take the budget down: --update"
            }
        }' from=measured "$1" from=budget "$2"
}

# Complaints about a budget that rose. OLD NEW MESSAGE
risen() {
    awk -v reasons="$(grep -c '^Budget: *[^ ]' "$3")" '
        /^#/ || !NF { next }
        from == "old" { old[$1] = $2; next }
        { new[$1] = $2 }
        $2 !~ /^[0-9]+$/ { print $1 ": " $2 " is no number"; next }
        !($1 in old) { if (!reasons) print $1 ": new in the budget" wanted; next }
        $2 <= old[$1] { next }
        !/^(module|tests)\./ { print $1 ": up from " old[$1] " to " $2 "; the core may not rise"; next }
        !reasons { print $1 ": up from " old[$1] " to " $2 wanted }
        END {
            for (name in old)
                if (!(name in new) && name !~ /^module\./ && !reasons) print name ": gone from the budget" wanted
        }
        ' wanted='; that needs a line "Budget: REASON" in the message' from=old "$1" from=new "$2"
}

verdict() {
    [ -s "$work/complaints" ] || return 0
    sort "$work/complaints" | sed 's/^/weight: /' >&2
    exit 1
}

if [ "${1-}" = --compare ]; then
    off_budget "$2" "$3" >"$work/complaints"
    risen "$4" "$3" "$5" >>"$work/complaints"
    verdict
    exit
fi
CDPATH='' cd "$(dirname "$0")/.."
budget=scripts/weight/budget

# Complaints about the file beside its version at HEAD (what is not committed has no message yet), then beside
# each older one, the newest first, until there are some.
ratchet() {
    [ -e .git ] || { echo "weight: no git here, so the budget has no past" >&2 && return; }
    # The line of first parents with what was merged into it: after a fast-forward to a branch that had
    # merged main, main's last commit is a second parent.
    commits=$(git rev-list --first-parent --parents HEAD | tr ' ' '\n' | awk '!seen[$0]++')
    for base in HEAD $commits; do
        git show "$base:$budget" >"$work/old" 2>/dev/null || continue
        git log --format=%B "$base..HEAD" >"$work/message"
        risen "$work/old" $budget "$work/message" >"$work/risen"
        [ ! -s "$work/risen" ] || break
    done
    [ ! -e "$work/risen" ] || cat "$work/risen"
}

runs=0
case ${1-} in
    --check | --update) ;;
    --ratchet) ratchet >"$work/complaints"; verdict; exit ;;
    '' | [1-9]*) runs=${1-3} ;;
    *) echo "weight: unknown '$1'; there are --check, --update, --ratchet, --compare and a number" >&2 && exit 2 ;;
esac

cxx=${CXX:-g++} flags=${CXXFLAGS:--O2}
compile() { # UNIT...: an object, what it was made of, and a line of user and system seconds and of KB
    for unit; do
        source=${unit%_O0} level=$flags define=
        case $unit in
            by_compiled) source=first_program define=-DTAUT_COMPILED ;;
            *_O0) level=-O0 ;;
        esac
        # shellcheck disable=SC2086  # lists of words
        env time -a -o "$work/$unit.time" -f '%U %S %M' $cxx -std=c++17 $level $define -Iinclude \
            -isystem "${EIGEN3_INCLUDE_DIR:-/usr/include/eigen3}" -MMD -MF "$work/$unit.made_of" \
            -c "scripts/weight/$source.cpp" -o "$work/$unit.o"
    done
}
reached() { # UNIT: headers, each by its shortest name
    tr -s ' \\' '\n' <"$work/$1.made_of" |
        sed -n -e :up -e 's#[^/.][^/]*/\.\./##' -e 't up' -e '/^include\//p' | sort -u
}
functions() { # UNIT: names, without parts of functions and what runs before main
    nm -P --defined-only "$work/$1.o" | awk '$2 ~ /^[tTwW]$/ && $1 !~ /\.(cold|part)|^_GLOBAL__/ { print $1 }' | sort
}
least() { # UNIT: seconds and MB of its runs
    awk '
        NR == 1 || $1 + $2 < seconds { seconds = $1 + $2 }
        NR == 1 || $3 < memory { memory = $3 }
        END { printf "%.2f %.0f\n", seconds, memory / 1000 }' "$work/$1.time"
}
unasked() {
    functions eigen_O0 >"$work/eigen_functions"
    functions core_O0 | comm -23 - "$work/eigen_functions" | c++filt
}
lines() { # of the files on its input
    xargs -r cat | wc -l
}
measure() {
    for unit in $units; do
        echo "$unit.memory_mb $(least $unit | cut -d ' ' -f 2)"
        echo "$unit.bytes $(size "$work/$unit.o" | awk 'NR == 2 { print $1 + $2 }')"
        echo "$unit.functions $(functions $unit | wc -l)"
        echo "$unit.headers $(reached $unit | grep -cv -e -inl)"
        echo "$unit.lines $(reached $unit | lines)"
    done
    echo "core.unasked $(unasked | wc -l)"
    reached core >"$work/core"
    echo "core.public_headers $(grep -cv -e -inl -e /detail/ -e /step/ "$work/core")"
    find include -type f | sort | comm -23 - "$work/core" >"$work/modules"
    for module in $(sed -E 's#^include/taut/([^/.]*).*#\1#' "$work/modules" | sort -u); do
        echo "module.$module $(grep "^include/taut/$module[/.]" "$work/modules" | lines)"
    done
    echo "tests.lines $(find tests -type f | lines)"
}

units="core first_program by_compiled steps limit"
if [ $runs -gt 0 ]; then # alone, in turn
    for _ in $(seq "$runs"); do compile eigen $units; done
    compile eigen_O0 core_O0
else # two at a time
    compile first_program by_compiled limit &
    compile eigen_O0 core_O0 core steps
    wait $!
fi
measure | sort >"$work/measured"

of_budget=
[ "$($cxx -dumpmachine) $($cxx -dumpversion) $flags" != "x86_64-linux-gnu 12 -O2" ] ||
    of_budget=$(sed -n '/^VERSION_ID="12"/p' /etc/os-release 2>/dev/null || true)
case ${1-} in
    --check)
        if [ -z "$of_budget" ]; then
            echo "weight: this is not g++ 12 -O2 on Debian 12; memory, bytes and functions are not held" >&2
            sed -i -E 's/(memory_mb|bytes|functions|unasked) .*/\1 -/' "$work/measured"
        fi
        off_budget "$work/measured" $budget >"$work/complaints"
        ! grep -q '^core.unasked: .* over ' "$work/complaints" ||
            unasked | sed 's/^/core.unasked: /' >>"$work/complaints"
        ratchet >>"$work/complaints"
        verdict
        echo "weight: $(wc -l <"$work/measured") numbers within their budget"
        ;;
    --update)
        [ "$of_budget" ] || { echo "weight: the budget is for g++ 12 -O2 on Debian 12" >&2 && exit 1; }
        # A number up to 3 % above its budget stays, or the noise of memory would be a rise.
        awk '
            /^#/ { print; next }
            from == "budget" { old[$1] = $2; next }
            { print $1, (($1 in old) && $2 >= old[$1] && $2 <= 1.03 * old[$1] ? old[$1] : $2) }
            ' from=budget $budget from=measured "$work/measured" >"$work/budget"
        cp "$work/budget" $budget
        ratchet | sed 's/^/weight: /' >&2
        ;;
    *)
        cat "$work/measured"
        echo "include.lines $(find include -type f | lines)"
        for unit in eigen $units; do echo "$unit $(least $unit)"; done | awk '
            NR == 1 { eigen = $2 }
            { printf "%s: %s MB, %s s, %.2f times that of Eigen\n", $1, $3, $2, $2 / eigen }'
        ;;
esac
