#!/usr/bin/python3
"""Measure the tables and numbers of doc/numerics.md: tolerances, methods, intervals, couplings, wakes.

How to call it: scripts/measure/tables.py.
"""

import csv
import functools
import math
import os

import numpy as np
from tables import CASES, COUNTS, DEFAULT, lattice, main, n_events, nose_and_tail, per_event, power, short, table

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


def error_of(results, right, t=None):
    """The larger of the errors of nose and tail."""
    pairs = zip(nose_and_tail(results, t), nose_and_tail(right, t))
    return max(float(np.linalg.norm(np.subtract(a, b))) for a, b in pairs)


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


@functools.cache
def error_tables(bench):
    """What `shoal error` finds for speed and cost of the default fish: one table for each force."""
    found = []
    for force in ("reactive", "pressure"):
        text, folder = DEFAULT.replace("{name: fish}", f"{{name: fish, force: {force}}}"), f"error-{force}"
        bench.call("error", bench.case(text), "--of", "steady_speed", "--of", "steady_cost_of_transport", "--models",
                   "-q", "--force", "-o", folder)
        with open(os.path.join(bench.folder, folder, "error.csv"), encoding="utf-8", newline="") as file:
            found.append(list(csv.DictReader(file)))
    return found


def error_rows(bench, are_choices):
    """Keys with levels and errors, in per cent, of speed and cost of the default fish with both forces."""
    rows = {}
    for number, table_of_force in enumerate(error_tables(bench)):
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


@table("fish", "spacing [L]", "coupling distance [L]", *COUNTS)
def school(bench):
    """cost of an event over the number of fish and the coupling distance (a minute)"""
    for n, spacing, reach in ((4, (1.5, 1.5), 0.5), (16, (1.5, 1.5), 0.5), (64, (1.5, 1.5), 0.5), (64, (1.5, 1.5), 0),
                              (9, (1.3, 0.4), 0), (9, (1.3, 0.4), 0.5), (9, (1.3, 0.4), 100)):
        run = bench.run(lattice(n, spacing, 0.5), f"solver.coupling_distance={reach}")
        yield n, f"{spacing[0]:g} x {spacing[1]:g}", reach, *(per_event(run) if run else ["failed", "", ""])


@table("threads", "same bits as one")
def threads(bench):
    """bodies and wakes of 64 fish after 0.1 s"""
    reference = None
    for n in (1, 2, 3):
        run = bench.run(lattice(64, (1.4, 0.6), 0.1), f"solver.threads={n}")
        bits = run["x"].tobytes() + run["wake_x"].tobytes()
        reference = reference or bits
        yield n, "yes" if bits == reference else "NO"


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
                balance = float(np.linalg.norm(run["momentum_balance"][-1]))
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
               short(float(np.linalg.norm(swim["momentum_balance"][-1]))),
               f"{bench.seconds('diamond_pressure', *keys, 'time.shedding_interval=0.01', 'time.end=12', repeats=1):.2f}")


if __name__ == "__main__":
    main("doc/numerics.md")
