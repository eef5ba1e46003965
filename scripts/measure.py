#!/usr/bin/python3
"""Measure the tables of README.md and doc/, and write them into the documents.

    scripts/measure.py NAME...              print tables as markdown
    scripts/measure.py --compare FILE...    measure every table of these documents again and list the rows that differ;
                                            print the tables that only the text names, to compare the numbers in the text
    scripts/measure.py --write FILE...      the same, and replace the tables in place
    scripts/measure.py --list               names of the tables, with a line about each

The line above a table contains the command of the table, for example "`scripts/measure.py tolerance`". The script runs
build/shoal in a temporary folder. Counts are exact; seconds are CPU seconds of one machine, and ratios of seconds come
from the same table. Rows agree like the output of commands (scripts/documents.py), CPU times to a factor of two. Exit
codes: 0 all rows agree, 1 some differ.
"""

import argparse
import csv
import json
import math
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from itertools import zip_longest

import netCDF4
from documents import NUMBER, is_same_line
from matplotlib import pyplot
from shoal._files import Results, np
from shoal._plot_style import LINES, STYLE

HERE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
CASES = os.path.join(HERE, "cases")

# A default fish from rest: all other keys have the defaults of doc/cases.md.
DEFAULT = """\
format: 1
time: {end: 8, output_interval: 0.1}
fish:
  - {name: fish}
"""

# The article's fish with settings that converge.
ARTICLE = f"""\
format: 1
include: [{CASES}/include/article.yaml]
time: {{end: 2, shedding_interval: 0.01, output_interval: 2}}
wake: {{lifetime: 2, decay: 0.2}}
fish:
  - {{name: fish}}
"""

# Two default fish side by side.
PAIR = """\
format: 1
time: {end: 4, shedding_interval: 0.02, output_interval: 4}
defaults: {fish: {control: {law: heading}}}
fish:
  - {name: right}
  - {name: left, start: {position: [0, 0.5]}}
"""

