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
    scripts/numerics.py nodes        speed against the nodes of a body, with and without a cusp for a tail; minutes
    scripts/numerics.py edge         error of the free sheet next to the tail: builds variants, takes minutes
    scripts/numerics.py events       cost of restarting the integrator at every event
    scripts/numerics.py start        cost of a muscle that starts at once
    scripts/numerics.py explicit     cost of the explicit methods against the stiffness of the body
    scripts/numerics.py rod          cost of all kinds of methods, verlet too, on a rod without fluid and damping
    scripts/numerics.py evidence     what the second edition of the model mends; a minute
    scripts/numerics.py choices      speed where the model would choose otherwise: builds variants, takes minutes
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
time: {end: 8, output_interval: 0.1}
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

    def variant(self, *changes):
        """The program with changes of the source: a file, what a pattern finds in it, and what takes its place."""
        tree = tempfile.mkdtemp(dir=self.folder)
        for part in ("src", "include"):
            shutil.copytree(os.path.join(HERE, part), os.path.join(tree, part))
        shutil.copy(os.path.join(HERE, "Makefile"), tree)
        for file, old, new in changes:
            path = os.path.join(tree, "src", file)
            with open(path, encoding="utf-8") as source:
                text, n_places = re.subn(old, new, source.read())
            if n_places == 0:
                sys.exit(f"numerics.py: nothing in src/{file} matches '{old}'")
            with open(path, "w", encoding="utf-8") as source:
                source.write(text)
        subprocess.run(["make", "-j", str(os.cpu_count()), "build/shoal"], cwd=tree, check=True, stdout=subprocess.DEVNULL)
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
        """Error after 3 s, then counts per event over 8 s, then work of the muscle and energy balance."""
        run = self.bench.run(DEFAULT, *self.keys, *more, program=program)
        if not run:
            return ["failed", *[""] * 5]
        error = "-"
        if self.right:
            error = short(max(distance(a, b) for a, b in zip(ends_at(run, 3), ends_at(self.right, 3))))
        balance = abs(run["energy_audit"][-1, 0] / run["actuation_work"][-1, 0])
        return [error, *per_event(run), failures(run), short(balance)]


DEFAULT_ROW = ["nose or tail [L]", *COUNTS, "failures", "balance over work"]


def default(bench):
    rows = []
    for interval in (0.01, 0.02):
        for modulus in (1e4, 3e4, 1e5, 3e5, 1e6, 1e8, 1e10):
            rows.append([f"{interval:g}", power(modulus), *DefaultFish(bench, interval, modulus).row()])
    table(["interval [s]", "modulus [Pa]", *DEFAULT_ROW], rows)


def highest(bench):
    rows = []
    for modulus in (3e4, 1e5, 3e5, 1e6, 1e8, 1e10):
        fish = DefaultFish(bench, 0.01, modulus)
        for limit in range(2, 6):
            rows.append([power(modulus), limit, *fish.row(f"solver.order={limit}")])
    table(["modulus [Pa]", "order", *DEFAULT_ROW], rows)


def nascent(bench):
    rows = []
    update, kinds = r"is_sheet \? update_jacobian : NULL", r"is_sheet \? solver->kinds : NULL"
    programs = [("as it is", bench.program),
                ("one norm for all unknowns", bench.variant(("solver/ida.c", kinds, "NULL"))),
                ("no update of the column", bench.variant(("solver/ida.c", update, "0 ? update_jacobian : NULL")))]
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


# A soft fish that feels its wake: that of the section interval of tests/verify.
SHEDDING = """\
format: 1
time: {end: 1.5, output_interval: 0.02}
wake: {lifetime: 1, fade: 0.2}
solver: {rtol: 1e-8, order: 5}
fish: [{name: fish, nodes: 7, sheet_points: 65, body: {modulus: 1e5}}]
"""

