#!/usr/bin/python3
"""Measure the tables of doc/numerics.md and print them as markdown.

    scripts/numerics.py default      cost and error of a default fish against the stiffness of the body; minutes
    scripts/numerics.py highest      the same against solver.order; minutes
    scripts/numerics.py nascent      cost without what follows the nascent stretch: builds variants, takes minutes
    scripts/numerics.py counts       cost of an event against the stiffness of the body
    scripts/numerics.py stiffness    error against the stiffness of the body
    scripts/numerics.py tolerance    error and cost against solver.rtol
    scripts/numerics.py order        error and cost against solver.order, for a soft and a stiff body
    scripts/numerics.py interval     error against time.shedding_interval, and its observed order
    scripts/numerics.py events       cost of restarting the integrator at every event
    scripts/numerics.py start        cost of a muscle that starts at once
    scripts/numerics.py explicit     cost of the explicit methods against the stiffness of the body
    scripts/numerics.py coupling     cost of two fish near each other, coupled in the Jacobian and not
    scripts/numerics.py school       cost of an event against the number of fish
    scripts/numerics.py coupled      cost against the tolerances of the linear solver: builds variants, takes minutes
    scripts/numerics.py energy       energy balance against solver.rtol
    scripts/numerics.py constants    error and cost with other constants in the source: builds variants, takes minutes
    scripts/numerics.py threads      the same bits for any number of threads

The first three are of a default fish, the others of one with the values of the first edition of the model.
Runs build/shoal (--program names another one) on small cases in a folder of its own, and removes it.
--verbose shows the commands.
"""

import argparse
import math
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile

from shoal_results import Results, np

HERE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

# A default fish: everything else has its default value, doc/cases.md.
DEFAULT = """\
format: 1
time: {end: 4, output_interval: 0.1}
fish:
  - {name: fish}
"""

# The values of the first edition of the model.
FIRST = f"include: [{HERE}/tests/data/first_edition.yaml]"

# One fish of the first edition.
ONE = f"""\
format: 1
{FIRST}
time: {{end: 2, shedding_interval: 0.01, output_interval: 2}}
fish:
  - {{name: fish}}
"""

# Two fish side by side.
PAIR = f"""\
format: 1
{FIRST}
time: {{end: 4, shedding_interval: 0.01, output_interval: 4}}
fish:
  - {{name: right}}
  - {{name: left, start: {{position: [0, 0.5]}}}}
"""

PUBLISHED_MOMENT = "fish[*].body.second_moment=published"


class Bench:
    """Runs cases in a folder of its own."""

    def __init__(self, program, verbose):
        self.program, self.verbose = program, verbose
        self.folder = tempfile.mkdtemp(prefix="shoal-numerics-")

    def run(self, text, *assignments, program=None):
        """The result of a case with some keys changed; None where integration failed."""
        case, result = os.path.join(self.folder, "case.yaml"), os.path.join(self.folder, "result.nc")
        with open(case, "w", encoding="utf-8") as file:
            file.write(text)
        command = [program or self.program, "run", case, "--force", "-q", "-o", result]
        for assignment in assignments:
            command += ["--set", assignment]
        if self.verbose:
            print(" ".join(command), file=sys.stderr)
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode == 1:
            return None
        if done.returncode != 0:
            sys.exit(f"numerics.py: {' '.join(command)} failed:\n{done.stderr}")
        return Results(result)

    def seconds(self, text, *assignments):
        """CPU time of a run, the smallest of three, s."""
        times = []
        for _ in range(3):
            before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
            self.run(text, *assignments)
            times.append(resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before)
        return min(times)

    def variant(self, file, old, new):
        """The program with what the pattern old finds in one source file replaced."""
        tree = tempfile.mkdtemp(dir=self.folder)
        for part in ("src", "include"):
            shutil.copytree(os.path.join(HERE, part), os.path.join(tree, part))
        shutil.copy(os.path.join(HERE, "Makefile"), tree)
        path = os.path.join(tree, "src", file)
        with open(path, encoding="utf-8") as source:
            text, n_places = re.subn(old, new, source.read())
        if n_places == 0:
            sys.exit(f"numerics.py: nothing in src/{file} matches '{old}'")
        with open(path, "w", encoding="utf-8") as source:
            source.write(text)
        subprocess.run(["make", "-j", str(os.cpu_count())], cwd=tree, check=True, stdout=subprocess.DEVNULL)
        return os.path.join(tree, "build", "shoal")


