#!/usr/bin/python3
"""Measure the tables of doc/steady.md.

How to call it: scripts/measure/tables.py.
"""

import math
import re
import subprocess

from tables import main, short, table


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


# Default fish under course control, on a coarse body and in a coarse wake.
FISH = """\
format: 1
time: {end: 10, shedding_interval: 0.05, output_interval: 0.1}
steady: {formation: true, tolerance: 1e-3, beats: 80}
defaults: {fish: {nodes: 9, sheet_points: 26, start: {speed: 0.8}, control: {law: course}}}
"""
FORMATIONS = [  # places behind and to the left of the first fish, m; phases in the second case of each, degrees
    ("two in line, near", [(0, 0), (1.5, 0)], [0, 180]),
    ("two in line, far", [(0, 0), (2.1, 0)], [0, 180]),
    ("two abreast", [(0, 0), (0, 0.5)], [0, 180]),
    ("three in line", [(0, 0), (1.5, 0), (3, 0)], [0, 180, 0]),
    ("triangle", [(0, 0), (1, 0.5), (1, -0.5)], [0, 0, 180]),
    ("four in line", [(0, 0), (1.5, 0), (3, 0), (4.5, 0)], [0, 180, 0, 180]),
    ("diamond", [(0, 0), (1, 0.5), (1, -0.5), (2, 0)], [0, 0, 180, 0]),
]
REASONS = [  # in a message: what the fish do
    (r"collision: after release, (\w+) and (\w+) approach", r"\1 and \2 collide"),
    (r"drift: after release, (\w+) drifts (back|ahead|to the left|to the right) .*? by (\S+) lengths", r"\1 drifts \2 by \3 m a beat"),
    (r"the fish hardly interact", "the fish hardly interact"),
    (r"after release, the fish stay together with a residual change per beat of (\S+),", r"together, but for changes of \1 a beat"),
    (r"the body of (\w+) folds", r"the body of \1 folds"),
]


@table("formation", "phases", "largest multiplier", "its mode", "without a steady state: released, the fish")
def formations(bench):
    """which formations of two to four default fish hold together (minutes)"""
    for name, places, antiphase in FORMATIONS:
        for phases in ([0] * len(places), antiphase):
            rows = [f"  - {{name: {letter}, start: {{position: [{x}, {y}]}}, wave: {{phase: {phase}}}}}"
                    for letter, (x, y), phase in zip("abcd", places, phases)]
            path = bench.case(FISH + "fish:\n" + "\n".join(rows) + "\n")
            done = subprocess.run([bench.program, "steady", path, "--force", "-o", "steady.nc"], cwd=bench.folder, capture_output=True,
                                  text=True, check=False)
            kind = "in phase" if not any(phases) else "antiphase"
            found = re.search(r"modes:\n +(\S+) \+- (\S+?)(?:, period (\S+) beats)?: (.*)", done.stdout)
            if found:
                size, error, period, mode = found.groups()
                verdict = re.search(r"\n  (stable|unstable|undecided)", done.stdout)[1]
                yield name, kind, f"{float(size):.3f} +- {float(error):.3f}, {verdict}", mode + (f", period {period} beats" if period else ""), ""
                continue
            message = re.sub(r"\s+", " ", done.stderr)
            reason = next((re.search(pattern, message).expand(words) for pattern, words in REASONS if re.search(pattern, message)), message[-80:])
            yield name, kind, "", "", reason


if __name__ == "__main__":
    main("doc/steady.md")