# The first step of a marker corrected at its end, by the trapezoidal rule.
CORRECTED = [("run/event.c", r"(        if \(state->wake\[f\]\.n_vortex > 0\) \{\n)", r"""\1
            struct wake *const wake = &state->wake[f];
            const int i = wake->n_vortex - 2;
            if (i >= 0) {
                wake->x[i] += school->interval / 2 * (flow->wake_u[first + i] - wake->u[i]);
                wake->y[i] += school->interval / 2 * (flow->wake_v[first + i] - wake->v[i]);
            }
""")]
# The strength linear along the stretches that have more than one point, by the parabola through three labels. How much
# of the nascent one is proportional to its own circulation is for the Jacobian.
LINEAR = [
    ("model/free_sheet.c", r"(void free_sheet_place_nascent\()", r"""double free_sheet_share;
\1"""),
    ("model/free_sheet.c", r"( = \(is_middle \? -1 : free_sheet_part\[i\]\) \* circulation;)", r"""\1
        if (markers->n_vortex > 1 && !is_middle) {
            const double *const label = &markers->circulation[markers->n_vortex - 1];
            free_sheet_share = tau / (interval + tau);
            sheet->circulation[first + i] += free_sheet_part[i] * (1 - 2 * free_sheet_xi[i]) * free_sheet_share *
                                             (circulation - tau * (label[0] - label[-1]) / interval);
        }"""),
    ("model/free_sheet.c", r"(part\[i\] \* middles->circulation\[stretch\] \* strength;)", r"""\1
        if (sheet->part[i] > 0 && sheet->part[i] < 1 && stretch > 0) {
            sheet->circulation[i] += sheet->part[i] * (1 - 2 * sheet->xi[i]) / 2 * strength *
                                     (middles->circulation[stretch] - middles->circulation[stretch - 1]);
        }"""),
    ("model/flow_derivative.c", r"0, free_sheet_part\[i\],", r"0,"
     " free_sheet_part[i] * (1 + free_sheet_share * (1 - 2 * free_sheet_xi[i])),"),
    ("model/free_sheet.h", r"(#endif\n)$", r"extern double free_sheet_share;\n\1"),
]
SHEETS = [("as it is", []), ("first step of a marker corrected", CORRECTED),
          ("strength linear along a stretch", LINEAR), ("both", CORRECTED + LINEAR),
          ("more points", [("model/free_sheet.c", "GRADED = 1", "GRADED = 3"),
                           ("model/free_sheet.c", "PAIRED = 4", "PAIRED = 20"),
                           ("model/free_sheet.c", r"4 \* FREE_SHEET_PANEL", "32 * FREE_SHEET_PANEL")])]


def path(results):
    """Nose and tail of the first fish and the circulation shed, at all times of a run."""
    x = results["x"][:, 0]
    return x[:, 0], x[:, results.n_nodes[0] - 1], results["shed_circulation"][:, :1]


def root_mean_square(a, b):
    """Over a run, of the distances between two paths."""
    return math.sqrt(float(np.mean(np.sum((a - b) ** 2, axis=1))))


def edge(bench):
    rows = []
    programs = [(name, bench.variant(*changes) if changes else bench.program) for name, changes in SHEETS]
    sizes = (0.02, 0.01, 0.005, 0.0025, 0.00125, 0.000625)
    for start, speed in (("from rest", 0), ("moving", 1)):
        for name, program in programs:
            runs = [path(bench.run(SHEDDING, f"fish[0].start.speed={speed}", f"time.shedding_interval={size:g}",
                                   program=program)) for size in sizes]
            row = [start, name]
            for quantity in range(3):
                changes = [root_mean_square(a[quantity], b[quantity]) for a, b in zip(runs, runs[1:])]
                slope = np.polyfit(np.log(sizes[1:]), np.log(changes), 1)[0]
                row += [short(changes[1]), f"{slope:.2f}"]
            rows.append(row)
    table(["start", "free sheet", "nose [m]", "order", "tail [m]", "order", "shed [m2/s]", "order"], rows)


# A default fish, from rest.
FROM_REST = """\
format: 1
time: {end: 12, shedding_interval: 0.02, output_interval: 12}
fish: [{name: fish}]
"""

# Bodies whose resolution is tested: the profile, what is the same for any number of nodes, and the least thickness.
BODIES = [("joukowski", "", 0), ("at least 2 % thick", "", 0.02), ("uniform, 10 %", "profile: uniform, thickness: 0.1, ", 0)]


def nodes(bench):
    rows = []
    sizes = (9, 17, 33, 65)
    for modulus in ("1e6", "1e8"):
        for name, keys, least in BODIES:
            speeds = []
            for n in sizes:
                more = [f"fish[0].nodes={n}", f"fish[0].sheet_points={max(33, 2 * n - 1)}"]
                body = f"{keys}modulus: {modulus}"
                if least > 0:
                    h = np.maximum(bench.run(FROM_REST, "time.end=0.02", "time.output_interval=0.02", *more)["edge_height"],
                                   least).ravel()[:n - 1]
                    body = f"profile: table, h: {h.tolist()}, w: {[0.25] * (n - 1)}, modulus: {modulus}"
                run = bench.run(FROM_REST, *more, f"fish[0].body={{{body}}}")
                speeds += [f"{run['speed'][-1, 0]:.4f}" if run else "failed"]
                tail = f"{run['strouhal'][-1, 0]:.2f}" if run else ""
            rows.append([name, modulus, *speeds, tail])
    table(["profile", "modulus [Pa]", *(f"{n} nodes" for n in sizes), "Strouhal number, 65"], rows)


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