def table(heads, rows):
    """Print a table in markdown."""
    cells = [heads] + [[str(cell) for cell in row] for row in rows]
    widths = [max(len(row[column]) for row in cells) for column in range(len(heads))]
    for number, row in enumerate(cells):
        print("| " + " | ".join(cell.rjust(width) for cell, width in zip(row, widths)) + " |")
        if number == 0:
            print("|" + "|".join("-" * (width + 1) + ":" for width in widths) + "|")


def power(value):
    """1e+06 as 1e6."""
    mantissa, exponent = f"{value:.0e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def short(value):
    """Two digits of an error."""
    return f"{value:.1e}"


def per_event(results):
    """Steps, Newton iterations and Jacobians per event."""
    n_events = round(float(results.time[-1]) / float(results["shedding_interval"]))
    names = ("steps", "newton_iterations", "jacobian_evaluations")
    return [f"{results[name][-1] / n_events:.2f}" for name in names]


COUNTS = ["steps", "Newton iterations", "Jacobians"]


def ends(results):
    """Position of nose and tail of the first fish, centre of mass, circulation shed, at the end."""
    x = results["x"][-1, 0]
    return x[0], x[results.n_nodes[0] - 1], results["com"][-1, 0], results["shed_circulation"][-1, 0]


def distance(a, b):
    """How far two points are apart."""
    return float(np.linalg.norm(np.subtract(a, b)))


def ends_at(results, t):
    """Position of nose and tail of the first fish at a time."""
    x = results["x"][int(np.argmin(np.abs(results.time - t))), 0]
    return x[0], x[results.n_nodes[0] - 1]


def failures(results):
    """Convergence failures per event."""
    n_events = round(float(results.time[-1]) / float(results["shedding_interval"]))
    return f"{results['convergence_failures'][-1] / n_events:.3f}"


class DefaultFish:
    """Runs of the default fish at one shedding interval and modulus, and what is right."""

    def __init__(self, bench, interval, modulus):
        self.bench = bench
        self.keys = [f"time.shedding_interval={interval:g}", f"fish[*].body.modulus={modulus:g}"]
        # of another order than the runs
        self.right = bench.run(DEFAULT, *self.keys, "time.end=3", "solver.rtol=1e-9", "solver.order=2",
                               "solver.max_steps=100000", "wake.tolerance=1e-9")

    def row(self, *more, program=None):
        """Error after 3 s, then counts per event over 4 s, then work of the muscle and energy audit."""
        run = self.bench.run(DEFAULT, *self.keys, *more, program=program)
        if not run:
            return ["failed", *[""] * 5]
        error = "-"
        if self.right:
            error = short(max(distance(a, b) for a, b in zip(ends_at(run, 3), ends_at(self.right, 3))))
        audit = abs(run["energy_audit"][-1, 0] / run["actuation_work"][-1, 0])
        return [error, *per_event(run), failures(run), short(audit)]


DEFAULT_ROW = ["nose or tail [L]", *COUNTS, "failures", "audit over work"]


def default(bench):
    rows = []
    for interval in (0.01, 0.02):
        for modulus in (1e4, 3e4, 1e5, 3e5, 1e6, 1e8, 1e10):
            rows.append([f"{interval:g}", power(modulus), *DefaultFish(bench, interval, modulus).row()])
    table(["interval [s]", "modulus [Pa]", *DEFAULT_ROW], rows)


def highest(bench):
    rows = []
    for modulus in (1e5, 1e6, 1e8, 1e10):
        fish = DefaultFish(bench, 0.01, modulus)
        for limit in range(2, 6):
            rows.append([power(modulus), limit, *fish.row(f"solver.order={limit}")])
    table(["modulus [Pa]", "order", *DEFAULT_ROW], rows)


def nascent(bench):
    rows = []
    update, kinds = r"is_sheet \? update_jacobian : NULL", r"is_sheet \? solver->kinds : NULL"
    programs = [("as it is", bench.program),
                ("one norm for all unknowns", bench.variant("solver/ida.c", kinds, "NULL")),
                ("no update of the column", bench.variant("solver/ida.c", update, "0 ? update_jacobian : NULL"))]
    for modulus in (1e5, 1e6, 1e8, 1e10):
        fish = DefaultFish(bench, 0.01, modulus)
        for name, program in programs:
            rows.append([name, power(modulus), *fish.row(program=program)])
    table(["Newton's iteration", "modulus [Pa]", *DEFAULT_ROW], rows)


