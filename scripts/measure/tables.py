"""Run cases and write tables: the common part of the scripts that measure what the documents state.

Each of these scripts measures the tables of one document and is called after it:

    scripts/measure/numerics.py NAME...     print tables as markdown
    scripts/measure/numerics.py --compare   measure every table of the document again and list the rows that differ; print
                                            the tables that only its text names, to compare the numbers in the text
    scripts/measure/numerics.py --write     the same, and replace the tables in place
    scripts/measure/numerics.py --list      names of the tables, with a line about each

In a document, the line above a table contains its command, for example "`scripts/measure/numerics.py tolerance`". The
scripts run build/shoal in a temporary folder. Counts are exact. Seconds are CPU seconds of one machine, and ratios of seconds
come from the same table. Rows are compared as scripts/documents.py compares output, and CPU times may differ by a factor of
two. The exit code is 1 if some rows differ.
"""

import argparse
import json
import math
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from itertools import zip_longest

HERE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
CASES = os.path.join(HERE, "cases")
SCRIPT = os.path.relpath(os.path.abspath(sys.argv[0]), HERE)
sys.path.insert(0, os.path.join(HERE, "scripts"))

import netCDF4  # noqa: E402
from documents import NUMBER, is_same_line  # noqa: E402
from shoal._files import Results, np  # noqa: E402

# A default fish from rest: all other keys have the defaults of doc/cases.md.
DEFAULT = """\
format: 1
time: {end: 8, output_interval: 0.1}
fish:
  - {name: fish}
"""


class Bench:
    """Runs cases in a temporary folder."""

    def __init__(self, program, verbose):
        self.program, self.verbose = program, verbose
        self.folder = tempfile.mkdtemp(prefix="shoal-measure-")

    def call(self, *arguments, may_fail=False):
        """Run the program; standard output, or None after a permitted exit code 1."""
        command = [self.program, *arguments]
        if self.verbose:
            print(" ".join(command), file=sys.stderr)
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, check=False)
        if done.returncode == 1 and may_fail:
            return None
        if done.returncode != 0:
            sys.exit(f"{SCRIPT}: {' '.join(command)} failed:\n{done.stderr}")
        return done.stdout

    def case(self, text):
        """The path of a case: of a file in cases/ by name, else of a new file with this text."""
        if "\n" not in text:
            return os.path.join(CASES, f"{text}.yaml")
        path = os.path.join(self.folder, "case.yaml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    def run(self, text, *assignments):
        """The result of a case with some keys changed; None where the integration failed."""
        result = os.path.join(self.folder, "result.nc")
        sets = [word for one in assignments for word in ("--set", one)]
        done = self.call("run", self.case(text), "--force", "-q", "-o", result, *sets, may_fail=True)
        return None if done is None else Results(result)

    def steady(self, text, *assignments):
        """The steady state of a case by `shoal steady --json`; None if the search fails."""
        sets = [word for one in assignments for word in ("--set", one)]
        done = self.call("steady", self.case(text), "--force", "-q", "--json", "-o", "steady.nc", *sets, may_fail=True)
        return None if done is None else json.loads(done)

    def study(self, name):
        """Run a study of cases/studies: its folder, and its study.nc."""
        folder = os.path.join(self.folder, name)
        self.call("study", os.path.join(CASES, f"studies/{name}.yaml"), "-q", "-o", folder)
        return folder, open_study(os.path.join(folder, "study.nc"))

    def seconds(self, text, *assignments, repeats=3):
        """CPU seconds of a run, the smallest of some repeats."""
        times = []
        for _ in range(repeats):
            before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
            self.run(text, *assignments)
            times.append(resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before)
        return min(times)


def markdown(heads, rows):
    """A table in markdown."""
    cells = [heads] + rows
    widths = [max(len(row[column]) for row in cells) for column in range(len(heads))]
    lines = ["| " + " | ".join(cell.rjust(width) for cell, width in zip(row, widths)) + " |" for row in cells]
    lines.insert(1, "|" + "|".join("-" * (width + 1) + ":" for width in widths) + "|")
    return "\n".join(lines) + "\n"


def power(value):
    """1e+06 as 1e6."""
    mantissa, exponent = f"{value:.0e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def short(value):
    """Two digits of an error."""
    return f"{value:.1e}"


COUNTS = ["steps", "Newton iterations", "Jacobians"]


def n_events(results):
    return round(float(results.time[-1]) / float(results["shedding_interval"]))


def per_event(results):
    """Steps, Newton iterations and Jacobians per event."""
    names = ("steps", "newton_iterations", "jacobian_evaluations")
    return [f"{results[name][-1] / n_events(results):.2f}" for name in names]


def nose_and_tail(results, t=None):
    """Positions of nose and tail of the first fish at a time, by default the last one."""
    row = -1 if t is None else int(np.argmin(np.abs(results.time - t)))
    x = results["x"][row, 0]
    return x[0], x[results.n_nodes[0] - 1]


TABLES = {}


def table(*heads):
    """Register a function that yields the rows of a table."""

    def register(rows):
        TABLES[rows.__name__] = (heads, rows)
        return rows

    return register


def strings(variable):
    """The strings of a variable over (n, text)."""
    return [text.strip("\0 ") for text in netCDF4.chartostring(np.asarray(variable[:], dtype="S1"))]


def open_study(path):
    """A study.nc as netCDF4 has it, with texts as arrays of letters."""
    study = netCDF4.Dataset(path)
    study.set_auto_mask(False)
    study.set_auto_chartostring(False)
    return study


def lattice(n, spacing, end, interval=0.01, output=None, fish="control: {law: heading}"):
    """n fish in a square, default ones with heading control."""
    side = math.ceil(math.sqrt(n))
    places = [f"  - {{start: {{position: [{spacing[0] * (i % side):g}, {spacing[1] * (i // side):g}]}}}}"
              for i in range(n)]
    return "\n".join(["format: 1", f"time: {{end: {end}, shedding_interval: {interval}, output_interval: {output or end}}}",
                      f"defaults: {{fish: {{{fish}}}}}", "fish:", *places, ""])


COMMAND = re.compile(rf"^`{re.escape(SCRIPT)} ([a-z_]+)`")
IN_TEXT = re.compile(rf"`{re.escape(SCRIPT)}\s([a-z_]+)`")


def is_same_row(heads, shown, printed):
    """Whether two rows of a table agree, CPU times to a factor of two."""
    if len(shown) != len(printed):
        return False
    for head, one, other in zip(heads, shown, printed):
        if re.search("(CPU|wall) time", head) and NUMBER.fullmatch(one) and NUMBER.fullmatch(other) and float(other) > 0:
            if not 0.5 <= float(one) / float(other) <= 2:
                return False
        elif not is_same_line(one, other):
            return False
    return True


def rows_of(lines):
    """The cells of the rows of a table in markdown, without its two head lines."""
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


def measure(bench, name):
    """The heads of a table, and the table in markdown."""
    heads, rows = TABLES[name]
    measured = []
    for row in rows(bench):
        measured.append([str(cell) for cell in row])
        if bench.verbose:
            print(f"{name}:", " | ".join(measured[-1]), file=sys.stderr, flush=True)
    return heads, markdown(list(heads), measured)


def compare(bench, path, is_write):
    """Measure the tables of a document below their commands, list rows that differ, and print the tables with numbers in
    the text; with is_write replace the tables. The number of tables that differ."""
    with open(path, encoding="utf-8") as file:
        lines = file.read().split("\n")
    named = IN_TEXT.findall("\n".join(lines))
    out, at, n_different = [], 0, 0
    while at < len(lines):
        found = COMMAND.match(lines[at]) if at == 0 or not lines[at - 1] else None
        if not found:
            out.append(lines[at])
            at += 1
            continue
        name = found[1]
        if name not in TABLES:
            sys.exit(f"{SCRIPT}: {path}: there is no table {name}")
        named.remove(name)

        # the paragraph of the command, then the table, if there is one
        while at < len(lines) and lines[at]:
            out.append(lines[at])
            at += 1
        begin = at + 1
        while at + 1 < len(lines) and (lines[at].startswith("|") or lines[at + 1].startswith("|")):
            at += 1
        print(f"{path}: {name}", file=sys.stderr)
        heads, text = measure(bench, name)
        now = text.rstrip("\n").split("\n")
        shown, printed = rows_of(lines[begin:at]), rows_of(now)
        different = [pair for pair in zip_longest(shown, printed, fillvalue=[]) if not is_same_row(heads, *pair)]
        if different:
            n_different += 1
            print(f"{path}:{begin + 1}: `{SCRIPT} {name}` differs",
                  *(f"    {sign} {' | '.join(row)}" for pair in different for sign, row in zip("-+", pair)), sep="\n")
        out += ["", *now, ""]
        at += 1
    if is_write:
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(out))

    for name in named:
        print(f"{path}: compare the numbers in the text with the table {name}")
        print(measure(bench, name)[1])
    return n_different


