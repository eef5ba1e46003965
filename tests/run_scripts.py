"""run_scripts.py: run scripts one after the other, each in a fork of this process, which has loaded what they need.

A script comes on standard input as the number of its words, the folder to run in and the words, the path first, each with
a zero byte at its end. What the script prints goes to the file python.printed of the first folder, and its exit code to
standard output.
"""

import os
import runpy
import sys
import traceback

import netCDF4  # noqa: F401
import numpy  # noqa: F401

printed = os.path.abspath("python.printed")


def word():
    """The next word on standard input, or None at its end."""
    letters = b"".join(iter(lambda: os.read(0, 1).replace(b"\0", b""), b""))
    return letters.decode()


def run(words):
    """Run a script in this process; its exit code."""
    os.dup2(os.open(printed, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), 1)
    os.dup2(1, 2)
    sys.argv = words
    sys.path[0] = os.path.dirname(words[0]) or "."
    try:
        runpy.run_path(words[0], run_name="__main__")
    except SystemExit as end:
        if end.code is None or isinstance(end.code, int):
            return end.code or 0
        print(end.code)
        return 1
    except BaseException:
        traceback.print_exc()
        return 1
    return 0


while n_words := word():
    os.chdir(word())
    words = [word() for _ in range(int(n_words))]
    child = os.fork()
    if child == 0:
        code = run(words)
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) & 255, flush=True)
