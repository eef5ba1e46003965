"""ratios.py STUDY: results over those at one value of an axis; the members 1 and 3 of the four have failed."""

import sys

import netCDF4
import numpy as np

study = netCDF4.Dataset(sys.argv[1])
study.set_auto_mask(False)
assert list(study["relative_member"][:]) == [2, 3, 2, 3]
ratio, speed, steps = study["ratio_speed"][:, 0], study["speed"][:, 0], study["ratio_steps"][:]
assert ratio[0] == speed[0] / speed[2] and ratio[2] == 1 and np.isnan(ratio[[1, 3]]).all(), ratio
assert steps[0] == study["steps"][0] / study["steps"][2] and "ratio_nose" not in study.variables
