#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT
"""Breaks one line of include/taut at a time, in a copy of the tree, and runs the tests of its room.

A list is made of blocks with blank lines between them:

    guard include/taut/guard/detail/trim.hpp    the room whose tests run, and the file
    # why it would hurt                         any number of such lines, or none
    - a line of the file                        which occurs once; blanks around it do not count
    + what becomes of it

The line "# unseen: why" marks a mutant that no test can kill.

The library is built once, with a switch at each line that can have one (switched.py); then the others are built one
by one. Each result is appended to build/mutants/results.tsv. A mutant that has one there is not run again, so the
program may be stopped and started again. docs/testing.md says more.
"""

import argparse
import collections
import os
import pathlib
import shutil
import signal
import sys

sys.dont_write_bytecode = True
from lists import HERE, LISTS, ROOT, broken, check, numbers  # noqa: E402, after the line above
from lists import rooms_that_read, read_list, rooms_with_tests  # noqa: E402
from switched import Switched  # noqa: E402
from table import ELSEWHERE, outcomes, record, table  # noqa: E402
from tree import NO_BUILD, SURVIVED, Copy, program_of  # noqa: E402


class Single(Copy):
    """One mutant at a time, each built anew. The switched build has run the unbroken programs, if there is one."""

    def __init__(self, options, switched):
        super().__init__(options, "single")
        self.sync()
        self.switched = switched
        self.configure("-D", "TAUT_COMPILED=OFF")  # which a line of the core would have built anew each time

    def run(self, name, room, limit):
        """(outcome, seconds of building, seconds of running, what failed)."""
        log = self.fresh_log(f"{name}-{room}")
        status, build_s = self.command(
            ["cmake", "--build", self.build, "--target", program_of(room)[0], "-j", str(self.options.jobs)],
            log, self.options.build_limit, self.work)
        if status is not None and status < 0:
            sys.exit(f"the build was stopped: {log}")
        if status != 0:
            return NO_BUILD, build_s, 0.0, "the compiler took too long" if status is None else ""
        folder = self.work / "single/run"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        for task, status, run_s in self.many([self.test(name, room, log, limit, folder)], 1):
            outcome, detail = self.outcome(task, status)
            return outcome, build_s, run_s, detail

    def time_limit(self, room):
        """Five times what the unbroken program takes, which must pass."""
        seconds = self.unbroken(room)
        if seconds is None and self.switched:
            seconds = self.switched.unbroken(room)
        if seconds is None:
            outcome, build_s, seconds, detail = self.run("unbroken", room, 3600)
            self.note(f"unbroken-{self.digest}", room, outcome, build_s, seconds, "unbroken", detail)
            if outcome != SURVIVED:
                sys.exit(f"{room} does not pass unbroken: {self.logs}/unbroken-{room}.log")
        return max(30.0, 5 * seconds)

    def try_mutant(self, mutant, rooms):
        """Until the tests of one of the rooms kill it."""
        limits = {room: self.time_limit(room) for room in rooms}
        path = self.tree / mutant.file
        whole = path.read_text(encoding="utf-8")
        try:
            path.write_text(broken(whole, mutant), encoding="utf-8")
            for room in rooms:
                outcome, build_s, run_s, detail = self.run(mutant.name, room, limits[room])
                self.note(mutant.key, room, outcome, build_s, run_s, mutant.name, detail)
                if outcome != SURVIVED:
                    return
        finally:
            path.write_text(whole, encoding="utf-8")


def elsewhere(mutants, rows):
    """Survivors, and the rooms whose tests read their header and have not run by them."""
    for m, outcome, _, _ in outcomes(mutants, rows):
        if outcome == SURVIVED:
            done = {row.program for row in rows if row.key == m.key}
            rooms = [room for room in rooms_that_read(m.file) if room not in done]
            if rooms:
                yield m, rooms


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", choices=(*LISTS, "both"), default="both")
    parser.add_argument("--room", help="only these rooms, such as guard,model")
    parser.add_argument("--numbers", type=numbers, help="only these of the list, such as 1-5,9")
    parser.add_argument("--most", type=int, help="at most so many of a room and list, drawn by their text")
    parser.add_argument("--check", action="store_true", help="whether each line occurs once; compiles nothing")
    parser.add_argument("--table", action="store_true", help="what is known; compiles nothing")
    parser.add_argument("--record", action="store_true", help="write what is known to results.txt; compiles nothing")
    parser.add_argument("--wider", action="store_true", help="survivors: all programs that read the header, too")
    parser.add_argument("--again", action="store_true", help="those that have a result, too")
    parser.add_argument("--singly", action="store_true", help="no switches: each mutant is built anew")
    parser.add_argument("--no-rest", action="store_true", help="only mutants that have a switch")
    parser.add_argument("--survivors", action="store_true", help="only those that survived, again")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="compilers and programs at a time")
    parser.add_argument("--memory", type=float, default=8, help="of a process, at most, GB")
    parser.add_argument("--build-limit", type=float, default=7200, help="s")
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "build/mutants",
                        help="the folder of the copy; two runs at a time need two")
    parser.add_argument("--cmake", action="append", default=[], help="one more argument: --cmake=-DNAME=VALUE")
    options = parser.parse_args()

    mutants = [m for name in LISTS if options.list in (name, "both") for m in read_list(name)]
    if options.room:
        mutants = [m for m in mutants if m.room in options.room.split(",")]
    if options.numbers:
        mutants = [m for m in mutants if int(m.name.split(":")[1]) in options.numbers]
    if options.most:
        ranks = collections.defaultdict(list)
        for m in mutants:
            ranks[m.room, m.name.split(":")[0]].append(m.key)
        mutants = [m for m in mutants if m.key in sorted(ranks[m.room, m.name.split(":")[0]])[:options.most]]
    if options.check:
        return 0 if check(mutants) else 1

    copy = Copy(options, ".")
    if options.table:
        table(mutants, copy.known())
        return 0
    if options.record:
        (HERE / "results.txt").write_text(record(mutants, copy.known()), encoding="utf-8")
        return 0
    if not check(mutants):
        return 1
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("stopped"))  # which ends the children and mends the line
    copy.lock()

    if options.survivors:
        mutants = [m for m, outcome, _, _ in outcomes(mutants, copy.known()) if outcome in (SURVIVED, ELSEWHERE)]
    before = len(copy.known()) if options.again or options.survivors else 0  # results that do not count
    known = {(row.key, row.program) for row in copy.known()[before:]}
    todo = [m for m in mutants if (m.key, m.room) not in known]
    switched = None if options.singly else Switched(options, [m for name in LISTS for m in read_list(name)])
    for room in rooms_with_tests() if switched else []:  # one after the other: the first results come early
        switched.run([(m, room) for m in todo if m.room == room])
    rest = [(m, [m.room]) for m in todo if not switched or not switched.has(m)]
    single = None
    if rest and not options.no_rest:
        single = Single(options, switched)
        for m, rooms in sorted(rest, key=lambda r: r[1]):  # a stable sort: a room is built once
            single.try_mutant(m, rooms)
    if options.wider:
        for room in sorted(rooms_with_tests(), key=switched.seconds) if switched else []:
            switched.run([(m, room) for m, rooms in elsewhere(mutants, copy.known()[before:]) if room in rooms])
        for m, rooms in elsewhere(mutants, copy.known()[before:]) if not options.no_rest else []:
            if not switched or not switched.has(m):
                single = single or Single(options, switched)
                single.try_mutant(m, rooms)
    table(mutants, copy.known())
    return 0


if __name__ == "__main__":
    sys.exit(main())
