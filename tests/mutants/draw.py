#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT
"""Draws mutants from all lines of include/taut and writes drawn.txt, in the format that run.py reads.

Each change that a pattern below allows has a rank, a hash of the seed, its file and its text; a room takes the
lowest, one for a line, and as many as its share of all such lines. So a line that is edited moves few others.
usage: draw.py [COUNT [SEED]]
"""

import collections
import hashlib
import re
import sys

sys.dont_write_bytecode = True
from lists import HERE, ROOT, read_list, written  # noqa: E402, after the line above

HEADERS = ROOT / "include/taut"

# (what is replaced, by what). clang-format sets binary operators between blanks, and references, pointers and
# template arguments not.
CHANGES = [
    (r"(?<= )\+(?= )", ["-"]), (r"(?<=[\w)\]] )-(?= )", ["+"]), (r"(?<= )\*(?= )", ["/"]), (r"(?<= )/(?= )", ["*"]),
    (r"(?<= )<(?= )", ["<="]), (r"(?<= )<=(?= )", ["<"]), (r"(?<= )>(?= )", [">="]), (r"(?<= )>=(?= )", [">"]),
    (r"(?<= )==(?= )", ["!="]), (r"(?<= )!=(?= )", ["=="]), (r"(?<= )&&(?= |$)", ["||"]), (r"(?<= )\|\|(?= |$)", ["&&"]),
    (r"(?<= )\+=(?= )", ["-=", "="]), (r"(?<= )-=(?= )", ["+="]), (r"(?<= )\*=(?= )", ["/="]), (r"(?<= )/=(?= )", ["*="]),
    (r"(?<![\w.])0\.5(?![\w.])", ["1"]), (r"(?<![\w.<\[-])2(?![\w.>])", ["1", "3"]), (r"(?<![\w.<\[-])4(?![\w.>])", ["2"]),
    (r"(?<![\w.<\[-])1(?![\w.>])", ["0", "2"]),
    (r"\btrue\b", ["false"]), (r"\bfalse\b", ["true"]),
    (r"\bstd::min\b", ["std::max"]), (r"\bstd::max\b", ["std::min"]),
    (r"\bstd::ceil\b", ["std::floor"]), (r"\bstd::floor\b", ["std::ceil"]),
    (r"(?<![\w+])\+\+(?=\w)", ["--"]), (r"(?<!-)--(?=\w)", ["++"]),
    (r"(?<=^if \()(?=.*\) (?:return|continue|break)\b)(?!!)(?=[^()&|]*(?:\([^()]*\)[^()&|]*)*\) (?:return|continue|break))",
     ["!NEGATE"]),
    (r"(?<=[(,=?:] )-(?=[\w(])", [""]), (r"(?<=\()-(?=[\w(])", [""]), (r"(?<=return )-(?=[\w(])", [""]),
    (r"(?<=\[)([a-z])(?=\])", [r"\1 + 1"]), (r"(?<=[a-z]) \+ 1(?=\])", [""]),
    (r"\bK_plus\b", ["K"]), (r"\bupper\(\)", ["lower()"]), (r"\blower\(\)", ["upper()"]),
]

# No line of these: text for people, declarations, what no compiler would take, what changes speed alone.
SKIPPED = re.compile(
    r'"|^(//|/\*|\*|#|alignas|using |typedef |template\b|namespace |class |struct |enum |friend |public:|private:|case |'
    r"static_assert|inline constexpr (int|std::size_t|Index|bool) )|\bfail\(|\brequire_|TAUT_|\breserve\(|operator|"
    r"\bstd::(string|move|forward|enable_if|conditional|void_t|is_)|\bconstexpr bool\b|decltype|\bif constexpr\b|"
    r"\bmost_repeats\b|= (default|delete);|for \(.*;.*;.*\+\+\w+\) *\{?$")
STEP = re.compile(r"^for \(.*; ([^;]*)\)")  # of a loop, without which it never ends


