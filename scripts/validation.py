#!/usr/bin/python3
"""Draw the figure of doc/validation.md: the program beside experiments, lifting surfaces and Navier-Stokes solutions.

    scripts/validation.py [TABLE ...] PICTURE      TABLE: of `build/verify/verify SECTION -o TABLE`, sections validation and
                                                   tandem; run now if there is none

An experiment has open marks in every panel; this program has a line, or filled marks beside the line of a theory. A grey
bar is the spread of the source, or 5 % where the source has one value.
"""

import csv
import json
import math
import os
import re
import subprocess
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot
from matplotlib.lines import Line2D
from shoal._plot_style import LINES, STYLE, paper

HERE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
WING = """format: 1
time: {end: 1, shedding_interval: 0.05}
fluid: {density: 1, viscosity: 0, velocity: [1, 0]}
fish: [{name: wing, nodes: 9, sheet_points: %d, force: pressure, wave: {amplitude: 0, frequency: 0}, start: {heading: 178},
        pressure: {span: finite, suction_limit: 0}, drag: {normal: 0}, motion: {prescribed: all},
        body: {profile: uniform, thickness: 0.02, depth: %g}}]
"""


def read(name):
    """A table of references, without its comments."""
    with open(os.path.join(HERE, "tests/verify/data", name), encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def lift_slope(depth):
    """The lift of a wing at an incidence of 2 degrees, over incidence and area."""
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "wing.yaml"), "w", encoding="utf-8") as file:
            file.write(WING % (max(33, round(1 + 6 / depth)), depth))
        done = subprocess.run([os.path.join(HERE, "build/shoal"), "steady", "wing.yaml", "-q", "--json"], cwd=folder,
                              capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(f"validation.py: wing of depth {depth:g}: {done.stderr}")
        return abs(json.loads(done.stdout)["steady_lift"][0]) / (0.5 * depth * math.radians(2))


def open_marks(k):
    """The marks of series k of an experiment."""
    return {"ls": "none", "marker": "os^"[k], "ms": 4, "mfc": "none", "color": LINES[k]}


def draw(tables, picture):
    lines = []
    for table in tables:
        with open(table, encoding="utf-8") as file:
            lines += [line.rstrip("\n").split("\t") for line in file]
    points = [(line[1], line[2], float(line[3]), float(line[4])) for line in lines if line[0] == "point"]
    figure, axes = pyplot.subplots(3, 2, figsize=(7, 8.2), layout="constrained")

    # a foil: thrust and power over the Strouhal number
    for panel, name, label in ((axes[0, 0], "foil_thrust", "thrust coefficient"), (axes[0, 1], "foil_power", "power coefficient")):
        for k, psi in enumerate((90, 75)):
            of = f"{name}_{psi}" if name == "foil_thrust" else name
            experiment, here = ("experiment", "here") if name == "foil_thrust" else (f"experiment, psi {psi}", f"psi {psi}")
            for word, style in ((experiment, open_marks(k)), (here, {"ls": ("-", "--")[k], "color": LINES[k]})):
                some = [(x, y) for figure_name, series, x, y in points if figure_name == of and series == word]
                panel.plot(*zip(*sorted(some)), label=f"{'experiment' if word == experiment else 'here'}, {psi}°", **style)
        panel.set(xlabel="Strouhal number", ylabel=label, ylim=(0, None))
        panel.legend(loc="upper left", fontsize=7)

    # wings of any depth
    wings = {float(row["w_over_L"]): float(row["lift_slope"]) for row in read("lifting_surface.csv")}
    depths = sorted(wings)
    axes[1, 0].plot(depths, [wings[depth] for depth in depths], ":", color="0.3", label="lifting surface")
    axes[1, 0].plot(depths, [lift_slope(depth) for depth in depths], "-", color=LINES[1], label="here")
    axes[1, 0].set(xscale="log", xlabel="depth / length", ylabel="lift slope", ylim=(0, None))
    axes[1, 0].legend(loc="upper left", fontsize=7)

    # Navier-Stokes: the result over the middle of the reference
    names = []
    for line in lines:
        # a single body, with the spread of the references if there are several; pairs have a table of their own
        source = re.fullmatch(r"Navier-Stokes(?:, (\S+) to (\S+))?", line[3]) if line[0] == "row" else None
        if not source:
            continue
        spread = [float(word or line[4]) for word in source.groups()]
        middle, low, high, obtained = float(line[4]), min(spread), max(spread), float(line[5])
        half = max((high - low) / 2 / middle, 0.05)
        words = line[2].split(",")[0].replace("heave of ", "").replace("an ell", "ell").replace("a NACA 0012", "NACA").replace(" at", "")
        names.append(words.replace(" coefficient", "").replace(" of a wake vortex over U c", "").replace(" of a wake vortex", ""))
        axes[1, 1].plot([1 - half, 1 + half], [-len(names)] * 2, color="0.6", lw=5, solid_capstyle="butt")
        axes[1, 1].plot(obtained / middle, -len(names), "o", color=LINES[1], ms=4)
    axes[1, 1].axvline(1, color="0.3", lw=0.6)
    bar = Line2D([], [], color="0.6", lw=5, label="references, at least ±5 %")
    here = Line2D([], [], ls="none", marker="o", ms=4, color=LINES[1], label="here")
    axes[1, 1].legend(handles=[bar, here], loc="lower right", bbox_to_anchor=(1, 1), ncols=2, fontsize=6, handlelength=1.2)
    axes[1, 1].set_yticks([-i - 1 for i in range(len(names))], names, size=6)
    axes[1, 1].set(xlabel="here / Navier-Stokes", xlim=(0, 2))

    # trout of three lengths
    for k, length in enumerate(("0.1", "0.2", "0.4")):
        for word, style in (("measured", open_marks(k)), ("here", {"ls": ("-", "--", "-.")[k], "color": LINES[k]})):
            some = [(x, y) for figure_name, series, x, y in points if figure_name == "trout" and series == f"{word}, {length} m"]
            axes[2, 0].plot(*zip(*some), label=f"{length} m, {'experiment' if word == 'measured' else 'here'}", **style)
    axes[2, 0].set(xlabel="beat frequency [Hz]", ylabel="stride [lengths]", ylim=(0, None))
    axes[2, 0].legend(loc="lower right", fontsize=7)

    # a plate in the wake of another one
    for series, label, style in (("published: integers", "integers", {"ls": ":", "color": "0.3"}),
                                 ("exact: linear theory", "linear theory", {"ls": "-", "color": LINES[0]}),
                                 ("in phase", "here, in phase", {"ls": "none", "marker": "o", "color": LINES[1]}),
                                 ("follower ahead", "here, follower ahead", {"ls": "none", "marker": "s", "color": LINES[2]})):
        some = [(x, y) for name, word, x, y in points if name == "tandem_places" and word == series]
        axes[2, 1].plot(*zip(*some), label=label, ms=4, **style)
    axes[2, 1].set(xlabel="number less the lead [beats]", ylabel="tail to nose [wavelengths]")
    axes[2, 1].legend(loc="upper left", fontsize=7)
    paper(figure, 170)
    figure.savefig(picture)


def main(arguments):
    if not arguments or arguments[0] in ("-h", "--help"):
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as folder, matplotlib.rc_context(STYLE):
        tables = arguments[:-1]
        for section in () if tables else ("validation", "tandem"):
            tables.append(os.path.join(folder, section))
            subprocess.run([os.path.join(HERE, "build/verify/verify"), section, "-o", tables[-1]], cwd=HERE, check=False,
                           stdout=subprocess.DEVNULL)
        draw(tables, arguments[-1])
    print(arguments[-1])


if __name__ == "__main__":
    main(sys.argv[1:])
