#!/usr/bin/python3
"""Measure the tables of doc/performance.md, the speed that README.md states, and what dropping markers saves (doc/numerics.md).

How to call it: scripts/measure/tables.py.
"""

import math
import os
import pathlib
import re
import resource
import subprocess
import time

import numpy as np
from matplotlib import pyplot
from tables import CASES, COUNTS, DEFAULT, HERE, lattice, main, n_events, nose_and_tail, per_event, rows_of, short, table

from shoal._plot_style import LINES, STYLE  # found by tables


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


def resume_full(bench, program, name, n, interval, lifetime, more):
    """Fill the wakes of n fish. Returns a function that goes on from there for `more` seconds, with a number of threads, and returns
    the seconds of CPU time and of wall time."""
    keys = f"start: {{speed: 0.81}}, control: {{law: {'course' if n == 1 else 'heading'}}}"
    with open(os.path.join(bench.folder, name + ".yaml"), "w", encoding="utf-8") as file:
        file.write(lattice(n, (2, 1), lifetime, interval, 0.5, keys) +
                   f"wake: {{lifetime: {lifetime}, decay: {lifetime / 4}}}\nsolver: {{threads: 1}}\n")
    paths = [os.path.join(bench.folder, name + end) for end in (".nc", ".ckpt")]
    for path in paths:
        if os.path.exists(path):
            os.remove(path)
    subprocess.run([program, "run", name + ".yaml", "-q", "--checkpoint-at", f"{lifetime:g}"], cwd=bench.folder, check=True,
                   capture_output=True)
    kept = [pathlib.Path(path).read_bytes() for path in paths]

    def once(threads=1):
        for path, data in zip(paths, kept):
            pathlib.Path(path).write_bytes(data)
        before, begin = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime, time.perf_counter()
        subprocess.run([program, "resume", name + ".ckpt", "-q", "--end", f"{lifetime + more:g}", "--threads", str(threads)],
                       cwd=bench.folder, check=True, capture_output=True)
        return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before, time.perf_counter() - begin
    return once


@table("fish", "CPU time", "wall time, two threads")
def full_wakes(bench):
    """time per simulated second of 1 to 64 default fish with the default interval and full wakes (minutes)"""
    for n, more in ((1, 8), (4, 4), (16, 2), (64, 1)):
        once = resume_full(bench, bench.program, "full", n, 0.01, 8, more)
        yield n, f"{once()[0] / more:.2g}", f"{once(2)[1] / more:.2g}"


EARLIER = "7a50a9ba"


@table("fish", "interval", "lifetime", "earlier lifetime", "CPU time over the earlier")
def earlier(bench):
    """CPU time with full wakes over that of commit 7a50a9ba, which drops no markers: both resume the same schools (minutes)"""
    tree = os.path.join(bench.folder, "earlier")
    os.mkdir(tree)
    archive = subprocess.run(["git", "-C", HERE, "archive", EARLIER], check=True, capture_output=True).stdout
    subprocess.run(["tar", "-x", "-C", tree], input=archive, check=True)
    subprocess.run(["make", "-C", tree, "-j2", "build/shoal"], check=True, capture_output=True)
    now, before = bench.program, os.path.join(tree, "build", "shoal")

    for n, interval, lifetime, over, more in ((1, 0.01, 3, 3, 16), (4, 0.01, 3, 3, 5), (16, 0.01, 3, 3, 1.5), (64, 0.01, 3, 3, 0.5),
                                              (1, 0.02, 3, 3, 16), (4, 0.02, 3, 3, 5), (16, 0.02, 3, 3, 1.5), (64, 0.02, 3, 3, 0.5),
                                              (1, 0.01, 10, 10, 8), (4, 0.01, 10, 10, 2), (1, 0.01, 8, 3, 8), (4, 0.01, 8, 3, 4)):
        runs = [resume_full(bench, now, "now", n, interval, lifetime, more),
                resume_full(bench, before, "before", n, interval, over, more)]
        times = [min(pair) for pair in zip(*([run()[0] for run in runs] for _ in range(3 if n < 16 else 2 if n < 64 else 1)))]
        yield n, interval, lifetime, over, f"{times[0] / times[1]:.2f}"


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


def draw_real_time(path):
    """draw the table real_time of doc/performance.md"""
    with open(os.path.join(HERE, "doc/performance.md"), encoding="utf-8") as file:
        lines = file.read().split("`scripts/measure/performance.py real_time`", 1)[1].split("\n\n", 2)[1]
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


if __name__ == "__main__":
    main("README.md", "doc/performance.md", "doc/numerics.md", picture=draw_real_time)