# The elastic rod of the article's fish, without fluid and damping.
ROD = f"""\
format: 1
include: [{CASES}/include/article.yaml]
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

MODULUS = "fish[*].body.modulus"


class Bench:
    """Runs cases in a temporary folder."""

    def __init__(self, program, verbose, before=None):
        self.program, self.verbose, self.before = program, verbose, before
        self.errors = []  # tables of `shoal error`, which two tables show
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
            sys.exit(f"measure.py: {' '.join(command)} failed:\n{done.stderr}")
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

    def error(self, text, *assignments):
        """The errors of the steady speed and cost of a case by `shoal error`, one run at a time."""
        sets = [word for one in assignments for word in ("--set", one)]
        self.call("error", self.case(text), "--force", "-q", "-j", "1", "-o", "error", "--of", "steady_speed", "--of",
                  "steady_cost_of_transport", *sets)

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


# ---- cells ----


def markdown(heads, rows):
    """A table in markdown."""
    cells = [heads] + [[str(cell) for cell in row] for row in rows]
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


def error_of(results, right, t=None):
    """The larger of the errors of nose and tail."""
    pairs = zip(nose_and_tail(results, t), nose_and_tail(right, t))
    return max(float(np.linalg.norm(np.subtract(a, b))) for a, b in pairs)


# ---- tables ----

TABLES = {}


def table(*heads):
    """Register a function that yields the rows of a table."""

    def register(rows):
        TABLES[rows.__name__] = (heads, rows)
        return rows

    return register


@table("case", "speed [m/s]", "cost [m/s2]", "Strouhal", "residual per beat", "beats", "decay per beat")
def steady_states(bench):
    """cruising speed, cost and stability of the cases of cases/ (minutes)"""
    for name in ("swim", "fish_pressure", "heaving_plate", "tandem_plates", "diamond_plates"):
        state = bench.steady(name)
        largest = max(math.hypot(*value) for value in state["steady_multiplier"])
        strouhal = state["steady_strouhal"][0]
        yield (name, f"{state['steady_speed'][0]:.4f}",
               f"{state['steady_cost_of_transport'][0]:.4f}", "" if strouhal is None else f"{strouhal:.3f}",
               short(state["steady_residual"]), state["steady_beats"], f"{largest:.2f}")


def turn_of(path, begin):
    """Settling time [beats] of the course within 5 degrees, and overshoot [degrees], of a member with a turn to 90 degrees."""
    member = netCDF4.Dataset(path)
    time, place, beat = member["time"][:], member["com"][:, 0], 1 / float(member["frequency"][0])
    n = round(beat / (time[1] - time[0]))
    way = place[n:] - place[:-n]
    error, time = np.degrees(np.unwrap(np.arctan2(way[:, 1], way[:, 0]))) % 360 - 90, time[n:]
    return (time[np.abs(error) > 5].max() - begin) / beat, max(0, -error[time > begin].min())


@table("modulus [Pa]", "beats per s, amplitude", "gain 2, damping 1", "1, 1", "1.5, 1", "1.5, 1.5", "1.25, 0.75")
def step_response(bench):
    """settling time and overshoot of turns of 90 degrees (a quarter of an hour)"""
    folder, study = bench.study("step_response")
    for first in range(0, study["member"].size, 5):
        turns = [turn_of(os.path.join(folder, f"member-{first + i:04d}.nc"), 4.1) for i in range(5)]
        yield (power(study["fish_body_modulus"][first]),
               f"{study['fish_wave_frequency'][first]:g}, {study['fish_wave_amplitude'][first]:g}",
               *(f"{settling:.1f}, {overshoot:.0f}" for settling, overshoot in turns))


@table("modulus [Pa]", "work [J], 0.04 s", "0.02", "0.01", "0.005", "settling, most [beats]", "overshoot [degree]",
       "evaluations, 0.04 s", "0.02", "0.01", "0.005")
def feedback(bench):
    """course control over modulus and interval: work, a turn of 90 degrees, effort (a minute)"""
    folder, study = bench.study("feedback")
    for first in range(0, study["member"].size, 4):
        turns = [turn_of(os.path.join(folder, f"member-{first + i:04d}.nc"), 8.1) for i in range(4)]
        of = slice(first, first + 4)
        yield (power(study["fish_body_modulus"][first]), *(f"{work:.2f}" for work in study["actuation_work"][of, 0]),
               *(f"{max(values):.1f}" for values in zip(*turns)),
               *(int(count) for count in study["residual_evaluations"][of]))


@table("depth [L]", "force", "span", "speed [m/s]", "cost [m/s2]", "largest multiplier")
def depth(bench):
    """steady speed, cost and stability over the depth of a stiff body, three forces (a minute)"""
    _, study = bench.study("depth")
    names = strings(study["fish_force"]), strings(study["fish_pressure_span"])
    for i in range(study["member"].size):
        yield (f"{study['fish_body_depth'][i]:g}", names[0][i], "" if names[0][i] == "reactive" else names[1][i],
               f"{study['steady_speed'][i, 0]:.4f}", f"{study['steady_cost_of_transport'][i, 0]:.4f}",
               f"{math.exp(study['steady_growth'][i]):.3f}")


def strings(variable):
    """The strings of a variable over (n, text)."""
    return [text.strip("\0 ") for text in netCDF4.chartostring(np.asarray(variable[:], dtype="S1"))]


def open_study(path):
    """A study.nc as netCDF4 has it, with texts as arrays of letters."""
    study = netCDF4.Dataset(path)
    study.set_auto_mask(False)
    study.set_auto_chartostring(False)
    return study


# ---- are true errors below the bars? ----

DEFAULTS = {
    "swim": ("swim", []),
    "swim, modulus 1e7": ("swim", ["fish[*].body.modulus=1e7"]),
    "swim, frequency 2": ("swim", ["fish[*].wave.frequency=2"]),
    "swim, force reactive": ("swim", ["fish[*].force=reactive"]),
    "foil_static": ("foil_static", []),
}


@table("case", "quantity", "value", "bar / value", "error / value", "bar over error")
def bars_of_defaults(bench):
    """bars of 18 numbers against runs with all numerical keys refined together (10 minutes)"""
    ratios = []
    for name, (case, sets) in DEFAULTS.items():
        of = ["steady_lift", "steady_deflection"] if case == "foil_static" else STEADY
        path, folder = bench.case(case), os.path.join(bench.folder, "defaults")
        words = [word for one in sets for word in ("--set", one)]
        bench.call("error", path, "-q", "--force", "-o", folder, *words, *[word for q in of for word in ("--of", q)])
        study = open_study(os.path.join(folder, "study.nc"))
        refined = ["steady.multipliers=false"]
        for k, key in enumerate(strings(study["key_name"])):
            if study["key_levels"][k] < 2:
                continue
            finest = float(study["key_value"][k, 0])
            is_grid = key.startswith("fish.") or key == "time.shedding_interval"
            refined += finer(key, finest if is_grid else finest / 2 if key == "wake.lifetime" else finest * 10)
        true = os.path.join(bench.folder, "true.nc")
        bench.call("steady", path, "-q", "--force", "-o", true, *words, *[word for one in refined for word in ("--set", one)])
        result = open_study(true)
        for quantity in of:
            value, bar = (float(study[f"{what}_{quantity}"][0]) for what in ("stated", "bar"))
            error = abs(float(result[quantity][0]) - value)
            ratios.append(bar / error)
            yield (name, quantity.removeprefix("steady_"), f"{value:.5g}", f"{bar / abs(value):.2e}", f"{error / abs(value):.2e}",
                   f"{ratios[-1]:.2f}")
    yield f"{sum(ratio >= 1 for ratio in ratios)} of {len(ratios)} inside", "", "", "", "median", f"{np.median(ratios):.2f}"


# Quantities of cases outside the choice of the rule; quantities of runs include the judges of an error study.
STEADY = ["steady_speed", "steady_cost_of_transport", "steady_strouhal", "steady_efficiency"]
RUN = ["speed", "cost_of_transport", "lateral_drift", "mean_heading"]
HEAVE = ["mean_thrust", "mean_power", "efficiency", "shed_circulation"]
STILL = "wave: {amplitude: 0, frequency: 0}"
ONE = "[{name: fish}]"
OTHERS = "[sheet_points, shedding_interval, rtol, tolerance, lifetime]"


def coverage_cases():
    """Kind, quantities, varied keys, and text of each case; nodes with a sheet for all levels of the nodes."""

    def text(nodes, sheet, body, fish=ONE, end=4, more=""):
        return (f"format: 1\ntime: {{end: {end:g}, shedding_interval: 0.02, output_interval: 0.1}}\n{more}"
                f"defaults: {{fish: {{nodes: {nodes}, sheet_points: {sheet}, {body}}}}}\nfish: {fish}\n")

    for body in ("body: {profile: uniform, modulus: 1e6}", "body: {modulus: 1e7}", "wave: {frequency: 2}",
                 "wave: {amplitude: 1.5}, body: {modulus: 3e6}", "body: {tail_thickness: 0.1, modulus: 5e5}",
                 "wave: {frequency: 0.5}", "body: {profile: uniform, modulus: 1e8}"):
        yield "reactive fish", STEADY, "[nodes]", text(25, 69, f"force: reactive, {body}")
    for body in ("body: {profile: uniform, modulus: 1e6}", "body: {modulus: 1e7}", "body: {}",
                 "wave: {frequency: 2}, body: {depth: 0.5, modulus: 5e6}"):
        yield "fish with pressure", STEADY, "[nodes]", text(13, 97, f"force: pressure, pressure: {{span: infinite}}, {body}")
        yield "fish with pressure", STEADY, OTHERS, text(13, 33, f"force: pressure, pressure: {{span: infinite}}, {body}")
    stream = "fluid: {density: 1, velocity: [1, 0], viscosity: 0}\n"
    for heading, modulus in ((170, 2e5), (160, 4e5), (176, 8e5), (172, 1.5e5), (165, 6e5), (178, 1.2e5), (150, 1e6), (174, 3e5)):
        body = (f"force: pressure, pressure: {{span: infinite}}, start: {{heading: {heading}, speed: 0}}, {STILL}, motion: {{prescribed: head}}, "
                f"body: {{profile: uniform, thickness: 0.05, depth: 1, density: 25.465, modulus: {modulus:g}}}")
        yield "foil", ["steady_lift", "steady_deflection"], "[nodes]", text(13, 97, body, more=stream)
        yield "foil", ["steady_lift", "steady_deflection"], "[sheet_points]", text(13, 33, body, more=stream)
    body = (f"force: pressure, pressure: {{span: infinite}}, start: {{speed: 1}}, {STILL}, motion: {{prescribed: head, heave: 0.05, frequency: 0.5}}, "
            "body: {profile: uniform, thickness: 0.05, depth: 1, density: 25.465, modulus: 814873, relaxation_time: 0.001}")
    for nodes, sheet, keys in ((13, 97, "[nodes]"), (13, 33, OTHERS)):
        yield ("foil", ["steady_thrust", "steady_fluid_power"], keys,
               text(nodes, sheet, body, more="fluid: {density: 1, viscosity: 0}\n"))
    for heave, frequency in ((0.175, 1), (0.05, 2)):
        body = (f"force: pressure, pressure: {{span: infinite}}, start: {{speed: 1.25}}, {STILL}, body: {{profile: uniform, thickness: 0.12, depth: 1}}, "
                f"motion: {{prescribed: all, heave: {heave}, frequency: {frequency}}}")
        yield "foil", HEAVE, OTHERS, text(13, 33, body, end=3 / frequency, more="fluid: {density: 1, viscosity: 1.25e-3}\n")
    for place, phase, body in (("[0, 0.5]", 90, "body: {}"), ("[1.4, 0.2]", 0, "body: {modulus: 1e7}")):
        fish = ("[{name: right, start: {position: [0, 0], speed: 0.8}}, "
                f"{{name: left, start: {{position: {place}, speed: 0.8}}, wave: {{phase: {phase}}}}}]")
        yield "two fish", RUN, "[nodes]", text(25, 69, f"force: reactive, {body}", fish, 3)
        yield "two fish", RUN, OTHERS, text(25, 49, f"force: reactive, {body}", fish, 3)
    for force, nodes, sheet in (("force: reactive", 25, 49), ("force: pressure, pressure: {span: infinite}", 13, 33)):
        body = f"{force}, start: {{speed: 0.8}}, control: {{bias: 0.3}}"
        yield "turn", RUN, "[nodes]", text(nodes, 97, body, end=3)
        yield "turn", RUN, OTHERS, text(nodes, sheet, body, end=3)


def finer(key, finest):
    """Assignments of a level twice as fine as the finest one."""
    if key.startswith("fish."):
        return [f"fish[*].{key[5:]}={2 * round(finest) - 1}"]
    if key != "wake.lifetime":
        return [f"{key}={finest / (2 if key == 'time.shedding_interval' else 10):.17g}"]
    return [f"wake.lifetime={2 * finest:.17g} beats", f"wake.decay={1.5 * finest:.17g} beats"]


def coverage_of(bench, number, of, keys, text):
    """Bars and true errors, both over the value, and whether the levels are flagged: of each key, quantity and fish."""
    path = bench.case(text)
    plain = os.path.join(bench.folder, f"plain-{number}.yaml")
    shutil.copy(path, plain)
    path = bench.case(f"{text}error: {{of: [{', '.join(of)}], keys: {keys}}}\n")
    folder = os.path.join(bench.folder, f"coverage-{number}")
    bench.call("study", path, "-q", "-o", folder)
    study = open_study(os.path.join(folder, "study.nc"))
    for k, key in enumerate(strings(study["key_name"])):
        if study["key_levels"][k] < 2:
            continue
        is_steady = of[0].startswith("steady_")
        sets = finer(key, float(study["key_value"][k, 0])) + ["steady.multipliers=false"] * is_steady
        true = os.path.join(bench.folder, "true.nc")
        bench.call("steady" if is_steady else "run", plain, "-q", "--force", "-o", true,
                   *[word for one in sets for word in ("--set", one)])
        result = open_study(true)
        base = int(study["key_member"][k, study["key_stated"][k]])
        # a study computes some quantities, which a result does not state
        for quantity in [name for name in of if name in result.variables]:
            values, flags = study[quantity][base], study[f"key_flag_{quantity}"][k]
            for f, value in enumerate(np.atleast_1d(values)):
                last = result[quantity][:] if is_steady else result[quantity][-1]
                yield (float(study[f"part_{quantity}"][k, f]) / abs(value),
                       abs(float(np.atleast_1d(last)[f]) - value) / abs(value), bytes(flags[f]).strip(b"\0 ") != b"")


def share(covered):
    """63 of 64 (98 %)"""
    return f"{sum(covered)} of {len(covered)} ({100 * sum(covered) / len(covered):.0f} %)" if covered else "none"


@table("cases", "covered", "not flagged", "bar over error, median", "flagged", "bar over error", "below 1e-4, not counted")
def error_coverage(bench):
    """how many true errors are within their bars, on cases that were not used to choose the rule (15 minutes)"""
    kinds = {}
    for number, (kind, *case) in enumerate(coverage_cases()):
        kinds.setdefault(kind, []).extend(coverage_of(bench, number, *case))
    kinds["all"] = [one for kind in kinds.values() for one in kind]
    for kind, found in kinds.items():
        counted = [one for one in found if max(one[:2]) > 1e-4]
        cells = []
        for is_flagged in (False, True):
            part = [one[:2] for one in counted if one[2] == is_flagged]
            ratios = [bar / error for bar, error in part if error > 0]
            cells += [share([error <= bar for bar, error in part]), f"{np.median(ratios):.1f}" if ratios else ""]
        yield kind, share([error <= bar for bar, error, _ in counted]), *cells, len(found) - len(counted)


@table("modulus [Pa]", "speed [m/s]", "cost [m/s2]", "steps", "Newton iterations", "Jacobians")
def stiff_fish(bench):
    """the default fish over the stiffness of the body: results and cost of an event (two minutes)"""
    for modulus in (1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11):
        state = bench.steady("swim", f"{MODULUS}={modulus:g}", "steady.multipliers=false")
        run = bench.run(DEFAULT, f"{MODULUS}={modulus:g}")
        if state is None:
            yield power(modulus), "none", "", *per_event(run)
        else:
            yield (power(modulus), f"{state['steady_speed'][0]:.4f}", f"{state['steady_cost_of_transport'][0]:.4f}",
                   *per_event(run))


@table("nodes", "speed, 1.5e6 Pa [m/s]", "cost [m/s2]", "speed, 1e8 Pa", "cost", "speed, reactive", "cost")
def nodes(bench):
    """speed and cost of the default fish over the number of nodes (two minutes)"""
    for n in (9, 13, 17, 25, 35, 49):
        row = [n]
        for keys in ((), (f"{MODULUS}=1e8",), ("fish[*].force=reactive",)):
            state = bench.steady("swim", f"fish[*].nodes={n}", "steady.multipliers=false", *keys)
            row += ["none", ""] if state is None else [f"{state['steady_speed'][0]:.4f}",
                                                      f"{state['steady_cost_of_transport'][0]:.4f}"]
        yield row


def error_rows(bench, are_choices):
    """Keys with levels and errors, in per cent, of speed and cost of the default fish with both forces."""
    if not bench.errors:
        for force in ("reactive", "pressure"):
            text, folder = DEFAULT.replace("{name: fish}", f"{{name: fish, force: {force}}}"), f"error-{force}"
            bench.call("error", bench.case(text), "--of", "steady_speed", "--of", "steady_cost_of_transport", "--models",
                       "-q", "--force", "-o", folder)
            with open(os.path.join(bench.folder, folder, "error.csv"), encoding="utf-8", newline="") as file:
                bench.errors.append(list(csv.DictReader(file)))
    rows = {}
    for number, table_of_force in enumerate(bench.errors):
        for line in table_of_force:
            if line["key"] in ("lowest", "highest"):
                continue
            row = rows.setdefault(line["key"], {"levels": [], "cells": {}, "is_choice": "choice" in line["verdict"]})
            if line["levels"] not in row["levels"]:
                row["levels"].append(line["levels"])
            is_estimate = line["verdict"] in ("", "accepted") or "noise" in line["verdict"] or row["is_choice"]
            row["cells"][number, line["quantity"]] = f"{float(line['percent']):.2f}{'' if is_estimate else ' *'}"
    for key, row in sorted(rows.items(), key=lambda item: item[0] == "sum"):
        if row["is_choice"] == are_choices:
            yield key, "; ".join(row["levels"]), *(row["cells"].get((number, f"steady_{quantity}"), "")
                                                   for number in range(2) for quantity in ("speed", "cost_of_transport"))


ERRORS = ["levels", "speed, reactive [%]", "cost [%]", "speed, pressure [%]", "cost [%]"]


@table("key", *ERRORS)
def errors(bench):
    """errors of the defaults: speed and cost of the default fish with both forces, by `shoal error` (minutes)"""
    yield from error_rows(bench, False)


@table("key", *ERRORS)
def choices(bench):
    """change of the same numbers by other choices of the model"""
    yield from error_rows(bench, True)


@table("shedding", "kutta", *COUNTS)
def events(bench):
    """cost of an event with and without a jump of the state"""
    for shedding in ("continuous", "impulsive"):
        for kutta in ("edge", "rate"):
            run = bench.run(ARTICLE, f"wake.shedding={shedding}", f"sheet.kutta={kutta}")
            yield shedding, kutta, *per_event(run)


@table("modulus [Pa]", "ramp [s]", *COUNTS)
def start(bench):
    """cost of a sudden start of the muscle, on an undamped body"""
    for modulus in (1e6, 1e10):
        for ramp in (0, 0.25, 1):
            run = bench.run(ARTICLE, f"{MODULUS}={modulus:g}", f"fish[*].wave.ramp={ramp:g}")
            yield power(modulus), f"{ramp:g}", *(per_event(run) if run else ["failed", "", ""])


@table("modulus [Pa]", "error_test", *COUNTS, "speed [m/s]", "balance [J]", "CPU time [s]")
def error_test(bench):
    """cases/swim.yaml for 8 s with the errors of the positions or of all unknowns in the error test (a minute)"""
    for modulus in (1e6, 1e9):
        for words in ("positions", "all"):
            keys = "time.end=8", f"{MODULUS}={modulus:g}", f"solver.error_test={words}"
            run = bench.run("swim", *keys)
            yield (power(modulus), words, *per_event(run), f"{run['speed'][-1, 0]:.4f}", short(abs(run["energy_balance"][-1, 0])),
                   f"{bench.seconds('swim', *keys):.2f}")


@table("start [m/s]", "modulus [Pa]", "1e-4", "3e-5", "1e-5", "1e-6", "half of the interval's")
def tolerance(bench):
    """errors over solver.rtol: nose or tail [1e-5 L] / work of the muscle [1e-4] (minutes)"""
    for speed in (0.79, 0):
        for modulus in (1e5, 1e6, 1e8, 1e10):
            keys = ("time.end=5", f"fish[*].start.speed={speed:g}", f"{MODULUS}={modulus:g}")

            def errors(run, right, share=1):
                work = run["actuation_work"][-1, 0] / right["actuation_work"][-1, 0] - 1
                return f"{1e5 * share * error_of(run, right):.2g}/{1e4 * share * abs(work):.2g}"

            right = bench.run(DEFAULT, *keys, "solver.rtol=1e-8")
            cells = [errors(bench.run(DEFAULT, *keys, f"solver.rtol={rtol}"), right)
                     for rtol in ("1e-4", "3e-5", "1e-5", "1e-6")]
            # the error of second order is four thirds of the difference from half of the interval
            pair = [bench.run(DEFAULT, *keys, "solver.rtol=1e-7", f"time.shedding_interval={size:g}")
                    for size in (0.01, 0.005)]
            yield f"{speed:g}", power(modulus), *cells, errors(*pair, 2 / 3)


@table("modulus [Pa]", "order", "nose or tail [L]", "balance over work", *COUNTS)
def order(bench):
    """the default fish over the highest order of the method (minutes)"""
    for modulus in (1e6, 1e10):
        keys = (f"{MODULUS}={modulus:g}",)
        right = bench.run(DEFAULT, *keys, "time.end=3", "solver.rtol=1e-8", "solver.order=2",
                          "solver.max_steps=100000", "wake.tolerance=1e-9")
        for highest in range(2, 6):
            run = bench.run(DEFAULT, *keys, f"solver.order={highest}")
            balance = abs(run["energy_balance"][-1, 0] / run["actuation_work"][-1, 0])
            yield power(modulus), highest, short(error_of(run, right, 3)), short(balance), *per_event(run)


@table("from", "to [periods]", "nose [L]", "order", "tail [L]", "order")
def interval(bench):
    """change of a fish that feels its own wake (force: pressure) from one shedding interval to the next (a minute)"""
    sizes = (0.04, 0.02, 0.01, 0.005, 0.0025)
    points = [1 + round(32 * math.sqrt(sizes[0] / size)) for size in sizes]
    keys = ("time.end=1.6", "time.output_interval=0.04", "solver.rtol=1e-8", "fish[*].force=pressure", "fish[*].nodes=17",
            "fish[*].start.speed=1")
    runs = [bench.run(DEFAULT, *keys, f"time.shedding_interval={size:g}", f"fish[*].sheet_points={n}")["x"][:, 0]
            for size, n in zip(sizes, points)]
    changes = [[math.sqrt(float(np.mean(np.sum((a[:, node] - b[:, node]) ** 2, axis=1)))) for node in (0, -1)]
               for a, b in zip(runs, runs[1:])]
    for number, size in enumerate(sizes[:-1]):
        row = [f"{size:g}", f"{sizes[number + 1]:g}"]
        for quantity in range(2):
            change = changes[number][quantity]
            row += [short(change), f"{math.log2(changes[number - 1][quantity] / change):.2f}" if number else ""]
        yield row


@table("modulus [Pa]", "method", "tail [L]", "steps per event", "evaluations", "Jacobians")
def explicit(bench):
    """cost of adaptive explicit methods over the stiffness of the article's fish (a minute)"""
    for modulus in (1e6, 1e10):
        keys = (f"{MODULUS}={modulus:g}",)
        right = bench.run(ARTICLE, *keys, "solver.rtol=1e-9")
        for method in ("ida", "heun", "rk4", "dormand_prince"):
            run = bench.run(ARTICLE, *keys, f"solver.method={method}", "solver.max_steps=20000")
            if run is None:
                yield power(modulus), method, "failed", "", "", ""
                continue
            cost = [f"{run[name][-1] / n_events(run):.2f}" for name in
                    ("steps", "residual_evaluations", "jacobian_evaluations")]
            yield power(modulus), method, short(error_of(run, right)), *cost


