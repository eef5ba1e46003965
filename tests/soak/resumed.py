#!/usr/bin/python3
"""resumed.py PROGRAM [CASES [FIRST]]: random schools on one thread, on two, and ended early and resumed on two; every bit
but the wall time must be equal. CASES of them (120), numbers FIRST on (0): one to six fish of every force, span, kind of
shedding and method, with walls, gusts, vortices and control, whose wakes lose markers, fade and end in the run."""

import random

from common import argument, different, finish, judge, shoal, values, write

n_cases, first = argument(2, 120), argument(3, 0)


def draw_fish(draw, k, span, can_press):
    """One fish as keys of a case file."""
    laws = ["none", "none", "course", "heading, desired_heading: 150", f"place, of: f0, offset: [{1.2 * k:.1f}, 0.2]" if k else "course"]
    force = draw.choice([f"force: pressure, pressure: {{span: {span}}}"] * 4 * can_press + ["force: reactive"])
    start = (f"position: [{draw.choice([0.3, 1.2]) * k + draw.uniform(-0.1, 0.1):.3f}, {draw.choice([0.35, -0.5]) * k:.3f}], "
             f"heading: {draw.uniform(170, 190):.2f}, speed: {draw.choice([0.5, 0.8, 2])}")
    return (f"  - {{name: f{k}, {force}, nodes: {draw.choice([9, 13])}, start: {{{start}}},\n"
            f"     wave: {{phase: {draw.uniform(0, 360):.1f}, amplitude: {draw.uniform(0.2, 0.5):.3f}}}, "
            f"body: {{depth: {draw.choice([0.15, 0.25, 0.4])}}}, control: {{law: {draw.choice(laws)}}}}}\n")


def draw_case(draw):
    """The text of a case, and the time at which it is ended early."""
    interval = draw.choice([0.01, 0.02, 0.02])
    n_events = draw.randrange(60, 130)
    span = draw.choice(["finite", "finite", "infinite"])
    shedding = draw.choice(["sheet"] * 5 + ["continuous"]) if span == "infinite" else "sheet"
    fluid = draw.choice(["", "", "fluid: {walls: [-3, 3]}\n", "fluid: {gust: {amplitude: 0.1, frequency: 1}}\n"])
    method = draw.choice(["ida"] * 5 + [f"imex, step: {interval}"])
    early = draw.randrange(5, n_events - 5)
    text = (f"format: 1\ntime: {{end: {n_events * interval:.2f}, shedding_interval: {interval}, output_interval: {interval}}}\n"
            f"wake: {{shedding: {shedding}, lifetime: {draw.choice([0.9, 1.3, 8])}, decay: {draw.choice([0.2, 0.5])}}}\n"
            f"solver: {{method: {method}}}\n{fluid}fish:\n"
            + "".join(draw_fish(draw, k, span, shedding == "sheet") for k in range(draw.choice([1, 2, 2, 3, 4, 6]))))
    return text, f"{early * interval:.2f}", f"{n_events * interval:.2f}"


n_refused = 0
for number in range(first, first + n_cases):
    text, early, end = draw_case(random.Random(number))
    write("case.yaml", text)
    runs = {"one": ["1"], "two": ["2"], "part": ["1", "--set", f"time.end={early}"]}
    done = {name: shoal("run", "case.yaml", "-q", "--force", "-o", name + ".nc", "--checkpoint-at", early, "--threads", *options)
            for name, options in runs.items()}
    if done["one"].returncode != 0:
        # a school that the program refuses, or that collides: alike on two threads
        n_refused += 1
        judge(f"{number}: refused", done["two"].stderr != done["one"].stderr and done["two"].stderr)
        print(number, done["one"].stderr.strip()[:150])
        continue
    resumed = shoal("resume", "part.nc", "-q", "--end", end, "--threads", "2")
    judge(f"{number}: exit codes", [name for name in done if done[name].returncode] or resumed.returncode and resumed.stderr)
    whole = values("one.nc")[1]
    judge(f"{number}: two threads", different("two.nc", whole))
    judge(f"{number}: resumed at {early} s", different("part.nc", whole))
judge("most schools run", n_refused > n_cases / 4 and f"{n_refused} were refused")
finish()
