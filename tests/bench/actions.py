#!/usr/bin/python3
"""actions.py PROGRAM LIBRARY [SECONDS]: what an environment of the module shoal costs.

One action an event: CPU time in Python over that of PROGRAM (tests/bench/actions.c), which does the same in C. And the
actions that SwimVectorEnv makes in a second of wall clock with one thread, with two, and in two processes, which share
nothing: the most that the machine gives at this time.
"""

import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import time

program, os.environ["SHOAL_LIBRARY"] = sys.argv[1:3]
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import shoal  # noqa: E402

END = float(sys.argv[3]) if len(sys.argv) > 3 else 3.0
CASE = {"format": 1, "name": "pair", "time": {"end": END, "shedding_interval": 0.02, "output_interval": 0.02},
        "fish": [{"name": "leader"}, {"name": "follower", "start": {"position": [1.5, 0.3]}}]}
FOLLOWER = dict(fish="follower", actions=("bias",), goal=("leader", (1.5, 0.3)),
                observations=("velocity", "heading", "goal", "closing", "curvature"),
                reward={"speed": 1.0, "cost_of_transport": 0.01})


def in_python(env):
    """CPU time of one action, us: the least of three episodes."""
    least = math.inf
    for _ in range(3):
        start, n, truncated = time.process_time(), 0, False
        env.reset()
        while not truncated:
            truncated = env.step([0.2 * math.sin(0.1 * n)])[3]
            n += 1
        least = min(least, 1e6 * (time.process_time() - start) / n)
    return least


def in_c(case):
    return float(subprocess.run([program, case], check=True, capture_output=True, text=True).stdout)


def with_threads(threads, n_envs=8):
    """Actions in a second of wall clock."""
    many = shoal.SwimVectorEnv(n_envs, CASE, {"time.end": min(END, 1)}, threads=threads, **FOLLOWER)
    many.reset()
    start, n = time.perf_counter(), 0
    while True:
        truncated = many.step([[0.2 * math.sin(0.1 * n)]] * n_envs)[3]
        n += 1
        if truncated.all():
            break
    taken = time.perf_counter() - start
    many.close()
    return n_envs * n / taken


def in_processes(n, n_envs=8):
    """The same in n processes, each with its part of the environments."""
    start = time.perf_counter()
    children = []
    for _ in range(n):
        child = os.fork()
        if child == 0:
            with_threads(1, n_envs // n)
            os._exit(0)
        children.append(child)
    for child in children:
        os.waitpid(child, 0)
    return n_envs * round(min(END, 1) / 0.02) / (time.perf_counter() - start)


with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "pair.yaml")
    pathlib.Path(path).write_text(json.dumps(CASE))
    env = shoal.SwimEnv(CASE, **FOLLOWER)
    pairs = [(in_c(path), in_python(env)) for _ in range(2)]
c, python = (min(times) for times in zip(*pairs))
print(f"an action and an event of two fish: {c:.0f} us in C, {python:.0f} us in Python, ratio {python / c:.3f}")
one, two, apart = (max(rates) for rates in zip(*((with_threads(1), with_threads(2), in_processes(2)) for _ in range(2))))
print(f"SwimVectorEnv of 8: {one:.0f} actions a second with one thread, {two:.0f} with two (ratio {two / one:.2f}), "
      f"{apart:.0f} in two processes (ratio {apart / one:.2f})")
