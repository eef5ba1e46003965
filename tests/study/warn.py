"""warn.py RESULT TEXT: make a text the warnings of a result."""

import sys

import netCDF4

with netCDF4.Dataset(sys.argv[1], "a") as data:
    data.warnings = sys.argv[2]