# The article's fish as a rod alone, without damping: nobody feels the fluid.
ROD = f"""\
format: 1
include: [{HERE}/cases/include/article.yaml]
time: {{end: 3, shedding_interval: 0.02, output_interval: 3}}
fluid: {{density: 0}}
wake: {{lifetime: 0.2}}
solver: {{max_steps: 100000}}
fish:
  - name: rod
    sheet_points: 5
    start: {{speed: 0}}
    body: {{second_moment: published, bending_damping: 0, stretching_damping: 0}}
"""


def rod_settings(modulus):
    """What is tried on the rod: implicit methods, and explicit ones with their longest stable step."""
    stable = math.sqrt(modulus / 1e4)
    for rtol in ("1e-4", "3e-5", "1e-5"):
        yield "ida", f"rtol {rtol}", [f"solver.rtol={rtol}"]
    for method, counts in (("trapezoid", (1, 2, 4)), ("verlet", (round(5 * stable),)), ("rk4", (round(3 * stable),))):
        for n in counts:
            yield method, f"{0.02 / n:.2g} s", [f"solver.method={method}", f"solver.step={0.02 / n:.12g}"]


def rod(bench):
    rows = []
    for modulus in (1e4, 1e6, 1e8, 1e9, 1e10):
        body = f"fish[*].body.modulus={modulus:g}"
        exact = ends(bench.run(ROD, body, "solver.method=verlet",
                               f"solver.step={0.02 / round(15 * math.sqrt(modulus / 1e4)):.12g}"))[:2]
        done = set()
        for method, setting, assignments in rod_settings(modulus):
            run = bench.run(ROD, body, *assignments) if method not in done else None
            error = max(distance(a, b) for a, b in zip(ends(run), exact)) if run else math.inf
            if error > 1e-4:
                continue
            done.add(method)
            rows.append([power(modulus), method, setting, short(error), int(run["residual_evaluations"][-1]),
                         f"{bench.seconds(ROD, body, *assignments):.2g}"])
    table(["modulus [Pa]", "method", "setting", "nose or tail [L]", "evaluations", "CPU time [s]"], rows)


# A fish of the second edition, from rest, with a row at every event.
EVERY_EVENT = """\
format: 1
time: {end: 20, shedding_interval: 0.02, output_interval: 0.02}
fish: [{name: fish}]
"""
# Wakes so smooth that nobody feels them.
NO_WAKE = "wake={shedding: continuous, smoothing: 1e6, lifetime: 0.1, fade: 0}"
# A plate that a stream meets at once, at an incidence whose sine is 0.01.
PLATE = """\
format: 1
time: {end: 1, shedding_interval: 0.01, output_interval: 0.01}
fluid: {velocity: [0.99995, 0.01]}
fish: [{name: plate, start: {speed: 0}, wave: {amplitude: 0}, motion: {driven: all, speed: 0}}]
"""
WAGNER = (0, 0.4167, 0.5508)
POWERS = ("actuation_power", "damping_power", "drag_power", "added_mass_power", "wake_power")


def last_beat(run, *names):
    """Means over the last second of a run of 1 Hz."""
    n = int(round(1 / (run.time[-1] - run.time[-2])))
    return [f"{float(np.mean(run[name][-n:, 0])):.3f}" for name in names]


def powers(run):
    return ", ".join(last_beat(run, *POWERS))


