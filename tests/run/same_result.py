#!/usr/bin/python3
"""same_result.py A B: whether two result files hold the same bits in every variable but wall_time."""

import sys

import netCDF4
import numpy as np

first, second = (netCDF4.Dataset(path) for path in sys.argv[1:3])
first.set_auto_mask(False)
second.set_auto_mask(False)
assert list(first.variables) == list(second.variables)
for name in first.variables:
    if name != "wall_time":
        a, b = (np.ascontiguousarray(data[name][...]) for data in (first, second))
        assert a.shape == b.shape and a.tobytes() == b.tobytes(), name
assert first.run_status.rstrip("\0") == second.run_status.rstrip("\0") == "complete"