def counts(bench):
    rows = []
    for modulus in (1e4, 1e6, 1e8, 1e10):
        run = bench.run(ONE, PUBLISHED_MOMENT, f"fish[*].body.modulus={modulus:g}")
        rows.append([7, 21, "published", power(modulus), *per_event(run)])
    for moment in ("ellipse", "published"):
        run = bench.run(ONE, f"fish[*].body.second_moment={moment}", "fish[*].body.modulus=1e7", "fish[*].nodes=41",
                        "fish[*].sheet_points=65")
        rows.append([41, 65, moment, power(1e7), *per_event(run)])
    table(["N", "M", "second moment", "modulus [Pa]", *COUNTS], rows)


def tolerance(bench):
    rows = []
    reference = ends(bench.run(ONE, "solver.rtol=1e-10", "solver.order=5"))
    for rtol in (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8):
        run = bench.run(ONE, f"solver.rtol={rtol:g}")
        errors = [short(distance(got, want)) for got, want in zip(ends(run), reference)]
        rows.append([power(rtol), *errors, *per_event(run)])
    table(["rtol", "nose [m]", "tail [m]", "centre of mass [m]", "shed [m2/s]", *COUNTS], rows)


def stiffness(bench):
    rows = []
    for moment in ("ellipse", "published"):
        for modulus in (1e4, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11):
            stiff = ["time.end=3", "time.output_interval=3", f"fish[*].body.second_moment={moment}",
                     f"fish[*].body.modulus={modulus:g}"]
            reference = ends(bench.run(ONE, *stiff, "solver.rtol=1e-9"))[:2]
            errors = []
            for rtol in (1e-5, 1e-6, 1e-7):
                got = ends(bench.run(ONE, *stiff, f"solver.rtol={rtol:g}"))
                errors.append(short(max(distance(a, b) for a, b in zip(got, reference))))
            rows.append([moment, power(modulus), *errors])
    table(["second moment", "modulus [Pa]", "nose or tail [m], rtol 1e-5", "1e-6", "1e-7"], rows)


def order(bench):
    rows = []
    for modulus in (1e6, 1e10):
        stiff = [PUBLISHED_MOMENT, f"fish[*].body.modulus={modulus:g}"]
        reference = ends(bench.run(ONE, *stiff, "solver.rtol=1e-9"))
        for highest in range(1, 6):
            run = bench.run(ONE, *stiff, f"solver.order={highest}")
            if run:
                rows.append([power(modulus), highest, short(distance(ends(run)[1], reference[1])), *per_event(run)])
            else:
                rows.append([power(modulus), highest, "failed", "", "", ""])
    table(["modulus [Pa]", "order", "tail [m]", *COUNTS], rows)


def interval(bench):
    # until 1.6 s no vortex decays; every interval divides this time
    values, rows = [], []
    sizes = (0.08, 0.04, 0.02, 0.01, 0.005, 0.0025)
    for size in sizes:
        run = bench.run(ONE, "time.end=1.6", f"time.shedding_interval={size:g}", "time.output_interval=1.6",
                        "solver.rtol=1e-10", "solver.order=5")
        values.append(ends(run))
    changes = [[distance(a, b) for a, b in zip(*pair)] for pair in zip(values, values[1:])]
    for number, size in enumerate(sizes[:-1]):
        row = [f"{size:g} to {sizes[number + 1]:g}"]
        for quantity, change in enumerate(changes[number]):
            row.append(short(change))
            row.append(f"{math.log2(changes[number - 1][quantity] / change):.2f}" if number else "")
        rows.append(row)
    table(["interval [s]", "nose [m]", "order", "tail [m]", "order", "centre [m]", "order", "shed [m2/s]", "order"],
          rows)


def events(bench):
    rows = []
    for keys in (["wake.shedding=continuous", "wake.kutta=edge"], ["wake.shedding=continuous", "wake.kutta=rate"],
                 ["wake.shedding=impulsive", "wake.kutta=edge"], ["wake.shedding=impulsive", "wake.kutta=rate"]):
        run = bench.run(ONE, *keys)
        rows.append([*(key.split("=")[1] for key in keys), *per_event(run)])
    table(["shedding", "kutta", *COUNTS], rows)


def start(bench):
    rows = []
    for modulus in (1e4, 1e6, 1e8):
        for ramp in (0, 0.25, 1):
            run = bench.run(ONE, PUBLISHED_MOMENT, f"fish[*].body.modulus={modulus:g}", f"fish[*].wave.ramp={ramp:g}")
            rows.append([power(modulus), f"{ramp:g}", *(per_event(run) if run else ["failed", "", ""])])
    table(["modulus [Pa]", "ramp [s]", *COUNTS], rows)