def rod_settings(modulus):
    """Settings for the rod: implicit methods, and explicit methods with the longest stable step."""
    stable = math.sqrt(modulus / 1e4)
    for rtol in ("1e-4", "3e-5", "1e-5"):
        yield "ida", f"rtol {rtol}", [f"solver.rtol={rtol}"]
    for method, counts in (("trapezoid", (1, 2, 4)), ("verlet", (round(5 * stable),)), ("rk4", (round(3 * stable),))):
        for n in counts:
            yield method, f"{0.02 / n:.2g} s", [f"solver.method={method}", f"solver.step={0.02 / n:.12g}"]


@table("modulus [Pa]", "method", "setting", "nose or tail [L]", "evaluations", "CPU time over ida")
def rod(bench):
    """the cheapest setting of each method on an undamped rod with an error below 1e-4 lengths (two minutes)"""
    for modulus in (1e4, 1e6, 1e10):
        body = f"{MODULUS}={modulus:g}"
        exact = bench.run(ROD, body, "solver.method=verlet",
                          f"solver.step={0.02 / round(15 * math.sqrt(modulus / 1e4)):.12g}")
        seconds = {}
        for method, setting, assignments in rod_settings(modulus):
            run = bench.run(ROD, body, *assignments) if method not in seconds else None
            error = error_of(run, exact) if run else math.inf
            if error > 1e-4:
                continue
            seconds[method] = bench.seconds(ROD, body, *assignments)
            ratio = seconds[method] / seconds["ida"] if "ida" in seconds else math.nan
            yield (power(modulus), method, setting, short(error), int(run["residual_evaluations"][-1]),
                   f"{ratio:.2g}")


