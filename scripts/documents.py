#!/usr/bin/python3
"""Compare the output of commands in documents with the output of the same commands now.

    scripts/documents.py FILE...            run the commands of these documents and list the output that differs
    scripts/documents.py --seconds FILE...  run only commands that take seconds; --rough: list only differences beyond tolerances
    scripts/documents.py --write FILE...    replace output that differs, in place

The commands of a document run as one session in an empty folder, which has the links build, cases, scripts and doc, and
shoal and plot.py are in PATH. The kind of a fenced block decides what is done with it:

    ```yaml      a file, named by a comment in the first line or by the sentence above: Write `pair.yaml`
    ```sh        commands; "sh minutes": skipped with --seconds, together with the output of these commands
    ```python    a script; all scripts of a document share their variables ("python minutes" likewise)
    ```output    the output of the block of commands or the script above; a line "..." stands for any lines,
                 and "..." in a line for any text. In a script a comment after print(...) is the output of this call.
    ```console   commands that are not run: for other machines, for hours

Two numbers agree if they differ by at most one unit of the last digit, integers above 99 by 2 %, and numbers below 1e-6 by
a factor of three. With --rough, numbers may differ by 1 %, integers above 9 by 20 %, and powers of ten and error bars by a
factor of three. Measured times (columns wall, +-, us/eval.; CPU x) are not compared. The output of a command is its
standard output, followed by its standard error without the lines of progress.

The exit code is 0 if all output is true, 1 if some differs or a command failed, and 2 for a wrong command line.
"""

import argparse
import contextlib
import io
import os
import re
import subprocess
import sys
import tempfile
import traceback

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
FENCE = re.compile(r"^```(\w*) *(\w*)\n(.*?)^```$", re.M | re.S)
PROGRESS = re.compile(r"^(t +[\d.]+ s|beat +\d+ |\d+ of \d+ members)")
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w])")
MEASURED = {"wall", "wall, s", "+-", "us/eval."}
PRINT = re.compile(r"^( *)print\((.*)\) +# (.*)$", re.M)


class Block:
    """A fenced block of a document: kind, option, text, and the line of its first line of text."""

    def __init__(self, document, found):
        self.kind, self.option, self.text = found.groups()
        self.start, self.end = found.span(3)
        self.line = document.count("\n", 0, self.start) + 1
        before = document[: found.start()].rstrip("\n").split("\n\n")[-1]
        named = re.findall(r"Write `([\w-]+\.yaml)`", before) + re.findall(r"\A# ([\w-]+\.yaml)\n", self.text)
        self.file = named[-1] if named and self.kind == "yaml" else None


def blocks_of(document):
    return [Block(document, found) for found in FENCE.finditer(document)]


# ---- comparison of lines


def is_near(shown, printed, is_rough, is_bar=False):
    """Whether two numbers as texts agree; is_bar: of an error bar."""
    if shown == printed:
        return True
    a, b = float(shown), float(printed)
    if 0 < abs(a) < 1e-6 or is_rough and a != 0 and ("e" in shown or is_bar):  # errors
        return 1 / 3 <= b / a <= 3
    if shown.lstrip("+-").isdigit():
        return abs(a - b) <= (0.2 * abs(a) if is_rough and abs(a) > 9 else 0.02 * abs(a) if abs(a) > 99 else 0)
    mantissa, _, exponent = shown.partition("e")
    unit = 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
    return abs(a - b) <= max(1.01 * unit, 0.01 * abs(a) if is_rough else 0)


def is_same_line(shown, printed, is_rough=False):
    """Whether a printed line is the shown line: words, and numbers within their last digit; "..." is any text."""
    shown, printed = (re.sub(r"CPU x [\d.]+", "CPU x", re.sub(r", CPU x [\d.]+", "", " ".join(line.split()))) for line in (shown, printed))
    words = [".*".join(map(re.escape, part.split("..."))) for part in NUMBER.split(shown)]
    found = re.fullmatch(f"({NUMBER.pattern})".join(words), printed)
    before = NUMBER.split(shown)
    return found is not None and all(is_near(a, b, is_rough, text.endswith("+- "))
                                     for text, a, b in zip(before, NUMBER.findall(shown), found.groups()))


def without_times(lines):
    """Lines of tables with an underscore in the columns of measured times."""
    columns = set()
    for line in lines:
        cells = re.split(r"\s{2,}", line.strip())
        if MEASURED & set(cells):
            columns = {i for i, cell in enumerate(cells) if cell in MEASURED}
        elif not line.strip():
            columns = set()
        yield "  ".join("_" if i in columns else cell for i, cell in enumerate(cells))


def is_same(shown, printed, is_rough):
    """Whether the printed lines are the shown lines, where a line "..." stands for any number of lines."""
    shown, printed = (list(without_times(lines)) for lines in (shown, printed))
    possible = {0}  # numbers of printed lines that the shown lines so far can stand for
    for line in shown:
        if line.strip() == "...":
            possible = set(range(min(possible), len(printed) + 1)) if possible else set()
        else:
            possible = {n + 1 for n in possible if n < len(printed) and is_same_line(line, printed[n], is_rough)}
    return len(printed) in possible


# ---- sessions


