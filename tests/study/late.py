#!/usr/bin/python3
"""late.py COMPARISON: whether the costs to the end of a method that was stopped are extrapolated, and those of others not."""

import sys

import netCDF4

data = netCDF4.Dataset(sys.argv[1])
late = next(m for m, status in enumerate(data["status"][:]) if status.startswith("failed: too slow"))
t = float(data["time"][late])
assert 0 < t < 2, t
for done, to_end in (("residual_evaluations", "evaluations_to_end"), ("wall_time", "wall_time_to_end")):
    assert data[done][late] > 0
    assert abs(data[to_end][late] - data[done][late] * 2 / t) < 1e-6 * data[to_end][late], (done, t)
    assert abs(data[to_end][0] - data[done][0]) == 0