@table("layout", "gap [L]", "Newton iterations, not coupled", "coupled", "Jacobians, not coupled", "coupled",
       "CPU time, coupled over not")
def coupling(bench):
    """cost of two fish near each other, with and without coupling blocks in the Jacobian (two minutes)"""
    for layout, gaps in (("side by side", (0.1, 0.5, 2)), ("one after the other", (0.1, 1))):
        for gap in gaps:
            # 0.25: the thickness of two fish, and the approach within four seconds
            place = f"[0, {gap + 0.25:g}]" if layout == "side by side" else f"[{gap + 1:g}, 0]"
            runs, times = [], []
            for reach in (0, 100):
                keys = f"fish[1].start.position={place}", f"solver.coupling_distance={reach}"
                runs.append(bench.run(PAIR, *keys))
                times.append(bench.seconds(PAIR, *keys))
            if None in runs:
                yield layout, f"{gap:g}", *["failed"] * 5
                continue
            (_, apart, apart_jacobians), (_, coupled, coupled_jacobians) = (per_event(run) for run in runs)
            yield layout, f"{gap:g}", apart, coupled, apart_jacobians, coupled_jacobians, f"{times[1] / times[0]:.2f}"


def lattice(n, spacing, end, interval=0.01, output=None, fish="control: {law: heading}"):
    """n fish in a square, default ones with heading control."""
    side = math.ceil(math.sqrt(n))
    places = [f"  - {{start: {{position: [{spacing[0] * (i % side):g}, {spacing[1] * (i // side):g}]}}}}"
              for i in range(n)]
    return "\n".join(["format: 1", f"time: {{end: {end}, shedding_interval: {interval}, output_interval: {output or end}}}",
                      f"defaults: {{fish: {{{fish}}}}}", "fish:", *places, ""])