class Session:
    """Runs the blocks of one document in a temporary folder."""

    def __init__(self, program, folder):
        self.folder, self.names = folder, {}
        for name in ("cases", "scripts", "doc"):
            os.symlink(os.path.join(ROOT, name), os.path.join(folder, name))
        os.symlink(os.path.dirname(program), os.path.join(folder, "build"))
        self.environment = {**os.environ, "PATH": os.pathsep.join([os.path.dirname(program), os.path.join(ROOT, "scripts"), os.environ["PATH"]]),
                            "MPLBACKEND": "Agg", "MPLCONFIGDIR": os.path.join(folder, ".matplotlib"), "OMP_NUM_THREADS": "1"}

    def commands(self, text):
        """The output of commands in the shell."""
        done = subprocess.run(["bash", "-c", text], cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, check=False)
        lines = done.stdout.splitlines() + [line for line in done.stderr.splitlines() if not PROGRESS.match(line)]
        return lines, done.returncode

    def script(self, text):
        """The output of a script, pairs (comment, output) of calls of print with a comment, and the traceback of a failure."""
        calls, out = [], io.StringIO()

        def shown(comment):
            def call(*values, **options):
                one = io.StringIO()
                print(*values, file=one, **options)
                out.write(one.getvalue())
                calls.append((comment, one.getvalue()))
            return call

        self.names["__shown__"] = shown
        text = PRINT.sub(lambda found: f"{found[1]}__shown__({found[3]!r})({found[2]})", text)
        here, failure = os.getcwd(), ""
        os.chdir(self.folder)
        try:
            with contextlib.redirect_stdout(out):
                exec(compile(text, "the script", "exec"), self.names)  # pylint: disable=exec-used
        except BaseException:  # pylint: disable=broad-except
            failure = traceback.format_exc(limit=-2)
        finally:
            os.chdir(here)
        return out.getvalue().splitlines(), calls, failure


def compare(path, program, only_seconds=False, is_rough=False):
    """Run a document; yields (block, line, shown lines, printed lines) for each output that differs, with a block of output
    or None, and for each failure."""
    with open(path, encoding="utf-8") as file:
        document = file.read()
    blocks = blocks_of(document)
    last = max((i for i, block in enumerate(blocks) if block.kind == "output" or block.kind == "python" and PRINT.search(block.text)), default=-1)
    with tempfile.TemporaryDirectory(prefix="shoal-documents-") as folder:
        session, printed, code, source = Session(program, folder), None, 0, None
        for i, block in enumerate(blocks[: last + 1]):
            follows = i + 1 < len(blocks) and blocks[i + 1].kind == "output"
            if block.file:
                with open(os.path.join(folder, block.file), "w", encoding="utf-8") as file:
                    file.write(block.text)
            elif block.kind in ("sh", "python") and only_seconds and block.option == "minutes":
                printed = None
            elif block.kind == "sh":
                print(f"{path}:{block.line}: {block.text.rstrip()}", file=sys.stderr)
                printed, code = session.commands(block.text)
                if code and not follows:
                    yield None, block.line, ["exit code 0"], [*printed[-5:], f"exit code {code}"]
            elif block.kind == "python":
                printed, calls, failure = session.script(block.text)
                if failure:
                    yield None, block.line, ["no exception"], failure.splitlines()
                for comment, text in calls:
                    if not is_same_line(comment, text):
                        yield None, block.line, [comment], text.splitlines()
            elif block.kind == "output" and printed is None and source is None:
                yield None, block.line, block.text.splitlines(), ["no command above"]
            elif block.kind == "output" and printed is not None and not is_same(block.text.splitlines(), printed, is_rough):
                yield block, block.line, block.text.splitlines(), printed
            if block.kind in ("sh", "python"):
                source = block


def replaced(shown, printed):
    """The shown lines with the numbers of the next printed line of the same words; None without such a line. Without "..."
    the printed lines."""
    if not any("..." in line for line in shown):
        return printed
    words = ["0".join(" ".join(part.split()) for part in NUMBER.split(line)) for line in printed]
    new, at = [], 0
    for line in shown:
        if "..." in line:
            new.append(line)
            continue
        wanted = "0".join(" ".join(part.split()) for part in NUMBER.split(line))
        if wanted not in words[at:]:
            return None
        at = words.index(wanted, at) + 1
        new.append(printed[at - 1])
    return new


def write(path, found):
    """Replace blocks of output by the printed lines."""
    with open(path, encoding="utf-8") as file:
        document = file.read()
    for block, _, shown, printed in reversed(found):
        new = replaced(shown, printed) if block else None
        if new:
            document = document[: block.start] + "\n".join(new) + "\n" + document[block.end :]
    with open(path, "w", encoding="utf-8") as file:
        file.write(document)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", metavar="FILE", help="documents in markdown")
    parser.add_argument("--seconds", action="store_true", help="only commands that take seconds")
    parser.add_argument("--rough", action="store_true", help="allow what the tolerance of the solver allows")
    parser.add_argument("--write", action="store_true", help="replace output that differs")
    parser.add_argument("--program", default=os.path.join(ROOT, "build", "shoal"), help="default: build/shoal")
    options = parser.parse_args()
    sys.path.insert(0, os.path.join(ROOT, "scripts"))  # the package shoal
    n_different = 0
    for path in options.files:
        found = list(compare(path, os.path.abspath(options.program), options.seconds, options.rough))
        for _, line, shown, printed in found:
            print(f"{path}:{line}: differs", *(f"    - {one}" for one in shown), *(f"    + {one}" for one in printed), sep="\n")
        if options.write:
            write(path, found)
        n_different += len(found)
    return 1 if n_different else 0


if __name__ == "__main__":
    sys.exit(main())
