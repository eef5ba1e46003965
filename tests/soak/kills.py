#!/usr/bin/python3
"""kills.py PROGRAM [KILLS [SEED]]: kill and stop runs at random times, a quarter of them while they are resumed, and resume
them until they are complete: every result must have the bits of a run that nobody disturbed (200 kills: minutes)."""

import os
import random
import signal
import subprocess
import time

import netCDF4

from common import argument, counts, different, finish, judge, program, shoal, succeed, values, write

n_kills, seed = argument(2, 200), argument(3, 1)
random.seed(seed)

CASE = """format: 1
time: {end: 0.8, shedding_interval: 0.01, output_interval: 0.02}
output: {wake_interval: 0.1}
fish:
  - {name: a, force: reactive, nodes: 7, sheet_points: 21}
  - {name: b, force: reactive, nodes: 9, sheet_points: 21, start: {position: [0.2, 1.5]}, control: {law: heading, desired_heading: 170}}
"""
# options of the runs: the second one writes a checkpoint at every event
WAYS = [
    ["--set", "time.checkpoint_interval=0.1"],
    ["--set", "time.checkpoint_interval=0.01"],
    ["--set", "time.checkpoint_interval=0.05", "--set", "wake.shedding=impulsive", "--threads", "2"],
    ["--set", "time.checkpoint_interval=0.1", "--set", "solver.method=dormand_prince"],
    ["--set", "time.checkpoint_interval=0.2", "--set", "wake.tolerance=0", "--set", "output.precision=single"],
]
SIGNALS = [signal.SIGKILL, signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGUSR1]


def killed(seconds, *arguments):
    """Start the program and send it a signal after some time; its exit code and message."""
    process = subprocess.Popen(
        [program, *arguments, "-q"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    time.sleep(seconds)
    process.send_signal(random.choice(SIGNALS))
    message = process.communicate()[1]
    return process.returncode, message


def places_of(path):
    """The times at which a run was stopped: there it renewed itself."""
    with netCDF4.Dataset(path) as data:
        return data.checkpoint_at.strip("\0")


def attempt(way, length, whole):
    """One run with its kills; what is wrong, or None."""
    code, message = killed(random.uniform(0, 1.1) * length, "run", "case.yaml", *way, "-o", "x.nc")
    counts["kills"] += 1
    while code != 0:
        if code not in (75, -signal.SIGKILL, -signal.SIGTERM, -signal.SIGUSR1):
            return f"exit code {code}: {message}"
        if os.path.exists("x.nc"):
            # every row that counts is that of the undisturbed run, where that renewed itself at the same times
            if not places_of("x.nc") and (names := different("x.nc", whole, rows=True)):
                return f"rows with other bits in {', '.join(names)}"
            if values("x.nc")[0] == "complete":
                break  # killed after its last row
        # killed before the first checkpoint: there is nothing to go on from
        has_checkpoint = os.path.exists("x.ckpt") or os.path.exists("x.ckpt.previous")
        again = ["resume", "x.ckpt"] if has_checkpoint else ["run", "case.yaml", *way, "-o", "x.nc", "--force"]
        if counts["in resume"] * 4 < counts["kills"] and has_checkpoint:
            code, message = killed(random.uniform(0, 0.8) * length, *again)
            counts.update({"in resume": 1, "kills": 1})
        else:
            done = shoal(*again, "-q")
            code, message = done.returncode, done.stderr
    status, places = values("x.nc")[0], places_of("x.nc")
    if places:
        succeed("run", "case.yaml", *way, "-q", "-o", "same.nc", "--force", "--checkpoint-at", places)
        whole = values("same.nc")[1]
    names = different("x.nc", whole)
    return f"{status}, other bits in {', '.join(names)} (checkpoints at {places})" if names or status != "complete" else None


write("case.yaml", CASE)
n_runs = 0
while counts["kills"] < n_kills:
    way = WAYS[n_runs // 4 % len(WAYS)]
    if n_runs % 4 == 0:
        started = time.monotonic()
        succeed("run", "case.yaml", *way, "-q", "-o", "whole.nc", "--force")
        length, whole = time.monotonic() - started, values("whole.nc")[1]
    n_runs += 1
    judge(f"run {n_runs} ({' '.join(way)})", attempt(way, length, whole))
    for name in os.listdir("."):
        if name.startswith("x."):
            os.unlink(name)
print(f"{counts['kills']} kills of {n_runs} runs, {counts['in resume']} of them while resuming; seed {seed}")
finish()
