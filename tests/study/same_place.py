"""same_place.py A B: whether the second fish has one place in two steady states."""

import sys

import netCDF4

one, other = (netCDF4.Dataset(path)["steady_place"][1, 0] for path in sys.argv[1:])
sys.exit(not abs(one - other) < 5e-3)
