#!/usr/bin/python3
"""Change the program in one place at a time and check that the tests fail.

    scripts/mutants.py [-j N] [ID...]
    scripts/mutants.py --check

A mutant is the program with one small error. Each mutant of tests/mutants/mutants.txt is built in a copy of this tree, in
which its tests then run, and it is killed if one of them fails. Without an ID all mutants run. --check only compares the
table with the sources.

The exit code is 0 if at least 9 in 10 are killed, 1 if fewer are, and 2 if the table does not fit the sources or the tests
fail on the unchanged program.
"""

import argparse
import glob
import os
import queue
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from dataclasses import dataclass

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
TABLE = "tests/mutants/mutants.txt"
COPIED = ("Makefile", "src", "include", "tests", "scripts", "cases", "doc", "build")
ENOUGH = 0.9  # of the mutants
TIME_LIMIT = 120  # seconds for one test: a mutant may never end


@dataclass
class Mutant:
    name: str
    file: str
    tests: list
    old: str
    new: str


def give_up(messages):
    print("\n".join(messages), file=sys.stderr)
    sys.exit(2)


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def write(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


# ---- the table


def read_table():
    """The mutants, one in a line; the table says how."""
    mutants = []
    for line in read(os.path.join(ROOT, TABLE)).splitlines():
        if not line.strip() or line[0] == "#":
            continue
        match = re.fullmatch(r"(\w+) (\S+): ([\w ]+): (.+?) =>(.*)", line)
        if not match:
            give_up([f"{TABLE}: not a mutant: {line}"])
        name, file, tests, old, new = match.groups()
        mutants.append(Mutant(name, file, tests.split(), old, new.strip()))
    return mutants


def path_of_test(name):
    """The C file or shell script of a test."""
    found = glob.glob(f"{ROOT}/tests/*/test_{name}.c") + glob.glob(f"{ROOT}/tests/*/test_{name}.sh")
    return os.path.relpath(found[0], ROOT) if len(found) == 1 else None


def faults(mutants):
    """Entries that do not fit the sources."""
    for mutant in mutants:
        path = os.path.join(ROOT, mutant.file)
        if not os.path.exists(path):
            yield f"{mutant.name}: there is no {mutant.file}"
        elif read(path).count(mutant.old) != 1:
            n = read(path).count(mutant.old)
            yield f"{mutant.name}: '{mutant.old}' occurs {n} times in {mutant.file} instead of once"
        for test in mutant.tests:
            if not path_of_test(test):
                yield f"{mutant.name}: there is no test_{test}, or more than one"
        if [other.name for other in mutants].count(mutant.name) > 1:
            yield f"{mutant.name}: this name occurs more than once"


# ---- copies of the tree


class Copy:
    """A copy of the tree, with existing build products."""

    def __init__(self, origin, folder):
        self.folder = folder
        os.makedirs(folder)
        existing = [name for name in COPIED if os.path.exists(os.path.join(origin, name))]
        # with the times of the files, so that make builds only what changes
        subprocess.run(["cp", "-a", *existing, folder], cwd=origin, check=True)

    def run(self, *command):
        """The output if the command fails, else None."""
        ended = subprocess.run(
            command,
            cwd=self.folder,
            env={**os.environ, "TIME_LIMIT": str(TIME_LIMIT)},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            check=False,
        )
        return ended.stdout if ended.returncode else None

    def build(self, tests):
        programs = ["build/" + path[:-2] for path in map(path_of_test, tests) if path.endswith(".c")]
        compiler = ["CC=ccache gcc"] if shutil.which("ccache") else []
        # unused code of a mutant is no error
        return self.run("make", "-s", *compiler, "CFLAGS=-O3 -g -Wno-error", "all", *programs)

    def test(self, name):
        path = path_of_test(name)
        return self.run("scripts/run-tests.sh", "build/shoal", path if path.endswith(".sh") else "build/" + path[:-2])

    def outcome(self, mutant):
        """"killed by TEST", "survived" or "not built"."""
        path = os.path.join(self.folder, mutant.file)
        original = read(path)
        write(path, original.replace(mutant.old, mutant.new))
        try:
            if self.build(mutant.tests):
                return "not built"
            for test in mutant.tests:
                if self.test(test):
                    return f"killed by {test}"
            return "survived"
        finally:
            write(path, original)


def on_all(copies, tasks, work):
    """work(copy, task) for every task, one at a time on each copy."""
    waiting = queue.SimpleQueue()
    for task in tasks:
        waiting.put(task)

    def loop(copy):
        while not waiting.empty():
            try:
                work(copy, waiting.get_nowait())
            except queue.Empty:
                return

    threads = [threading.Thread(target=loop, args=(copy,), daemon=True) for copy in copies]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def prepare(folder, n, tests):
    """n copies in which the tests are built and pass."""
    first = Copy(ROOT, os.path.join(folder, "0"))
    output = first.build(tests)
    if output:
        give_up([output, "the program as it is cannot be built"])
    copies = [first] + [Copy(first.folder, os.path.join(folder, str(i))) for i in range(1, n)]
    failures = []

    def check(copy, test):
        output = copy.test(test)
        if output:
            failures.append(f"{output}test_{test} fails on the program as it is")

    on_all(copies, tests, check)
    if failures:
        give_up(failures)
    return copies


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-j", type=int, default=2, metavar="N", help="mutants at a time (2)")
    parser.add_argument("--check", action="store_true", help="only see that the table fits the sources")
    parser.add_argument("ID", nargs="*", help="mutants to run (all)")
    arguments = parser.parse_args()
    table = read_table()
    mutants = [mutant for mutant in table if not arguments.ID or mutant.name in arguments.ID]
    wrong = list(faults(table)) + [f"{ID}: no such mutant" for ID in arguments.ID if ID not in [m.name for m in table]]
    if wrong:
        give_up(wrong)
    if arguments.check:
        return

    outcomes = {}
    with tempfile.TemporaryDirectory(prefix="shoal-mutants-") as folder:
        copies = prepare(folder, arguments.j, sorted({test for mutant in mutants for test in mutant.tests}))

        def run(copy, mutant):
            started = time.monotonic()
            outcomes[mutant.name] = copy.outcome(mutant)
            seconds = time.monotonic() - started
            print(f"{mutant.name:<36} {mutant.file:<34} {outcomes[mutant.name]:<34} {seconds:5.1f} s", flush=True)

        on_all(copies, mutants, run)

    killed = [name for name, outcome in outcomes.items() if outcome.startswith("killed")]
    for name, outcome in outcomes.items():
        if name not in killed:
            print(f"{name}: {outcome}")
    print(f"{len(killed)} of {len(mutants)} killed")
    return 0 if len(killed) >= ENOUGH * len(mutants) else 1


if __name__ == "__main__":
    sys.exit(main())
