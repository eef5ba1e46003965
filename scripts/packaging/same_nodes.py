#!/usr/bin/python3
"""same_nodes.py HERE THERE: whether two runs of 1 s end with the same nodes, within 1e-12 m."""

import sys

import netCDF4
import numpy

here, there = (netCDF4.Dataset(path) for path in sys.argv[1:])
distance = numpy.abs(here["x"][-1] - there["x"][-1]).max()
print(f"{sys.argv[1]}: distance of the nodes {distance:.1e} m, limit 1e-12")
sys.exit(float(here["time"][-1]) != 1 or not distance <= 1e-12)
