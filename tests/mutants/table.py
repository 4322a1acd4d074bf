# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT
"""Prints what is known of the mutants."""

import collections
import posixpath

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


def table(mutants, rows):
    found = list(outcomes(mutants, rows))
    print("\n" + "\n".join(counts(found)))
    for m, outcome, room, _ in found:
        if outcome in (SURVIVED, ELSEWHERE):
            where = f" its own room, {room} kills it" if outcome == ELSEWHERE else ""
            unseen = f"\n# unseen: {m.unseen}" if m.unseen else ""
            print(f"\n{m.name} survived{where}: {m.file}{unseen}\n- {m.old}\n+ {m.new}")


def record(mutants, rows):
    """What results.txt holds: no times, nothing of the machine."""
    found = list(outcomes(mutants, rows))
    lines = ["# Written by run.py --record: what became of each mutant, and the first check that failed.",
             "# elsewhere: not in its own room. docs/testing.md says more.", "", *counts(found), ""]
    for m, outcome, room, how in found:
        how = posixpath.normpath(how) if how else ""
        by = "" if room in ("", m.room) or how.startswith(f"tests/{room}/") else f" ({room})"
        unseen = f"unseen: {m.unseen}" if m.unseen else ""
        lines.append(f"{m.name:12}{m.room:14}{outcome:18}{how}{by}{unseen}".rstrip())
    return "\n".join(lines) + "\n"
