# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT
"""Builds the library once with all mutants in it that switches.py can write, and runs the tests by each."""

import collections
import json
import pathlib
import re
import shlex
import shutil
import sys

import switches
from lists import ROOT, broken, rooms_with_tests
from tree import SURVIVED, Copy, Task, program_of

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
        """[(source, arguments)] that check the syntax of what is built."""
        folders = [f"{program_of(room)[0]}.dir/" for room in rooms_with_tests()]
        listed = json.loads((self.build / "compile_commands.json").read_text(encoding="utf-8"))
        found = []
        for entry in listed:
            words = shlex.split(entry["command"])
            output = words[words.index("-o") + 1]
            if not any(f in output for f in (*folders, "TautCompiled.dir/", "test_support.dir/")) \
                    or entry["file"].endswith((".hxx.cxx", ".hxx")):
                continue
            at = words.index("-o")
            del words[at:at + 2]
            for i, word in enumerate(words):
                if word.endswith("cmake_pch.hxx"):  # a copy, as it may have been compiled from other text
                    copy = self.work / "switched" / re.sub(r"\W", "-", word.split("CMakeFiles/")[1]).replace(
                        "-hxx", ".hxx")
                    copy.write_text(pathlib.Path(word).read_text(encoding="utf-8"), encoding="utf-8")
                    words[i] = str(copy)
            size = pathlib.Path(entry["file"]).stat().st_size
            found.append((pathlib.Path(entry["file"]), [*words, "-fsyntax-only", "-w"], size))
        ranks = collections.Counter()
        order = []  # the two largest of each room and of each part of Taut::Compiled: the build checks the rest
        for source, words, size in sorted(found, key=lambda f: (-f[2], f[0])):
            of = source.stem.split("_")[0] if source.parent.name == "compiled" else source.parent.name
            ranks[of] += 1
            if ranks[of] <= 2:
                order.append((ranks[of], str(source), words))
        return [(pathlib.Path(source), words) for _, source, words in sorted(order)]

    def blame(self, text):
        """Groups whose lines the errors of a compiler name, and the errors that name none."""
        guilty, innocent, context = set(), [], []
        place = re.compile(r"(include/taut/[\w./]+):(\d+)")
        lines = text.splitlines()
        for i, line in enumerate(lines):
            is_error = re.search(r":\d+:\d+: (fatal )?error:", line) or re.search(r": error: ", line)
            if re.search(r"required (from|by)|In (instantiation|substitution)|[Rr]equired from", line):
                context.append(line)
                continue
            if not is_error:
                if re.search(r": (note|warning):", line):
                    context = []
                continue
            after = []
            for follow in lines[i + 1:]:
                if ": error:" in follow:
                    break
                after.append(follow)
            for said in (line, *context, *after):
                groups = [g for file, at in place.findall(said)
                          for g in self.lines.get(file, {}).get(int(at), [])]
                if groups:
                    guilty.add(groups[0])
                    break
            else:
                innocent.append(line)
            context = []
        return guilty, innocent

    def next_candidates(self, text, source, moved):
        """moved: the groups that were moved on since all were written."""
        guilty, innocent = self.blame(text)
        if not guilty:
            sys.exit(f"{source} does not compile, and no switch is to blame:\n" + "\n".join(innocent[:10]))
        for group in guilty - moved:
            moved.add(group)
            group.at += 1
            left = len(group.candidates) - group.at
            print(f"{source.name}: {', '.join(m.name for m, _, _ in group.mutants)}: {left} places left", flush=True)

    def check(self):
        """Moves groups on to candidates that compile."""
        self.write()
        self.configure("-D", "TAUT_COMPILED=ON", "-D", "CMAKE_CXX_FLAGS=-w",
                       "-D", "CMAKE_EXPORT_COMPILE_COMMANDS=ON")
        if self.checked == self.digest:
            return
        waiting, jobs = collections.deque(self.commands()), self.options.jobs
        while waiting:
            batch, moved = {}, set()
            for _ in range(min(jobs, len(waiting))):
                source, words = waiting.popleft()
                batch[str(source)] = (source, words)
            tasks = [Task(name, words, self.fresh_log(f"syntax-{source.parent.name}-{source.stem}"),
                          self.options.build_limit, self.build) for name, (source, words) in batch.items()]
            for task, status, _ in self.many(tasks, jobs):
                if status != 0:
                    source, words = batch[task.name]
                    self.next_candidates(task.log.read_text(encoding="utf-8", errors="replace"), source, moved)
                    waiting.appendleft((source, words))
            self.save()
            self.write()
        self.checked = self.digest
        self.save()

    def compile(self, rooms):
        targets = sorted({program_of(room)[0] for room in rooms})
        while True:
            log = self.fresh_log("build")
            status, seconds = self.command(
                ["cmake", "--build", self.build, "-j", str(self.options.jobs), "--target", *targets, "--", "-k", "0"],
                log, self.options.build_limit, self.work)
            if status == 0:
                print(f"{', '.join(targets)}: built in {seconds:.0f} s", flush=True)
                return
            self.next_candidates(log.read_text(encoding="utf-8", errors="replace"), log, set())
            self.save()
            self.write()

    # ---- the runs ----

    def run(self, wanted):
        """wanted: [(mutant, room)], of which those without a switch are left."""
        wanted = [(m, room) for m, room in wanted if self.has(m)]
        rooms = {room for _, room in wanted}
        if not rooms:
            return
        free = [self.work / f"switched/run-{i}" for i in range(self.options.jobs)]
        self.compile(rooms)
        wanted = [w for w in wanted if self.has(w[0])]
        fresh = [self.test(room, room, self.fresh_log(f"unbroken-{room}"), 3600, self.work)
                 for room in sorted(rooms) if self.unbroken(room) is None]
        for task, status, seconds in self.many(self.placed(fresh, free), self.options.jobs):
            free.append(task.cwd)
            outcome, detail = self.outcome(task, status)
            self.note(f"unbroken-{self.digest}", task.name, outcome, 0, seconds, "unbroken", detail)
            if outcome != SURVIVED:
                print(f"{task.name} does not pass unbroken: {task.log}", flush=True)
        took = {room: self.unbroken(room) for room in rooms}
        wanted = [w for w in wanted if took[w[1]] is not None]
        of, tasks = {}, []
        for m, room in sorted(wanted, key=lambda w: self.numbers[w[0].key]):
            name = f"{m.name}-{room}"
            of[name] = (m, room)
            tasks.append(self.test(name, room, self.fresh_log(name), max(30.0, 5 * took[room]), self.work,
                                   {"TAUT_MUTANT": str(self.numbers[m.key])}))
        for task, status, seconds in self.many(self.placed(tasks, free), self.options.jobs):
            free.append(task.cwd)
            m, room = of[task.name]
            outcome, detail = self.outcome(task, status)
            self.note(m.key, room, outcome, 0, seconds, m.name, detail)

    def seconds(self, room):
        """What its unbroken tests took; those that have not run come last."""
        known = self.unbroken(room)
        return float("inf") if known is None else known

    @staticmethod
    def placed(tasks, free):
        """Each in an empty folder: tests write files, and ask whether some are not there."""
        for task in tasks:
            folder = free.pop()
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir()
            yield task._replace(cwd=folder)