@table("fish", "spacing [L]", "coupling distance [L]", *COUNTS)
def school(bench):
    """cost of an event over the number of fish and the coupling distance (a minute)"""
    for n, spacing, reach in ((4, (1.5, 1.5), 0.5), (16, (1.5, 1.5), 0.5), (64, (1.5, 1.5), 0.5), (64, (1.5, 1.5), 0),
                              (9, (1.3, 0.4), 0), (9, (1.3, 0.4), 0.5), (9, (1.3, 0.4), 100)):
        run = bench.run(lattice(n, spacing, 0.5), f"solver.coupling_distance={reach}")
        yield n, f"{spacing[0]:g} x {spacing[1]:g}", reach, *(per_event(run) if run else ["failed", "", ""])


@table("fish", "nodes", "unknowns", "entries of the factors, blocks", "klu", "GMRES iterations per event", "CPU time of klu over blocks")
def linear(bench):
    """solver.linear blocks against klu: factors and CPU time of close fish at cruising speed (ten minutes)"""
    for n, nodes, end in ((1, 13, 2), (1, 25, 2), (1, 50, 1), (1, 100, 0.4), (1, 199, 0.2), (4, 13, 1), (4, 25, 1), (4, 50, 0.4),
                          (4, 100, 0.1), (16, 13, 0.4), (16, 25, 0.2)):
        text = lattice(n, (1.2, 0.4), end, 0.02, end, f"nodes: {nodes}, start: {{speed: 0.8}}")
        runs, times = [], [math.inf, math.inf]
        for repeat in range(3 if n == 1 else 1):
            for i, kind in enumerate(("blocks", "klu")):
                before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
                run = bench.run(text, f"solver.linear={kind}", "solver.threads=1")
                times[i] = min(times[i], resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before)
                # NetCDF reads lazily: keep the values before the next run replaces the file
                if repeat == 0:
                    runs.append((int(run["factor_non_zeros"][-1]), int(run["gmres_iterations"][-1]) / n_events(run),
                                 int(run["differential_unknowns"].sum() + run["algebraic_unknowns"].sum())))
        yield (n, nodes, f"{runs[0][2]:,}", f"{runs[0][0]:,}", f"{runs[1][0]:,}", f"{runs[0][1]:.1f}",
               f"{times[1] / times[0]:.2f}")


@table("threads", "same bits as one")
def threads(bench):
    """bodies and wakes of 64 fish after 0.1 s"""
    reference = None
    for n in (1, 2, 3):
        run = bench.run(lattice(64, (1.4, 0.6), 0.1), f"solver.threads={n}")
        bits = run["x"].tobytes() + run["wake_x"].tobytes()
        reference = reference or bits
        yield n, "yes" if bits == reference else "NO"


def swimmers(n, end, more=""):
    """n fish at cruising speed with the default body of the program before."""
    body = "body: {thickness: 0.2, depth: 0.25, modulus: 1e6}, drag: {normal: 0}"
    return lattice(n, (2, 1), end, 0.02, 0.2, f"start: {{speed: 0.79}}, {body}{more}")


@table("case", "simulated [s]", "CPU time before [s]", "CPU time over it, 1e-5", "3e-5", "error before", "1e-5", "3e-5")
def ratios(bench):
    """CPU time against the program before (--before), and errors as in the table tolerance (an hour)"""
    now, before = bench, Bench(bench.before, bench.verbose)
    slow = ("fish[*].start.speed=0",)
    infinite = swimmers(16, 2, ", pressure: {span: infinite}")
    readme = swimmers(2, 20, ", control: {law: course}").replace("[2, 0]", "[2, 0.3]")
    for name, text, end, keys in (("one fish", swimmers(1, 5), 5, ()), ("4 fish", swimmers(4, 3), 3, ()),
                                  ("16 fish", swimmers(16, 2), 2, ()), ("64 fish", swimmers(64, 0.8), 0.8, ()),
                                  ("64 fish", swimmers(64, 3.2), 3.2, ()), ("16 fish, infinite", infinite, 2, ()),
                                  ("one fish from rest", swimmers(1, 20), 20, slow),
                                  ("README's school", readme, 20, (*slow, "time.shedding_interval=0.01")),
                                  ("diamond", "diamond", 5, ()), ("`steady`", swimmers(1, 20), None, slow),
                                  ("`error`", swimmers(1, 20), None, slow)):
        variants = [(before, "1e-5"), (now, "1e-5"), (now, "3e-5")]
        seconds, errors = [math.inf] * 3, ["", "", ""]
        for _ in range(1 if name in ("64 fish", "`error`") else 3):
            for i, (program, rtol) in enumerate(variants):
                start = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
                sets = *keys, f"solver.rtol={rtol}", "solver.threads=1"
                act = {"`steady`": program.steady, "`error`": program.error}.get(name, program.run)
                run = act(text, *sets, *([f"time.end={end}"] if end else []))
                seconds[i] = min(seconds[i], resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - start)
                # NetCDF reads lazily: keep the values before the next run replaces the file
                errors[i] = (nose_and_tail(run), float(run["actuation_work"][-1, 0])) if end else ""
        if end and name != "64 fish":
            for i, program in ((0, before), (1, now)):
                right = program.run(text, *keys, "solver.rtol=1e-8", "solver.max_steps=100000", f"time.end={end}")
                places, work = nose_and_tail(right), float(right["actuation_work"][-1, 0])
                for k in (0,) if i == 0 else (1, 2):
                    of_place = max(float(np.linalg.norm(np.subtract(a, b))) for a, b in zip(errors[k][0], places))
                    errors[k] = f"{1e5 * of_place:.2g}/{1e4 * abs(errors[k][1] / work - 1):.2g}"
        else:
            errors = [""] * 3
        yield (name, f"{end:g}" if end else "", f"{seconds[0]:.2f}", *(f"{one / seconds[0]:.2f}" for one in seconds[1:]),
               *errors)
    shutil.rmtree(before.folder)


@table("the article's diamond, 5 s", "nose or tail [L]", *COUNTS, "evaluations", "CPU time [s]")
def peers(bench):
    """counts and time of the article's diamond: its own scheme, and the converged model by implicit and explicit methods (a minute)"""
    with open(bench.case("diamond"), encoding="utf-8") as file:
        converged = file.read().replace("include/article.yaml", f"{CASES}/include/article.yaml")
    own = re.sub("(?m)^include:.*$", "preset: published", converged)
    right = nose_and_tail(bench.run(converged, "time.end=5", "solver.rtol=1e-9", "solver.max_steps=100000"))
    for name, text, *keys in (("the article's scheme, ida, rtol 1e-6", own, "solver.rtol=1e-6"), ("converged, ida", converged),
                              *((f"converged, {method}", converged, f"solver.method={method}")
                                for method in ("heun", "rk4", "dormand_prince"))):
        run = bench.run(text, "time.end=5", "solver.max_steps=100000", *keys)
        error = max(float(np.linalg.norm(np.subtract(a, b))) for a, b in zip(nose_and_tail(run), right))
        yield (name, short(error) if text is converged else "", *per_event(run), f"{run['residual_evaluations'][-1] / n_events(run):.1f}",
               f"{bench.seconds(text, 'time.end=5', 'solver.max_steps=100000', 'solver.threads=1', *keys, repeats=1):.2f}")


@table("fish", "CPU time", "wall time, two threads")
def real_time(bench):
    """time per simulated second of 1 to 256 default fish at cruising speed over 3.2 s (minutes)"""
    for n in (1, 4, 16, 64, 256):
        text = lattice(n, (2, 1), 3.2, 0.02, 0.2, "start: {speed: 0.81}")
        new = bench.seconds(text, "solver.threads=1", repeats=3 if n < 64 else 1) / 3.2
        begin = time.perf_counter()
        bench.run(text, "solver.threads=2")
        yield n, f"{new:.2g}", f"{(time.perf_counter() - begin) / 3.2:.2g}"