def explicit(bench):
    rows = []
    for modulus in (1e4, 1e6, 1e8):
        stiff = [PUBLISHED_MOMENT, f"fish[*].body.modulus={modulus:g}"]
        tail = ends(bench.run(ONE, *stiff, "solver.rtol=1e-9"))[1]
        for method in ("ida", "heun", "rk4", "dormand_prince"):
            run = bench.run(ONE, *stiff, f"solver.method={method}")
            cost = [f"{run[name][-1] / 200:.2f}" for name in ("steps", "residual_evaluations", "jacobian_evaluations")]
            rows.append([power(modulus), method, short(distance(ends(run)[1], tail)), *cost])
    table(["modulus [Pa]", "method", "tail [m]", "steps", "evaluations", "Jacobians"], rows)


def coupling(bench):
    rows = []
    for layout, gaps in (("side by side", (0.1, 0.2, 0.3, 0.5, 0.75, 1, 1.5, 2)),
                         ("one after the other", (0.1, 0.2, 0.5, 1, 2))):
        for gap in gaps:
            # 0.25: the thickness of two fish, and how much closer they get in four seconds
            place = f"[0, {gap + 0.25:g}]" if layout == "side by side" else f"[{gap + 1:g}, 0]"
            runs, times = [], []
            for reach in (0, 100):
                keys = f"fish[1].start.position={place}", f"solver.coupling_distance={reach}"
                runs.append(bench.run(PAIR, *keys))
                times.append(bench.seconds(PAIR, *keys))
            if None in runs:
                rows.append([layout, f"{gap:g}", *["failed"] * 6])
                continue
            (_, apart, apart_jacobians), (_, coupled, coupled_jacobians) = (per_event(run) for run in runs)
            rows.append([layout, f"{gap:g}", f"{runs[1]['least_distance'][-1]:.2f}", apart, coupled, apart_jacobians,
                         coupled_jacobians, f"{times[1] / times[0]:.2f}"])
    table(["layout", "gap [L]", "at the end", "Newton iterations, not coupled", "coupled", "Jacobians, not coupled",
           "coupled", "time, coupled over not"], rows)


def lattice(n, spacing, end):
    """n fish in a square, with heading control."""
    side = math.ceil(math.sqrt(n))
    places = [f"  - {{start: {{position: [{spacing[0] * (i % side):g}, {spacing[1] * (i // side):g}]}}}}"
              for i in range(n)]
    return "\n".join(["format: 1", FIRST, f"time: {{end: {end}, shedding_interval: 0.01, output_interval: {end}}}",
                      "wake: {lifetime: 2}", "defaults: {fish: {control: {law: heading}}}", "fish:", *places, ""])


def school(bench):
    rows = []
    for n, spacing, reach in ((4, (1.5, 1.5), 0.5), (16, (1.5, 1.5), 0.5), (64, (1.5, 1.5), 0.5),
                              (64, (1.5, 1.5), 0), (64, (1.5, 1.5), 1.5),
                              (9, (1.3, 0.4), 0), (9, (1.3, 0.4), 0.5), (9, (1.3, 0.4), 100)):
        case, key = lattice(n, spacing, 0.5), f"solver.coupling_distance={reach}"
        run = bench.run(case, key)
        cost = [*per_event(run), f"{1000 * bench.seconds(case, key) / 50:.1f}"] if run else ["failed", "", "", ""]
        rows.append([n, f"{spacing[0]:g} x {spacing[1]:g}", reach, *cost])
    table(["fish", "spacing [L]", "coupling distance [L]", *COUNTS, "CPU time of an event [ms]"], rows)


def energy(bench):
    rows = []
    for rtol in (1e-3, 1e-4, 1e-5, 1e-6, 1e-7):
        run = bench.run(ONE, f"solver.rtol={rtol:g}", "time.output_interval=0.1")
        residual, work = np.abs(run["energy_audit"][:, 0]).max(), run["actuation_work"][-1, 0]
        rows.append([power(rtol), short(residual), f"{work:.4f}", short(residual / abs(work)),
                     short(np.abs(run["total_circulation"]).max())])
    table(["rtol", "largest residual [J]", "work of the muscle [J]", "residual over work",
           "total circulation [m2/s]"], rows)


