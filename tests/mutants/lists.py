# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT
"""Reads the lists of mutants; run.py says what is in them."""

import collections
import functools
import hashlib
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
LISTS = ("chosen", "drawn")
Mutant = collections.namedtuple("Mutant", "name room file old new at key unseen")


def read_list(name):
    path = HERE / f"{name}.txt"
    mutants, block, at, unseen = [], [], 0, ""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines() + [""], 1):
        if line.strip() and not line.startswith("#"):
            at = at or number
            block.append(line)
            continue
        if line.startswith("# unseen: "):
            unseen = line[len("# unseen: "):]
        if line.strip() or not block:
            continue
        head = block[0].split()
        if len(block) != 3 or len(head) != 2 or block[1][:1] != "-" or block[2][:1] != "+":
            sys.exit(f"{path}:{at}: not a block of ROOM FILE, a line '- ' and a line '+ '")
        old, new = block[1][1:].strip(), block[2][1:].strip()
        key = hashlib.sha256("\n".join([head[1], old, new]).encode()).hexdigest()[:12]
        mutants.append(Mutant(f"{name}:{len(mutants) + 1}", head[0], head[1], old, new, at, key, unseen))
        block, at, unseen = [], 0, ""
    return mutants


def broken(text, mutant):
    """The file with its one line replaced, or None where that line does not occur once."""
    lines = text.split("\n")
    found = [n for n, line in enumerate(lines) if line.strip() == mutant.old]
    if len(found) != 1:
        return None
    line = lines[found[0]]
    lines[found[0]] = line[:len(line) - len(line.lstrip())] + mutant.new
    return "\n".join(lines)


def check(mutants):
    problems, seen, texts = [], {}, {}
    for m in mutants:
        where = f"{m.name} (line {m.at} of its list)"
        path = ROOT / m.file
        if not path.is_file():
            problems.append(f"{where}: there is no {m.file}")
            continue
        text = texts.setdefault(m.file, path.read_text(encoding="utf-8"))
        count = sum(line.strip() == m.old for line in text.split("\n"))
        if count != 1:
            problems.append(f"{where}: its line occurs {count} times in {m.file}: {m.old}")
        if m.old == m.new:
            problems.append(f"{where}: it changes nothing")
        if m.key in seen:
            problems.append(f"{where}: the same as {seen[m.key]}")
        seen[m.key] = m.name
        if not any((ROOT / "tests" / m.room).glob("*_test.cpp")):
            problems.append(f"{where}: room {m.room} has no tests")
    for problem in problems:
        print(problem)
    print(f"{len(mutants)} mutants, {len(problems)} problems")
    return not problems


def numbers(text):
    chosen = set()
    for part in text.split(","):
        first, _, last = part.partition("-")
        chosen.update(range(int(first), int(last or first) + 1))
    return chosen


@functools.lru_cache(None)
def included(path):
    found = []
    for name in re.findall(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', path.read_text(encoding="utf-8"), re.M):
        for folder in (path.parent, ROOT / "include", ROOT / "tests"):
            if (folder / name).is_file():
                found.append((folder / name).resolve())
                break
    return found


def rooms_with_tests():
    """Those with the least to compile come first."""
    sizes = {p.name: sum(f.stat().st_size for f in p.glob("*_test.cpp")) for p in (ROOT / "tests").iterdir()}
    return sorted((room for room, size in sizes.items() if size), key=lambda room: (sizes[room], room))


@functools.lru_cache(None)
def read_by(room):
    front = [*(ROOT / "tests" / room).glob("*_test.cpp"), *(ROOT / "tests/support").glob("*.cpp")]
    known = set(front)
    while front:
        for path in included(front.pop()):
            if path not in known:
                known.add(path)
                front.append(path)
    return known


def rooms_that_read(file):
    return [room for room in rooms_with_tests() if (ROOT / file).resolve() in read_by(room)]
