# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT
"""Prints what is known of the mutants."""

import collections
import posixpath

from lists import written
from tree import KILLED, NO_BUILD, SURVIVED

ELSEWHERE, NOT_RUN = "elsewhere", "not run"
COLUMNS = (KILLED, ELSEWHERE, SURVIVED, NO_BUILD, NOT_RUN)


def outcomes(mutants, rows):
    """[(mutant, outcome, the room that killed it, how)]. elsewhere: by another room's tests than its own."""
    latest = collections.defaultdict(dict)
    for row in rows:
        latest[row.key][row.program] = row
    for m in mutants:
        of = latest[m.key]
        killers = [room for room, row in of.items() if row.outcome == KILLED]
        if m.room in killers:
            yield m, KILLED, m.room, of[m.room].detail
        elif killers:
            yield m, ELSEWHERE, killers[0], of[killers[0]].detail
        elif any(row.outcome == NO_BUILD for row in of.values()):
            yield m, NO_BUILD, "", ""
        else:
            yield m, SURVIVED if of else NOT_RUN, "", ""


def counts(found):
    by_room = collections.defaultdict(collections.Counter)
    for m, outcome, _, _ in found:
        by_room[m.room][outcome] += 1
        by_room["all"][outcome] += 1
    yield f"{'room':14}" + "".join(f"{c:>18}" for c in COLUMNS)
    for room in sorted(by_room, key=lambda r: (r == "all", r)):
        yield f"{room:14}" + "".join(f"{by_room[room][c]:>18}" for c in COLUMNS)


def exceptions(found):
    """Of each room those that its own tests do not kill."""
    for room in sorted({m.room for m, outcome, _, _ in found if outcome != KILLED}):
        yield f"\n{room}"
        for m, outcome, _, how in found:
            if m.room == room and outcome != KILLED:
                unseen = f"unseen: {m.unseen}" if m.unseen else ""
                place = f"{posixpath.normpath(how)}  " if how else ""
                yield f"  {m.name:12}{outcome:17} {place}{' '.join(written(*m[1:5], unseen).split())}"


def table(mutants, rows):
    found = list(outcomes(mutants, rows))
    print("\n".join(["", *counts(found), *exceptions(found)]))


def record(mutants, rows):
    """What results.txt holds: no times, nothing of the machine."""
    found = list(outcomes(mutants, rows))
    lines = ["# Written by run.py --record: how many were killed, and those that the tests of their own room do not kill.",
             "# elsewhere: another room's do, by the check that is named.", "", *counts(found), *exceptions(found)]
    return "\n".join(lines) + "\n"
