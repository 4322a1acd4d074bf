# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT
"""Reads and writes the lists of mutants; chosen.txt says what is in them."""

import collections
import functools
import hashlib
import os
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
HEADERS = "include/taut/"
LISTS = ("chosen", "drawn")
MARKS = re.compile(r"\[-(.*?)-\]|\{\+(.*?)\+\}")
Mutant = collections.namedtuple("Mutant", "name room file old new key unseen")


def read_list(name):
    mutants = []
    for line in (HERE / f"{name}.txt").read_text(encoding="utf-8").splitlines():
        if not line.strip() or line.startswith("#"):
            continue
        place, rest = line.split(None, 1)
        code, _, why = rest.partition("  # ")
        old, new = MARKS.sub(r"\1", code).strip(), MARKS.sub(r"\2", code).strip()
        room, _, file = place.rpartition(":")
        key = hashlib.sha256("\n".join([HEADERS + file, old, new]).encode()).hexdigest()[:12]
        mutants.append(Mutant(f"{name}:{len(mutants) + 1}", room or file.split("/")[0], HEADERS + file, old, new, key,
                              why.partition("unseen: ")[2]))
    return mutants


def written(room, file, old, new, why=""):
    """The line of a list, in which whole words go and come."""
    a, b = (re.findall(r"\w+|\W", text) for text in (old, new))
    same = len(os.path.commonprefix([a, b]))
    tail = len(os.path.commonprefix([a[same:][::-1], b[same:][::-1]]))
    goes, comes = ("".join(words[same:len(words) - tail]) for words in (a, b))
    marked = (f"[-{goes}-]" if goes else "") + (f"{{+{comes}+}}" if comes else "")
    file = file[len(HEADERS):]
    place = file if file.split("/")[0] == room else f"{room}:{file}"
    return f"{place:40} {''.join(a[:same])}{marked}{''.join(a[len(a) - tail:])}" + (f"  # {why}" if why else "")


def broken(text, mutant):
    """The file with its one line replaced."""
    return "\n".join(line.replace(mutant.old, mutant.new) if line.strip() == mutant.old else line
                     for line in text.split("\n"))


def check(mutants):
    problems, seen = [], {}
    for m in mutants:
        text = (ROOT / m.file).read_text(encoding="utf-8") if (ROOT / m.file).is_file() else ""
        count = sum(line.strip() == m.old for line in text.split("\n"))
        problems += [f"{m.name}: {problem}" for problem in (
            count != 1 and f"its line occurs {count} times in {m.file}: {m.old}",
            m.old == m.new and "it changes nothing",
            m.key in seen and f"the same as {seen.get(m.key)}",
            not any((ROOT / "tests" / m.room).glob("*_test.cpp")) and f"room {m.room} has no tests") if problem]
        seen[m.key] = m.name
    print("\n".join([*problems, f"{len(mutants)} mutants, {len(problems)} problems"]))
    return not problems


@functools.lru_cache(None)
def included(path):
    names = re.findall(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', path.read_text(encoding="utf-8"), re.M)
    found = ([folder / name for folder in (path.parent, ROOT / "include", ROOT / "tests")
              if (folder / name).is_file()] for name in names)
    return [paths[0].resolve() for paths in found if paths]


def rooms_with_tests():
    """Those with the least to compile come first."""
    sizes = {p.name: sum(f.stat().st_size for f in p.glob("*_test.cpp")) for p in (ROOT / "tests").iterdir()}
    return sorted((room for room, size in sizes.items() if size), key=lambda room: (sizes[room], room))


@functools.lru_cache(None)
def read_by(room):
    front = [*(ROOT / "tests" / room).glob("*.cpp"), *(ROOT / "tests/support").glob("*.cpp")]
    known = set(front)
    while front:
        new = set(included(front.pop())) - known
        known |= new
        front += new
    return known


def rooms_that_read(file):
    return [room for room in rooms_with_tests() if (ROOT / file).resolve() in read_by(room)]