def evidence_of_energy(bench):
    free = ("time.end=60", NO_WAKE, "fish[0].nodes=7", "fish[0].wave.number=6",
            "fish[0].drag={normal: 0, tangential: 0}")
    what = "neither drag nor wake, wave number +6, after 60 s: speed [m/s], powers [W]"
    body = "section: nodes, density: 2000, relaxation_time: 0, bending_damping: 0.5, stretching_damping: 1"
    article = (f"fish[0].body={{{body}}}", "fish[0].drag.added_mass=1.5")
    pointed = "fish[0].drag.extent=thickness"
    for name, keys in (("force: published", ["fish[0].force=published"]),
                       ("the article's body and C_A", [*article, "fish[0].force=published"]),
                       ("force: reactive", []), ("the same, pointed tail", [pointed])):
        run = bench.run(EVERY_EVENT, *free, *keys)
        yield what, name, f"{run['speed'][-1, 0]:.3f}; {powers(run)}"
    with open(os.path.join(HERE, "cases", "single_free.yaml"), encoding="utf-8") as file:
        text = file.read().replace("[include/", f"[{HERE}/cases/include/")
    yield "the article's fish, last beat: powers [W]", "single_free", powers(bench.run(text))
    fish = bench.run(EVERY_EVENT)
    what = "a default fish from rest"
    speeds = [fish["speed"][int(np.argmin(np.abs(fish.time - t))), 0] for t in (4, 8, 20)]
    yield what + ": speed after 4, 8, 20 s [m/s]", "", ", ".join(f"{speed:.3f}" for speed in speeds)
    wave = 2 * math.pi / 6  # lengths per beat
    yield what + ": slip, the last speed over that of the wave", "", f"{speeds[-1] / wave:.3f}"
    yield what + ", last beat: powers [W]", "", powers(fish)
    fish = bench.run(EVERY_EVENT, NO_WAKE)
    yield what + ", no wake, last beat: powers [W]", "", powers(fish)
    yield what + ", no wake: speed after 20 s [m/s]", "", f"{fish['speed'][-1, 0]:.3f}"
    for n in (7, 13):
        fish = bench.run(EVERY_EVENT, NO_WAKE, "time.end=4", "fish[0].body.modulus=1e5", f"fish[0].nodes={n}")
        yield "1e5 Pa, no wake: speed after 4 s [m/s]", f"{n} nodes", f"{fish['speed'][-1, 0]:.3f}"


def evidence_of_damping(bench):
    for relaxation in (0.001, 0.01):
        fish = bench.run(EVERY_EVENT, f"fish[0].body.relaxation_time={relaxation}")
        muscle, damping = (float(power) for power in last_beat(fish, "actuation_power", "damping_power"))
        yield "part of the muscle's power that is damped", f"{relaxation} s", f"{-100 * damping / muscle:.0f} %"


def evidence_of_wagner(bench):
    settings = [("smoothing 0.2, continuous", ["wake={shedding: continuous, smoothing: 0.2}"]), ("default", []),
                ("21 points", ["fish[0].sheet_points=21"])]
    for name, assignments in settings:
        shed = bench.run(PLATE, *assignments)["shed_circulation"][[0, 50, 100], 0] / (math.pi * 0.01)
        yield "started plate: circulation shed at s = 0, 1, 2", name, ", ".join(f"{part:.4f}" for part in shed)
    yield "", "exact", ", ".join(f"{part:.4f}" for part in WAGNER)


def evidence_of_streams(bench):
    for stream in (0, 0.5, 0.99):
        run = bench.run(f"format: 1\ninclude: [{HERE}/cases/include/article.yaml]\ntime: {{end: 4}}\n"
                        f"fluid: {{velocity: [{stream}, 0]}}\nfish: [{{start: {{speed: {1 - stream:g}}}}}]\n")
        yield "the same swim in a stream: Strouhal number", f"{stream} m/s", f"{run['strouhal'][-1, 0]:.4f}"


def evidence_of_sections(bench):
    h = {}
    for n, section in ((321, "mean"), (7, "nodes"), (7, "mean")):
        run = bench.run(EVERY_EVENT, "time.end=0.02", "fluid.density=0", "fish[0].sheet_points=5",
                        f"fish[0].nodes={n}", f"fish[0].body.section={section}")
        h[n, section] = run["edge_height"].ravel()
    exact = [np.mean(h[321, "mean"] ** power) for power in (1, 3)]
    for section in ("nodes", "mean"):
        mass = np.mean(h[7, section]) / exact[0] - 1
        yield "7 nodes: error of the mass", f"section: {section}", f"{100 * mass:.1f} %"
    cube = np.mean(h[7, "nodes"] ** 3) / exact[1] - 1
    yield "7 nodes: error of the integral of h^3", "section: nodes", f"{100 * cube:.1f} %"


def evidence(bench):
    rows = []
    for part in (evidence_of_energy, evidence_of_damping, evidence_of_wagner, evidence_of_streams,
                 evidence_of_sections):
        rows += [list(row) for row in part(bench)]
    table(["what", "setting", "measured"], rows)