def main(*documents, picture=None):
    """The command line of a script: the documents that state its tables, and a function that draws a picture."""
    parser = argparse.ArgumentParser(description=sys.modules["__main__"].__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"print a table: {', '.join(TABLES)}")
    parser.add_argument("--compare", action="store_true", help=f"list the rows of {' and '.join(documents)} that differ")
    parser.add_argument("--write", action="store_true", help="list these rows and replace them")
    parser.add_argument("--list", action="store_true", help="list the tables")
    if picture:
        parser.add_argument("--picture", metavar="FILE", help=picture.__doc__)
    parser.add_argument("--program", default=os.path.join(HERE, "build", "shoal"), help="default: build/shoal")
    parser.add_argument("--verbose", action="store_true", help="show the commands, and each row once it is measured")
    options = parser.parse_args()
    unknown = [name for name in options.names if name not in TABLES]
    if unknown:
        parser.error(f"there is no table {unknown[0]}: {', '.join(TABLES)}")
    if options.list:
        for name, (_, rows) in TABLES.items():
            print(f"{name:16s} {rows.__doc__}")
        return
    if picture and options.picture:
        picture(options.picture)
        return
    bench, n_different = Bench(os.path.abspath(options.program), options.verbose), 0
    try:
        for name in options.names:
            print(measure(bench, name)[1], end="")
        if options.compare or options.write:
            n_different = sum(compare(bench, os.path.relpath(os.path.join(HERE, document)), options.write) for document in documents)
    finally:
        shutil.rmtree(bench.folder)
    sys.exit(1 if n_different else 0)
