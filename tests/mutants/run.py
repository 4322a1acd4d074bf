#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT
"""Breaks one line of include/taut at a time, in a copy of the tree, and runs the tests of its room.

The library is built once, with a switch at each line that can have one (switched.py); then the others are built one
by one. Each result is appended to build/mutants/results.tsv. A mutant that has one there is not run again, so the
program may be stopped and started again. docs/testing.md says more, chosen.txt what is in the lists.
"""

import argparse
import os
import pathlib
import re
import shutil
import signal
import sys

sys.dont_write_bytecode = True
from lists import HERE, LISTS, ROOT, broken, check  # noqa: E402, after the line above
from lists import read_list, rooms_that_read, rooms_with_tests  # noqa: E402
from switched import Switched  # noqa: E402
from table import ELSEWHERE, outcomes, record, table  # noqa: E402
from tree import NO_BUILD, SURVIVED, Copy, program_of  # noqa: E402


class Single(Copy):
    """One mutant at a time, each built anew."""

    def __init__(self, options, switched):
        super().__init__(options, "single")
        self.sync()
        self.switched = switched
        self.configure("-D", "TAUT_COMPILED=OFF")  # which a line of the core would have built anew each time

    def run(self, mutant, room):
        log = self.fresh_log(f"{mutant.name}-{room}")
        status, _ = self.build_targets([program_of(room)], log)
        if status is not None and status < 0:
            sys.exit(f"the build was stopped: {log}")
        if status != 0:
            return NO_BUILD, "the compiler took too long" if status is None else "", 0.0
        folder = self.work / "single/run"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        task = self.test(mutant.name, room, log, self.switched.time_limit(room), folder)
        status, run_s = self.command(task)
        return (*self.outcome(task, status), run_s)

    def try_mutant(self, mutant, rooms):
        """Until the tests of one of the rooms kill it."""
        path = self.tree / mutant.file
        whole = path.read_text(encoding="utf-8")
        try:
            path.write_text(broken(whole, mutant), encoding="utf-8")
            for room in rooms:
                outcome, detail, run_s = self.run(mutant, room)
                self.note(mutant.key, room, outcome, run_s, mutant.name, detail)
                if outcome != SURVIVED:
                    return
        finally:
            path.write_text(whole, encoding="utf-8")


def elsewhere(mutants, rows):
    """Survivors, and the rooms whose tests read their header and have not run by them."""
    for m, outcome, _, _ in outcomes(mutants, rows):
        if outcome == SURVIVED:
            done = {row.program for row in rows if row.key == m.key}
            yield m, [room for room in rooms_that_read(m.file) if room not in done]


def names(text):
    """Those of "chosen:3,drawn:7-9"."""
    found = set()
    for name, first, last in re.findall(r"(\w+):(\d+)(?:-(\d+))?", text):
        found.update(f"{name}:{number}" for number in range(int(first), int(last or first) + 1))
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--room", help="only these rooms, in this order: guard,network")
    parser.add_argument("--only", type=names, help="only these, such as chosen:3,drawn:7-9")
    parser.add_argument("--check", action="store_true", help="whether each line occurs once; compiles nothing")
    parser.add_argument("--table", action="store_true", help="what is known; compiles nothing")
    parser.add_argument("--record", action="store_true", help="write what is known to results.txt; compiles nothing")
    parser.add_argument("--wider", action="store_true", help="survivors: all programs that read the header, too")
    parser.add_argument("--again", action="store_true", help="those that have a result, too")
    parser.add_argument("--survivors", action="store_true", help="only those that survived, again")
    parser.add_argument("--no-rest", action="store_true", help="only mutants that have a switch")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="compilers and programs at a time")
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "build/mutants",
                        help="the folder of the copy; two runs at a time need two")
    parser.add_argument("--cmake", action="append", default=[], help="one more argument: --cmake=-DNAME=VALUE")
    options = parser.parse_args()

    everyone = [m for name in LISTS for m in read_list(name)]
    mutants = [m for m in everyone if (not options.room or m.room in options.room.split(","))
               and (not options.only or m.name in options.only)]
    if options.check:
        return 0 if check(mutants) else 1
    copy = Copy(options, ".")
    if options.table or options.record:
        if options.record:
            (HERE / "results.txt").write_text(record(mutants, copy.known()), encoding="utf-8")
        table(mutants, copy.known())
        return 0
    if not check(everyone):
        return 1
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("stopped"))  # which ends the children and mends the line
    copy.lock()

    if options.survivors:
        mutants = [m for m, outcome, _, _ in outcomes(mutants, copy.known()) if outcome in (SURVIVED, ELSEWHERE)]
    before = len(copy.known()) if options.again or options.survivors else 0  # results that do not count
    known = {(row.key, row.program) for row in copy.known()[before:]}
    todo = [m for m in mutants if (m.key, m.room) not in known]
    switched = Switched(options, everyone)
    for room in options.room.split(",") if options.room else rooms_with_tests():  # so that results come early
        switched.run([(m, room) for m in todo if m.room == room])
    singly = [(m, [m.room]) for m in todo if not switched.has(m)]
    if options.wider:
        for room in sorted(rooms_with_tests(), key=switched.seconds):
            switched.run([(m, room) for m, rooms in elsewhere(mutants, copy.known()[before:]) if room in rooms])
        singly = [(m, [m.room, *(room for room in rooms_that_read(m.file) if room != m.room)]) for m, _ in singly]
    if singly and not options.no_rest:
        single = Single(options, switched)
        for m, rooms in sorted(singly, key=lambda of: of[1]):  # a stable sort: a room is built once
            single.try_mutant(m, rooms)
    table(mutants, copy.known())
    return 0


if __name__ == "__main__":
    sys.exit(main())