# Other choices than those of the model: what is changed in the source, and where the speed is taken.
CHOICES = [
    ("tail flux with the velocity of the last edge's midpoint",
     [("model/reactive.c", r"w\[i\] \+ edge->rate\[i\] / 2", "w[i] + 0 * edge->rate[i]"),
      ("model/reactive.c", r"(by_rate\[1\]\[i\]\[j\] \+=) by_tail / 2", r"\1 0 * by_tail")],
     "1e5 Pa, no wake, after 4 s", (NO_WAKE, "fish[0].body.modulus=1e5", "time.end=4"), (7, 13)),
    ("edge midpoints see the own wake as control points do",
     [("model/flow_at_bodies.c", r"(const struct range control = \{flow->points\[chunk->fish\].first,) [^;]*;",
       r"\1 flow_tail(&flow->school->fish[chunk->fish])};"),
      ("model/flow_derivative.c", r"at->f == at->g \? other->n_control : 0;", "at->f == at->g ? flow_tail(other) : 0;")],
     "after 8 s", ("time.end=8",), (17, 33)),
]


def choices(bench):
    rows = []
    for name, changes, setting, keys, sizes in CHOICES:
        for which, program in (("as it is", bench.program), (name, bench.variant(*changes))):
            for n in sizes:
                run = bench.run(EVERY_EVENT, *keys, f"fish[0].nodes={n}", program=program)
                rows.append([which, setting, n, f"{run['speed'][-1, 0]:.3f}" if run else "failed"])
    table(["choice", "setting", "nodes", "speed [m/s]"], rows)


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
    rows, times = [], []
    for n, spacing, reach in ((64, (1.5, 1.5), 0.5), (64, (1.5, 1.5), 0), (64, (1.5, 1.5), 1.5), (16, (1.5, 1.5), 0.5),
                              (4, (1.5, 1.5), 0.5), (9, (1.3, 0.4), 0), (9, (1.3, 0.4), 0.5), (9, (1.3, 0.4), 100)):
        case, key = lattice(n, spacing, 0.5), f"solver.coupling_distance={reach}"
        run = bench.run(case, key)
        cost = ["failed", "", "", ""]
        if run:
            times.append(bench.seconds(case, key))
            cost = [*per_event(run), f"{times[-1] / times[0]:.3f}"]
        rows.append([n, f"{spacing[0]:g} x {spacing[1]:g}", reach, *cost])
    table(["fish", "spacing [L]", "coupling distance [L]", *COUNTS, "CPU time over that of the first row"], rows)


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
COST, MAX = r"(jacobian_cost =) \d+,", r"(max_iterations =) \d+,"
POSITION, VELOCITY = r"(case UNKNOWN_Y: return) [^ ]+ \* length", r"(case UNKNOWN_VY: return) [^ ]+ \* length"
VARIANTS = [
    ("Newton coefficient 0.33", "solver/ida.c", NEWTON, r"\1 0.33;"),
    ("Newton coefficient 0.03", "solver/ida.c", NEWTON, r"\1 0.03;"),
    ("Newton coefficient 0.0003", "solver/ida.c", NEWTON, r"\1 0.0003;"),
    ("at most 4 iterations", "solver/ida.c", MAX, r"\1 4,"),
    ("cost of a Jacobian 2", "solver/ida.c", COST, r"\1 2,"),
    ("cost of a Jacobian 20", "solver/ida.c", COST, r"\1 20,"),
    ("change of cj 0.25", "solver/ida.c", CJ, r"\1 0.25;"),
    ("no corotation", "solver/corotation.c", r"(body->has_moved =) 1;", r"\1 0;"),
    ("no initial guess", "solver/ida_newton.c", r"same \? 1 : 0", r"same ? 0 : 0"),
    ("stop at events only", "solver/ida.c", r"n_steps > 1 \?", r"n_steps < 0 ?"),
    ("scale of x 0.018 L", "model/residual_unknowns.c", POSITION, r"\1 0.018 * length"),
    ("scale of v 10 L f", "model/residual_unknowns.c", VELOCITY, r"\1 10 * length"),
    ("scale of v 0.1 L f", "model/residual_unknowns.c", VELOCITY, r"\1 0.1 * length"),
]


def constants(bench):
    programs = [("as it is", bench.program)]
    programs += [(name, bench.variant(change)) for name, *change in VARIANTS]
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
        program = bench.variant(("solver/ida.c", r"linear_relative = [^,]+, linear_absolute = [^;]+;",
                                 f"linear_relative = {relative}, linear_absolute = {absolute};"))
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
          (default, highest, nascent, counts, stiffness, tolerance, order, interval, nodes, edge, events, start,
           explicit, rod, evidence, choices, coupling, school, energy, constants, coupled, threads)}


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
