#!/bin/sh
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# The budget of the weight can fail, and says of what. Usage: weight.sh SCRIPT (scripts/weight.sh)
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
script=$(realpath "$1")
# shellcheck disable=SC2046  # a list of words
unset $(git rev-parse --local-env-vars)  # of a hook, which would mean its own repository
export GIT_CONFIG_GLOBAL=/dev/null
cd "$work"

# expect pass|fail WHAT [TEXT...] -- COMMAND...: the verdict, and the lines that say why, each with its TEXT
expect() {
    verdict=$1 what=$2
    shift 2
    : >texts
    while [ "$1" != -- ]; do
        echo "$1" >>texts
        shift
    done
    shift
    got=pass
    "$@" >said 2>&1 || got=fail
    missing=$(while read -r text; do grep -qF -- "$text" said || echo "$text"; done <texts)
    reasons=$(grep -c '^weight: ' said) || true
    if [ "$got" != "$verdict" ] || [ "$missing" ] || [ "$reasons" -ne "$(wc -l <texts)" ]; then
        echo "$what: $got instead of $verdict, or not for these reasons alone:"
        cat texts said
        exit 1
    fi
}

# numbers FILE CORE MODULE
numbers() { printf '# name value\ncore.unasked 0\ncore.lines %s\nmodule.io %s\ntests.lines 5000\n' "$2" "$3" >"$1"; }
numbers budget 1000 1000
echo 'Less' >silent
printf 'More\n\nBudget: a reader of one more format\n' >reason
compare() { sh "$script" --compare measured "$@"; }
held() { expect "$@" -- compare budget budget silent; }

numbers measured 1020 980
held pass "2 % over, 2 % below"
numbers measured 1040 960
held fail "4 % over, 4 % below" "core.lines: 1040 is 4.0 % over" "module.io: 960 is 4.0 % below its budget of 1000"
numbers measured - 1000
held pass "not measured by this compiler"
numbers measured 1000 1000
sed -i 's/unasked 0/unasked 1/; s/^tests.lines/tests.new/' measured
held fail "one of none, a line new, a line gone" "core.unasked: 1 is" "tests.new: measured, but not in the budget" \
    "tests.lines: in the budget, but no longer measured"

# compare: of two budgets, what is measured being the new one
numbers measured 1000 1100
expect fail "a module's rise" "module.io: up from 1000 to 1100" -- compare measured budget silent
expect pass "a module's rise with a reason" -- compare measured budget reason
numbers measured 1001 900
expect fail "the core's rise" "core.lines: up from 1000 to 1001" -- compare measured budget silent
expect fail "the core's rise with a reason" "the core may not rise" -- compare measured budget reason
numbers measured 1000 1000
echo 'module.new 7' >>measured
expect fail "a new module" "module.new: new in the budget" -- compare measured budget silent
expect pass "a new module with a reason" -- compare measured budget reason
numbers measured 1000 1000
sed -i '/^core.lines/d; /^module/d' measured
expect fail "a number of the core dropped" "core.lines: gone from the budget" -- compare measured budget silent
expect pass "the same with a reason" -- compare measured budget reason
expect fail "no budget" -- compare absent budget silent

# The past of the file.
command -v git >/dev/null || exit 0
mkdir -p tree/scripts/weight && cp "$script" tree/scripts/weight.sh && cd tree
history() { git -c user.name=test -c user.email=test@example.org "$@" >/dev/null 2>&1; }
commit() { # CORE MODULE MESSAGE
    numbers scripts/weight/budget "$1" "$2"
    history add -A
    history commit --allow-empty -m "$3"
}
past() { expect "$@" -- sh scripts/weight.sh --ratchet; }
history init -b main
commit 1000 1000 'The first'
past pass "the first version"
numbers scripts/weight/budget 1000 1100
past fail "a rise before its commit" "module.io"
commit 1000 1100 'A rise'
commit 1000 1100 'Something else'
past fail "a rise two commits ago" "module.io: up from 1000 to 1100"
commit 1000 1050 'Half of it
Budget: a reason given late'
past pass "a reason given late"
commit 1010 1050 'The core
Budget: none is taken'
commit 1010 1050 'Something else'
past fail "the core's rise two commits ago" "core.lines"
commit 1000 1050 'The core as it was'
past pass "the core as it was"
history checkout -b side
commit 800 1050 'A trial, taken back'
commit 1000 1200 'On a branch
Budget: more formats'
history checkout main
commit 900 1050 'Less core'
history merge --no-commit -s ours side
commit 900 1200 'A merge'
past pass "a merge brings the reasons of its branch"
commit 950 1200 'Half of it undone'
past fail "a rise after a merge" "core.lines: up from 900 to 950"