def code_lines(path):
    """(number, stripped line without its comment) of statements, outside #if, static_assert and docstrings."""
    inside_if, inside_assert = 0, False
    for line in path.read_text(encoding="utf-8").split("\n"):
        text = line.strip()
        if re.match(r"#\s*if", text):
            inside_if += 1
        elif re.match(r"#\s*endif", text):
            inside_if -= 1
        elif text.startswith("static_assert"):
            inside_assert = not text.endswith(";")
        elif inside_assert:
            inside_assert = not text.endswith(";")
        elif not inside_if and text:
            yield text


def variants(text):
    code = re.split(r"\s+//", text)[0]
    for pattern, replacements in CHANGES:
        for match in re.finditer(pattern, code):
            for replacement in replacements:
                if replacement == "!NEGATE":
                    inside = re.match(r"if \((.*)\) (return|continue|break)\b", code)
                    if not inside or inside.group(1).count("(") != inside.group(1).count(")"):
                        continue
                    yield f"if (!({inside.group(1)})) {code[inside.start(2):]}"
                else:
                    yield code[:match.start()] + match.expand(replacement) + code[match.end():]


def is_change(old, new):
    """Not where a loop never ends, or the new line is the same or cannot compile."""
    step = STEP.match(old)
    if step and step.group(1) not in new:
        return False
    if new == old or re.search(r"/ 0\b|\b0 /|\[-|<0,|, 0>|- -|\+ \+", new):
        return False
    return not re.search(r"Identity\(\) /|/ [a-z_]+\.(transpose|col|row)|/ ([A-Z]|identity|mass|p|dx|dv)\b", new)


def drawn(count, seed):
    by_room, sizes = {}, collections.Counter()
    by_hand = {(m.file, m.old, m.new) for m in read_list("chosen")}
    for path in sorted(HEADERS.rglob("*.[hi]pp")):
        file = path.relative_to(ROOT).as_posix()
        room = path.relative_to(HEADERS).parts[0]
        if not (ROOT / "tests" / room).is_dir():
            continue
        lines = list(code_lines(path))
        whole = collections.Counter(line.strip() for line in path.read_text(encoding="utf-8").split("\n"))
        for text in lines:
            if whole[text] != 1 or SKIPPED.search(text):
                continue
            changes = sorted({v for v in variants(text)
                              if is_change(text, v) and (file, text, v) not in by_hand})
            if not changes:
                continue
            sizes[room] += 1

            def rank(new):  # an index moved on is four times as rare as the rest
                digest = hashlib.sha256(f"{seed}\n{file}\n{text}\n{new}".encode()).hexdigest()
                return digest if " + 1]" not in new or " + 1]" in text or digest[-1] < "4" else "~"
            best = min(changes, key=rank)
            by_room.setdefault(room, []).append((rank(best), file, text, best))
    total = sum(sizes.values())
    shares = {room: count * size / total for room, size in sizes.items()}
    quota = {room: max(1, int(share)) for room, share in shares.items()}
    while sum(quota.values()) != count:  # the largest remainders, or the least
        up = sum(quota.values()) < count
        room = (max if up else min)((r for r in quota if up or quota[r] > 1),
                                    key=lambda r: (shares[r] - quota[r], r))
        quota[room] += 1 if up else -1
    for room in sorted(by_room):
        for _, file, old, new in sorted(sorted(by_room[room])[:quota[room]], key=lambda m: m[1:]):
            yield room, file, old, new


def main():
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 90
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    unseen = {(m.file, m.old, m.new): f"unseen: {m.unseen}" for m in read_list("drawn") if m.unseen}
    lines = [written(*mutant, unseen.get(mutant[1:], "")) for mutant in drawn(count, seed)]
    head = f"# Written by draw.py: {count} mutants by seed {seed}. chosen.txt describes the format.\n"
    (HERE / "drawn.txt").write_text("\n".join([head, *lines, ""]), encoding="utf-8")


if __name__ == "__main__":
    main()
