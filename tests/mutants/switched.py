# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT
"""Builds the library once with all mutants in it that switches.py can write, and runs the tests by each."""

import collections
import json
import math
import pathlib
import re
import shlex
import shutil
import sys

import switches
from lists import ROOT, broken, rooms_with_tests
from tree import BUILD_LIMIT, SURVIVED, Copy, Task, program_of

HEADER = "include/taut_mutants.hpp"


class Switched(Copy):
    """Of all mutants of the lists, so that one build serves every choice among them."""

    def __init__(self, options, mutants):
        super().__init__(options, "switched")
        self.numbers = {m.key: number for number, m in enumerate(mutants, 1)}
        self.store = self.work / "switched/choices.json"
        stored = json.loads(self.store.read_text(encoding="utf-8")) if self.store.is_file() else {}
        self.checked = stored.get("checked", "")
        self.texts, self.tokens, self.groups, self.lines = {}, {}, {}, {}
        at_line = collections.defaultdict(list)
        for m in mutants:
            at_line[m.file, m.old].append((m, self.numbers[m.key]))
        for (file, _), at in at_line.items():
            if file not in self.texts:
                self.texts[file] = (ROOT / file).read_text(encoding="utf-8")
                self.tokens[file] = switches.Tokens(self.texts[file])
            new = [(m, n, switches.Tokens(broken(self.texts[file], m))) for m, n in at]
            self.groups.setdefault(file, []).append(switches.Group(self.tokens[file], new))
        for file in self.groups:
            while self.rewritten(file, stored.get("choices", {})) is None:
                pass
        self.check()
        print(f"{sum(map(self.has, mutants))} of {len(mutants)} mutants have a switch", flush=True)

    def rewritten(self, file, choices=None):
        """The text of a file with its switches, or None where two groups had to become one."""
        for group in self.groups[file]:
            if choices is not None:
                group.at = max(group.at, choices.get(group.name(), 0))
        text, lines = switches.rewrite(self.texts[file], self.tokens[file], self.groups[file])
        if text is None:
            one, other = lines
            self.groups[file].remove(one)
            self.groups[file].remove(other)
            self.groups[file].append(switches.Group(self.tokens[file], one.mutants + other.mutants))
            return None
        self.lines[file] = lines
        first, rest = text.split("\n", 1)
        return f"#include <{pathlib.Path(HEADER).name}>  {first}\n{rest}"

    def write(self):
        texts = {HEADER: switches.HEADER}
        for file in self.groups:
            text = None
            while text is None:
                text = self.rewritten(file)
            texts[file] = text
        self.sync(texts)

    def save(self):
        choices = {g.name(): g.at for groups in self.groups.values() for g in groups}
        self.store.write_text(json.dumps({"checked": self.checked, "choices": choices}, indent=1), encoding="utf-8")

    def has(self, mutant):
        return any(g.candidate() and mutant.key in (m.key for m, _, _ in g.mutants) for g in self.groups[mutant.file])

    # ---- what compiles ----

    def commands(self):
        """[(source, arguments)] that check the syntax of the largest source of each room and of each part of
        Taut::Compiled; the build checks the rest."""
        folders = [f"{program_of(room)}.dir/" for room in rooms_with_tests()]
        found = []
        for entry in json.loads((self.build / "compile_commands.json").read_text(encoding="utf-8")):
            words, source = shlex.split(entry["command"]), pathlib.Path(entry["file"])
            at = words.index("-o")
            if not any(f in words[at + 1] for f in (*folders, "TautCompiled.dir/", "test_support.dir/")) \
                    or source.suffix in (".cxx", ".hxx"):
                continue
            del words[at:at + 2]
            for i, word in enumerate(words):
                if word.endswith("cmake_pch.hxx"):  # a copy, as it may have been compiled from other text
                    words[i] = str(self.work / "switched" / re.sub(r"\W", "-", word.split("CMakeFiles/")[1])) + ".hxx"
                    shutil.copy(word, words[i])
            found.append((-source.stat().st_size, source, [*words, "-fsyntax-only", "-w"]))
        largest = {}
        for _, source, words in sorted(found):
            of = source.stem.split("_")[0] if source.parent.name == "compiled" else source.parent.name
            largest.setdefault(of, (source, words))
        return list(largest.values())

    def blame(self, text):
        """Groups whose lines the errors of a compiler name, and the errors that name none."""
        guilty, innocent, lines = set(), [], text.splitlines()
        errors = [i for i, line in enumerate(lines) if re.search(r": (fatal )?error: ", line)]
        for i, end in zip(errors, [*errors[1:], len(lines)]):
            begin = i
            while begin > 0 and not re.search(r": (note|warning|(fatal )?error):", lines[begin - 1]):
                begin -= 1
            context = [line for line in lines[begin:i]
                       if re.search(r"[Rr]equired (from|by)|In (instantiation|substitution)", line)]
            groups = [g for said in (lines[i], *context, *lines[i + 1:end])
                      for file, at in re.findall(r"(include/taut/[\w./]+):(\d+)", said)
                      for g in self.lines.get(file, {}).get(int(at), [])]
            guilty.update(groups[:1])
            innocent += [] if groups else [lines[i]]
        return guilty, innocent

    def next_candidates(self, log, moved):
        """moved: the groups that were moved on since all were written."""
        guilty, innocent = self.blame(log.read_text(encoding="utf-8", errors="replace"))
        if not guilty:
            sys.exit(f"{log}: this does not compile, and no switch is to blame:\n" + "\n".join(innocent[:10]))
        for group in guilty - moved:
            moved.add(group)
            group.at += 1
            left = len(group.candidates) - group.at
            print(f"{log.stem}: {', '.join(m.name for m, _, _ in group.mutants)}: {left} places left", flush=True)

    def check(self):
        """Moves groups on to candidates that compile."""
        self.write()
        self.configure("-D", "TAUT_COMPILED=ON", "-D", "CMAKE_CXX_FLAGS=-w",
                       "-D", "CMAKE_EXPORT_COMPILE_COMMANDS=ON")
        if self.checked == self.headers:
            return
        waiting, jobs = self.commands(), self.options.jobs
        while waiting:
            batch, moved = {str(source): (source, words) for source, words in waiting[:jobs]}, set()
            tasks = [Task(name, words, self.fresh_log(f"syntax-{source.parent.name}-{source.stem}"), BUILD_LIMIT,
                          self.build) for name, (source, words) in batch.items()]
            done = []
            for task, status, _ in self.many(tasks, jobs):
                if status == 0:
                    done.append(task.name)
                else:
                    self.next_candidates(task.log, moved)
            waiting = [w for w in waiting if str(w[0]) not in done]
            self.save()
            self.write()
        self.checked = self.headers
        self.save()

    def compile(self, rooms):
        while True:
            log = self.fresh_log("build")
            status, seconds = self.build_targets(sorted(map(program_of, rooms)), log)
            if status == 0:
                print(f"{', '.join(sorted(rooms))}: built in {seconds:.0f} s", flush=True)
                return
            self.next_candidates(log, set())
            self.save()
            self.write()

    # ---- the runs ----

    def run(self, wanted):
        """wanted: [(mutant, room)], of which those without a switch are left; None: the unbroken program."""
        wanted = [(m, room) for m, room in wanted if not m or self.has(m)]
        rooms = {room for _, room in wanted}
        if not rooms:
            return
        self.compile(rooms)
        fresh = {room: (self.test(room, room, self.fresh_log(f"unbroken-{room}"), 3600, self.work), ("", room))
                 for room in sorted(rooms) if self.seconds(room) == math.inf}
        self.note_all(fresh, f"unbroken-{self.digest}")
        tasks = {}
        for m, room in sorted((w for w in wanted if w[0]), key=lambda w: self.numbers[w[0].key]):
            if self.has(m) and self.seconds(room) < math.inf:
                name = f"{m.name}-{room}"
                tasks[name] = (self.test(name, room, self.fresh_log(name), self.time_limit(room), self.work,
                                         {"TAUT_MUTANT": str(self.numbers[m.key])}), (m, room))
        self.note_all(tasks)

    def note_all(self, tasks, unbroken=None):
        """Each is run in an empty folder: tests write files, and ask whether some are not there."""
        free = [self.work / f"switched/run-{i}" for i in range(self.options.jobs)]

        def placed():
            for task, _ in tasks.values():
                folder = free.pop()
                shutil.rmtree(folder, ignore_errors=True)
                folder.mkdir()
                yield task._replace(cwd=folder)

        for task, status, seconds in self.many(placed(), self.options.jobs):
            free.append(task.cwd)
            m, room = tasks[task.name][1]
            outcome, detail = self.outcome(task, status)
            self.note(unbroken or m.key, room, outcome, seconds, "unbroken" if unbroken else m.name, detail)
            if unbroken and outcome != SURVIVED:
                print(f"{room} does not pass unbroken: {task.log}", flush=True)

    def seconds(self, room):
        """What its unbroken tests took; infinity before they have passed."""
        return min((float(row.run_s) for row in self.known() if row.key == f"unbroken-{self.digest}"
                    and row.program == room and row.outcome == SURVIVED), default=math.inf)

    def time_limit(self, room):
        """Five times that."""
        if self.seconds(room) == math.inf:
            self.run([(None, room)])
        return max(30.0, 5 * self.seconds(room))
