#!/usr/bin/python3
"""kills.py PROGRAM [KILLS [SEED]]: kill and stop runs at random times, a quarter of them while they are resumed, and resume
them until they are complete: every result must have the bits of a run that nobody disturbed (200 kills: minutes)."""

import os
import random
import signal
import subprocess
import sys
import tempfile
import time

import netCDF4
import numpy as np

program = os.path.abspath(sys.argv[1])
n_kills = int(sys.argv[2]) if len(sys.argv) > 2 else 200
seed = int(sys.argv[3]) if len(sys.argv) > 3 else 1
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


def run(*arguments):
    done = subprocess.run([program, *arguments, "-q"], stdin=subprocess.DEVNULL, capture_output=True, text=True)
    return done.returncode, done.stderr


def killed(seconds, number, *arguments):
    """Start the program and send it a signal after some time; its exit code."""
    process = subprocess.Popen(
        [program, *arguments, "-q"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    time.sleep(seconds)
    process.send_signal(number)
    message = process.communicate()[1]
    return process.returncode, message


def variables(path):
    with netCDF4.Dataset(path) as data:
        data.set_auto_mask(False)
        names = [name for name in data.variables if name != "wall_time"]
        return ({name: np.ascontiguousarray(data[name][...]).tobytes() for name in names},
                data.run_status.strip("\0"), data.checkpoint_at.strip("\0"))


def rows_are_whole(path, whole):
    """Every row that counts is that of the undisturbed run; only asked where that renewed itself at the same times."""
    with netCDF4.Dataset(path) as data, netCDF4.Dataset(whole) as other:
        data.set_auto_mask(False)
        other.set_auto_mask(False)
        if data.checkpoint_at.strip("\0"):
            return True
        n = len(data["time"])
        grows = [name for name in data.variables if "time" in data[name].dimensions and name != "wall_time"]
        return all(data[name][...].tobytes() == other[name][:n].tobytes() for name in grows)


def attempt(way, length, counts):
    """One run with its kills; what is wrong, or None."""
    code, message = killed(random.uniform(0, 1.1) * length, random.choice(SIGNALS), "run", "case.yaml", *way, "-o", "x.nc")
    counts["kills"] += 1
    for _ in range(100):
        if code == 0:
            break
        if code not in (75, -signal.SIGKILL, -signal.SIGTERM, -signal.SIGUSR1):
            return f"exit code {code}: {message}"
        if os.path.exists("x.nc") and not rows_are_whole("x.nc", "whole.nc"):
            return "a row that counts is not that of the undisturbed run"
        if os.path.exists("x.nc") and variables("x.nc")[1] == "complete":
            break  # killed after its last row
        # killed before the first checkpoint: there is nothing to go on from
        again = ["resume", "x.ckpt"]
        if not os.path.exists("x.ckpt") and not os.path.exists("x.ckpt.previous"):
            again = ["run", "case.yaml", *way, "-o", "x.nc", "--force"]
        if counts["in resume"] * 4 < counts["kills"] and again[0] == "resume":
            code, message = killed(random.uniform(0, 0.8) * length, random.choice(SIGNALS), *again)
            counts["in resume"] += 1
            counts["kills"] += 1
        else:
            code, message = run(*again)
    found, status, places = variables("x.nc")
    if status != "complete":
        return f"it is {status}"
    whole = "whole.nc"
    if places:
        whole = "same.nc"
        code, message = run("run", "case.yaml", *way, "-o", whole, "--force", "--checkpoint-at", places)
        if code != 0:
            return message
    wanted = variables(whole)[0]
    wrong = [name for name in wanted if wanted[name] != found.get(name)]
    return f"other bits in {', '.join(wrong)} (checkpoints at {places or 'the interval'})" if wrong else None


counts = {"kills": 0, "in resume": 0, "runs": 0, "wrong": 0}
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    open("case.yaml", "w").write(CASE)
    while counts["kills"] < n_kills:
        way = WAYS[counts["runs"] // 4 % len(WAYS)]
        if counts["runs"] % 4 == 0:
            started = time.monotonic()
            code, message = run("run", "case.yaml", *way, "-o", "whole.nc", "--force")
            assert code == 0, message
            length = time.monotonic() - started
        wrong = attempt(way, length, counts)
        counts["runs"] += 1
        if wrong:
            counts["wrong"] += 1
            print(f"FAILED  run {counts['runs']} ({' '.join(way)}): {wrong}", flush=True)
        for name in os.listdir("."):
            if name.startswith("x."):
                os.unlink(name)
    os.chdir("/")
print(f"{counts['kills']} kills of {counts['runs']} runs, {counts['in resume']} of them while resuming; seed {seed}")
print(f"{counts['runs'] - counts['wrong']} passed, {counts['wrong']} failed, 0 skipped")
sys.exit(counts["wrong"] > 0)
