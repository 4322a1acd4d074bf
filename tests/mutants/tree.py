# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT
"""A private copy of the tree, and what runs in it."""

import collections
import fcntl
import hashlib
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import time

from lists import ROOT

KILLED, SURVIVED, NO_BUILD = "killed", "survived", "does not compile"
BUILD_LIMIT = 7200  # s
MEMORY = 8 * 2**30  # bytes of a process, at most
Result = collections.namedtuple("Result", "key program outcome run_s name detail")
Task = collections.namedtuple("Task", "name arguments log limit cwd environment", defaults=({},))


def program_of(room):
    return f"{room}_test"


def limits():
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


class Copy:
    def __init__(self, options, folder):
        self.options = options
        self.work = options.work.resolve()
        self.tree, self.build = self.work / folder / "tree", self.work / folder / "build"
        self.logs = self.work / folder / "logs"
        self.results = self.work / "results.tsv"
        self.logs.mkdir(parents=True, exist_ok=True)

    def lock(self):
        self.held = open(self.work / "lock", "w", encoding="utf-8")
        try:
            fcntl.flock(self.held, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            sys.exit(f"{self.work} is in use by another run; give --work")

    def sync(self, instead=None):
        """As the tree is, whatever an interrupted run left, but for {file: text}; what is equal keeps its time."""
        instead = instead or {}
        listed = subprocess.run(["git", "ls-files", "-coz", "--exclude-standard"], cwd=ROOT, check=True,
                                stdout=subprocess.PIPE).stdout.decode().split("\0")
        files = {f for f in listed if (ROOT / f).is_file()} | set(instead)
        digest, headers = hashlib.sha256(), hashlib.sha256()
        for file in sorted(files):
            here, there = ROOT / file, self.tree / file
            content = instead[file].encode() if file in instead else here.read_bytes()
            if file.startswith(("include/", "tests/", "compiled/", "cmake/")) \
                    and not file.startswith("tests/mutants/"):
                digest.update(file.encode() + content)
            if file.startswith("include/"):
                headers.update(file.encode() + content)
            if there.is_file() and there.read_bytes() == content:
                continue
            there.parent.mkdir(parents=True, exist_ok=True)
            there.write_bytes(content)
            if here.is_file():
                shutil.copymode(here, there)
        for there in [p for p in self.tree.rglob("*") if p.is_file()]:
            if str(there.relative_to(self.tree)) not in files:
                there.unlink()
        self.digest, self.headers = digest.hexdigest()[:12], headers.hexdigest()[:12]

    # ---- processes ----

    def many(self, tasks, jobs):
        """So many tasks at a time. (task, exit status or None after its limit, seconds) of each as it ends."""
        tasks, running = iter(tasks), []
        try:
            while True:
                while len(running) < jobs and (task := next(tasks, None)) is not None:
                    with open(task.log, "ab") as out:
                        out.write(f"\n$ {' '.join(map(str, task.arguments))}\n".encode())
                        out.flush()
                        child = subprocess.Popen(
                            task.arguments, cwd=task.cwd, stdin=subprocess.DEVNULL, stdout=out, stderr=out,
                            start_new_session=True, preexec_fn=limits, env={**os.environ, **task.environment})
                    running.append((task, child, time.monotonic()))
                if not running:
                    return
                time.sleep(0.02)
                for task, child, start in list(running):
                    seconds = time.monotonic() - start
                    status = child.poll()
                    if status is None and seconds <= task.limit:
                        continue
                    if status is None:
                        os.killpg(child.pid, signal.SIGKILL)
                        child.wait()
                    running.remove((task, child, start))
                    yield task, status, seconds
        finally:
            for _, child, _ in running:
                os.killpg(child.pid, signal.SIGKILL)
                child.wait()

    def command(self, task):
        for _, status, seconds in self.many([task], 1):
            return status, seconds

    def configure(self, *more):
        log = self.fresh_log("configure")
        if self.command(Task("", ["cmake", "--preset", "test", "-S", ".", "-B", self.build, "-D",
                                  "TAUT_BUILD_EXAMPLES=OFF", "-D", "TAUT_TEST_PARTS=units", "-D", "TAUT_WERROR=OFF",
                                  *more, *self.options.cmake], log, 600, self.tree))[0] != 0:
            sys.exit(f"cmake failed: {log}")

    def build_targets(self, targets, log):
        return self.command(Task("", ["cmake", "--build", self.build, "-j", str(self.options.jobs), "--target",
                                      *targets, "--", "-k", "0"], log, BUILD_LIMIT, self.work))

    def test(self, name, room, log, limit, cwd, environment=None):
        """The task that runs the tests of a room up to the first failure."""
        return Task(name, [self.build / "tests" / program_of(room), "--abort"], log, limit, cwd, environment or {})

    @staticmethod
    def outcome(task, status):
        if status == 0:
            return SURVIVED, ""
        text = task.log.read_text(encoding="utf-8", errors="replace")
        failed = re.findall(r"(tests/\S+?:\d+): FAILED", text)
        return KILLED, failed[-1] if failed else "time limit" if status is None else f"exit status {status}"

    # ---- results ----

    def known(self):
        if not self.results.is_file():
            return []
        rows = [line.split("\t") for line in self.results.read_text(encoding="utf-8").splitlines()]
        return [Result(*row) for row in rows if len(row) == len(Result._fields)]

    def note(self, key, program, outcome, run_s, name, detail):
        with open(self.results, "a", encoding="utf-8") as out:
            out.write("\t".join([key, program, outcome, f"{run_s:.1f}", name, detail]) + "\n")
        print(f"{name:12} {program:14} {outcome:17} {run_s:5.1f} s  {detail}", flush=True)

    def fresh_log(self, name):
        log = self.logs / f"{name.replace(':', '-').replace('/', '-')}.log"
        log.unlink(missing_ok=True)
        return log
