#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT
"""Breaks one line of include/taut at a time, in a copy of the tree, and runs the tests of its room.

A list is made of blocks with blank lines between them:

    guard include/taut/guard/detail/trim.hpp    the room whose tests run, and the file
    # why it would hurt                         any number of such lines, or none
    - a line of the file                        which occurs once; blanks around it do not count
    + what becomes of it

Each result is appended to build/mutants/results.tsv. A mutant that has one there is not run again, so the program
may be stopped and started again. docs/testing.md says more.
"""

import argparse
import collections
import fcntl
import filecmp
import hashlib
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
LISTS = ("chosen", "drawn")
KILLED, SURVIVED, NO_BUILD = "killed", "survived", "does not compile"

Mutant = collections.namedtuple("Mutant", "name room file old new at key")
Result = collections.namedtuple("Result", "key program outcome build_s run_s name detail")


# ---- lists ----

def read_list(name):
    path = HERE / f"{name}.txt"
    mutants, block, at = [], [], 0
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines() + [""], 1):
        if line.strip() and not line.startswith("#"):
            at = at or number
            block.append(line)
            continue
        if line.strip() or not block:
            continue
        head = block[0].split()
        if len(block) != 3 or len(head) != 2 or block[1][:1] != "-" or block[2][:1] != "+":
            sys.exit(f"{path}:{at}: not a block of ROOM FILE, a line '- ' and a line '+ '")
        old, new = block[1][1:].strip(), block[2][1:].strip()
        key = hashlib.sha256("\n".join([head[1], old, new]).encode()).hexdigest()[:12]
        mutants.append(Mutant(f"{name}:{len(mutants) + 1}", head[0], head[1], old, new, at, key))
        block, at = [], 0
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


# ---- which programs read a header ----

