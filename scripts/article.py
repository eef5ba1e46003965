#!/usr/bin/python3
"""Run the cases of the article's figures (cases/article), and print the tables of doc/article.md.

    scripts/article.py figures     what the article says of each figure, and what its case gives (half a minute)
    scripts/article.py matrix      the same at other tolerances and intervals, and by an explicit method (an hour)
    scripts/article.py converged   the same with the converged and with the default model (a minute)
    scripts/article.py numbers     what the fish of Figure 6 does with another value of each number that the article leaves
                                   open (a minute)
    scripts/article.py --check     check that every case does what the article says of it, and that doc/article.md has the
                                   table of the figures

The exit code is 0, 1 if with --check a case does not do what the article says or a number differs, and 2 for a wrong command
line.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile

import netCDF4
import numpy as np
from documents import is_same_line

HERE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
CASES = os.path.join(HERE, "cases")


class Run:
    """The open result of a case, or the time at which its integration failed."""

    def __init__(self, program, folder, case, *assignments):
        result = os.path.join(folder, f"{os.path.basename(case)}.nc")
        sets = [word for one in assignments for word in ("--set", one)]
        command = [program, "run", os.path.join(CASES, f"{case}.yaml"), "-q", "--force", "-o", result, *sets]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        failed = re.search(r"integration failed at t = ([\d.]+) s", done.stderr)
        if done.returncode and not failed:
            sys.exit(f"article.py: {' '.join(command)} failed:\n{done.stderr}")
        self.failed = float(failed[1]) if failed else None
        self.data = None if failed else netCDF4.Dataset(result)
        if self.data:
            self.data.set_auto_mask(False)

    def __getitem__(self, name):
        return self.data[name][:]

    def headings(self):
        """The mean headings of the fish over each beat of one second, in degrees (beat, fish)."""
        n = round(1 / (self["time"][1] - self["time"][0]))
        heading = self["heading"][1:]
        return np.array([heading[i : i + n].mean(axis=0) for i in range(0, len(heading) - n + 1, n)])

    def drift(self):
        """The largest distance of a mean heading over a beat from 180 degrees."""
        return np.abs(self.headings() - 180).max()

    def distances(self):
        """The distance of the first two centres of mass over time, in body lengths of 1 m."""
        return np.linalg.norm(self["com"][:, 0] - self["com"][:, 1], axis=1)

    def turning(self):
        """The mean sum of the natural turning angles over the last beat, in degrees (fish)."""
        n = round(1 / (self["time"][1] - self["time"][0]))
        angles = 2 * np.arctan(self["natural_curvature"][-n:] * self["edge_length"][:][None, :, None] / 2)
        return np.degrees(angles).sum(axis=2).mean(axis=0)


def listed(values, form):
    return ", ".join(f"{value:{form}}" for value in values)


# Per figure: what the article says; the numbers of a run, long and short; and whether they are what the article says. Where
# the article gives no number ("slight drift"), the bound is ours: doc/article.md.
def figure5(run):
    bend = run.turning()
    words = f"the muscle bends the body by {listed(bend, '.1f')} degrees in the mean of the beat"
    return words, listed(bend, ".1f"), bend[0] < -30 and abs(bend[1]) < 0.1 and abs(bend[0] + bend[2]) < 0.1


def figure6_free(run):
    drift = run.drift()
    return (f"mean headings within {drift:.1f} degrees of 180; {run.headings()[-1, 0]:.1f} at the end", f"{drift:.1f}",
            drift < 15)


def figure6_turn(run):
    last = run.headings()[-5:, 0]
    return (f"mean headings from {last.min():.1f} to {last.max():.1f} degrees in the last five beats",
            f"{last.min():.1f} to {last.max():.1f}", np.abs(last - 135).max() < 3)


def figure7_free(run):
    end = run.distances()[-1]
    return (f"headings of {listed(run.headings()[-1], '.1f')} degrees and a distance of {end:.2f} lengths at the end",
            f"{end:.2f}", abs(end - 1) > 1)


def figure7_control(run):
    drift, distances = run.drift(), run.distances()
    return (f"mean headings within {drift:.1f} degrees of 180, distances from {distances.min():.2f} to {distances.max():.2f} lengths",
            f"{drift:.1f}; {distances[-1]:.2f}", drift < 10 and np.abs(distances - 1).max() < 1.5)


def figure8(run):
    drift = run.drift()
    return (f"mean headings within {drift:.1f} degrees of 180; {listed(run.headings()[-1], '.1f')} at the end",
            f"{drift:.1f}", drift < 12)


FIGURES = {
    "figure5": ("the reference gait over one beat, for a bias of -0.5, 0 and 0.5", figure5),
    "figure6_free": ("one free fish swims for 20 s with slight drift", figure6_free),
    "figure6_turn": ("one fish under control turns by 45 degrees to 135", figure6_turn),
    "figure7_free": ("two free fish side by side, one length apart, drift within 20 s", figure7_free),
    "figure7_control": ("the same two under control hold a heading of 180 degrees", figure7_control),
    "figure8": ("four fish in a diamond, in phase, hold a heading of 180 degrees for 25 s", figure8),
}


# Numbers and readings that the article leaves open: symbol, key, other values, and the reason for our value.
OPEN = [
    ("N", "fish[*].nodes", (13,), "edges of a sixth of a length resolve a wave of one length; the amplitude, both dampings and I hold for this number"),
    ("N_b", "fish[*].sheet_points", (41,), "three bound vortices on each edge"),
    ("d", "fish[*].body.thickness", (0.1,), "parameter of the foil: 25 % thick at most"),
    ("E", "fish[*].body.modulus", (1e5, 1e7), "the body follows its muscle: a stiffer one swims alike"),
    ("density of the body", "fish[*].body.density", (1000,), "twice that of water"),
    ("density of the fluid", "fluid.density", (), "water"),
    ("damping of bending", "fish[*].body.bending_damping", (0.25, 1), "the modes of the body decay within a beat"),
    ("damping of stretching", "fish[*].body.stretching_damping", (0.5, 2), "the same"),
    ("A", "fish[*].wave.amplitude", (0.3,), "the tail sweeps about a quarter of the length"),
    ("c_1, c_2", "fish[*].wave.quadratic", (0,), "the envelope grows almost linearly from the nose to the tail"),
    ("beta", "fish[*].wave.number", (-6.2832,), "about one wave on the body, from head to tail"),
    ("C_F", "fish[*].drag.tangential", (4e-3,), "laminar friction of a plate, 1.33/sqrt(Re), at a Reynolds number of 1e6"),
    ("C_D", "fish[*].drag.normal", (0.5, 2, 3, 5), "see below"),
    ("C_A", "fish[*].added_mass.coefficient", (1,), "above the 1 of an ellipse"),
    ("delta", "wake.smoothing", (0.1,), "many times the distance of the vortices, about 0.01 lengths"),
    ("T_diss", "wake.lifetime", (1, 4), "two beats, about two lengths of wake"),
    ("time step", "time.shedding_interval", (0.005,), "a hundredth of a beat"),
    ("start speed", "fish[*].start.speed", (0.5,), "one length a beat"),
    ("ramp of the muscle", "fish[*].wave.ramp", (0.5, 0), "see below"),
    ("removed vortices in (12)", "wake.removed_circulation", ("dropped",), "see below"),
]


def markdown(heads, rows):
    """A table; all but the first column are aligned to the left too, since they hold words."""
    return "\n".join(f"| {' | '.join(map(str, row))} |" for row in [heads, ["---"] * len(heads), *rows])


class Tables:
    """The tables, by name."""

    def __init__(self, program, folder):
        self.program = program
        self.run = lambda case, *assignments: Run(program, folder, case, *assignments)
        self.missed = []

    def figures(self):
        rows = []
        for name, (says, measure) in FIGURES.items():
            run = self.run(f"article/{name}")
            words, _, is_met = measure(run) if run.data else (f"fails at {run.failed:.2f} s", "", False)
            if not is_met:
                self.missed.append(f"{name}: {words}")
            rows.append([f"[{name.replace('figure', '').replace('_', ', ')}](figures/{name}.png)", f"`{name}.yaml`", says, words])
        return markdown(["figure", "case", "what the article says", "what the case gives"], rows)

    def matrix(self):
        rows = []
        for interval in ("0.01", "0.005"):
            for key in ("rtol=1e-4", "rtol=3e-5", "rtol=1e-6", "rtol=1e-8", *(["method=dormand_prince"] if interval == "0.01" else [])):
                row = [f"{interval} s", key.replace("method=", "").replace("=", " ")]
                for name, (_, measure) in FIGURES.items():
                    if name == "figure5":
                        continue
                    run = self.run(f"article/{name}", f"time.shedding_interval={interval}", "time.output_interval=0.1", f"solver.{key}")
                    words, short, is_met = measure(run) if run.data else ("", f"fails at {run.failed:.2f} s", False)
                    if not is_met:
                        self.missed.append(f"{name}, {', '.join(row[:2])}: {words or short}")
                    row.append(short)
                print(row, file=sys.stderr, flush=True)
                rows.append(row)
        return markdown(["interval", "setting", "6, free: drift [degree]", "6, turn: headings [degree]", "7, free: distance [L]",
                         "7, control: drift [degree]; distance [L]", "8: drift [degree]"], rows)

    def numbers(self):
        rows = []
        keys = json.loads(subprocess.run([self.program, "keys", "--json"], capture_output=True, text=True, check=True).stdout)
        value = {key["path"]: key["published"] or key["default"] or (key["derived"] or "").split(",")[0] for key in keys}
        for symbol, key, others, reason in OPEN:
            cells = []
            for other in others:
                cell = []
                for name in "figure6_free", "figure6_turn":
                    run = self.run(f"article/{name}", f"{key}={other}")
                    cell.append(FIGURES[name][1](run)[1] if run.data else f"fails at {run.failed:.2f} s")
                cells.append(f"{other:g}: {'; '.join(cell)}" if not isinstance(other, str) else f"{other}: {'; '.join(cell)}")
            path = key.replace("[*]", "")
            rows.append([symbol, f"`{path}`", value[path], reason, "<br>".join(cells)])
        return markdown(["symbol", "key", "our value", "reason", "other value: drift; turn [degree]"], rows)

    def converged(self):
        rows = []
        for what, form, *cases in (
            ("heading of a free fish after 20 s [degree]", ".1f", "article/figure6_free", "single_free", "swim"),
            ("heading after the turn to 135 degrees", ".1f", "article/figure6_turn", "single_turn", "turn"),
            ("headings of a free pair after 20 s", ".1f", "article/figure7_free", "pair_free", None),
            ("headings of a controlled pair after 20 s", ".1f", "article/figure7_control", "pair_heading", "pair"),
            ("headings of a diamond after 25 s", ".1f", "article/figure8", "diamond", "school"),
        ):
            runs = [self.run(case, *(["time.end=20"] if case == "swim" else ["time.end=25"] if case == "school" else []))
                    if case else None for case in cases]
            rows.append([what, *(listed(run.headings()[-1], form) if run else "" for run in runs)])
            if cases[1] == "single_free":
                steps = [run["steps"][-1] * float(run.data["shedding_interval"][...]) / run["time"][-1] for run in runs]
                rows.append(["steps per event of the free fish", *(f"{n:.2f}" for n in steps)])
                speeds = [[self.run(case, f"fish[0].start.speed={v}", "time.end=20")["speed"][-1, 0] for v in (0, 1, 3)] for case in cases]
                rows.append(["its speed after 20 s from 0, 1 and 3 m/s [m/s]", *(listed(each, ".3f") for each in speeds)])
        return markdown(["quantity", "as published", "made to converge", "default model"], rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", nargs="?", choices=["figures", "matrix", "numbers", "converged"], default="figures")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--program", default=os.path.join(HERE, "build", "shoal"), help="default: build/shoal")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="shoal-article-") as folder:
        tables = Tables(os.path.abspath(options.program), folder)
        table = getattr(tables, options.table)()
    print(table)
    if not options.check:
        return 0

    with open(os.path.join(HERE, "doc", "article.md"), encoding="utf-8") as file:
        lines = file.read().split("\n")
    missed = [*tables.missed, *(f"doc/article.md has no line like {row}" for row in table.split("\n")
                                if not any(is_same_line(line, row) for line in lines))]
    print("\n".join(missed), end="\n" if missed else "", file=sys.stderr)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
