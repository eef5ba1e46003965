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
decays, grows = course("run3.3.nc"), course("run3.8.nc")
assert np.ptp(decays[50:]) < 0.5 * np.ptp(decays[20:30]), decays
assert np.ptp(grows[50:]) > 2 * np.ptp(grows[20:30]), grows
assert found["unstable"] == "above" and found["kind"] == "Neimark-Sacker", found
assert found["threshold"] - found["bar"] < 3.8 and found["threshold"] + found["bar"] > 3.3, found
assert 0 < found["by_error"] < found["bar"] < 1, found
crossings = np.sum(np.diff(np.sign(decays[10:50] - decays[40:].mean())) != 0)
assert abs(80 / crossings - found["period"]) < 0.3, (crossings, found)
