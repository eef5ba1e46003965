"""The threshold lies between a run that decays and one that grows, and its oscillation has the period of the runs."""
import json
import sys
import netCDF4
import numpy as np

def course(path):
    """Mean heading of each beat of 1 s, less the desired one, degree."""
    with netCDF4.Dataset(path) as data:
        time, heading = np.asarray(data["time"][:]), np.asarray(data["heading"][:, 0])
    return np.array([((heading[(time >= n) & (time < n + 1)] + 180) % 360 - 180).mean() for n in range(60)])

found = json.load(open("course.json"))
runs = {gain: course(f"run{gain}.nc") for gain in (3.4, 3.6)}
# by which the oscillation grows in a beat, from beats 20 to 29 to beats 50 to 59
growth = {gain: (np.std(run[50:]) / np.std(run[20:30])) ** (1 / 30) - 1 for gain, run in runs.items()}
assert growth[3.4] < -0.01 and growth[3.6] > 0.01, growth
zero = 3.4 + 0.2 * growth[3.4] / (growth[3.4] - growth[3.6])
# ten beats are four periods, so that the growth is known to 0.5 %, and the gain without growth to 0.02
assert abs(zero - found["threshold"]) < 0.02, (zero, growth, found)
assert found["unstable"] == "above" and found["kind"] == "Neimark-Sacker", found
assert 0 < found["by_error"] < 0.02 < found["bar"], found
decays = runs[3.4]
crossings = np.sum(np.diff(np.sign(decays[10:50] - decays[40:].mean())) != 0)
assert abs(80 / crossings - found["period"]) < 0.3, (crossings, found)