@table("fish", "CPU time of 20 events from the start [s]", "exponent", "memory [MB]", "exponent")
def growth(bench):
    """CPU time and memory over the number of default fish at cruising speed, one thread (two minutes)"""
    last = None
    for n in (16, 64, 256, 1024):
        with open(os.path.join(bench.folder, "case.yaml"), "w", encoding="utf-8") as file:
            file.write(lattice(n, (2, 1), 0.4, 0.02, 0.4, "start: {speed: 0.81}"))
        command = [bench.program, "run", "case.yaml", "-q", "--force", "--set", "solver.threads=1"]
        run = subprocess.Popen(command, cwd=bench.folder, stderr=subprocess.DEVNULL)
        used = os.wait4(run.pid, 0)[2]
        now = used.ru_utime, used.ru_maxrss / 1000
        orders = [f"{math.log(a / b) / math.log(4):.2f}" for a, b in zip(now, last)] if last else ["", ""]
        yield n, f"{now[0]:.2g}", orders[0], f"{now[1]:.0f}", orders[1]
        last = now


def draw_real_time(path):
    """The table real_time of doc/performance.md as a figure."""
    with open(os.path.join(HERE, "doc/performance.md"), encoding="utf-8") as file:
        lines = file.read().split("`scripts/measure.py real_time`", 1)[1].split("\n\n", 2)[1]
    rows = rows_of(lines.split("\n"))
    with pyplot.rc_context(STYLE):
        figure, axes = pyplot.subplots(figsize=(4.5, 3), layout="constrained")
        for i, (k, label) in enumerate(((-2, "CPU time, one thread"), (-1, "wall time, two threads"))):
            x, y = zip(*((int(row[0]), float(row[k])) for row in rows if row[k]))
            axes.loglog(x, y, marker="os"[i], ms=4, color=LINES[i], label=label)
        axes.axhline(1, color="0.3", lw=0.8, ls=":")
        axes.annotate("real time", (1, 1), (0, 2), textcoords="offset points", size=7)
        axes.set(xlabel="fish", ylabel="time per simulated time [s/s]")
        axes.set_xticks([int(row[0]) for row in rows], [row[0] for row in rows])
        axes.minorticks_off()
        axes.legend(fontsize=7)
        figure.savefig(path)


@table("force", "span", "CPU time over reactive", "of 16 fish", *COUNTS)
def forces(bench):
    """cost of a default fish (10 s) and of 16 fish (2 s) with three forces, one thread (minutes)"""
    keys = [("fish[*].force=reactive",)]
    keys += [("fish[*].force=pressure", f"fish[*].pressure.span={span}") for span in ("infinite", "finite")]
    one, many = DEFAULT.replace("end: 8", "end: 10"), lattice(16, (1.5, 1.5), 2)
    seconds = []
    for text in one, many:
        # alternate, so that the load of the machine is the same for all
        passes = [[bench.seconds(text, "solver.threads=1", *force) for force in keys] for _ in range(3)]
        seconds.append([min(times) for times in zip(*passes)])
    for i, force in enumerate(keys):
        names = [key.split("=")[1] for key in force]
        yield (*(names + [""])[:2], *(f"{times[i] / times[0]:.2f}" for times in seconds),
               *per_event(bench.run(one, *force)))


@table("speed [m/s]", "steps, most in 10 ms", "median after that", "closest [mm]", "balance over energy", "rtol 1e-6",
       "energy [J]", "of it stretching", "shortest body [L]", "shortest edge")
def impact(bench):
    """two fish that meet head on (seconds)"""
    for speed in (1, 5, 15):
        keys = ("time.end=0.2", f"fish[*].start.speed={speed}")
        run, finer = bench.run("head_on", *keys), bench.run("head_on", *keys, "solver.rtol=1e-6")
        energy = run["kinetic_energy"][0, 0]
        balances = [short(float(np.abs(one["energy_balance"]).max() / energy)) for one in (run, finer)]
        steps = np.diff(np.asarray(run["steps"]))
        most = int(np.argmax(steps))
        closest = float(run.data.closest_approach.split()[0])
        close_up = bench.run("head_on", *keys, "time.shedding_interval=0.001", "time.output_interval=0.001")
        edges = np.linalg.norm(np.diff(np.asarray(close_up["x"])[:, 0], axis=1), axis=2)
        stretching = float(np.max(close_up["stretching_energy"])) / energy
        yield (speed, int(steps[most]), f"{np.median(steps[most + 1:]):.0f}", f"{1000 * closest:.1f}" if closest > 0 else "< 0.05", *balances,
               f"{energy:.4g}", f"{stretching:.2f}", f"{edges.sum(axis=1).min():.2f}",
               f"{edges.min() * edges.shape[1]:.2f}")


# Two rigid foils of tests/verify/data/school_navier_stokes.csv: chord 1, period 1, Re 1000.
FOILS = """\
format: 1
time: {{end: 6, shedding_interval: 0.01, output_interval: 1}}
fluid: {{density: 1, viscosity: 1.25e-3}}
{}
defaults:
  fish:
    nodes: 9
    force: pressure
    pressure: {{span: infinite}}
    start: {{speed: 1.25}}
    wave: {{amplitude: 0, frequency: 0}}
    body: {{profile: uniform, thickness: 0.08, depth: 1}}
    motion: {{prescribed: all, heave: 0.125, pitch: 10, pitch_phase: 90, pivot: 0.33333333, frequency: 1}}
fish:
  - {{name: first}}
{}"""
BRIEF = "wake: {lifetime: 3 beats, decay: 2.25 beats}"