def included(path, folders):
    for name in re.findall(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', path.read_text(encoding="utf-8"), re.M):
        for folder in (path.parent, *folders):
            found = (folder / name).resolve()
            if found.is_file():
                yield found
                break


def programs_that_read(file):
    folders = (ROOT / "include", ROOT / "tests")
    target, programs = (ROOT / file).resolve(), []
    for room in sorted(p.name for p in (ROOT / "tests").iterdir() if any(p.glob("*_test.cpp"))):
        front = [*(ROOT / "tests" / room).glob("*_test.cpp"), *(ROOT / "tests/support").glob("*.cpp")]
        known = set(front)
        while front:
            for path in included(front.pop(), folders):
                if path not in known:
                    known.add(path)
                    front.append(path)
        if target in known:
            programs.append(room)
    return programs


# ---- the private copy ----

class Copy:
    def __init__(self, options):
        self.options = options
        self.work = options.work.resolve()
        self.tree, self.build, self.logs = self.work / "tree", self.work / "build", self.work / "logs"
        self.results = self.work / "results.tsv"
        self.logs.mkdir(parents=True, exist_ok=True)

    def lock(self):
        self.held = open(self.work / "lock", "w", encoding="utf-8")
        try:
            fcntl.flock(self.held, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            sys.exit(f"{self.work} is in use by another run; give --work")

    def sync(self):
        """As the tree is, whatever an interrupted run left; what is equal keeps its time."""
        listed = subprocess.run(["git", "ls-files", "-coz", "--exclude-standard"], cwd=ROOT, check=True,
                                stdout=subprocess.PIPE).stdout.decode().split("\0")
        files = {f for f in listed if f and (ROOT / f).is_file()}
        for file in files:
            here, there = ROOT / file, self.tree / file
            if there.is_file() and filecmp.cmp(here, there, shallow=False):
                continue
            there.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(here, there)
            shutil.copymode(here, there)
        for there in [p for p in self.tree.rglob("*") if p.is_file()]:
            if str(there.relative_to(self.tree)) not in files:
                there.unlink()
        digest = hashlib.sha256()
        for file in sorted(f for f in files if f.startswith(("include/", "tests/", "compiled/", "cmake/"))
                           and not f.startswith("tests/mutants/")):
            digest.update(file.encode() + (ROOT / file).read_bytes())
        self.digest = digest.hexdigest()[:12]

    def command(self, arguments, log, limit, cwd):
        """(exit status or None after the limit, seconds); output goes to the log."""
        def limits():
            most = int(self.options.memory * 2**30)
            resource.setrlimit(resource.RLIMIT_AS, (most, most))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        start = time.monotonic()
        with open(log, "ab") as out:
            out.write(f"\n$ {' '.join(map(str, arguments))}\n".encode())
            out.flush()
            child = subprocess.Popen(arguments, cwd=cwd, stdin=subprocess.DEVNULL, stdout=out, stderr=out,
                                     start_new_session=True, preexec_fn=limits)
            try:
                status = child.wait(limit)
            except BaseException as error:
                os.killpg(child.pid, signal.SIGKILL)
                child.wait()
                if not isinstance(error, subprocess.TimeoutExpired):
                    raise
                status = None
        return status, time.monotonic() - start

    def configure(self):
        log = self.logs / "configure.log"
        status, _ = self.command(
            ["cmake", "--preset", "test", "-S", ".", "-B", self.build, "-D", "TAUT_BUILD_EXAMPLES=OFF",
             "-D", "TAUT_TEST_PARTS=units", "-D", "TAUT_WERROR=OFF",
             "-D", "TAUT_COMPILED=OFF",  # which a line of the core would have built anew, for whatever program
             *self.options.cmake], log, 600, self.tree)
        if status != 0:
            sys.exit(f"cmake failed: {log}")

    def run(self, program, log, limit):
        """(outcome, seconds of building, seconds of running, what failed)."""
        status, build_s = self.command(
            ["cmake", "--build", self.build, "--target", f"{program}_test", "-j", str(self.options.jobs)],
            log, self.options.build_limit, self.work)
        if status != 0:
            return NO_BUILD, build_s, 0.0, "the compiler took too long" if status is None else ""
        begin = log.stat().st_size
        status, run_s = self.command([self.build / "tests" / f"{program}_test", "--abort"], log, limit,
                                     self.build / "tests")
        if status == 0:
            return SURVIVED, build_s, run_s, ""
        with open(log, "rb") as said:
            said.seek(begin)
            text = said.read().decode(errors="replace")
        failed = re.search(r"(tests/\S+?:\d+): FAILED", text)
        detail = failed.group(1) if failed else "time limit" if status is None else f"exit status {status}"
        return KILLED, build_s, run_s, detail

    def known(self):
        if not self.results.is_file():
            return []
        rows = [line.split("\t") for line in self.results.read_text(encoding="utf-8").splitlines()]
        return [Result(*row) for row in rows if len(row) == len(Result._fields)]

    def note(self, key, program, result, name):
        outcome, build_s, run_s, detail = result
        row = [key, program, outcome, f"{build_s:.1f}", f"{run_s:.1f}", name, detail]
        with open(self.results, "a", encoding="utf-8") as out:
            out.write("\t".join(row) + "\n")
        print(f"{name:12} {program:14} {outcome:17} {build_s:6.0f} s + {run_s:5.1f} s  {detail}", flush=True)

    def time_limit(self, program):
        """Five times what the unbroken program takes, which must pass."""
        key = f"unbroken-{self.digest}"
        for row in self.known():
            if row.key == key and row.program == program and row.outcome == SURVIVED:
                return max(60.0, 5 * float(row.run_s))
        result = self.run(program, self.fresh_log(f"unbroken-{program}"), 3600)
        self.note(key, program, result, "unbroken")
        if result[0] != SURVIVED:
            sys.exit(f"{program}_test does not pass unbroken: {self.logs}/unbroken-{program}.log")
        return max(60.0, 5 * result[2])

    def fresh_log(self, name):
        log = self.logs / f"{name.replace(':', '-')}.log"
        log.unlink(missing_ok=True)
        return log

    def try_mutant(self, mutant, programs):
        """Until one of the programs kills it."""
        limits = {program: self.time_limit(program) for program in programs}
        path = self.tree / mutant.file
        whole = path.read_text(encoding="utf-8")
        try:
            path.write_text(broken(whole, mutant), encoding="utf-8")
            for program in programs:
                result = self.run(program, self.fresh_log(f"{mutant.name}-{program}"), limits[program])
                self.note(mutant.key, program, result, mutant.name)
                if result[0] != SURVIVED:
                    return
        finally:
            path.write_text(whole, encoding="utf-8")


# ---- the whole ----

def table(mutants, rows):
    latest = {}
    for row in rows:
        latest.setdefault(row.key, {})[row.program] = row.outcome
    counts = collections.defaultdict(collections.Counter)
    survivors = []
    for m in mutants:
        outcomes = latest.get(m.key, {})
        if not outcomes:
            outcome = "not run"
        elif KILLED in outcomes.values():
            outcome = KILLED if outcomes.get(m.room) == KILLED else "elsewhere"
        else:
            outcome = NO_BUILD if NO_BUILD in outcomes.values() else SURVIVED
        counts[m.room][outcome] += 1
        counts["all"][outcome] += 1
        if outcome in (SURVIVED, "elsewhere"):
            survivors.append((m, outcome))
    columns = (KILLED, "elsewhere", SURVIVED, NO_BUILD, "not run")
    print(f"\n{'room':14}" + "".join(f"{c:>18}" for c in columns))
    for room in sorted(counts, key=lambda r: (r == "all", r)):
        print(f"{room:14}" + "".join(f"{counts[room][c]:>18}" for c in columns))
    for m, outcome in survivors:
        print(f"\n{m.name} survived{'' if outcome == SURVIVED else ' its own room'}: {m.file}\n- {m.old}\n+ {m.new}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--list", choices=(*LISTS, "both"), default="both")
    parser.add_argument("--room", help="only these rooms, such as guard,model")
    parser.add_argument("--numbers", type=numbers, help="only these of the list, such as 1-5,9")
    parser.add_argument("--most", type=int, help="at most so many of a room and list, drawn by their text")
    parser.add_argument("--check", action="store_true", help="whether each line occurs once; compiles nothing")
    parser.add_argument("--table", action="store_true", help="what is known; compiles nothing")
    parser.add_argument("--wider", action="store_true", help="survivors: all programs that read the header, too")
    parser.add_argument("--again", action="store_true", help="those that have a result, too")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="compilers at a time")
    parser.add_argument("--memory", type=float, default=8, help="of a process, at most, GB")
    parser.add_argument("--build-limit", type=float, default=7200, help="s")
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "build/mutants",
                        help="the folder of the copy; two runs at a time need two")
    parser.add_argument("--cmake", action="append", default=[], help="one more argument of cmake: --cmake=-DNAME=VALUE")
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

    copy = Copy(options)
    if options.table:
        table(mutants, copy.known())
        return 0
    if not check(mutants):
        return 1
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("stopped"))  # which ends the child and mends the line
    copy.lock()
    copy.sync()
    copy.configure()
    for m in sorted(mutants, key=lambda m: m.room):  # a stable sort: a room is built once
        if options.again or not any(r.key == m.key and r.program == m.room for r in copy.known()):
            copy.try_mutant(m, [m.room])
    for m in mutants if options.wider else []:
        rows = [r for r in copy.known() if r.key == m.key]
        if any(r.outcome != SURVIVED for r in rows):
            continue
        done = {r.program for r in rows}
        copy.try_mutant(m, [p for p in programs_that_read(m.file) if p not in done])
    table(mutants, copy.known())
    return 0


if __name__ == "__main__":
    sys.exit(main())