# Variants of the program: name, file, pattern of the old text, new text.
NEWTON, CJ = r"(newton_coefficient =) [^;]+;", r"(cj_change =) [^;]+;"
COST, MAX = r"(jacobian_cost =) \d+,", r"(max_iterations =) \d+;"
POSITION, VELOCITY = r"(case UNKNOWN_Y: return) [^ ]+ \* length", r"(case UNKNOWN_VY: return) [^ ]+ \* length"
VARIANTS = [
    ("Newton coefficient 0.33", "solver/ida.c", NEWTON, r"\1 0.33;"),
    ("Newton coefficient 0.03", "solver/ida.c", NEWTON, r"\1 0.03;"),
    ("Newton coefficient 0.0003", "solver/ida.c", NEWTON, r"\1 0.0003;"),
    ("at most 4 iterations", "solver/ida.c", MAX, r"\1 4;"),
    ("cost of a Jacobian 2", "solver/ida.c", COST, r"\1 2,"),
    ("cost of a Jacobian 20", "solver/ida.c", COST, r"\1 20,"),
    ("change of cj 0.25", "solver/ida.c", CJ, r"\1 0.25;"),
    ("no corotation", "solver/corotation.c", r"(body->has_moved =) 1;", r"\1 0;"),
    ("no initial guess", "solver/ida_newton.c", r"same \? 1 : 0", r"same ? 0 : 0"),
    ("stop at events only", "solver/ida.c", r"n_steps > 1 \?", r"n_steps < 0 ?"),
    ("scale of x 0.018 L", "model/residual.c", POSITION, r"\1 0.018 * length"),
    ("scale of v 10 L f", "model/residual.c", VELOCITY, r"\1 10 * length"),
    ("scale of v 0.1 L f", "model/residual.c", VELOCITY, r"\1 0.1 * length"),
]


def constants(bench):
    programs = [("as it is", bench.program)]
    programs += [(name, bench.variant(*change)) for name, *change in VARIANTS]
    rows = []
    for modulus in (1e6, 1e10):
        stiff = [PUBLISHED_MOMENT, f"fish[*].body.modulus={modulus:g}"]
        tail = ends(bench.run(ONE, *stiff, "solver.rtol=1e-9"))[1]
        for name, program in programs:
            run = bench.run(ONE, *stiff, program=program)
            what = [short(distance(ends(run)[1], tail)), *per_event(run)] if run else ["failed", "", "", ""]
            rows.append([name, power(modulus), *what])
    table(["constant", "modulus [Pa]", "tail [m]", *COUNTS], rows)


# Tolerances of the linear solver: fractions of the right-hand side, and of the error at which Newton's iteration ends.
TOLERANCES = [(relative, absolute) for absolute in (0, 0.1) for relative in ("1e-1", "1e-2", "1e-3", "1e-4", "1e-10")]


def coupled(bench):
    rows = []
    place = "fish[1].start.position=[0, 0.3]"
    for relative, absolute in TOLERANCES:
        program = bench.variant("solver/ida.c", r"linear_relative = [^,]+, linear_absolute = [^;]+;",
                                f"linear_relative = {relative}, linear_absolute = {absolute};")
        runs = [bench.run(PAIR, place, f"fish[*].body.modulus={modulus}", program=program)
                for modulus in ("1e6", "1e9")]
        rows.append([relative, absolute, *(cell for run in runs for cell in per_event(run)[1:])])
    table(["relative", "absolute", *("Newton iterations, 1e6 Pa", "Jacobians"),
           *("Newton iterations, 1e9 Pa", "Jacobians")], rows)


def threads(bench):
    rows = []
    reference = None
    for n in (1, 2, 3):
        # enough fish that threads share every loop
        run = bench.run(lattice(64, (1.4, 0.6), 0.1), f"solver.threads={n}")
        x = run["x"].tobytes() + run["wake_x"].tobytes()
        reference = reference or x
        rows.append([n, "yes" if x == reference else "NO"])
    table(["threads", "same bits as one"], rows)


TABLES = {function.__name__: function for function in
          (default, highest, nascent, counts, stiffness, tolerance, order, interval, events, start, explicit, coupling,
           school, energy, constants, coupled, threads)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", choices=TABLES)
    parser.add_argument("--program", default=os.path.join(HERE, "build", "shoal"), help="default: build/shoal")
    parser.add_argument("--verbose", action="store_true", help="show the commands")
    options = parser.parse_args()
    bench = Bench(os.path.abspath(options.program), options.verbose)
    try:
        TABLES[options.table](bench)
    finally:
        shutil.rmtree(bench.folder)


if __name__ == "__main__":
    main()