def reference(name):
    """The rows of a table of tests/verify/data."""
    with open(os.path.join(HERE, "tests/verify/data", name), encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def power_and_thrust(bench, wake, second=""):
    """Coefficients of power and thrust of every foil, mean of the last two periods."""
    run = bench.run(FOILS.format(wake, second))
    return (np.mean(run["mean_power"][-2:], axis=0) / (0.5 * 1.25**3),
            np.mean(run["mean_thrust"][-2:], axis=0) / (0.5 * 1.25**2))


@table("foil 2", "phase", "CP ratio of foil 1: NS", "3 beats", "default", "CP ratio of foil 2: NS", "3 beats", "default",
       "change of CP of foil 2: NS", "3 beats", "default", "change of CT of foil 2: NS", "3 beats", "default")
def pairs_of_foils(bench):
    """two foils beside a Navier-Stokes solution, with a wake of 3 beats and the default one (a minute)"""
    wakes = (BRIEF, "")
    alone = [power_and_thrust(bench, wake) for wake in wakes]
    for row in reference("school_navier_stokes.csv"):
        distance, phase = float(row["distance"]), int(row["phase"])
        place = (1 + distance, 0) if row["place"] == "in line" else (0, distance)
        second = f"  - {{name: second, start: {{position: [{place[0]}, {place[1]}]}}, motion: {{phase: {phase}}}}}\n"
        of = [power_and_thrust(bench, wake, second) for wake in wakes]
        ratio = [[power[i] / single[0][0] for (power, _), single in zip(of, alone)] for i in (0, 1)]
        power = [of[k][0][1] - alone[k][0][0] for k in (0, 1)]
        thrust = [of[k][1][1] - alone[k][1][0] for k in (0, 1)]
        yield (f"{row['place']}, {distance:g}", phase, row["power1"], *(f"{value:.2f}" for value in ratio[0]),
               row["power2"], *(f"{value:.2f}" for value in ratio[1]),
               f"{0.610 * (float(row['power2']) - 1):+.2f}", *(f"{value:+.2f}" for value in power),
               f"{float(row['thrust2']):+.2f}", *(f"{value:+.2f}" for value in thrust))


@table("gap [L]", "NS: power ratio", "place [L]", "3 beats", "place [L]", "default", "place [L]")
def pairs_of_swimmers(bench):
    """a swimmer that follows another one beside a Navier-Stokes solution of its midlines (a minute)"""
    with open(os.path.join(CASES, "swimmer_navier_stokes.yaml"), encoding="utf-8") as file:
        text = file.read()
    head, fish = text.split("fish:\n  - name: swimmer\n")
    body = "".join(f"  {line}\n" for line in fish.rstrip("\n").split("\n"))
    begin = head.replace("end: 12", "end: 6")
    pair = (f"defaults:\n  fish:\n{body}fish:\n  - {{name: first, start: {{speed: 0.634}}}}\n"
            "  - {name: second, start: {position: [%g, 0], speed: 0.634}}\n")
    for row in reference("swimmers_navier_stokes.csv"):
        cells = []
        for wake in (BRIEF + "\n", ""):
            run = bench.run(begin + wake + pair % (1 + float(row["gap"])))
            n = int(round(1 / (run.time[-1] - run.time[-2])))
            behind = np.mean(run["x"][-n:, 1, 0] - run["x"][-n:, 0, 0], axis=0)
            power = run["mean_power"][-1]
            cells += [f"{power[1] / power[0]:.2f}", f"{behind[0]:.2f}, {abs(behind[1]):.2f}"]
        yield row["gap"], f"{row['power']} ({row['wake']})", f"{row['along']}, {row['beside']}", *cells


# Pairs of publications whose fish differ from ours: what carries over is a sign, a slope or a ratio.
DEFAULT_PAIR = """\
format: 1
time: {end: 4, shedding_interval: 0.02, output_interval: 0.1}
%s
defaults: {fish: {nodes: 17, start: {speed: 0.8}, control: {law: course}}}
fish: [{name: leader}, {name: follower, start: {position: [%g, 0.31]}, wave: {phase: %d}}]
"""
PITCHING = """\
format: 1
time: {end: 30, shedding_interval: 0.02, output_interval: 0.1}
fluid: {density: 1, viscosity: 1e-3}
%s
defaults:
  fish:
    nodes: 5
    force: pressure
    pressure: {span: infinite}
    start: {speed: 1}
    wave: {amplitude: 0, frequency: 0}
    body: {profile: uniform, thickness: 0.05, depth: 1, density: 20, modulus: 1e6}
    motion: {prescribed: all, surge: free, pitch: 15, frequency: 1}
fish:
  - {name: first}
"""


def slope_of_least_power(bench, wake):
    """Change of the phase at which a follower of the default fish needs the least power, degrees per wavelength U/f."""
    phases, places, least = np.arange(0, 360, 45), [], []
    for distance in (1.2, 1.4, 1.6, 1.8, 2.0):
        ratio = []
        for phase in phases:
            run = bench.run(DEFAULT_PAIR % (wake, distance, phase))
            n = int(round(1 / (run.time[-1] - run.time[-2])))
            places.append(np.mean(run["x"][-n:, 1, 0, 0] - run["x"][-n:, 0, 0, 0]))
            ratio.append(run["mean_power"][-1][1] / run["mean_power"][-1][0])
        least.append(np.angle(-np.mean(np.array(ratio) * np.exp(1j * np.radians(phases)))))
    places = np.mean(np.reshape(places, (-1, len(phases))), axis=1)
    return np.degrees(np.polyfit(places, np.unwrap(least), 1)[0]) * run["speed"][-1][0]


def best_efficiency(bench, wake):
    """Efficiency of a follower of the swimmer at Re 5000 one length behind over that alone, U^2.5/power for a drag of a
    laminar boundary layer: the best of six phases in line, and of those 0.2 and 0.4 lengths beside."""
    with open(os.path.join(CASES, "swimmer_navier_stokes.yaml"), encoding="utf-8") as file:
        head, fish = file.read().split("fish:\n  - name: swimmer\n")
    body = "".join(f"  {line}\n" for line in fish.rstrip("\n").split("\n"))
    text = (f"{head.replace('end: 12', 'end: 6').replace('rtol: 1e-6', 'rtol: 1e-4')}{wake}\ndefaults:\n  fish:\n{body}"
            "      control: {law: course}\nfish:\n  - {name: first, start: {speed: 0.634}}\n")

    def efficiency(more=""):
        run = bench.run(text + more)
        return run["speed"][-1][-1] ** 2.5 / run["mean_power"][-1][-1]

    alone = efficiency()
    best = [max(efficiency(f"  - {{name: second, start: {{position: [2, {beside}], speed: 0.634}}, wave: {{phase: {phase}}}}}\n")
                for phase in range(0, 360, 60)) / alone for beside in (0, 0.2, 0.4)]
    return best[0], max(best[1:])


def changes_of_cost(bench, wake):
    """Change of the cost of transport of pitching foils that swim freely, %, from that alone."""
    def costs(more=""):
        run = bench.run(PITCHING % wake + more)
        return run["mean_power"][-1] / run["speed"][-1]

    alone = costs()[0]
    for keys in ("position: [0, 0.6]}", "position: [0, 0.6]}, motion: {phase: 180}", "position: [1.8, 0]}",
                 "position: [1.8, 0]}, motion: {phase: 90}", "position: [1.5, 0.5]}"):
        both = costs(f"  - {{name: second, start: {{{keys}}}\n") / alone - 1
        yield 100 * (np.mean(both) if "[0, " in keys else both[1])


@table("publication", "pair", "there", "3 beats", "default")
def published_pairs(bench):
    """signs, slopes and ratios of three publications on pairs, which have other bodies (two minutes)"""
    def of_both(function):
        return zip(*(function(bench, wake) for wake in (BRIEF, "")))

    slopes = [slope_of_least_power(bench, wake) for wake in (BRIEF, "")]
    yield ("Li et al. (2020), robots", "phase of the follower's least power over its place, degrees a wavelength", "-360",
           *(f"{slope:.0f}" for slope in slopes))
    for pair, there, here in zip(("in line, one length apart", "offset"), ("1.16", "1.42"), of_both(best_efficiency)):
        yield ("Maertens et al. (2017), Navier-Stokes in two dimensions, Re 5000",
               f"efficiency of the follower over that alone, best phase, {pair}", there, *(f"{value:.2f}" for value in here))
    pairs = ("side by side, in phase: both", "side by side, in antiphase: both", "in line, in phase: follower",
             "in line, a quarter ahead: follower", "diagonal, in phase: follower")
    for pair, there, here in zip(pairs, ("less", "more", "less", "less", "less"), of_both(changes_of_cost)):
        yield ("Heydari et al. (2024), pitching foils, Re 1645", f"cost of transport, {pair}", there,
               *(f"{value:+.0f} %" for value in here))


# Swims for the table leg_impulse: a case or a text, and keys.
TWO = """\
format: 1
time: {{end: 12, shedding_interval: 0.02, output_interval: 0.1}}
defaults: {{fish: {{start: {{speed: 0.8}}, control: {{law: course}}}}}}
fish:
  - {{name: first}}
  - {{name: second, {}}}
"""
LEG_CASES = (
    ("one fish ([swim](../cases/swim.yaml))", "swim", ()),
    ("depth 0.1 L", "swim", ("fish[0].body.depth=0.1",)),
    ("depth 0.5 L", "swim", ("fish[0].body.depth=0.5",)),
    ("a pair in antiphase, 0.4 L apart", TWO.format("start: {position: [0, 0.4]}, wave: {phase: 180}"), ()),
    ("a leader, and a follower 1.5 L behind", TWO.format("start: {position: [1.5, 0.1]}"), ()),
)


@table("case", "drag [N s]", "`leg_impulse` [N s]", "over drag", "balance over drag")
def leg_impulse(bench):
    """momentum that the growing lengths of legs take in a beat, along the course"""
    for name, case, keys in LEG_CASES:
        run = bench.run(case, *keys)
        first = run.nearest(run.time[-1] - 1)
        ahead = run["com"][-1] - run["com"][first]
        ahead /= np.linalg.norm(ahead, axis=1)[:, None]
        drag, legs = (abs(float(np.sum((run[key][-1] - run[key][first]) * ahead))) for key in ("external_impulse", "leg_impulse"))
        balance = float(np.linalg.norm(run["momentum_balance"][-1] - run["momentum_balance"][first]))
        yield name, f"{drag:.3f}", f"{legs:.3f}", f"{legs / drag:.2f}", short(balance / drag)


NINE = """\
format: 1
time: {{end: 3, shedding_interval: {interval}, output_interval: 1}}
defaults: {{fish: {{start: {{speed: 0.8}}, pressure: {{span: {span}}}}}}}
fish:
"""


@table("case", "span", "interval", "released", "kept", "balance [N s]")
def markers(bench):
    """markers of a wake of three beats, and the momentum balance, of one fish and of nine dense ones"""
    dense = [f"  - {{start: {{position: [{1.4 * (i // 3) + 0.2 * (i % 3):g}, {0.4 * (i % 3):g}]}}}}\n" for i in range(9)]
    for name, fish in (("one fish", ["  - {}\n"]), ("nine dense fish", dense)):
        for span in ("finite", "infinite"):
            for interval in (0.02, 0.01):
                run = bench.run(NINE.format(span=span, interval=interval) + "".join(fish))
                kept = int(run["wake_count"][-1].sum())
                balance = float(np.linalg.norm(run["momentum_balance"][-1].sum(axis=0)))
                yield name, span, interval, len(fish) * round(3 / interval), kept, short(balance)


FOLLOWER = """\
format: 1
time: {{end: 10, shedding_interval: 0.02, output_interval: 0.1}}
wake: {{lifetime: {lifetime} beats, decay: {decay} beats}}
steady: {{formation: true, tolerance: 1e-3, beats: 250}}
defaults: {{fish: {{nodes: 17, start: {{speed: 0.8}}, control: {{law: course}}}}}}
fish: [{{name: leader}}, {{name: follower, start: {{position: {place}}}}}]
"""


@table("lifetime", "decay", "speed", "cost", "beats", "1.5 m", "1.95 m", "3 m", "4 m", "4.4 m", "multiplier", "beats of the pair",
       "balance [N s]", "CPU time of the diamond [s]")
def lifetimes(bench):
    """one fish, a follower and the diamond, with wakes of 3 to 20 beats (two minutes)"""
    for lifetime, decay in ((3, 2.25), (5, 1.25), (8, 2), (12, 3), (20, 1)):
        keys = (f"wake.lifetime={lifetime} beats", f"wake.decay={decay} beats")
        alone = bench.steady("swim", *keys)
        changes = []
        for place, t in (("[1.5, 0]", 4), ("[1.95, 0]", 4), ("[3, 0.1]", 10), ("[4, 0.1]", 10), ("[4.4, 0.1]", 10)):
            run = bench.run(FOLLOWER.format(lifetime=lifetime, decay=decay, place=place))
            cost = run["cost_of_transport"][run.nearest(t)]
            changes.append(f"{100 * (cost[1] / cost[0] - 1):+.2f} %")
        pair = bench.steady(FOLLOWER.format(lifetime=lifetime, decay=decay, place="[1.95, 0]"))
        swim = bench.run("swim", *keys, "time.end=12")
        yield (lifetime, decay, f"{alone['steady_speed'][0]:.5f}", f"{alone['steady_cost_of_transport'][0]:.5f}", alone["steady_beats"],
               *changes, f"{max(math.hypot(*value) for value in pair['steady_multiplier']):.3f}" if pair else "not found",
               pair["steady_beats"] if pair else "over 250",
               short(float(np.linalg.norm(swim["momentum_balance"][-1].sum(axis=0)))),
               f"{bench.seconds('diamond_pressure', *keys, 'time.shedding_interval=0.01', 'time.end=12', repeats=1):.2f}")


# ---- documents ----

COMMAND = re.compile(r"^`scripts/measure\.py ([a-z_]+)`")
IN_TEXT = re.compile(r"`scripts/measure\.py\s([a-z_]+)`")


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
            sys.exit(f"measure.py: {path}: there is no table {name}")
        named.remove(name)

        # the paragraph of the command, then the table, if there is one
        while at < len(lines) and lines[at]:
            out.append(lines[at])
            at += 1
        begin = at + 1
        while at + 1 < len(lines) and (lines[at].startswith("|") or lines[at + 1].startswith("|")):
            at += 1
        print(f"{path}: {name}", file=sys.stderr)
        heads, rows = TABLES[name]
        now = markdown(list(heads), [list(row) for row in rows(bench)]).rstrip("\n").split("\n")
        shown, printed = rows_of(lines[begin:at]), rows_of(now)
        different = [pair for pair in zip_longest(shown, printed, fillvalue=[]) if not is_same_row(heads, *pair)]
        if different:
            n_different += 1
            print(f"{path}:{begin + 1}: `scripts/measure.py {name}` differs",
                  *(f"    {sign} {' | '.join(row)}" for pair in different for sign, row in zip("-+", pair)), sep="\n")
        out += ["", *now, ""]
        at += 1
    if is_write:
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(out))

    for name in named:
        print(f"{path}: compare the numbers in the text with the table {name}")
        heads, rows = TABLES[name]
        print(markdown(list(heads), [list(row) for row in rows(bench)]))
    return n_different


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="tables or documents")
    parser.add_argument("--compare", action="store_true", help="NAMEs are documents")
    parser.add_argument("--write", action="store_true", help="NAMEs are documents, to be changed")
    parser.add_argument("--list", action="store_true", help="list the tables")
    parser.add_argument("--picture", metavar="FILE", help="draw the table real_time of doc/performance.md")
    parser.add_argument("--program", default=os.path.join(HERE, "build", "shoal"), help="default: build/shoal")
    parser.add_argument("--before", default=os.path.join(HERE, "build", "before", "build", "shoal"),
                        help="the program before, of `make bench`; default: build/before/build/shoal")
    parser.add_argument("--verbose", action="store_true", help="show the commands")
    options = parser.parse_args()
    if options.list:
        for name, (_, rows) in TABLES.items():
            print(f"{name:14s} {rows.__doc__}")
        return
    if options.picture:
        return draw_real_time(options.picture)
    bench = Bench(os.path.abspath(options.program), options.verbose, os.path.abspath(options.before))
    n_different = 0
    try:
        for name in options.names:
            if options.compare or options.write:
                n_different += compare(bench, name, options.write)
            elif name in TABLES:
                heads, rows = TABLES[name]
                print(markdown(list(heads), [list(row) for row in rows(bench)]), end="")
            else:
                parser.error(f"there is no table {name}: {', '.join(TABLES)}")
    finally:
        shutil.rmtree(bench.folder)
    sys.exit(1 if n_different else 0)


if __name__ == "__main__":
    main()
